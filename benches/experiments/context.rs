//! What the experiments share: the device, the inputs, and how time is taken.

use gdel::{
    Mesh3, Points3,
    internals::{
        Options, cpu,
        d3::generate::{Distribution3, generate3d},
        gpu::{AdapterChoice, Gpu, engine::GpuEngine, phase1::Settings},
        io::{PointCloud, files},
    },
    stats::Stats,
};
use pollster::block_on;
use std::{
    error::Error,
    fs,
    path::{Path, PathBuf},
    process::Command,
    time::Instant,
};

pub struct Context {
    sizes: Option<Vec<usize>>,
    pub models: Vec<Model>,
    repeat: usize,
    seed: u64,
    cgal: Option<PathBuf>,
    pub gpu: Gpu,
    /// Milliseconds for opening the device.
    pub opening: f64,
}

/// A point cloud with a name.
pub struct Model {
    pub name: String,
    pub cloud: PointCloud,
}

/// A run with the median time.
pub struct Timed {
    pub milliseconds: f64,
    pub stats: Stats,
}

impl Context {
    pub fn new(
        sizes: Option<Vec<usize>>,
        models: Vec<PathBuf>,
        adapter: Option<String>,
        repeat: usize,
        seed: u64,
        cgal: PathBuf,
    ) -> Result<Self, Box<dyn Error>> {
        let model = |path: PathBuf| -> Result<Model, Box<dyn Error>> {
            let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
            Ok(Model { name, cloud: files::read_points(&path)? })
        };
        let adapter = match adapter {
            None => AdapterChoice::Default,
            Some(text) => text.parse().map(AdapterChoice::Index).unwrap_or(AdapterChoice::Name(text)),
        };
        let clock = Instant::now();
        let gpu = block_on(Gpu::open(&adapter))?;
        let opening = clock.elapsed().as_secs_f64() * 1e3;
        let models = models.into_iter().map(model).collect::<Result<_, _>>()?;
        let cgal = cgal.exists().then_some(cgal);
        Ok(Context { sizes, models, repeat: repeat.max(1), seed, cgal, gpu, opening })
    }

    /// Returns one line on what the figures were measured with.
    pub fn setting(&self) -> String {
        let cgal = if self.cgal.is_some() { "with" } else { "without" };
        format!(
            "{} ({}); medians of {} after a warm-up, warm engine, points in host memory to mesh in host memory; {cgal} CGAL",
            self.gpu.adapter().name,
            self.gpu.adapter().driver,
            self.repeat
        )
    }

    /// Returns the sizes of the command line, or these.
    pub fn sizes(&self, default: &[usize]) -> Vec<usize> {
        self.sizes.clone().unwrap_or_else(|| default.to_vec())
    }

    pub fn points(&self, distribution: Distribution3, size: usize) -> Vec<[f64; 3]> {
        generate3d(distribution, size, self.seed)
    }

    /// Returns the GPU engine; other settings than the default ones are for experiments about them.
    pub fn engine(&self, settings: Settings<3>) -> Result<GpuEngine<3>, Box<dyn Error>> {
        let mut engine = block_on(GpuEngine::new(self.gpu.clone()))?;
        engine.set_settings(settings);
        Ok(engine)
    }

    /// Returns the GPU engine's run with the median time.
    pub fn on_gpu<'a>(
        &self,
        engine: &mut GpuEngine<3>,
        points: impl Into<Points3<'a>>,
    ) -> Result<Timed, Box<dyn Error>> {
        let points = points.into();
        self.median(|| block_on(engine.triangulate(points, &Options::default())))
    }

    /// Returns the statistics of a run of the GPU engine that is not timed.
    pub fn once_on_gpu(&self, engine: &mut GpuEngine<3>, points: Points3<'_>) -> Result<Stats, Box<dyn Error>> {
        Ok(block_on(engine.triangulate(points, &Options::default()))?.stats)
    }

    /// Returns the CPU engine's run with the median time.
    pub fn on_cpu<'a>(&self, points: impl Into<Points3<'a>>) -> Result<Timed, Box<dyn Error>> {
        let points = points.into();
        self.median(|| cpu::delaunay::<3>(points, &Options::default()))
    }

    /// Returns CGAL's milliseconds, if its program is installed.
    pub fn on_cgal<'a>(&self, points: impl Into<Points3<'a>>) -> Result<Option<f64>, Box<dyn Error>> {
        let Some(program) = &self.cgal else { return Ok(None) };
        let points = points.into();
        let file = tempfile::Builder::new().suffix(".f64").tempfile()?;
        let bytes = (0..points.len()).flat_map(|i| points.get(i)).flat_map(f64::to_le_bytes).collect::<Vec<u8>>();
        fs::write(file.path(), bytes)?;
        let lines =
            output_of(program, &[Path::new("--repeat"), Path::new(&(self.repeat + 1).to_string()), file.path()])?;
        let run = |line: &str| -> Result<f64, Box<dyn Error>> {
            let run: serde_json::Value = serde_json::from_str(line)?;
            Ok(run["seconds"].as_f64().ok_or("CGAL's program printed no seconds")? * 1e3)
        };
        let mut runs = lines.lines().skip(1).map(run).collect::<Result<Vec<f64>, _>>()?;
        runs.sort_by(f64::total_cmp);
        Ok(runs.get(runs.len() / 2).copied())
    }

    fn median(&self, mut run: impl FnMut() -> Result<Mesh3, gdel::Error>) -> Result<Timed, Box<dyn Error>> {
        run()?;
        let mut runs = Vec::with_capacity(self.repeat);
        for _ in 0..self.repeat {
            let clock = Instant::now();
            let mesh = run()?;
            // The rest is dropped here: its memory is given back before the next run takes its own.
            runs.push((clock.elapsed().as_secs_f64() * 1e3, mesh.stats));
        }
        runs.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let (milliseconds, stats) = runs.swap_remove(runs.len() / 2);
        Ok(Timed { milliseconds, stats })
    }
}

fn output_of(program: &Path, arguments: &[&Path]) -> Result<String, Box<dyn Error>> {
    let output = Command::new(program).args(arguments).output()?;
    if !output.status.success() {
        return Err(format!("{}: {}", program.display(), String::from_utf8_lossy(&output.stderr).trim()).into());
    }
    Ok(String::from_utf8(output.stdout)?)
}
