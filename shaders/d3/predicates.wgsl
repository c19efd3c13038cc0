// Orientation and in-sphere: exact, with all ties broken.
//
// Conventions as in src/predicates: orient3d(a, b, c, d) is the sign of det(b − a, c − a, d − a);
// insphere(a, b, c, d, e) is positive when e is inside the sphere through the positively oriented
// a, b, c, d, and changes sign with every exchange of two arguments.
//
// Ties. Point i has the height h_i = |p_i|² + δ_i, δ_0 ≫ δ_1 ≫ …, and its coordinates are lowered
// by ε(i, j), j = z, y, x, infinitely smaller than all δ, with ε(0, z) ≫ ε(0, y) ≫ ε(0, x) ≫ ε(1,
// z) ≫ …, each infinitely smaller than every product of those before it (Edelsbrunner and Mücke
// 1990). The heights are those of the coordinates that are not lowered.
//
// Infinity leans. Lifted to these heights, the triangulation is a convex hull, and infinity would
// be the direction straight up, which four coplanar points leave undecided. So it leans, by an η
// that is smaller than all δ and larger than all ε, away from the interior point: with that point
// as the origin, an orientation is the determinant of the rows (x, y, z, 1 + η·h), as if each point
// had been moved towards the origin by an infinitely small share η·h of the way. Planes become
// paraboloids, so coplanar points of the hull are triangulated as their circles in the plane say,
// as the CPU engine and splaying (src/d3/splay/predicates.rs) do it, and no flat tetrahedra lie
// under the hull. The rows of an in-sphere determinant, (x, y, z, h, 1 + η·h), lose η to a column
// operation: it knows nothing of the lean. So the coefficient of η in an orientation is the
// in-sphere determinant with the interior point for the fifth: only where four points are in a
// plane with the interior point, or in a line, is anything left to the lowered coordinates.
//
// The coefficients, in order. A product of ε's is a set S of (point, coordinate). The determinant
// is linear in each row and column, so only sets with at most one entry in each row and column
// count, and the coefficient of S follows from those of S's subsets and the determinant with *one*
// taken off the coordinates in S: that determinant is the sum of the coefficients of all subsets.
// The subsets come before S in the order. So they are all 0 when S is evaluated, and the
// determinant that is lowered by S is the coefficient of S. The same holds for the coefficients of
// η and of δ_i within each S; the latter are orientations of the other four points.
//
// S is a bit set, 3·rank + (z: 0, y: 1, x: 2), and the order is that of the numbers. The last one
// is never zero: it leaves the row of the point with the highest index alone. This holds also for
// points that share all coordinates. The interior point's index is above every other.
//!include d3/exact_{width}
//!include common/ties

const PERTURBATIONS = array<u32, 15>(0, 1, 2, 4, 8, 10, 12, 16, 20, 32, 64, 66, 68, 80, 84);

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

// The differences of four points to the last one.
struct Rows {
    a: Row,
    b: Row,
    c: Row,
    d: Row,
}

// Returns the sign that five vertices give to an in-sphere test or an orientation, never 0 where
// these are not: insphere(a, b, c, d, e); or, if `of_four`, the orientation of a, b, c, d, where e
// is the interior point.
fn perturbed_sign(a_: Vertex, b_: Vertex, c_: Vertex, d_: Vertex, e_: Vertex, of_four: bool) -> i32 {
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
    var rows = Rows(difference(a, e), difference(b, e), difference(c, e), difference(d, e));
    let perturbations = not_unrolled(15);
    let points = not_unrolled(4);
    var sign = 0;
    for (var i = 0u; i < perturbations && sign == 0; i++) {
        let s = PERTURBATIONS[i];
        var volume = zero_volume();
        var by_height = 0;
        var sum = zero_determinant();
        // The coefficients of the heights: by the convention for the sign, +[bcd], −[acd], +[abd]
        // and −[abc], and for the last point what makes their sum 0. A step's point has the first
        // row; then the rows move up, and are where they were after the last step.
        for (var k = 0u; k < points; k++) {
            var coefficient = determinant(
                lowered(rows.b, lowering(s, (k + 1) % 4)),
                lowered(rows.c, lowering(s, (k + 2) % 4)),
                lowered(rows.d, lowering(s, (k + 3) % 4))
            );
            if k % 2 == 1 {
                coefficient = minus(zero_determinant(), coefficient);
            }
            volume = accumulate(volume, lift_of(rows.a), coefficient);
            by_height = select(by_height, sign_of_determinant(coefficient), by_height == 0);
            sum = plus(sum, coefficient);
            rows = Rows(rows.b, rows.c, rows.d, rows.a);
        }
        // Raising the last point moves it out of the sphere of four that are positively oriented.
        let by_orientation = sign_of_determinant(sum);
        let by_volume = sign_of_volume(volume);
        sign = select(select(by_height, -by_orientation, by_height == 0), by_volume, by_volume != 0);
        sign = select(sign, by_orientation, of_four && by_orientation != 0);
    }
    return sign * parity;
}
