// Lists the tetrahedra of the mesh that have a wanted vertex and were not gathered before, and numbers
// them as they are listed, in no order. One invocation per tetrahedron.
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
@group(0) @binding(6) var<storage, read_write> gathered_slots: array<u32>;

var<workgroup> ghosts: u32;
// The tetrahedra of the workgroup at hand that are listed, and the place of the first of them.
var<workgroup> listed: atomic<u32>;
var<workgroup> start_here: u32;

fn is_wanted(v: u32) -> bool {
    return v != control.infinite && ((wanted[v >> 5] >> (v & 31)) & 1) != 0;
}

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    if local == 0 {
        ghosts = atomicLoad(&control.ghosts);
    }
    let len = sums[arrayLength(&sums) - 1] + workgroupUniformLoad(&ghosts);
    for (var start = group.x * WORKGROUP; start < len; start += groups.x * WORKGROUP) {
        if local == 0 {
            atomicStore(&listed, 0u);
        }
        workgroupBarrier();
        let t = start + local;
        var place = NONE;
        if t < len {
            if gathering.first == 1 {
                region_numbers[t] = 0;
            }
            let tet = mesh_tetrahedra[t];
            let is_listed = is_wanted(tet.x) || is_wanted(tet.y) || is_wanted(tet.z) || is_wanted(tet.w);
            if is_listed && region_numbers[t] == 0 {
                place = atomicAdd(&listed, 1u);
            }
        }
        workgroupBarrier();
        // One atomic operation on the counter per workgroup: nearly all may be listed.
        if local == 0 && atomicLoad(&listed) != 0 {
            start_here = atomicAdd(&control.gathered, atomicLoad(&listed));
        }
        workgroupBarrier();
        if place != NONE {
            gathered_slots[start_here + place] = t;
            region_numbers[t] = gathering.first + start_here + place;
        }
    }
}
