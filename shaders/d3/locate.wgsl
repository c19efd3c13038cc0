// The first tetrahedra.
//
// Expects: control, counts, simplices, neighbors.

fn first_simplex() -> vec4u {
    return vec4u(counts[COUNT_FOUND], counts[COUNT_FOUND + 1], counts[COUNT_FOUND + 2], counts[COUNT_FOUND + 3]);
}

// Makes the first tetrahedron, and beyond its facet k the infinite one of the facet's corners and
// infinity, in the slots after.
fn make_first(first: vec4u, infinite: u32) {
    let base = infinite * SLOTS_PER_POINT;
    simplices[base] = first;
    neighbors[base] = 4 * (vec4u(base) + vec4u(1, 2, 3, 4)) + 3;
    for (var k = 0u; k < 4; k++) {
        let c = facet(k);
        simplices[base + 1 + k] = vec4u(first[c.x], first[c.y], first[c.z], infinite);
        // Beyond the edge opposite a corner, the infinite tetrahedron of the facet opposite that
        // corner, where k's place among the corners is the face.
        var near = vec4u(0, 0, 0, 4 * base + k);
        for (var i = 0u; i < 3; i++) {
            let there = facet(c[i]);
            let face = select(select(2u, 1u, there.y == k), 0u, there.x == k);
            near[i] = 4 * (base + 1 + c[i]) + face;
        }
        neighbors[base + 1 + k] = near;
    }
    // The slots 0 to 4 of the block are taken.
    atomicStore(&control.free[infinite], 0xe0u);
}
