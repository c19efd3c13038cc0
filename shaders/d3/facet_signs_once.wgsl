// The exact signs of a facet, as d3/facet_signs returns them. One loop takes all signs, so that the
// exact arithmetic is compiled once, in half of the time.
//
// Expects: simplices; what d3/signs does.
//!include d3/signs

fn facet_signs(t: u32, tet: vec4u, k: u32, e: u32, is_violated: bool) -> u32 {
    let at_infinity = tet == vec4u(control.infinite);
    let is_infinite = any(at_infinity);
    let c = facet(k);
    let apex = simplices[t][k];
    var x = vec3u(simplices[t][c.x], simplices[t][c.y], simplices[t][c.z]);
    var negative = 0u;
    var edge = 0u;
    for (var step = select(0u, 1u, is_violated); step < 4 && negative < 2; step++) {
        // As `conflict` has them, and then as `orient` does.
        let of_four = step > 0 || is_infinite;
        let corners = select(select(tet, vec4u(e), at_infinity), vec4u(x.x, x.y, apex, e), step > 0);
        var sign = -1;
        if of_four || e != control.infinite {
            sign = finite_sign(corners, select(e, control.infinite, of_four), of_four);
        }
        if sign == 0 {
            return UNDECIDED;
        }
        if step > 0 {
            if (sign < 0) != any(corners == vec4u(control.infinite)) {
                negative += 1;
                edge = step - 1;
            }
            x = x.yzx;
        } else if sign < 0 {
            return LOCALLY_DELAUNAY;
        }
    }
    return negative | (edge << 2);
}
