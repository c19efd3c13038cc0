// Signs on vertices that may be at infinity.
//
// Expects: finite_sign, control.

// Returns the orientation of four finite vertices. The number of infinity stands for the interior
// point.
fn orient_finite(v: vec4u) -> i32 {
    return finite_sign(v, control.infinite, true);
}

// Returns the orientation of four vertices. Infinity lies opposite to the interior point.
fn orient(v: vec4u) -> i32 {
    let sign = orient_finite(v);
    return select(sign, -sign, any(v == vec4u(control.infinite)));
}

// Returns a positive sign if e is inside the circumsphere of a positively oriented tetrahedron. For
// an infinite one that is the half-space beyond its hull facet; infinity is inside none.
fn conflict(tet: vec4u, e: u32) -> i32 {
    let at_infinity = tet == vec4u(control.infinite);
    let of_four = any(at_infinity);
    if e == control.infinite && !of_four {
        return -1;
    }
    return finite_sign(select(tet, vec4u(e), at_infinity), select(e, control.infinite, of_four), of_four);
}
