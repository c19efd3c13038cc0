//! Semi-discrete optimal transport: the weights with which the cells of a power diagram have given volumes.
//!
//! They exist and are unique up to a constant (Aurenhammer, Hoffmann and Aronov 1998). Found by the damped Newton
//! method of Kitagawa, Mérigot and Thibert (*Convergence of a Newton algorithm for semi-discrete optimal transport*,
//! 2019), which converges from any weights with which no cell is empty:
//!
//! 1. `sites`: the distinct points, and such weights;
//! 2. `cells`: the volumes and their derivatives;
//! 3. `laplacian`: the step with which all volumes would be right if they were linear;
//! 4. of that the largest of the shares 1, ½, ¼, … with which no cell becomes too small and the error falls.

mod cells;
mod halves;
mod in_order;
mod laplacian;
mod sites;

pub use halves::sites_by_halves;

use super::voronoi::{Clip, VoronoiShapes};
use crate::{
    cpu::{Incremental, MeshOf},
    dimension::Dimension,
    error::Error,
    geometry::Euclidean,
    input::points::Points,
    mesh::Mesh,
    options::{Options, Progress},
    parallel::{self, Threads},
    stats::Phase,
};
use cells::Cells;
use sites::Sites;
use std::sync::Arc;

/// Coordinates may be as large as this, and what the cells are clipped to as small as its reciprocal: then no square or
/// volume overflows.
const LARGEST: f64 = 1e90;

/// The share by which the sum of masses may differ from the volume that they are to fill.
const SLACK: f64 = 1e-6;

/// The residual of the linear system, as a share of the error, and the largest entries of it, as shares of the masses:
/// a cell that is smaller than half its mass must not become even smaller because of it.
const PRECISION: f64 = 1e-2;
const PRECISION_OF_CELLS: f64 = 0.1;

/// The largest number of steps, and of halvings of one step. Where steps come to be so small, rounding decides.
const MAX_STEPS: usize = 500;
const MAX_HALVINGS: i32 = 30;

/// What [`Triangulator::transport3d`](crate::Triangulator::transport3d) is to reach.
///
/// # Examples
///
/// ```
/// let mut options = gdel::TransportOptions::default();
/// options.masses = Some(&[1.0, 2.0, 3.0]);
/// options.normalize = true;
/// ```
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct TransportOptions<'a> {
    /// The mass of each point, which is the volume that its cell is to have, in 2D the area. By default all are equal.
    pub masses: Option<&'a [f64]>,
    /// Whether masses are only compared with each other: they are multiplied so that their sum is the volume of what
    /// the cells are clipped to. By default it has to be that already, within a millionth.
    pub normalize: bool,
    /// The share of its mass by which the volume of a cell may differ from it; by default 0.001.
    pub tolerance: f64,
}

impl Default for TransportOptions<'_> {
    fn default() -> Self {
        TransportOptions { masses: None, normalize: false, tolerance: 1e-3 }
    }
}

/// Weights with which cells have the masses of their points.
///
/// [`Triangulator::transport3d`](crate::Triangulator::transport3d) has an example.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Transport {
    /// The weight of each point, of which the least is 0; equal points have equal ones.
    pub weights: Vec<f64>,
    /// The volume of each point's cell, in 2D the area. Equal points share a cell: each has as much of it as of their
    /// masses.
    pub volumes: Vec<f64>,
    /// The largest difference between the mass of a cell and its volume, as a share of the mass.
    pub error: f64,
    /// The number of Newton's steps.
    pub steps: usize,
}

/// Finds the weights.
///
/// # Errors
///
/// Returns the errors of [`Triangulator::transport3d`](crate::Triangulator::transport3d).
pub fn transport<const D: usize, const N: usize>(
    points: Points<'_, D>,
    clip: Clip<'_, D>,
    options: &TransportOptions<'_>,
    run: &Options,
) -> Result<Transport, Error>
where
    Dimension<D>: Incremental<D>,
    MeshOf<D>: Mesh<D, N>,
    Euclidean: VoronoiShapes<D, N>,
{
    let masses = options.masses;
    check(points, clip, options)?;
    parallel::with_threads(run.threads, |threads| {
        let sites = Sites::new(points, masses);
        let newton = Newton { sites: &sites, clip, tolerance: options.tolerance, run, threads };
        let Solution { weights, volumes, error, steps } = newton.solve(masses.is_some() && !options.normalize)?;
        let of_points = |of_site: &dyn Fn(usize) -> f64| sites.of_points.iter().map(|&s| of_site(s as usize)).collect();
        let mut volumes: Vec<f64> = of_points(&|s| volumes[s] / sites.masses[s]);
        for (i, volume) in volumes.iter_mut().enumerate() {
            *volume *= masses.map_or(1.0, |masses| masses[i]);
        }
        Ok(Transport { weights: of_points(&|s| weights[s]), volumes, error, steps })
    })
}

/// Checks the input.
fn check<const D: usize>(
    points: Points<'_, D>,
    clip: Clip<'_, D>,
    options: &TransportOptions<'_>,
) -> Result<(), Error> {
    points.validate_by(Threads::All)?;
    let bad = |option, range| Err(Error::BadOption { option, range });
    if clip == Clip::None {
        return bad(
            "what cells are clipped to",
            "a box, a convex shape or the hull: cells without bounds have no volume",
        );
    }
    let corners = match clip {
        Clip::Box([low, high]) => vec![low, high],
        Clip::Convex(corners) => corners.to_vec(),
        _ => Vec::new(),
    };
    let extent = |points: Points<'_, D>| {
        let [low, high] = points.bounds().unwrap_or([[0.0; D], [1.0; D]]);
        (0..D).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max)
    };
    let is_small = |points: Points<'_, D>| points.iter().flatten().all(|x| x.abs() <= LARGEST);
    let shape = if corners.is_empty() { points } else { Points::F64(&corners) };
    let is_flat = extent(shape) == 0.0;
    if !is_small(points) || !is_small(Points::F64(&corners)) || (extent(shape) < 1.0 / LARGEST && !is_flat) {
        return bad("coordinates", "at most 1e90, and the extent of what cells are clipped to at least 1e-90");
    }
    if !(options.tolerance > 0.0 && options.tolerance < 1.0) {
        return bad("the tolerance", "between 0 and 1");
    }
    let Some(masses) = options.masses else { return Ok(()) };
    if masses.len() != points.len() {
        return Err(Error::ValueCount { values: masses.len(), points: points.len() });
    }
    match masses.iter().position(|&mass| !(mass > 0.0 && mass.is_finite())) {
        Some(index) => Err(Error::BadMass { index }),
        None => Ok(()),
    }
}

/// Newton's method.
struct Newton<'a, const D: usize> {
    sites: &'a Sites<D>,
    clip: Clip<'a, D>,
    tolerance: f64,
    run: &'a Options,
    threads: Threads,
}

/// What has been found for the sites.
struct Solution {
    weights: Vec<f64>,
    volumes: Vec<f64>,
    error: f64,
    steps: usize,
}

/// Weights, their cells, and how much these lack of their masses.
struct State {
    weights: Vec<f64>,
    cells: Cells,
    lacking: Vec<f64>,
    /// The length of that vector.
    length: f64,
}

impl<const D: usize> Newton<'_, D> {
    /// Finds the weights. If the masses `must_fit`, their sum has to be the volume of all cells.
    fn solve<const N: usize>(&self, must_fit: bool) -> Result<Solution, Error>
    where
        Dimension<D>: Incremental<D>,
        MeshOf<D>: Mesh<D, N>,
        Euclidean: VoronoiShapes<D, N>,
    {
        let weights = from_zero(self.sites.first_weights(self.clip)?);
        if weights.is_empty() {
            return Ok(Solution { weights, volumes: Vec::new(), error: 0.0, steps: 0 });
        }
        self.report(0.0)?;
        let cells = Cells::new(&self.sites.points, &weights, self.clip, &self.options(0.0))?;
        let Some(cells) = cells else { return Err(stopped(f64::INFINITY)) };
        let whole: f64 = cells.volumes.iter().sum();
        let sum: f64 = self.sites.masses.iter().sum();
        if must_fit && (sum - whole).abs() > SLACK * whole {
            return Err(Error::MassSum { masses: shown(sum), volume: shown(whole) });
        }
        let masses: Vec<f64> = self.sites.masses.iter().map(|mass| mass / sum * whole).collect();
        let least = 0.5 * cells.volumes.iter().chain(&masses).copied().fold(f64::INFINITY, f64::min);
        let mut state = self.state(weights, cells, &masses);
        let error = |state: &State| {
            let shares = state.lacking.iter().zip(&masses).map(|(lacking, mass)| (lacking / mass).abs());
            shares.fold(0.0, f64::max)
        };
        let first = error(&state);
        for steps in 0..MAX_STEPS {
            let error = error(&state);
            if error <= self.tolerance {
                self.report(1.0)?;
                return Ok(Solution { weights: state.weights, volumes: state.cells.volumes, error, steps });
            }
            // What is left falls by shares.
            let fraction = if first > error { (first / error).ln() / (first / self.tolerance).ln() } else { 0.0 };
            let next = self.step(&state, &masses, least, fraction)?;
            let Some(next) = next else { return Err(stopped(error)) };
            state = next;
        }
        Err(stopped(error(&state)))
    }

    /// Takes a step, as large as it may be; none if rounding does not permit any.
    fn step<const N: usize>(
        &self,
        state: &State,
        masses: &[f64],
        least: f64,
        fraction: f64,
    ) -> Result<Option<State>, Error>
    where
        Dimension<D>: Incremental<D>,
        MeshOf<D>: Mesh<D, N>,
        Euclidean: VoronoiShapes<D, N>,
    {
        let check = || self.report(fraction);
        let limits: Vec<f64> = masses.iter().map(|mass| PRECISION_OF_CELLS * mass).collect();
        let step = state.cells.derivatives.solve(self.threads, &state.lacking, (PRECISION, &limits), check)?;
        for halvings in 0..MAX_HALVINGS {
            let share = 0.5f64.powi(halvings);
            let weights = from_zero(state.weights.iter().zip(&step).map(|(w, step)| w + share * step).collect());
            let cells = Cells::new(&self.sites.points, &weights, self.clip, &self.options(fraction))?;
            let Some(cells) = cells else { continue };
            if cells.volumes.iter().any(|&volume| volume < least) {
                continue;
            }
            let next = self.state(weights, cells, masses);
            if next.length <= (1.0 - 0.5 * share) * state.length {
                return Ok(Some(next));
            }
        }
        Ok(None)
    }

    fn state(&self, weights: Vec<f64>, cells: Cells, masses: &[f64]) -> State {
        let mut lacking: Vec<f64> = masses.iter().zip(&cells.volumes).map(|(mass, volume)| mass - volume).collect();
        let length = laplacian::squared_norm(self.threads, &mut lacking).sqrt();
        State { weights, cells, lacking, length }
    }

    /// Returns the options of a triangulation, which ends if the caller wants to stop.
    fn options(&self, fraction: f64) -> Options {
        let on_progress = self.run.on_progress.clone().map(|callback| {
            Arc::new(move |_| callback(Progress { phase: Phase::Transport, fraction })) as crate::options::OnProgress
        });
        Options { on_progress, ..self.run.clone() }
    }

    fn report(&self, fraction: f64) -> Result<(), Error> {
        self.run.report(Phase::Transport, fraction)
    }
}

/// Returns a number with nine digits, which are enough to see by how much a sum differs.
fn shown(number: f64) -> String {
    format!("{:?}", format!("{number:.8e}").parse().unwrap_or(number))
}

/// Returns weights less the least of them.
fn from_zero(mut weights: Vec<f64>) -> Vec<f64> {
    let least = weights.iter().copied().fold(f64::INFINITY, f64::min);
    weights.iter_mut().for_each(|w| *w -= least);
    weights
}

/// Returns the error for cells that are no nearer to their masses.
fn stopped(error: f64) -> Error {
    Error::TransportStopped { error: format!("{error:.1e}") }
}
