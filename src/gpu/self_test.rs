//! Proves that a device computes what it should, by inputs whose meshes are known.
//!
//! The Delaunay triangulation of an input is one set of simplices, on every device. So a number for each input
//! suffices to notice drivers that compile a shader wrongly, or return zeros.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        device_mesh::MeshArrays,
        engine::{Complete, Destination, GpuEngine, Outcome},
        host::Here,
    },
    index::NONE,
    input::{lattice::Width, points::Points},
    options::Options,
    platform,
    random::Random,
};

/// How the points of a test lie.
#[derive(Debug, Clone, Copy)]
enum Shape {
    /// Uniform in the unit cube, on the wide lattice.
    Uniform,
    /// On a small grid, with ties and duplicates, on the narrow lattice.
    Grid,
    /// Near the unit sphere, where only exact arithmetic decides.
    Sphere,
}

/// An input, and what its mesh is known to be.
#[derive(Debug, Clone, Copy)]
pub struct KnownAnswer {
    /// What the test is called.
    pub name: &'static str,
    shape: Shape,
    count: usize,
    /// The fingerprints of the meshes in two and in three dimensions.
    answers: [u64; 2],
}

/// The tests: one for ties on the narrow lattice, one for exact arithmetic on the wide one, and one so large that
/// lists fill several workgroups.
pub const KNOWN_ANSWERS: [KnownAnswer; 3] = [
    KnownAnswer {
        name: "grid",
        shape: Shape::Grid,
        count: 1_000,
        answers: [0xa30d_6e1a_f134_4004, 0x04a1_ed6b_cd3d_933d],
    },
    KnownAnswer {
        name: "sphere",
        shape: Shape::Sphere,
        count: 400,
        answers: [0x1733_69c5_2cc7_2c7c, 0xc47a_91b8_953a_416e],
    },
    UNIFORM,
];

/// The largest of the tests.
pub const UNIFORM: KnownAnswer = KnownAnswer {
    name: "uniform",
    shape: Shape::Uniform,
    count: 30_000,
    answers: [0x23a7_46ad_a0b6_f6de, 0xa100_7ee8_ec16_c7ed],
};

/// The points along an axis of the grid.
const SIDE: u64 = 12;

impl KnownAnswer {
    /// Returns the points.
    pub fn points<const D: usize>(&self) -> Vec<[f64; D]> {
        let mut random = Random::new(self.count as u64);
        let point = || match self.shape {
            Shape::Uniform => random.in_cube(),
            Shape::Grid => random.on_grid(SIDE),
            Shape::Sphere => random.on_sphere(),
        };
        std::iter::repeat_with(point).take(self.count).collect()
    }

    /// Returns the fingerprint of the mesh in `D` dimensions.
    pub fn answer<const D: usize>(&self) -> u64 {
        self.answers[D - 2]
    }
}

/// Returns a number that depends on the set of simplices and on which are neighbours, and not on their order. There are
/// `D + 1` words for each simplex in each list.
pub fn fingerprint<const D: usize>(simplices: &[u32], neighbors: &[u32]) -> u64 {
    let corners: Vec<u64> = simplices.iter().map(|&v| mix(v.into())).collect();
    // A sum, so that the order of the corners does not matter.
    let sum_of = |corners: &[u64]| corners.iter().fold(0, |sum: u64, &v| sum.wrapping_add(v));
    let own: Vec<u64> = corners.chunks_exact(D + 1).map(|corners| mix(sum_of(corners))).collect();
    let across = |&n: &u32| match n {
        NONE => 0,
        // Half-edges in 2D.
        n => own.get(n as usize / if D == 2 { 3 } else { 1 }).copied().unwrap_or_default(),
    };
    let facets = corners.iter().zip(neighbors).enumerate();
    facets.fold(0, |sum, (i, (corner, n))| sum.wrapping_add(mix(own[i / (D + 1)] ^ corner ^ across(n))))
}

/// Returns a hash, by the last steps of SplitMix64.
fn mix(word: u64) -> u64 {
    let word = word.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

impl<const D: usize> GpuEngine<D>
where
    Dimension<D>: Complete<D>,
{
    /// Triangulates the inputs of [`KNOWN_ANSWERS`] on the device, with all kernels of ordinary runs, which are compiled
    /// if they are not.
    ///
    /// # Errors
    ///
    /// Returns [`Error::WrongResults`] if a mesh is not the known one, or was left to the CPU engine; and the errors of
    /// [`GpuEngine::triangulate`].
    pub async fn self_test(&mut self) -> Result<(), Error> {
        self.kernels(Width::Narrow, 0).await?;
        self.finish_compiling().await?;
        for test in &KNOWN_ANSWERS {
            match self.fingerprint_of(&test.points()).await {
                Ok(found) if found == Some(test.answer::<D>()) => {}
                // The check of the mesh may notice it first.
                Ok(_) | Err(Error::WrongResults { .. }) => return Err(self.gpu().wrong(test.name)),
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// Returns the fingerprint of the mesh of some points, if it is made on the device.
    async fn fingerprint_of(&mut self, points: &[[f64; D]]) -> Result<Option<u64>, Error> {
        let options = Options::default();
        let mut host = platform::any_host(Here::new(Points::F64(points), &options, Default::default()));
        let outcome = self.drive(&mut host, &options, Destination::Device(None)).await?;
        let Outcome::Made(made) = outcome else { return Ok(None) };
        let mesh = made.into_host().await?;
        let [simplices, neighbors, _] = Dimension::<D>::words(&mesh);
        Ok(Some(fingerprint::<D>(simplices, neighbors)))
    }
}
