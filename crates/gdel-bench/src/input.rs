//! The points that are triangulated, and what differs between the dimensions.

use clap::Args;
use gdel::{
    Backend, DeviceMesh, DeviceMesh2, DeviceMesh3, Error, Mesh2, Mesh3, Points, Triangulator,
    internals::{
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        dimension::Dimension,
        gpu::{AdapterChoice, Gpu},
    },
    stats::Stats,
};
use gdel_io::files::Input as File;
use pollster::block_on;
use std::path::Path;

/// The options of a command that triangulates.
#[derive(Args)]
pub struct Source {
    /// Distributions, as `gdel generate` has them, or files with points
    #[arg(default_value = "uniform")]
    pub inputs: Vec<String>,
    /// How many points, for distributions
    #[arg(long, value_delimiter = ',', default_value = "1000000")]
    pub points: Vec<usize>,
    /// The dimension of the points
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u8).range(2..=3))]
    pub dim: u8,
    /// Round coordinates to single precision
    #[arg(long)]
    pub single: bool,
    /// Seed of the distributions
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

impl Source {
    /// Returns the points of each input in each size.
    ///
    /// # Errors
    ///
    /// Returns those of reading files.
    pub fn clouds<const D: usize>(&self) -> impl Iterator<Item = Result<Cloud<D>, Box<dyn std::error::Error>>>
    where
        Dimension<D>: Space<D>,
    {
        let sized = self.inputs.iter().flat_map(|input| {
            let is_file = Path::new(input).exists();
            let sizes = if is_file { &[0][..] } else { &self.points[..] };
            sizes.iter().map(move |&size| (input, size))
        });
        sized.map(|(input, size)| {
            let doubles = match Dimension::<D>::generate(input, size, self.seed) {
                Some(points) => points,
                None => Points::from(&File::new(Path::new(input), None)?.read::<D>()?).iter().collect(),
            };
            let singles = self.single.then(|| doubles.iter().map(|p| p.map(|x| x as f32)).collect());
            Ok(Cloud { name: input.clone(), doubles, singles })
        })
    }
}

/// Points with their name.
pub struct Cloud<const D: usize> {
    pub name: String,
    doubles: Vec<[f64; D]>,
    singles: Option<Vec<[f32; D]>>,
}

impl<const D: usize> Cloud<D> {
    pub fn points(&self) -> Points<'_, D> {
        match &self.singles {
            Some(singles) => Points::F32(singles),
            None => Points::F64(&self.doubles),
        }
    }

    /// Returns the type of the coordinates.
    pub fn precision(&self) -> &'static str {
        if self.singles.is_some() { "f32" } else { "f64" }
    }
}

/// What differs between the dimensions.
pub trait Space<const D: usize> {
    /// A mesh in host memory.
    type Mesh: Default;

    /// Returns points of the distribution with this name, if there is one.
    fn generate(name: &str, count: usize, seed: u64) -> Option<Vec<[f64; D]>>;

    /// Triangulates into the memory of a mesh.
    fn triangulate(triangulator: &Triangulator, points: Points<'_, D>, mesh: &mut Self::Mesh) -> Result<(), Error>;

    /// Triangulates, and leaves the mesh on the device.
    fn triangulate_resident(triangulator: &Triangulator, points: Points<'_, D>) -> Result<DeviceMesh<D>, Error>;

    /// Returns the number of simplices, which points are duplicates, and what the run says about itself.
    fn summary(mesh: &Self::Mesh) -> (usize, &[u32], &Stats);
}

impl Space<2> for Dimension<2> {
    type Mesh = Mesh2;

    fn generate(name: &str, count: usize, seed: u64) -> Option<Vec<[f64; 2]>> {
        let distribution = Distribution2::ALL.into_iter().find(|distribution| distribution.name() == name)?;
        Some(generate2d(distribution, count, seed))
    }

    fn triangulate(triangulator: &Triangulator, points: Points<'_, 2>, mesh: &mut Mesh2) -> Result<(), Error> {
        triangulator.delaunay2d_into(points, mesh)
    }

    fn triangulate_resident(triangulator: &Triangulator, points: Points<'_, 2>) -> Result<DeviceMesh2, Error> {
        triangulator.device()?.delaunay2d(points)
    }

    fn summary(mesh: &Mesh2) -> (usize, &[u32], &Stats) {
        (mesh.triangles.len(), &mesh.duplicate_of, &mesh.stats)
    }
}

impl Space<3> for Dimension<3> {
    type Mesh = Mesh3;

    fn generate(name: &str, count: usize, seed: u64) -> Option<Vec<[f64; 3]>> {
        let distribution = Distribution3::ALL.into_iter().find(|distribution| distribution.name() == name)?;
        Some(generate3d(distribution, count, seed))
    }

    fn triangulate(triangulator: &Triangulator, points: Points<'_, 3>, mesh: &mut Mesh3) -> Result<(), Error> {
        triangulator.delaunay3d_into(points, mesh)
    }

    fn triangulate_resident(triangulator: &Triangulator, points: Points<'_, 3>) -> Result<DeviceMesh3, Error> {
        triangulator.device()?.delaunay3d(points)
    }

    fn summary(mesh: &Mesh3) -> (usize, &[u32], &Stats) {
        (mesh.tetrahedra.len(), &mesh.duplicate_of, &mesh.stats)
    }
}

/// The options of a command that uses a GPU.
#[derive(Args)]
pub struct Adapter {
    /// The GPU, by a part of its name
    #[arg(long)]
    adapter: Option<String>,
}

impl Adapter {
    fn choice(&self) -> AdapterChoice {
        self.adapter.clone().map_or(AdapterChoice::Default, AdapterChoice::Name)
    }

    /// Opens the device.
    ///
    /// # Errors
    ///
    /// Returns those of [`Gpu::open`].
    pub fn open(&self) -> Result<Gpu, Error> {
        block_on(Gpu::open(&self.choice()))
    }

    /// Returns a triangulator for a backend, which opens the device when it first needs it.
    pub fn triangulator(&self, backend: Backend) -> Triangulator {
        Triangulator::new().backend(backend).adapter(self.choice())
    }
}
