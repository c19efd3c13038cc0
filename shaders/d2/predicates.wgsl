// Orientation and in-circle: exact, with all ties broken.
//
// Conventions: orient2d(a, b, c) is the sign of det(b − a, c − a), positive where the turn is to
// the left; incircle(a, b, c, d) is positive when d is inside the circle through the positively
// oriented a, b, c, and changes sign with every exchange of two arguments.
//
// Ties are broken as d3/perturbed explains: by the heights of the points, by the tilt of infinity
// away from the interior point, then by the lowered coordinates ε(i, j), j = y, x. So a point of
// the hull between two others on a line is beyond their edge, and no flat triangles lie along the
// hull. A set S of lowered coordinates is a bit set, 2·rank + (y: 0, x: 1).
//!include d2/exact_{width}
//!include common/ties
//!include common/unrolled

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

// The differences of three points to the last one.
struct Rows {
    a: Row,
    b: Row,
    c: Row,
}

// Returns the sign that four vertices give to an in-circle test or an orientation, never 0 where
// these are not: incircle(a, b, c, d); or, if `of_three`, the orientation of a, b, c, where d is
// the interior point.
fn perturbed_sign(a: Vertex, b: Vertex, c: Vertex, d: Vertex, of_three: bool) -> i32 {
    let sorted = in_order(a, b, c, d);
    let origin = sorted.d.position;
    var rows = Rows(
        difference(sorted.a.position, origin),
        difference(sorted.b.position, origin),
        difference(sorted.c.position, origin)
    );
    let perturbations = not_unrolled(5);
    let points = not_unrolled(3);
    var sign = 0;
    for (var i = 0u; i < perturbations && sign == 0; i++) {
        let s = PERTURBATIONS[i];
        var volume = zero_volume();
        var by_height = 0;
        var sum = zero_determinant();
        // The coefficients of the heights: +[bc], −[ac], +[ab], and for the last point what makes
        // their sum 0. A step's point has the first row; then the rows move up, and are where they
        // were after the last step.
        for (var k = 0u; k < points; k++) {
            let coefficient = determinant(
                lowered(rows.b, lowering(s, (k + 1) % 3)), lowered(rows.c, lowering(s, (k + 2) % 3))
            );
            volume = accumulate(volume, lift_of(rows.a), coefficient);
            by_height = select(by_height, sign_of_determinant(coefficient), by_height == 0);
            sum = plus(sum, coefficient);
            rows = Rows(rows.b, rows.c, rows.a);
        }
        // Raising the last point moves it out of the circle of three that are positively oriented.
        let by_orientation = sign_of_determinant(sum);
        let by_volume = sign_of_volume(volume);
        sign = select(select(by_height, -by_orientation, by_height == 0), by_volume, by_volume != 0);
        sign = select(sign, by_orientation, of_three && by_orientation != 0);
    }
    return sign * sorted.parity;
}
