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
    // 3-2: above or below the ring. 2-3: beyond the plane of the edge and x_0; then beyond that of
    // x_1 or x_2.
    let above = orient(select(vec4u(x, p), vec4u(x.x, p, d, e), is_23)) > 0;
    var k = select(1u, 0u, above);
    if is_23 {
        let beyond = orient(vec4u(select(x.z, x.y, above), p, d, e)) > 0;
        k = select(select(1u, 2u, beyond), select(0u, 1u, beyond), above);
    }
    return vec2u(history[n].tets[k], history[n].next[k]);
}
