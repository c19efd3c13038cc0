// Orientation and in-sphere: exact, with all ties broken, and with the vertex at infinity.
//
// Conventions as in src/predicates: orient3d(a, b, c, d) is the sign of det(b − a, c − a, d − a);
// insphere(a, b, c, d, e) is positive when e is inside the sphere through the positively oriented
// a, b, c, d, and changes sign with every exchange of two arguments.
//
// Ties. Point i has the height |p_i|² + δ_i, δ_0 ≫ δ_1 ≫ …, and its coordinates are lowered by ε(i,
// j), j = z, y, x, infinitely smaller than all δ, with ε(0, z) ≫ ε(0, y) ≫ ε(0, x) ≫ ε(1, z) ≫ …,
// each infinitely smaller than every product of those before it (Edelsbrunner and Mücke 1990). The
// heights are those of the coordinates that are not lowered. A determinant is then a polynomial in
// δ and ε, and its sign is that of the first coefficient that is not 0.
//
// The coefficients, in order. A product of ε's is a set S of (point, coordinate). The determinant
// is linear in each row and column, so only sets with at most one entry in each row and column
// count, and the coefficient of S follows from those of S's subsets and the determinant with *one*
// taken off the coordinates in S: that determinant is the sum of the coefficients of all subsets.
// The subsets come before S in the order. So they are all 0 when S is evaluated, and the
// determinant that is lowered by S is the coefficient of S. The same holds for the coefficients of
// δ_i within each S, which are orientations of the other four points.
//
// S is a bit set, 3·rank + (z: 0, y: 1, x: 2), and the order is that of the numbers. The last one
// is never zero: it leaves the row of the point with the highest index alone. This holds also for
// points that share all coordinates.
//!include d3/exact_{width}
//!include common/ties

const PERTURBATIONS = array<u32, 15>(0, 1, 2, 4, 8, 10, 12, 16, 20, 32, 64, 66, 68, 80, 84);

// The vertex at infinity: the point (0, 0, 0) with an infinite height, in homogeneous coordinates.
// No finite vertex has this index.
const INFINITE: u32 = 0xffffffff;

// Returns the coordinates of the point of this rank that S lowers.
fn lowering(s: u32, rank: u32) -> vec3u {
    let bits = s >> (3 * rank);
    return vec3u((bits >> 2) & 1, (bits >> 1) & 1, bits & 1);
}

// det(a, b, c).
fn determinant(a: Row, b: Row, c: Row) -> Determinant {
    return plus(minus(expand(a, minor(b, c)), expand(b, minor(a, c))), expand(c, minor(a, b)));
}

// Returns the sign of det(b − a, c − a, d − a), 0 when the points are coplanar.
fn orient3d_exact(a: Vertex, b: Vertex, c: Vertex, d: Vertex) -> i32 {
    return sign_of_determinant(determinant(difference(b, a), difference(c, a), difference(d, a)));
}

// Returns orient3d with ties broken by the lowered coordinates: never 0 for vertices with different
// indices.
fn orient3d(a: Vertex, b: Vertex, c: Vertex, d: Vertex) -> i32 {
    let sorted = in_order(a, b, c, d);
    let u = difference(sorted.a, sorted.d);
    let v = difference(sorted.b, sorted.d);
    let w = difference(sorted.c, sorted.d);
    var sign = 0;
    for (var i = 0; i < 15 && sign == 0; i++) {
        let s = PERTURBATIONS[i];
        sign = sign_of_determinant(determinant(lowered(u, lowering(s, 0)), lowered(v, lowering(s, 1)), lowered(w, lowering(s, 2))));
    }
    // det(b − a, c − a, d − a) = −det(a − d, b − d, c − d).
    return -sign * sorted.parity;
}

// Returns insphere with ties broken by the heights first and the lowered coordinates then: never 0
// for vertices with different indices. One of them may be the vertex at infinity: then it is the
// orientation of the other four.
fn insphere(a_: Vertex, b_: Vertex, c_: Vertex, d_: Vertex, e_: Vertex) -> i32 {
    var a = a_;
    var b = b_;
    var c = c_;
    var d = d_;
    var e = e_;
    var parity = 1;
    put_in_order(&a, &b, &parity);
    put_in_order(&d, &e, &parity);
    put_in_order(&c, &e, &parity);
    put_in_order(&c, &d, &parity);
    put_in_order(&b, &e, &parity);
    put_in_order(&a, &d, &parity);
    put_in_order(&a, &c, &parity);
    put_in_order(&b, &d, &parity);
    put_in_order(&b, &c, &parity);
    // The other rows are differences to the last point, so the vertex at infinity goes before it.
    let infinite = e.index == INFINITE;
    if infinite {
        let last = d;
        d = e;
        e = last;
        parity = -parity;
    }
    let u = difference(a, e);
    let v = difference(b, e);
    let w = difference(c, e);
    var t = difference(d, e);
    var la = lift_of(u);
    var lb = lift_of(v);
    var lc = lift_of(w);
    var ld = lift_of(t);
    if infinite {
        t = difference(e, e);
        la = zero_lift();
        lb = zero_lift();
        lc = zero_lift();
        ld = unit_lift();
    }
    var sign = 0;
    for (var i = 0; i < 15 && sign == 0; i++) {
        let s = PERTURBATIONS[i];
        let p = lowered(u, lowering(s, 0));
        let q = lowered(v, lowering(s, 1));
        let r = lowered(w, lowering(s, 2));
        let pq = minor(p, q);
        let pr = minor(p, r);
        let ps = minor(p, t);
        let qr = minor(q, r);
        let qs = minor(q, t);
        let rs = minor(r, t);
        // The coefficients of the heights: by the convention for the sign, +[bcd], −[acd], +[abd]
        // and −[abc], and for the last point what makes their sum 0.
        let ka = plus(minus(expand(q, rs), expand(r, qs)), expand(t, qr));
        let kb = minus(minus(expand(r, ps), expand(p, rs)), expand(t, pr));
        let kc = plus(minus(expand(p, qs), expand(q, ps)), expand(t, pq));
        let kd = minus(minus(expand(q, pr), expand(p, qr)), expand(r, pq));
        let ke = minus(zero_determinant(), plus(plus(ka, kb), plus(kc, kd)));
        let volume = accumulate(accumulate(accumulate(accumulate(zero_volume(), la, ka), lb, kb), lc, kc), ld, kd);
        let by_height = sign_or(ka, sign_or(kb, sign_or(kc, sign_or(kd, sign_of_determinant(ke)))));
        let by_volume = sign_of_volume(volume);
        sign = select(select(by_height, 0, infinite), by_volume, by_volume != 0);
    }
    return sign * parity;
}
