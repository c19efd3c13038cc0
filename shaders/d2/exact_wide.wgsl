// Exact determinants of 62-bit lattice coordinates.
//
// The bounds are those of the narrow form with 62 in the place of 31: differences below 2^62 (two
// limbs), 2×2 determinants below 2^125 (four), lifts below 2^125 (four), in-circle determinants
// below 2^249 (eight).
//
// Expects: vertices: array<VertexWords>, for load_position and load_high.
//!include arithmetic/limbs_128
//!include arithmetic/rows_wide

// High words of x and y, and low words; the highest bit of the third says that the point was
// rounded to the lattice.
alias VertexWords = vec4i;

// 64-bit coordinates as low and high limbs.
struct Position {
    low: vec2u,
    high: vec2u,
}

// A difference of two lattice points.
struct Row {
    low: vec2u,
    high: vec2u,
}

struct Determinant {
    limbs: vec4u,
}

fn load_high(v: u32) -> vec2i {
    return vertices[v].xy;
}

fn load_position(v: u32) -> Position {
    let words = vertices[v];
    let high = vec2u(words.xy);
    let low = vec2u(words.zw) & vec2u(0x7fffffff);
    return Position((high << vec2u(31)) | low, high >> vec2u(1));
}

fn difference(a: Position, b: Position) -> Row {
    return Row(a.low - b.low, a.high - b.high - vec2u(a.low < b.low));
}

// The row with `by` taken off.
fn lowered(r: Row, by: vec2u) -> Row {
    return Row(r.low - by, r.high - vec2u(r.low < by));
}

fn lift_of(r: Row) -> Lift {
    return Lift(add_128(multiply_i64(x_of(r), x_of(r)), multiply_i64(y_of(r), y_of(r))));
}

// det(p, q).
fn determinant(p: Row, q: Row) -> Determinant {
    return Determinant(subtract_128(multiply_i64(x_of(p), y_of(q)), multiply_i64(x_of(q), y_of(p))));
}

fn plus(a: Determinant, b: Determinant) -> Determinant {
    return Determinant(add_128(a.limbs, b.limbs));
}

fn minus(a: Determinant, b: Determinant) -> Determinant {
    return Determinant(subtract_128(a.limbs, b.limbs));
}

fn zero_determinant() -> Determinant {
    return Determinant(vec4u(0));
}

fn sign_of_determinant(a: Determinant) -> i32 {
    return sign_of(a.limbs.w, a.limbs.x | a.limbs.y | a.limbs.z);
}

struct Volume {
    low: vec4u,
    high: vec4u,
}

fn zero_volume() -> Volume {
    return Volume(vec4u(0), vec4u(0));
}

// s + l·m.
fn accumulate(s: Volume, l: Lift, m: Determinant) -> Volume {
    let r0 = multiply_row(m.limbs.x, l.limbs, vec4u(0));
    let r1 = next_row(r0, m.limbs.y, l.limbs);
    let r2 = next_row(r1, m.limbs.z, l.limbs);
    let r3 = next_row(r2, m.limbs.w, l.limbs);
    let upper = subtract_128(vec4u(r3.low.yzw, r3.high), if_negative_128(m.limbs.w, l.limbs));
    let low = add_carrying(s.low, vec4u(r0.low.x, r1.low.x, r2.low.x, r3.low.x));
    return Volume(low.limbs, add_128(add_128(s.high, upper), vec4u(low.carry, 0, 0, 0)));
}

fn sign_of_volume(s: Volume) -> i32 {
    let rest = s.low | vec4u(s.high.xyz, 0);
    return sign_of(s.high.w, rest.x | rest.y | rest.z | rest.w);
}
