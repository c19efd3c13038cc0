// One step of a point along the history.
//
// Expects: orient of d2/signs.
@group(0) @binding(4) var<storage, read> history: array<EdgeFlip>;

// Returns the triangle of flip n that holds point p, and the flip that changed that triangle later.
fn follow(n: u32, p: u32) -> vec2u {
    // The first of the two triangles lies on the left of the edge.
    let k = select(1u, 0u, orient(vec3u(history[n].edge, p)) > 0);
    return vec2u(history[n].triangles[k], history[n].next[k]);
}
