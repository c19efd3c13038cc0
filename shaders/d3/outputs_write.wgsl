// Writes the arrays of the mesh: the tetrahedra in the order of their slots, the tetrahedra across
// their facets, and the facets of the hull, which are those of the ghosts opposite infinity. One
// invocation per slot.
//!include d3/outputs
@group(0) @binding(0) var<storage, read> outputs: OutputParams;
@group(0) @binding(1) var<storage, read> mesh_tetrahedra: array<vec4u>;
@group(0) @binding(2) var<storage, read> mesh_neighbors: array<vec4u>;
// The number of tetrahedra of the mesh before each slot.
@group(0) @binding(3) var<storage, read> numbers: array<u32>;
@group(0) @binding(4) var<storage, read_write> out_tetrahedra: array<vec4u>;
// -1 outside the hull.
@group(0) @binding(5) var<storage, read_write> out_neighbors: array<vec4i>;
// Three vertices per facet, in no order.
@group(0) @binding(6) var<storage, read_write> out_hull: array<u32>;
// The facets of the hull that were written.
@group(0) @binding(7) var<storage, read_write> hull_len: atomic<u32>;

// The ghosts of the workgroup's slots at hand, and the number of the first of them.
var<workgroup> ghosts: atomic<u32>;
var<workgroup> first: u32;

fn across(facet: u32) -> i32 {
    let u = facet >> 2;
    let number = numbers[u];
    var next = outputs.finite;
    if u + 1 < outputs.count {
        next = numbers[u + 1];
    }
    return select(-1, i32(number), next != number);
}

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let infinite = outputs.infinite;
    let count = outputs.count;
    for (var start = group.x * WORKGROUP; start < count; start += groups.x * WORKGROUP) {
        if local == 0 {
            atomicStore(&ghosts, 0u);
        }
        workgroupBarrier();
        let t = start + local;
        var tet = vec4u(0);
        if t < count {
            tet = mesh_tetrahedra[t];
        }
        let is_used = any(tet != vec4u(0));
        let is_ghost = is_used && tet.w == infinite;
        var place = 0u;
        if is_ghost {
            place = atomicAdd(&ghosts, 1u);
        } else if is_used {
            let near = mesh_neighbors[t];
            let number = numbers[t];
            out_tetrahedra[number] = tet;
            out_neighbors[number] = vec4i(across(near.x), across(near.y), across(near.z), across(near.w));
        }
        workgroupBarrier();
        // One atomic operation on the counter per workgroup: all points may lie on the hull.
        if local == 0 {
            first = atomicAdd(&hull_len, atomicLoad(&ghosts));
        }
        workgroupBarrier();
        if is_ghost {
            let at = 3 * (first + place);
            out_hull[at] = tet.x;
            out_hull[at + 1] = tet.y;
            out_hull[at + 2] = tet.z;
        }
    }
}
