// Copies the listed tetrahedra, with their neighbours by the numbers that these have, or 0, and notes
// for which of its vertices each is the tetrahedron of the vertex. One invocation per tetrahedron.
//!include common/layout
//!include d3/gathering
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read_write> gathered_slots: array<u32>;
@group(0) @binding(2) var<storage, read> region_numbers: array<u32>;
@group(0) @binding(3) var<storage, read> mesh_tetrahedra: array<vec4u>;
@group(0) @binding(4) var<storage, read> mesh_neighbors: array<vec4u>;
// One more than the tetrahedron of each point.
@group(0) @binding(5) var<storage, read> vertex_simplex: array<u32>;
@group(0) @binding(6) var<storage, read_write> gathered_tetrahedra: array<vec4u>;
@group(0) @binding(7) var<storage, read_write> gathered_neighbors: array<vec4u>;

fn renumbered(across: u32) -> u32 {
    return 4 * region_numbers[across >> 2] + (across & 3);
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let count = atomicLoad(&control.gathered);
    for (var i = id.x; i < count; i += groups.x * WORKGROUP) {
        let t = gathered_slots[i];
        let near = mesh_neighbors[t];
        let tet = mesh_tetrahedra[t];
        var named = 0u;
        for (var k = 0u; k < 4; k++) {
            named |= select(0u, 1u << k, vertex_simplex[tet[k]] == t + 1);
        }
        gathered_slots[i] = t | (named << NAMED_SHIFT);
        gathered_tetrahedra[i] = tet;
        gathered_neighbors[i] = vec4u(renumbered(near.x), renumbered(near.y), renumbered(near.z), renumbered(near.w));
    }
}
