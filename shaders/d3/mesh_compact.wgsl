// Copies the tetrahedra to their numbers, with the points of the input as vertices, and notes one
// tetrahedron of each point. The vertices of infinite ones change places, so that infinity comes
// last. One invocation per slot.
//!include d3/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(2) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(3) var<storage, read> neighbors: array<vec4u>;
// The output of mesh_number.
@group(0) @binding(4) var<storage, read> numbers: array<u32>;
@group(0) @binding(5) var<storage, read_write> mesh_tetrahedra: array<vec4u>;
@group(0) @binding(6) var<storage, read_write> mesh_neighbors: array<vec4u>;
// One more than the highest tetrahedron of each point; infinity comes last.
@group(0) @binding(7) var<storage, read_write> vertex_simplex: array<atomic<u32>>;
//!include d3/exact_{width}

// Returns where corner k goes when infinity goes from `place` to the end by two exchanges, which
// keep the orientation.
fn moved(k: u32, place: u32) -> u32 {
    let next = (place + 1) % 3;
    let other = (place + 2) % 3;
    let turned = select(select(select(k, next, k == other), other, k == next), place, k == 3);
    return select(select(turned, 3u, k == place), k, place == 3);
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < control.blocks * BLOCK; t += groups.x * WORKGROUP) {
        let tet = simplices[t];
        if all(tet == vec4u(0)) {
            continue;
        }
        let number = numbers[t] >> 2;
        let place = numbers[t] & 3;
        let near = neighbors[t];
        var points = vec4u(0);
        var across = vec4u(0);
        for (var k = 0u; k < 4; k++) {
            let point = index_of(tet[k]);
            let there = numbers[near[k] >> 2];
            points = replaced(points, moved(k, place), point);
            across = replaced(across, moved(k, place), (there & ~3u) | moved(near[k] & 3, there & 3));
            if atomicLoad(&vertex_simplex[point]) <= number {
                atomicMax(&vertex_simplex[point], number + 1);
            }
        }
        mesh_tetrahedra[number] = points;
        mesh_neighbors[number] = across;
    }
}
