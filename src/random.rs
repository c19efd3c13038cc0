//! Random points that are the same bit for bit on every platform, for both dimensions.

use rand_pcg::{
    Pcg64Mcg,
    rand_core::{Rng, SeedableRng},
};

/// The number of points along each axis of a random grid.
pub const GRID_SIDE: u64 = 512;

/// The inner and the outer radius of thin spheres and thin circles.
pub const THIN_SPHERE_RADII: [f64; 2] = [1.0, 1.01];

/// Declares the distributions of the synthetic points of one dimension, with their names.
macro_rules! distributions {
    (
        $(#[$attribute:meta])*
        pub enum $distribution:ident {
            $($(#[$variant_attribute:meta])* $variant:ident = $name:literal,)*
        }
    ) => {
        $(#[$attribute])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum $distribution {
            $($(#[$variant_attribute])* $variant,)*
        }

        impl $distribution {
            /// Every distribution.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$variant),*];

            /// Returns the name on the command line.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }
        }
    };
}
pub(crate) use distributions;

/// A generator of random numbers, and of points of `D` coordinates.
pub(crate) struct Random(Pcg64Mcg);

impl Random {
    /// Creates a generator from a seed.
    pub(crate) fn new(seed: u64) -> Self {
        Random(Pcg64Mcg::seed_from_u64(seed))
    }

    /// Returns a number uniform in [0, 1), a multiple of 2⁻⁵³.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (0.5 * f64::EPSILON)
    }

    /// Returns a point uniform in the unit cube [0, 1)ᴰ.
    pub(crate) fn in_cube<const D: usize>(&mut self) -> [f64; D] {
        std::array::from_fn(|_| self.unit())
    }

    /// Returns a point uniform in the unit ball, by rejection from the cube [−1, 1)ᴰ.
    pub(crate) fn in_ball<const D: usize>(&mut self) -> [f64; D] {
        loop {
            let p: [f64; D] = self.in_cube().map(|x| 2.0 * x - 1.0);
            if squared_norm(p) <= 1.0 {
                return p;
            }
        }
    }

    /// Returns a point uniform on the unit sphere: a point of the ball, projected. Points within
    /// 0.01 of the centre are rejected, because too few of their bits are left for a direction.
    pub(crate) fn on_sphere<const D: usize>(&mut self) -> [f64; D] {
        loop {
            let p: [f64; D] = self.in_ball();
            let squared = squared_norm(p);
            if squared >= 1e-4 {
                let norm = squared.sqrt();
                return p.map(|x| x / norm);
            }
        }
    }

    /// Returns a point uniform in volume between two radii.
    pub(crate) fn in_shell(&mut self, [inner, outer]: [f64; 2]) -> [f64; 3] {
        let direction: [f64; 3] = self.on_sphere();
        let cubed = |r: f64| r * r * r;
        let radius = libm::cbrt(cubed(inner) + self.unit() * (cubed(outer) - cubed(inner)));
        direction.map(|x| x * radius)
    }

    /// Returns a point of the integer grid with `side` points along each axis.
    pub(crate) fn on_grid<const D: usize>(&mut self, side: u64) -> [f64; D] {
        std::array::from_fn(|_| (self.0.next_u64() % side) as f64)
    }

    /// Returns a point whose coordinates are normal with mean 0 and variance 1.
    pub(crate) fn gaussian<const D: usize>(&mut self) -> [f64; D] {
        std::array::from_fn(|_| self.normal())
    }

    /// Returns a normal number by Marsaglia's polar method. The method's second value is dropped,
    /// so that a point depends on nothing before it except the generator's state.
    fn normal(&mut self) -> f64 {
        loop {
            let [u, v] = std::array::from_fn(|_| 2.0 * self.unit() - 1.0);
            let squared = u * u + v * v;
            if squared > 0.0 && squared < 1.0 {
                return u * (-2.0 * libm::log(squared) / squared).sqrt();
            }
        }
    }
}

/// Returns the squared distance from the origin.
pub(crate) fn squared_norm<const D: usize>(p: [f64; D]) -> f64 {
    // The sum starts with the first term rather than with 0, so that no rounding differs between
    // dimensions.
    p.into_iter().map(|x| x * x).reduce(|a, b| a + b).unwrap_or(0.0)
}
