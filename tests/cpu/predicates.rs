//! The signs of the predicates against big integers: random cases, and cases that are zero, or one
//! rounding step from zero.

use crate::oracle::{in_circumsphere, in_circumsphere_symbolic, integers, orientation, sign};
use gdel::{
    Points,
    internals::{
        input::lattice::Lattice,
        predicates::{collinear, filter::PredicateContext, incircle, insphere, orient2d, orient3d},
    },
};
use gdel_reference::insphere_symbolic;
use num_bigint::BigInt;
use rand_pcg::{
    Pcg64Mcg,
    rand_core::{Rng, SeedableRng},
};

/// The number of cases of each predicate and [`Kind`].
const CASES: usize = 5_000;

/// How the arguments of a case are related.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Of 53 random bits.
    Random,
    /// In a small grid: often degenerate.
    Grid,
    /// On a line, plane, circle or sphere, exactly.
    Degenerate,
    /// Degenerate, with one to three coordinates moved by a rounding step.
    NearlyDegenerate,
    /// Coordinates slightly above 10⁷, in thousandths, as in maps.
    Offset,
    /// Random bits: all exponents.
    AnyFinite,
    /// Each point has its own scale.
    MixedScales,
}

impl Kind {
    const ALL: [Kind; 7] = [
        Kind::Random,
        Kind::Grid,
        Kind::Degenerate,
        Kind::NearlyDegenerate,
        Kind::Offset,
        Kind::AnyFinite,
        Kind::MixedScales,
    ];

    /// Returns whether signs of zero must occur, so that the test tests them.
    fn has_zeros(self) -> bool {
        matches!(self, Kind::Grid | Kind::Degenerate)
    }
}

/// The degenerate position that a predicate detects.
#[derive(Debug, Clone, Copy)]
enum Position {
    /// On a common line or plane.
    Flat,
    /// On a common circle or sphere.
    Spherical,
}

struct Cases(Pcg64Mcg);

impl Cases {
    fn below(&mut self, n: u64) -> u64 {
        self.0.next_u64() % n
    }

    fn small(&mut self, max: u64) -> f64 {
        self.below(2 * max + 1) as f64 - max as f64
    }

    fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn any_finite(&mut self) -> f64 {
        loop {
            let x = f64::from_bits(self.0.next_u64());
            if x.is_finite() {
                return x;
            }
        }
    }

    /// Returns a power of two, from the smallest positive number to nearly the largest.
    fn scale(&mut self) -> f64 {
        let exponents = [-1074, -1060, -1022, -700, -350, -190, 0, 0, 50, 180, 300, 600, 1000];
        let exponent: i32 = exponents[self.below(exponents.len() as u64) as usize];
        match exponent {
            -1022.. => f64::from_bits(((exponent + 1023) as u64) << 52),
            _ => f64::from_bits(1 << (exponent + 1074)),
        }
    }

    fn points<const D: usize, const N: usize>(&mut self, kind: Kind, position: Position) -> [[f64; D]; N] {
        let mut coordinates = |mut f: Box<dyn FnMut(&mut Self) -> f64>| [(); N].map(|()| [(); D].map(|()| f(self)));
        match kind {
            Kind::Random => coordinates(Box::new(Cases::unit)),
            Kind::Grid => coordinates(Box::new(|cases| cases.small(2))),
            Kind::Offset => coordinates(Box::new(|cases| 1e7 + cases.below(50) as f64 / 1000.0)),
            Kind::AnyFinite => coordinates(Box::new(Cases::any_finite)),
            Kind::MixedScales => [(); N].map(|()| {
                let scale = self.scale();
                [(); D].map(|()| self.small(5) * scale)
            }),
            Kind::Degenerate => self.degenerate(position),
            Kind::NearlyDegenerate => {
                let mut points = self.degenerate(position);
                for _ in 0..=self.below(3) {
                    let x = &mut points[self.below(N as u64) as usize][self.below(D as u64) as usize];
                    let moved = if self.below(2) == 0 { x.next_up() } else { x.next_down() };
                    *x = if moved.is_finite() { moved } else { *x };
                }
                points
            }
        }
    }

    /// Returns small integers times a power of two.
    fn degenerate<const D: usize, const N: usize>(&mut self, position: Position) -> [[f64; D]; N] {
        let scale = self.scale();
        let [center, u, v] = [9, 9, 9].map(|max| [(); D].map(|()| self.small(max)));
        [(); N].map(|()| {
            let p: [f64; D] = match position {
                Position::Flat => {
                    // One parameter fewer than the dimension.
                    let (s, t) = (self.small(9), if D == 2 { 0.0 } else { self.small(9) });
                    std::array::from_fn(|i| center[i] + s * u[i] + t * v[i])
                }
                Position::Spherical => {
                    // Sign changes and rotations of the coordinates keep the distance from the
                    // centre.
                    let mut p = u.map(|x| if self.below(2) == 0 { x } else { -x });
                    p.rotate_left(self.below(D as u64) as usize);
                    std::array::from_fn(|i| center[i] + p[i])
                }
            };
            p.map(|x| x * scale)
        })
    }
}

/// Runs all kinds of cases; `found` and `expected` return signs that must be equal.
fn compare<const D: usize, const N: usize>(
    position: Position,
    found: impl Fn([[f64; D]; N]) -> i8,
    expected: impl Fn(&[&[BigInt; D]]) -> i8,
) {
    let mut cases = Cases(Pcg64Mcg::seed_from_u64(1));
    for kind in Kind::ALL {
        let mut signs = [0; 3];
        for _ in 0..CASES {
            let points: [[f64; D]; N] = cases.points(kind, position);
            let integers = integers(&points);
            let expected = expected(&integers.iter().collect::<Vec<_>>());
            assert_eq!(found(points), expected, "{kind:?} {points:?}");
            // Exchanging two arguments changes the sign.
            let (i, j) = (cases.below(N as u64) as usize, cases.below(N as u64) as usize);
            let mut exchanged = points;
            exchanged.swap(i, j);
            assert_eq!(found(exchanged), if i == j { expected } else { -expected }, "{kind:?} {exchanged:?}");
            signs[(expected + 1) as usize] += 1;
        }
        let [negative, zero, positive] = signs;
        assert!(negative + positive > CASES / 50 || kind == Kind::Degenerate, "{kind:?}: {signs:?}");
        assert!(zero > CASES / 50 || !kind.has_zeros(), "{kind:?}: {signs:?}");
    }
}

#[test]
fn orient2d_is_exact() {
    compare(Position::Flat, |[a, b, c]| orient2d(a, b, c), |points| sign(&orientation(points)));
}

#[test]
fn orient3d_is_exact() {
    compare(Position::Flat, |[a, b, c, d]| orient3d(a, b, c, d), |points| sign(&orientation(points)));
}

#[test]
fn incircle_is_exact() {
    compare(Position::Spherical, |[a, b, c, d]| incircle(a, b, c, d), |points| sign(&in_circumsphere(points)));
}

#[test]
fn insphere_is_exact() {
    compare(Position::Spherical, |[a, b, c, d, e]| insphere(a, b, c, d, e), |points| sign(&in_circumsphere(points)));
}

#[test]
fn insphere_of_coplanar_points_is_exact() {
    compare(Position::Flat, |[a, b, c, d, e]| insphere(a, b, c, d, e), |points| sign(&in_circumsphere(points)));
}

/// Returns different indices for the points, independent of their order among the arguments.
fn indices<const N: usize>(points: [[f64; 3]; N], salt: u64) -> [u32; N] {
    let hash = |p: [f64; 3]| {
        let mixed =
            p.iter().fold(salt | 1, |h, x| (h ^ x.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29));
        (mixed >> 32) as u32
    };
    points.map(hash)
}

#[test]
fn insphere_symbolic_is_exact() {
    for salt in [1, 2, 3] {
        let mut cases = Cases(Pcg64Mcg::seed_from_u64(salt));
        for kind in Kind::ALL {
            let mut ties = 0;
            for _ in 0..CASES / 3 {
                let points: [[f64; 3]; 5] = cases.points(kind, Position::Spherical);
                let indices = indices(points, cases.0.next_u64());
                if (0..5).any(|i| indices[..i].contains(&indices[i])) {
                    continue;
                }
                let integers = integers(&points);
                let integers: Vec<_> = integers.iter().collect();
                let expected = in_circumsphere_symbolic(&indices, &integers);
                let found = |order: [usize; 5]| insphere_symbolic(order.map(|i| (indices[i], points[i])));
                assert_eq!(found([0, 1, 2, 3, 4]), expected, "{kind:?} {indices:?} {points:?}");
                assert_eq!(found([1, 0, 2, 3, 4]), -expected, "{kind:?} {indices:?} {points:?}");
                assert_eq!(found([4, 1, 2, 3, 0]), -expected, "{kind:?} {indices:?} {points:?}");
                let tie = in_circumsphere(&integers) == BigInt::ZERO;
                let coplanar = (0..5).all(|k| {
                    let others: Vec<_> = (0..5).filter(|&i| i != k).map(|i| integers[i]).collect();
                    orientation(&others) == BigInt::ZERO
                });
                assert_eq!(expected == 0, coplanar);
                ties += usize::from(tie && !coplanar);
            }
            assert!(ties > CASES / 300 || !kind.has_zeros(), "{kind:?}: {ties}");
        }
    }
}

#[test]
fn collinear_is_exact() {
    let mut cases = Cases(Pcg64Mcg::seed_from_u64(1));
    for kind in Kind::ALL {
        let mut count = 0;
        for _ in 0..CASES {
            let mut points: [[f64; 3]; 3] = cases.points(kind, Position::Flat);
            if kind == Kind::Degenerate {
                // On a line, not only in a plane; small integers, so exactly.
                let [a, b, _] = points;
                let c = std::array::from_fn(|i| b[i] + (b[i] - a[i]));
                points[2] = if c.iter().all(|x: &f64| x.is_finite()) { c } else { a };
            }
            let [a, b, c] = points;
            let big = integers(&points);
            let expected = (0..3).all(|axis| {
                let flat = [0, 1, 2].map(|i| [big[i][axis].clone(), big[i][(axis + 1) % 3].clone()]);
                orientation(&flat.iter().collect::<Vec<_>>()) == BigInt::ZERO
            });
            assert_eq!(collinear(a, b, c), expected, "{kind:?} {points:?}");
            count += usize::from(expected);
        }
        assert!(count > CASES / 50 || kind != Kind::Degenerate, "{kind:?}: {count}");
    }
}

/// The predicates of a context, on a lattice fitted to the points, with filters that hold for all
/// of them.
#[test]
fn predicates_of_prepared_vertices_are_exact() {
    let mut cases = Cases(Pcg64Mcg::seed_from_u64(1));
    for kind in Kind::ALL {
        for position in [Position::Flat, Position::Spherical] {
            for _ in 0..CASES / 5 {
                // More points than arguments, so that the common bounds are not those of the
                // arguments.
                let points: [[f64; 3]; 10] = cases.points(kind, position);
                let order: Vec<u32> = (0..10).map(|i| i * 7 % 10).collect();
                let input = Points::F64(&points);
                let vertices = PredicateContext::new(input, &Lattice::fit(input), order.clone());
                let integers = integers(&points);
                let [a, b, c, d, e] = std::array::from_fn(|_| cases.below(10) as u32);
                let point = |v: u32| &integers[order[v as usize] as usize];
                let five = [a, b, c, d, e];
                let expected = sign(&orientation(&[a, b, c, d].map(point)));
                assert_eq!(vertices.orient3d(a, b, c, d), expected, "{kind:?} {five:?} {points:?}");
                if (0..5).any(|i| five[..i].contains(&five[i])) {
                    continue;
                }
                let expected = in_circumsphere_symbolic(&five.map(|v| order[v as usize]), &five.map(point));
                assert_eq!(vertices.insphere([a, b, c, d], e), expected, "{kind:?} {five:?} {points:?}");
            }
        }
    }
}
