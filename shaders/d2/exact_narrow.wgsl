// Exact determinants of 31-bit lattice coordinates.
//
// Differences are below 2^31. So 2×2 determinants are below 2^63 (two limbs; lowered differences
// may be −2^31, but a determinant of 2^63 takes +2^31 too), and lifts, squared distances, below
// 2^63 (two limbs). The in-circle determinant of points in a square of side M is at most M^4 <
// 2^125 (four limbs): moved to the square's centre, it is a 4×4 determinant with rows (x, y, w, 1),
// |x|, |y| ≤ M/2 and, after a multiple of the last column is taken off, |w| ≤ M²/4; the largest 4×4
// determinant of signs is 16.
//
// Expects: vertices: array<VertexWords>, for load_position and load_high.
//!include arithmetic/limbs_128

// x and y.
alias VertexWords = vec2i;

struct Position {
    xy: vec2i,
}

// A difference of two lattice points; its entries may also be −2^31.
struct Row {
    d: vec2i,
}

struct Lift {
    limbs: vec2u,
}

struct Determinant {
    limbs: vec2u,
}

fn load_high(v: u32) -> vec2i {
    return vertices[v];
}

fn load_position(v: u32) -> Position {
    return Position(vertices[v]);
}

fn difference(a: Position, b: Position) -> Row {
    return Row(a.xy - b.xy);
}

// The row with `by` taken off.
fn lowered(r: Row, by: vec2u) -> Row {
    return Row(r.d - vec2i(by));
}

fn lift_of(r: Row) -> Lift {
    return Lift(add_64(multiply_i32(r.d.x, r.d.x), multiply_i32(r.d.y, r.d.y)));
}

// det(p, q).
fn determinant(p: Row, q: Row) -> Determinant {
    return Determinant(subtract_64(multiply_i32(p.d.x, q.d.y), multiply_i32(q.d.x, p.d.y)));
}

fn plus(a: Determinant, b: Determinant) -> Determinant {
    return Determinant(add_64(a.limbs, b.limbs));
}

fn minus(a: Determinant, b: Determinant) -> Determinant {
    return Determinant(subtract_64(a.limbs, b.limbs));
}

fn zero_determinant() -> Determinant {
    return Determinant(vec2u(0));
}

fn sign_of_determinant(a: Determinant) -> i32 {
    return sign_of(a.limbs.y, a.limbs.x);
}

struct Volume {
    limbs: vec4u,
}

fn zero_volume() -> Volume {
    return Volume(vec4u(0));
}

// s + l·m.
fn accumulate(s: Volume, l: Lift, m: Determinant) -> Volume {
    return Volume(add_128(s.limbs, multiply_i64(l.limbs, m.limbs)));
}

fn sign_of_volume(s: Volume) -> i32 {
    return sign_of(s.limbs.w, s.limbs.x | s.limbs.y | s.limbs.z);
}
