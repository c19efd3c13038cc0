// Marks the tetrahedra of the mesh that have a wanted vertex and were not gathered before. One
// invocation per slot.
//!include common/layout
//!include d3/gathering
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> gathering: Gathering;
// The last entry is the number of finite tetrahedra.
@group(0) @binding(2) var<storage, read> sums: array<u32>;
@group(0) @binding(3) var<storage, read> mesh_tetrahedra: array<vec4u>;
// A bit per point.
@group(0) @binding(4) var<storage, read> wanted: array<u32>;
// The number of each tetrahedron that was gathered, or 0.
@group(0) @binding(5) var<storage, read_write> region_numbers: array<u32>;
@group(0) @binding(6) var<storage, read_write> marks: array<u32>;
//!include d3/wanted

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let len = sums[arrayLength(&sums) - 1] + atomicLoad(&control.ghosts);
    for (var t = id.x; t < control.blocks * BLOCK; t += groups.x * WORKGROUP) {
        if gathering.first == 1 {
            region_numbers[t] = 0;
        }
        var mark = 0u;
        if t < len && region_numbers[t] == 0 {
            mark = u32(has_wanted(mesh_tetrahedra[t]));
        }
        marks[t] = mark;
    }
}
