// Exact determinants of 62-bit lattice coordinates.
//
// The bounds are those of the narrow form with 62 in the place of 31: differences below 2^62 (two
// limbs), minors below 2^125 (four), 3×3 determinants below 2^188 (six), lifts below 3·2^124
// (four), in-sphere determinants below 2.25·2^310 (ten).
//
// Expects: vertices: array<VertexWords>, for load_vertex and load_high.
//!include arithmetic/limbs_128
//!include arithmetic/rows_wide

// High words of x, y and z, and the input index; or their low words, and whether the point was
// rounded to the lattice.
alias VertexWords = vec4i;

// A lattice point: 64-bit coordinates as low and high limbs. `index` is its place in the input,
// which breaks ties.
struct Vertex {
    low: vec3u,
    high: vec3u,
    index: u32,
    // The vertex itself.
    number: u32,
}

// A difference of two lattice points.
struct Row {
    low: vec3u,
    high: vec3u,
}

struct Determinant {
    low: vec4u,
    high: vec2u,
}

fn load_high(v: u32) -> vec3i {
    return vertices[2 * v].xyz;
}

// The place of a vertex in the input.
fn index_of(v: u32) -> u32 {
    return u32(vertices[2 * v].w);
}

fn load_vertex(v: u32) -> Vertex {
    let words = vertices[2 * v];
    let high = vec3u(words.xyz);
    let low = vec3u(vertices[2 * v + 1].xyz);
    return Vertex((high << vec3u(31)) | low, high >> vec3u(1), u32(words.w), v);
}

fn difference(a: Vertex, b: Vertex) -> Row {
    return Row(a.low - b.low, a.high - b.high - vec3u(a.low < b.low));
}

// The row with `by` taken off.
fn lowered(r: Row, by: vec3u) -> Row {
    return Row(r.low - by, r.high - vec3u(r.low < by));
}

fn z_of(r: Row) -> vec2u {
    return vec2u(r.low.z, r.high.z);
}

fn lift_of(r: Row) -> Lift {
    let xy = add_128(multiply_i64(x_of(r), x_of(r)), multiply_i64(y_of(r), y_of(r)));
    return Lift(add_128(xy, multiply_i64(z_of(r), z_of(r))));
}

// x and y only.
fn minor(p: Row, q: Row) -> vec4u {
    return subtract_128(multiply_i64(x_of(p), y_of(q)), multiply_i64(x_of(q), y_of(p)));
}

// z·m, for a minor m.
fn expand(r: Row, m: vec4u) -> Determinant {
    let z = z_of(r);
    let p0 = multiply_row(z.x, m, vec4u(0));
    let p1 = next_row(p0, z.y, m);
    let upper = subtract_128(vec4u(p1.low.yzw, p1.high), if_negative_128(z.y, m));
    let top = subtract_64(upper.zw, vec2u(if_negative(m.w, z.x), if_negative(m.w, z.y)));
    return Determinant(vec4u(p0.low.x, p1.low.x, upper.xy), top);
}

fn plus(a: Determinant, b: Determinant) -> Determinant {
    let low = add_carrying(a.low, b.low);
    return Determinant(low.limbs, add_64(add_64(a.high, b.high), vec2u(low.carry, 0)));
}

fn minus(a: Determinant, b: Determinant) -> Determinant {
    let x = subtract_limb(a.low.x, b.low.x, 0);
    let y = subtract_limb(a.low.y, b.low.y, x.y);
    let z = subtract_limb(a.low.z, b.low.z, y.y);
    let w = subtract_limb(a.low.w, b.low.w, z.y);
    return Determinant(vec4u(x.x, y.x, z.x, w.x), subtract_64(subtract_64(a.high, b.high), vec2u(w.y, 0)));
}

fn zero_determinant() -> Determinant {
    return Determinant(vec4u(0), vec2u(0));
}

fn sign_of_determinant(a: Determinant) -> i32 {
    return sign_of(a.high.y, a.low.x | a.low.y | a.low.z | a.low.w | a.high.x);
}

struct Volume {
    low: vec4u,
    middle: vec4u,
    high: vec2u,
}

fn zero_volume() -> Volume {
    return Volume(vec4u(0), vec4u(0), vec2u(0));
}

// s + l·m.
fn accumulate(s: Volume, l: Lift, m: Determinant) -> Volume {
    let r0 = multiply_row(m.low.x, l.limbs, vec4u(0));
    let r1 = next_row(r0, m.low.y, l.limbs);
    let r2 = next_row(r1, m.low.z, l.limbs);
    let r3 = next_row(r2, m.low.w, l.limbs);
    let r4 = next_row(r3, m.high.x, l.limbs);
    let r5 = next_row(r4, m.high.y, l.limbs);
    let upper = subtract_128(vec4u(r5.low.yzw, r5.high), if_negative_128(m.high.y, l.limbs));
    let low = add_carrying(s.low, vec4u(r0.low.x, r1.low.x, r2.low.x, r3.low.x));
    let s4 = add_limb(s.middle.x, r4.low.x, low.carry);
    let s5 = add_limb(s.middle.y, r5.low.x, s4.y);
    let s6 = add_limb(s.middle.z, upper.x, s5.y);
    let s7 = add_limb(s.middle.w, upper.y, s6.y);
    let s8 = add_limb(s.high.x, upper.z, s7.y);
    return Volume(low.limbs, vec4u(s4.x, s5.x, s6.x, s7.x), vec2u(s8.x, s.high.y + upper.w + s8.y));
}

fn sign_of_volume(s: Volume) -> i32 {
    let low = s.low | s.middle;
    return sign_of(s.high.y, low.x | low.y | low.z | low.w | s.high.x);
}
