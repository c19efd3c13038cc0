// Copies the tetrahedra without the gaps between them, and notes one tetrahedron of each vertex. One invocation a slot.
//!include shared/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> tets: array<vec4u>;
@group(0) @binding(2) var<storage, read> neighbors: array<vec4u>;
// The number of each tetrahedron without gaps.
@group(0) @binding(3) var<storage, read> offsets: array<u32>;
@group(0) @binding(4) var<storage, read_write> compacted_tets: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> compacted_neighbors: array<vec4u>;
// One more than the highest tetrahedron of each vertex.
@group(0) @binding(6) var<storage, read_write> tet_of: array<atomic<u32>>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < control.blocks * BLOCK; t += groups.x * 256) {
        let tet = tets[t];
        if all(tet == vec4u(0)) {
            continue;
        }
        let number = offsets[t];
        let near = neighbors[t];
        compacted_tets[number] = tet;
        var renumbered = near & vec4u(3);
        for (var k = 0u; k < 4; k++) {
            renumbered[k] |= 4 * offsets[near[k] >> 2];
            if atomicLoad(&tet_of[tet[k]]) <= number {
                atomicMax(&tet_of[tet[k]], number + 1);
            }
        }
        compacted_neighbors[number] = renumbered;
    }
}
