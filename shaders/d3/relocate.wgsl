// One step of a point along the history.
//
// Expects: orient of d3/signs.
@group(0) @binding(4) var<storage, read> history: array<FlipNode>;

// Returns the tetrahedron of flip n that holds point p, and the flip that changed that tetrahedron
// later.
fn follow(n: u32, p: u32) -> vec2u {
    let x = history[n].ring;
    let d = history[n].d;
    let e = history[n].e;
    let is_23 = history[n].kind == FLIP_23;
    // After a 3-2 flip: above or below the ring. After a 2-3 flip: beyond the plane of the edge and x_0, then that of
    // x_1 or x_2. In a loop, so that the exact arithmetic is compiled once.
    let steps = not_unrolled(select(1u, 2u, is_23));
    var k = 0u;
    for (var step = 0u; step < steps; step++) {
        let corner = select(select(x.z, x.y, k == 0), x.x, step == 0);
        let beyond = orient(select(vec4u(x, p), vec4u(corner, p, d, e), is_23)) > 0;
        k = select(select(1u, 0u, beyond), select(select(1u, 2u, beyond), select(0u, 1u, beyond), k == 0), step == 1);
    }
    return vec2u(history[n].tets[k], history[n].next[k]);
}
