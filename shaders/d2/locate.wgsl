// The first triangles.
//
// Expects: counts, simplices, neighbors.

fn first_simplex() -> vec3u {
    return vec3u(counts[COUNT_FOUND], counts[COUNT_FOUND + 1], counts[COUNT_FOUND + 2]);
}

// Makes the first triangle, and beyond its edge k the infinite one of the edge's ends and infinity,
// in the slots after.
fn make_first(first: vec3u, infinite: u32) {
    let base = infinite * SLOTS_PER_POINT;
    simplices[base] = vec4u(first, 0);
    neighbors[base] = vec4u(4 * (vec3u(base) + vec3u(1, 2, 3)) + 2, 0);
    for (var k = 0u; k < 3; k++) {
        let next = (k + 1) % 3;
        let previous = (k + 2) % 3;
        simplices[base + 1 + k] = vec4u(first[previous], first[next], infinite, 0);
        neighbors[base + 1 + k] = vec4u(4 * (base + 1 + previous) + 1, 4 * (base + 1 + next), 4 * base + k, 0);
    }
}
