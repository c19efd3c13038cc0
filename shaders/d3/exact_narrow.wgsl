// Exact determinants of 31-bit lattice coordinates.
//
// Differences are below 2^31. So 2×2 minors are below 2^63 (two limbs), and 3×3 determinants below
// 4·2^93 = 2^95 (three limbs: a determinant is linear in each entry, so it is largest where all are
// ±2^31, and the largest determinant of signs is 4). Lifts, squared distances, are below 3·2^62
// (two limbs, unsigned). The in-sphere determinant of points in a cube of side M is at most
// 2.25·M^5 < 2^157 (five limbs): moved to the cube's centre, it is a 5×5 determinant with rows (x,
// y, z, w, 1), |x|, |y|, |z| ≤ M/2 and, after a multiple of the last column is taken off, |w| ≤
// 3/8·M²; the largest 5×5 determinant of signs is 48.
//
// Expects: vertices: array<VertexWords>, for load_vertex and load_high.
//!include arithmetic/limbs

// x, y, z and the input index.
alias VertexWords = vec4i;

// A lattice point. `index` is its place in the input, which breaks ties.
struct Vertex {
    position: vec3i,
    index: u32,
    // The vertex itself.
    number: u32,
}

// A difference of two lattice points; its entries may also be −2^31.
struct Row {
    d: vec3i,
}

struct Lift {
    limbs: vec2u,
}

struct Determinant {
    limbs: vec3u,
}

fn load_high(v: u32) -> vec3i {
    return vertices[v].xyz;
}

// The place of a vertex in the input.
fn index_of(v: u32) -> u32 {
    return u32(vertices[v].w);
}

fn load_vertex(v: u32) -> Vertex {
    let words = vertices[v];
    return Vertex(words.xyz, u32(words.w), v);
}

fn difference(a: Vertex, b: Vertex) -> Row {
    return Row(a.position - b.position);
}

// The row with `by` taken off.
fn lowered(r: Row, by: vec3u) -> Row {
    return Row(r.d - vec3i(by));
}

fn lift_of(r: Row) -> Lift {
    let xy = add_64(multiply_i32(r.d.x, r.d.x), multiply_i32(r.d.y, r.d.y));
    return Lift(add_64(xy, multiply_i32(r.d.z, r.d.z)));
}

// x and y only.
fn minor(p: Row, q: Row) -> vec2u {
    return subtract_64(multiply_i32(p.d.x, q.d.y), multiply_i32(q.d.x, p.d.y));
}

// z·m, for a minor m.
fn expand(r: Row, m: vec2u) -> Determinant {
    let z = u32(r.d.z);
    let p0 = multiply_add(m.x, z, 0, 0);
    let p1 = multiply_add(m.y, z, p0.y, 0);
    let upper = subtract_64(p1, vec2u(if_negative(z, m.x), if_negative(z, m.y)));
    return Determinant(vec3u(p0.x, upper.x, upper.y - if_negative(m.y, z)));
}

fn plus(a: Determinant, b: Determinant) -> Determinant {
    let x = add_limb(a.limbs.x, b.limbs.x, 0);
    let y = add_limb(a.limbs.y, b.limbs.y, x.y);
    return Determinant(vec3u(x.x, y.x, a.limbs.z + b.limbs.z + y.y));
}

fn minus(a: Determinant, b: Determinant) -> Determinant {
    let x = subtract_limb(a.limbs.x, b.limbs.x, 0);
    let y = subtract_limb(a.limbs.y, b.limbs.y, x.y);
    return Determinant(vec3u(x.x, y.x, a.limbs.z - b.limbs.z - y.y));
}

fn zero_determinant() -> Determinant {
    return Determinant(vec3u(0));
}

fn sign_of_determinant(a: Determinant) -> i32 {
    return sign_of(a.limbs.z, a.limbs.x | a.limbs.y);
}

struct Volume {
    low: vec4u,
    high: u32,
}

fn zero_volume() -> Volume {
    return Volume(vec4u(0), 0);
}

// s + l·m.
fn accumulate(s: Volume, l: Lift, m: Determinant) -> Volume {
    let x = l.limbs.x;
    let y = l.limbs.y;
    let a0 = multiply_add(x, m.limbs.x, 0, 0);
    let a1 = multiply_add(y, m.limbs.x, a0.y, 0);
    let b0 = multiply_add(x, m.limbs.y, a1.x, 0);
    let b1 = multiply_add(y, m.limbs.y, a1.y, b0.y);
    let c0 = multiply_add(x, m.limbs.z, b1.x, 0);
    let c1 = multiply_add(y, m.limbs.z, b1.y, c0.y);
    let upper = subtract_64(c1, vec2u(if_negative(m.limbs.z, x), if_negative(m.limbs.z, y)));
    let s0 = add_limb(s.low.x, a0.x, 0);
    let s1 = add_limb(s.low.y, b0.x, s0.y);
    let s2 = add_limb(s.low.z, c0.x, s1.y);
    let s3 = add_limb(s.low.w, upper.x, s2.y);
    return Volume(vec4u(s0.x, s1.x, s2.x, s3.x), s.high + upper.y + s3.y);
}

fn sign_of_volume(s: Volume) -> i32 {
    return sign_of(s.high, s.low.x | s.low.y | s.low.z | s.low.w);
}
