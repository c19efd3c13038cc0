// Checks the mesh: adds up the hashes of its half-edges, without those of the hull, of which the sum is 0 if each half-edge
// and the one that runs against it know each other, and all others are those of the hull. One invocation per triangle,
// and per half-edge of the hull.
//!include d2/simplex
//!include d2/facet_hash
@group(0) @binding(0) var<storage, read_write> control: Control;
// The last entry is the number of triangles.
@group(0) @binding(1) var<storage, read> sums: array<u32>;
@group(0) @binding(2) var<storage, read> mesh_triangles: array<u32>;
@group(0) @binding(3) var<storage, read> halfedges: array<u32>;
@group(0) @binding(4) var<storage, read> hull: array<vec2u>;

var<workgroup> sum_here: atomic<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    if local == 0 {
        atomicStore(&sum_here, 0u);
    }
    workgroupBarrier();
    var sum = 0u;
    let len = sums[arrayLength(&sums) - 1];
    for (var t = id.x; t < len; t += groups.x * WORKGROUP) {
        for (var k = 0u; k < CORNERS; k++) {
            let ends = vec2u(mesh_triangles[3 * t + k], mesh_triangles[3 * t + (k + 1) % 3]);
            sum += facet_hash(ends, 3 * t + k, halfedges[3 * t + k]);
        }
    }
    let on_hull = atomicLoad(&control.hull);
    for (var i = id.x; i < on_hull; i += groups.x * WORKGROUP) {
        sum -= facet_hash(hull[i], NONE, NONE);
    }
    atomicAdd(&sum_here, sum);
    workgroupBarrier();
    if local == 0 {
        atomicAdd(&control.mesh_sum, atomicLoad(&sum_here));
    }
}
