// Checks the arrays of a mesh: adds up the hashes of its facets, without those of the hull, of which the sum is 0 if each
// tetrahedron and the one across see the same facet from either side, and all others are those of the hull. Counts these
// and the vertices of the hull. One invocation per tetrahedron, and per facet of the hull.
//!include d3/simplex
//!include d3/facet_hash
//!include common/check_params
@group(0) @binding(0) var<storage, read> check_params: CheckParams;
@group(0) @binding(1) var<storage, read> out_tetrahedra: array<vec4u>;
@group(0) @binding(2) var<storage, read> out_neighbors: array<vec4u>;
@group(0) @binding(3) var<storage, read> out_hull: array<u32>;
// A bit per point, 0 at first.
@group(0) @binding(4) var<storage, read_write> seen: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read_write> checked: array<atomic<u32>>;

var<workgroup> sum_here: atomic<u32>;
var<workgroup> outside_here: atomic<u32>;
var<workgroup> on_hull_here: atomic<u32>;

// Returns 1 if nobody has seen this vertex before.
fn is_new(v: u32) -> u32 {
    return 1 - ((atomicOr(&seen[v >> 5], 1u << (v & 31)) >> (v & 31)) & 1);
}

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    if local == 0 {
        atomicStore(&sum_here, 0u);
        atomicStore(&outside_here, 0u);
        atomicStore(&on_hull_here, 0u);
    }
    workgroupBarrier();
    var sum = 0u;
    var outside = 0u;
    for (var t = id.x; t < check_params.count; t += groups.x * WORKGROUP) {
        let tet = out_tetrahedra[t];
        let near = out_neighbors[t];
        for (var k = 0u; k < CORNERS; k++) {
            let f = facet(k);
            sum += facet_hash(vec3u(tet[f.x], tet[f.y], tet[f.z]), t, near[k]);
            outside += u32(near[k] == NONE);
        }
    }
    var on_hull = 0u;
    for (var i = id.x; i < check_params.hull; i += groups.x * WORKGROUP) {
        let corners = vec3u(out_hull[3 * i], out_hull[3 * i + 1], out_hull[3 * i + 2]);
        sum -= facet_hash(corners, NONE, NONE);
        on_hull += is_new(corners.x) + is_new(corners.y) + is_new(corners.z);
    }
    atomicAdd(&sum_here, sum);
    atomicAdd(&outside_here, outside);
    atomicAdd(&on_hull_here, on_hull);
    workgroupBarrier();
    if local == 0 {
        atomicAdd(&checked[CHECK_SUM], atomicLoad(&sum_here));
        atomicAdd(&checked[CHECK_OUTSIDE], atomicLoad(&outside_here));
        atomicAdd(&checked[CHECK_ON_HULL], atomicLoad(&on_hull_here));
    }
}
