// Coordinates of rows, and lifts, where coordinates have two limbs.
//
// Expects: Row, with the coordinates' low and high limbs.

// A sum of squared coordinates.
struct Lift {
    limbs: vec4u,
}

fn x_of(r: Row) -> vec2u {
    return vec2u(r.low.x, r.high.x);
}

fn y_of(r: Row) -> vec2u {
    return vec2u(r.low.y, r.high.y);
}
