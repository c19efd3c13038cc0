//! `--weights` and `--radii`: the weights of points, in a column of their file.

use super::{dimension::read, failure::Failure, progress::Progress};
use clap::Args;
use gdel::internals::cpu::weights_of_radii;
use gdel_io::{PointCloud, files::Input};

/// Arguments of the commands that take weights.
#[derive(Args)]
pub(super) struct Weights {
    /// Compute the regular triangulation of points with weights: the column of the input that holds these, by its name
    /// or its number, counted from 1. In text and CSV, the first line has the names; in .ply the properties of vertices
    /// are columns, in .node those of each line, named by `triangulate`, in .npz arrays, and in .vtu the data of points
    #[arg(long, value_name = "COLUMN", conflicts_with = "radii")]
    weights: Option<String>,
    /// The same with the squares of a column of radii for weights
    #[arg(long, value_name = "COLUMN")]
    radii: Option<String>,
}

impl Weights {
    /// Returns whether there are to be weights.
    pub(super) fn are_given(&self) -> bool {
        self.weights.is_some() || self.radii.is_some()
    }

    /// Reads the points, and their weights if there are to be any.
    pub(super) fn read<const D: usize>(&self, input: &Input) -> Result<(PointCloud<D>, Option<Vec<f64>>), Failure> {
        let _progress = Progress::new("reading");
        let Some(column) = self.weights.as_ref().or(self.radii.as_ref()) else {
            return Ok((read::<D>(input)?, None));
        };
        let (cloud, values) = input.read_with_values::<D>(column)?;
        if self.radii.is_none() {
            return Ok((cloud, Some(values)));
        }
        let squares = weights_of_radii(&values);
        let weights = squares.map_err(|source| Failure::Points { path: input.path().into(), source })?;
        Ok((cloud, Some(weights)))
    }
}
