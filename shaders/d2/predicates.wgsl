// Orientation and in-circle: exact, with all ties broken.
//
// Conventions: orient2d(a, b, c) is the sign of det(b − a, c − a), positive where the turn is to
// the left; incircle(a, b, c, d) is positive when d is inside the circle through the positively
// oriented a, b, c, and changes sign with every exchange of two arguments.
//
// Ties are broken as d3/predicates explains: by the heights of the points, by infinity that leans
// away from the interior point, then by the lowered coordinates ε(i, j), j = y, x. So a point of the
// hull between two others on a line is beyond their edge, and no flat triangles lie along the hull.
// A set S of lowered coordinates is a bit set, 2·rank + (y: 0, x: 1).
//!include d2/exact_{width}

// The last one is never zero.
const PERTURBATIONS = array<u32, 5>(0, 1, 2, 4, 6);

// A lattice point. `index` is its place in the input, which breaks ties.
struct Vertex {
    position: Position,
    index: u32,
}

// Returns the coordinates of the point of this rank that S lowers.
fn lowering(s: u32, rank: u32) -> vec2u {
    let bits = s >> (2 * rank);
    return vec2u((bits >> 1) & 1, bits & 1);
}

// Returns the sign of det(b − a, c − a), 0 when the points are collinear.
fn orient2d_exact(a: Position, b: Position, c: Position) -> i32 {
    return sign_of_determinant(determinant(difference(b, a), difference(c, a)));
}

// Returns the in-circle determinant with d as the origin.
fn incircle_volume(u: Row, v: Row, w: Row) -> Volume {
    let first = accumulate(zero_volume(), lift_of(u), determinant(v, w));
    return accumulate(accumulate(first, lift_of(v), determinant(w, u)), lift_of(w), determinant(u, v));
}

// Exchanges two vertices if they are not in the order of their indices.
fn put_in_order(a: ptr<function, Vertex>, b: ptr<function, Vertex>, parity: ptr<function, i32>) {
    if (*b).index < (*a).index {
        let c = *a;
        *a = *b;
        *b = c;
        *parity = -*parity;
    }
}

// Returns the sign that four vertices give to an in-circle test or an orientation, never 0 where
// these are not: incircle(a, b, c, d); or, if `of_three`, the orientation of a, b, c, where d is the
// interior point.
fn perturbed_sign(a_: Vertex, b_: Vertex, c_: Vertex, d_: Vertex, of_three: bool) -> i32 {
    var a = a_;
    var b = b_;
    var c = c_;
    var d = d_;
    var parity = 1;
    put_in_order(&a, &b, &parity);
    put_in_order(&c, &d, &parity);
    put_in_order(&a, &c, &parity);
    put_in_order(&b, &d, &parity);
    put_in_order(&b, &c, &parity);
    let u = difference(a.position, d.position);
    let v = difference(b.position, d.position);
    let w = difference(c.position, d.position);
    let la = lift_of(u);
    let lb = lift_of(v);
    let lc = lift_of(w);
    var sign = 0;
    for (var i = 0; i < 5 && sign == 0; i++) {
        let s = PERTURBATIONS[i];
        let p = lowered(u, lowering(s, 0));
        let q = lowered(v, lowering(s, 1));
        // The coefficients of the heights: +[bc], −[ac], +[ab], and for the last point what makes
        // their sum 0.
        let ka = determinant(q, w);
        let kb = determinant(w, p);
        let kc = determinant(p, q);
        let kd = minus(zero_determinant(), plus(plus(ka, kb), kc));
        let volume = accumulate(accumulate(accumulate(zero_volume(), la, ka), lb, kb), lc, kc);
        let sa = sign_of_determinant(ka);
        let sb = sign_of_determinant(kb);
        let sc = sign_of_determinant(kc);
        let sd = sign_of_determinant(kd);
        let by_height = select(select(select(sd, sc, sc != 0), sb, sb != 0), sa, sa != 0);
        let by_volume = sign_of_volume(volume);
        sign = select(by_height, by_volume, by_volume != 0);
        // Raising the last point moves it out of the circle of three that are positively oriented.
        sign = select(sign, -sd, of_three && sd != 0);
    }
    return sign * parity;
}
