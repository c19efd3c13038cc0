// Copies the listed tetrahedra, with their neighbours by the numbers that these have, or 0. One
// invocation per tetrahedron.
//!include common/layout
@group(0) @binding(0) var<storage, read> gathered_slots: array<u32>;
// The last entry is how many are listed.
@group(0) @binding(1) var<storage, read> gather_sums: array<u32>;
@group(0) @binding(2) var<storage, read> region_numbers: array<u32>;
@group(0) @binding(3) var<storage, read> mesh_tetrahedra: array<vec4u>;
@group(0) @binding(4) var<storage, read> mesh_neighbors: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> gathered_tetrahedra: array<vec4u>;
@group(0) @binding(6) var<storage, read_write> gathered_neighbors: array<vec4u>;

fn renumbered(across: u32) -> u32 {
    return 4 * region_numbers[across >> 2] + (across & 3);
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let count = gather_sums[arrayLength(&gather_sums) - 1];
    for (var i = id.x; i < count; i += groups.x * WORKGROUP) {
        let t = gathered_slots[i];
        let near = mesh_neighbors[t];
        gathered_tetrahedra[i] = mesh_tetrahedra[t];
        gathered_neighbors[i] = vec4u(renumbered(near.x), renumbered(near.y), renumbered(near.z), renumbered(near.w));
    }
}
