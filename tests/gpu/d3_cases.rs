//! Five vertices each, for the predicates: generic, nearly degenerate and degenerate.

use crate::positions::{clustered, corners, cospherical, direction, grid, indices, largest, uniform};
use gdel::internals::input::lattice::Width;
use gdel_reference::d3::predicates::Vertex;
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// The arguments of an in-sphere test; the first four are those of an orientation, with the last
/// for the interior point.
pub type Case = [Vertex; 5];

/// How the points of a case lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Anywhere on the lattice.
    Uniform,
    /// All coordinates are 0 or the largest.
    Corners,
    /// A few lattice steps apart: all kinds of degeneracy, also points that coincide.
    SmallGrid,
    /// In a plane, exactly or off by one.
    Coplanar,
    /// On a sphere of integer radius, exactly or off by one.
    Cospherical,
    /// All on a line.
    Collinear,
    /// As near to each other as a millionth of the range.
    Clustered,
}

/// All families.
pub const FAMILIES: &[Family] = &[
    Family::Uniform,
    Family::Corners,
    Family::SmallGrid,
    Family::Coplanar,
    Family::Cospherical,
    Family::Collinear,
    Family::Clustered,
];

impl Family {
    /// Asserts that the numbers of zeros and of signs that the filter decided, for orientation and
    /// in-sphere, are about what the family promises, so that a generator that misses its aim is
    /// noticed.
    pub fn check_that_it_is_what_it_says(self, zeros: [usize; 2], decided: [usize; 2], cases: usize) {
        let share = |part: usize| part as f64 / cases as f64;
        match self {
            Family::Uniform => assert!(share(decided[0]) > 0.99 && share(decided[1]) > 0.99),
            Family::Clustered => assert!(zeros == [0, 0]),
            Family::Corners | Family::SmallGrid => assert!(share(zeros[0]) > 0.05 && share(zeros[1]) > 0.05),
            Family::Coplanar => assert!((0.3..0.9).contains(&share(zeros[0]))),
            Family::Cospherical => assert!((0.3..0.9).contains(&share(zeros[1]))),
            Family::Collinear => assert!(zeros == [cases, cases]),
        }
    }
}

/// `count` cases of a family, the same in every run.
pub fn cases(family: Family, width: Width, count: usize) -> Vec<Case> {
    let mut rng = Pcg64Mcg::seed_from_u64(family as u64);
    (0..count)
        .map(|_| {
            let positions = positions(family, width, &mut rng);
            let indices = indices(&mut rng);
            std::array::from_fn(|i| Vertex { position: positions[i], index: indices[i] })
        })
        .collect()
}

fn positions(family: Family, width: Width, rng: &mut impl Rng) -> [[i64; 3]; 5] {
    let max = largest(width);
    match family {
        Family::Uniform => uniform(max, rng),
        Family::Corners => corners(max, rng),
        Family::SmallGrid => grid(max, rng),
        Family::Coplanar => {
            let limit = max / 4;
            let [u, v]: [[i64; 3]; 2] =
                std::array::from_fn(|_| std::array::from_fn(|_| rng.random_range(-limit / 4..limit / 4)));
            let off = rng.random_range(0..5);
            std::array::from_fn(|i| {
                let [s, t] = [rng.random_range(-2..=2), rng.random_range(-2..=2)];
                let nudge = i64::from(i == off && rng.random::<bool>());
                std::array::from_fn(|axis| 2 * limit + s * u[axis] + t * v[axis] + nudge * i64::from(axis == 0))
            })
        }
        // Of length 9.
        Family::Cospherical => cospherical(&[[0, 0, 9], [1, 4, 8], [4, 4, 7], [3, 6, 6]], max / 20, max, rng),
        Family::Collinear => {
            let u: [i64; 3] = direction(max, rng);
            std::array::from_fn(|_| {
                let s = rng.random_range(-8..=8);
                std::array::from_fn(|axis| max / 2 + s * u[axis])
            })
        }
        Family::Clustered => clustered(max, rng),
    }
}
