// Checks the mesh at the end of Phase 1: adds up the hashes of its facets, whose sum is 0 if each tetrahedron and the one
// across see the same facet from either side; and counts the points that have one of their tetrahedra. One invocation per
// tetrahedron, and per point.
//!include d3/simplex
//!include d3/facet_hash
@group(0) @binding(0) var<storage, read_write> control: Control;
// The last entry is the number of finite tetrahedra.
@group(0) @binding(1) var<storage, read> sums: array<u32>;
@group(0) @binding(2) var<storage, read> mesh_tetrahedra: array<vec4u>;
@group(0) @binding(3) var<storage, read> mesh_neighbors: array<vec4u>;
// One more than a tetrahedron of each point, or 0.
@group(0) @binding(4) var<storage, read> vertex_simplex: array<u32>;

var<workgroup> sum_here: atomic<u32>;
var<workgroup> vertices_here: atomic<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    if local == 0 {
        atomicStore(&sum_here, 0u);
        atomicStore(&vertices_here, 0u);
    }
    workgroupBarrier();
    var sum = 0u;
    let len = sums[arrayLength(&sums) - 1] + atomicLoad(&control.ghosts);
    for (var t = id.x; t < len; t += groups.x * WORKGROUP) {
        let tet = mesh_tetrahedra[t];
        let near = mesh_neighbors[t];
        for (var k = 0u; k < CORNERS; k++) {
            let f = facet(k);
            sum += facet_hash(vec3u(tet[f.x], tet[f.y], tet[f.z]), 4 * t + k, near[k]);
        }
    }
    var vertices = 0u;
    for (var v = id.x; v < control.infinite; v += groups.x * WORKGROUP) {
        let t = vertex_simplex[v];
        if t != 0 {
            let tet = mesh_tetrahedra[t - 1];
            vertices += u32(any(tet == vec4u(v)));
        }
    }
    atomicAdd(&sum_here, sum);
    atomicAdd(&vertices_here, vertices);
    workgroupBarrier();
    if local == 0 {
        atomicAdd(&control.mesh_sum, atomicLoad(&sum_here));
        atomicAdd(&control.mesh_vertices, atomicLoad(&vertices_here));
    }
}
