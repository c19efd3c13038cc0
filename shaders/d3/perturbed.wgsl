// Orientation and in-sphere with all ties broken.
//
// Ties. Point i has the height h_i = |p_i|² + δ_i, δ_0 ≫ δ_1 ≫ …, and its coordinates are lowered
// by ε(i, j), j = z, y, x, infinitely smaller than all else, with ε(0, z) ≫ ε(0, y) ≫ ε(0, x) ≫ ε(1,
// z) ≫ …, each infinitely smaller than every product of those before it (Edelsbrunner and Mücke
// 1990). The heights are those of the coordinates that are not lowered.
//
// Five coplanar points: the newest one is perturbed inwards most. Heights cannot decide, so each point is moved
// towards the interior point by a share ζ_i, smaller than η and larger than all ε; it is the larger
// the later the point was inserted, and of those of a round, the lower its index is, each infinitely
// larger than the next. The coefficient of ζ_i is, up to its sign, the in-sphere determinant of the
// other four with the interior point for the fifth. So a point that is inserted into a facet of the
// hull lies inside all flat tetrahedra under it: they are flipped away, and the point comes to be
// joined to what is below. If it were outside of them, they would remain between two triangulations of
// the facet, and each later point would add to them. The tetrahedra of the answer are not flat, so that it
// does not depend on the order of insertion.
//
// Four coplanar points of the hull: ties at infinity follow the in-circle sign. Lifted to these
// heights, the triangulation is a convex hull, and infinity would be the direction straight up, which
// four coplanar points leave undecided. So infinity is tilted away from the interior point, by an η
// that is smaller than all δ and larger than all ε: with that point as the origin, an orientation is the determinant of the rows (x, y, z, 1 + η·h), as if each point
// had been moved towards the origin by an infinitely small share η·h of the way. Planes become
// paraboloids, so coplanar points of the hull are triangulated as their circles in the plane say,
// as the CPU engine and splaying (src/d3/splay/predicates.rs) do it, and no flat tetrahedra lie
// under the hull. The rows of an in-sphere determinant, (x, y, z, h, 1 + η·h), lose η to a column
// operation: the tilt does not affect it. So the coefficient of η in an orientation is the
// in-sphere determinant with the interior point for the fifth: only where four points are in a
// plane with the interior point, or in a line, is anything left to the lowered coordinates.
//
// The coefficients, in order. A product of ε's is a set S of (point, coordinate). The determinant
// is linear in each row and column, so only sets with at most one entry in each row and column
// count, and the coefficient of S follows from those of S's subsets and the determinant with *one*
// taken off the coordinates in S: that determinant is the sum of the coefficients of all subsets.
// The subsets come before S in the order. So they are all 0 when S is evaluated, and the
// determinant that is lowered by S is the coefficient of S. The same holds for the coefficients of
// η, ζ_i and δ_i within each S; the last are orientations of the other four points. An orientation
// of which the coefficients of η and of all δ_i are 0 has none of ζ_i.
//
// S is a bit set, 3·rank + (z: 0, y: 1, x: 2), and the order is that of the numbers. The last one
// is never zero: it leaves the row of the point with the highest index alone. This holds also for
// points that share all coordinates. The interior point's index is above every other.
//
// Expects: vertices; control, of which this takes the number of the interior point; round_of.
//!include d3/predicates
//!include common/ties

const PERTURBATIONS = array<u32, 15>(0, 1, 2, 4, 8, 10, 12, 16, 20, 32, 64, 66, 68, 80, 84);

// Returns the coordinates of the point of this rank that S lowers.
fn lowering(s: u32, rank: u32) -> vec3u {
    let bits = s >> (3 * rank);
    return vec3u((bits >> 2) & 1, (bits >> 1) & 1, bits & 1);
}

// The differences of four points to the last one.
struct Rows {
    a: Row,
    b: Row,
    c: Row,
    d: Row,
}

// Returns the place of the vertex with the largest ζ but for those of `done`, a bit each: the one that was
// inserted last, of several the first.
fn latest(first: vec4u, last: u32, done: u32) -> u32 {
    var place = 5u;
    var round = 0u;
    for (var k = 0u; k < 5; k++) {
        let inserted = round_of(select(first[k & 3], last, k == 4));
        if ((done >> k) & 1) == 0 && (place == 5 || inserted > round) {
            place = k;
            round = inserted;
        }
    }
    return place;
}

// Returns the differences of four points to a fifth.
fn rows_of(a: Vertex, b: Vertex, c: Vertex, d: Vertex, origin: Vertex) -> Rows {
    return Rows(difference(a, origin), difference(b, origin), difference(c, origin), difference(d, origin));
}

// The steps for each set of lowered coordinates: without ζ, then with that of each point.
const STEPS_PER_SET: u32 = 6;

// Returns the sign that five vertices give to an in-sphere test or an orientation, never 0 where
// these are not: insphere(a, b, c, d, e); or, if `of_four`, the orientation of a, b, c, d, where e
// is the interior point.
//
// Hardly any test needs more than the first step. So only the numbers of the vertices are kept for the others,
// which load them again: all else would be in registers during the exact arithmetic.
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
    let first = vec4u(a.number, b.number, c.number, d.number);
    let last = e.number;
    var rows = rows_of(a, b, c, d, e);
    let steps = not_unrolled(15 * STEPS_PER_SET);
    let points = not_unrolled(4);
    var step = 0u;
    // The place of the vertex for which the interior point comes in, and those of which this was so.
    var left_out = 4u;
    var done = 0u;
    var sign = 0;
    while step < steps {
        let s = PERTURBATIONS[step / STEPS_PER_SET];
        var volume = zero_volume();
        var by_height = 0;
        var sum = zero_determinant();
        // The coefficients of the heights: by the convention for the sign, +[bcd], −[acd], +[abd]
        // and −[abc], and for the last point what makes their sum 0. A step's point has the first
        // row; then the rows move up, and are where they were after the last step.
        for (var k = 0u; k < points; k++) {
            let next = (vec3u(k) + vec3u(1, 2, 3)) % 4;
            let ranks = next + select(vec3u(0), vec3u(1), next >= vec3u(left_out));
            var coefficient = determinant(
                lowered(rows.b, lowering(s, ranks.x)),
                lowered(rows.c, lowering(s, ranks.y)),
                lowered(rows.d, lowering(s, ranks.z))
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
        if sign != 0 {
            break;
        }
        step += select(1u, STEPS_PER_SET, of_four);
        var origin = last;
        if step % STEPS_PER_SET == 0 {
            left_out = 4;
            done = 0;
        } else {
            left_out = latest(first, last, done);
            done |= 1u << left_out;
            origin = control.infinite;
        }
        let four = select(vec4u(first.yzw, last), first, vec4u(0, 1, 2, 3) < vec4u(left_out));
        rows = rows_of(
            load_vertex(four.x), load_vertex(four.y), load_vertex(four.z), load_vertex(four.w), load_vertex(origin)
        );
    }
    return select(sign, -sign, left_out % 2 == 1) * parity;
}
