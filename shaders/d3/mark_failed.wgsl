// Marks the vertices of the facets that are not locally Delaunay (§3.2.1): their stars are wanted.
// One invocation per slot.
//
// Examines only the facets that a flip iteration could not flip: the tetrahedra around them may have
// changed since.
//!include d3/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(2) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(3) var<storage, read> neighbors: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> status: array<Status>;
// Whether each vertex failed.
@group(0) @binding(5) var<storage, read_write> failed: array<atomic<u32>>;
// The input indices of the failed vertices.
@group(0) @binding(6) var<storage, read_write> failed_points: array<u32>;
// A bit per point.
@group(0) @binding(7) var<storage, read_write> wanted: array<atomic<u32>>;
//!include d3/signs

fn fail(v: u32) {
    if v != control.infinite && atomicExchange(&failed[v], 1u) == 0 {
        let point = index_of(v);
        failed_points[atomicAdd(&control.failed, 1u)] = point;
        atomicOr(&wanted[point >> 5], 1u << (point & 31));
    }
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < control.blocks * BLOCK; t += groups.x * WORKGROUP) {
        let suspect = (atomicLoad(&status[t].flags) >> SUSPECT_SHIFT) & CHECK;
        let tet = simplices[t];
        if suspect == 0 || all(tet == vec4u(0)) {
            continue;
        }
        let near = neighbors[t];
        let facets = not_unrolled(4);
        for (var k = 0u; k < facets; k++) {
            if ((suspect >> k) & 1) != 0 && conflict(tet, simplices[near[k] >> 2][near[k] & 3]) > 0 {
                let c = facet(k);
                fail(tet[c.x]);
                fail(tet[c.y]);
                fail(tet[c.z]);
                // Both sides may be suspect: the one with the lower number counts.
                let other = near[k] >> 2;
                if other > t || ((atomicLoad(&status[other].flags) >> (SUSPECT_SHIFT + (near[k] & 3))) & 1) == 0 {
                    atomicAdd(&control.not_locally_delaunay, 1u);
                }
            }
        }
    }
    if exact_signs != 0 {
        atomicAdd(&control.exact, exact_signs);
    }
}
