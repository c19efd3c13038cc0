// Returns which child of a tetrahedron, split at p, holds q, by 3 orientations.
//
// The planes of p, v0, v1 and of p, v2, v3 leave two children, which a third plane divides. `infinite` is infinity's number, or NONE where that number stands for
// the interior point.
//
// Expects: orient_finite of d3/signs.
fn child_of(tet: vec4u, p: u32, q: u32, infinite: u32) -> u32 {
    var a = 3u;
    var b = 0u;
    var child = 0u;
    let steps = not_unrolled(3);
    for (var step = 0u; step < steps; step++) {
        let i = select(select(1 - b, 0u, step == 1), 3u, step == 0);
        let j = select(select(5 - a, 1u, step == 1), 2u, step == 0);
        let four = replaced(replaced(tet, i, q), j, p);
        let positive = (orient_finite(four) > 0) != any(four == vec4u(infinite));
        if step == 0 {
            a = select(2u, 3u, positive);
        } else if step == 1 {
            b = select(1u, 0u, positive);
        } else {
            child = select(1 - b, 5 - a, positive);
        }
    }
    return child;
}
