//! `--clip`: what cells are clipped to.

use super::{dimension::read, failure::Failure};
use clap::error::ErrorKind;
use gdel::{Clip, Points};
use gdel_io::files::Input;
use std::path::{Path, PathBuf};

/// The argument.
#[derive(Debug, Clone)]
pub(super) enum ClipShape {
    None,
    Box,
    Hull,
    /// The lowest coordinates, then the highest.
    Bounds(Vec<f64>),
    /// The file with the corners.
    Corners(PathBuf),
}

impl ClipShape {
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let bounds: Option<Vec<f64>> = text.split(',').map(|x| x.trim().parse().ok()).collect();
        Ok(match (text, bounds) {
            ("none", _) => ClipShape::None,
            ("box", _) => ClipShape::Box,
            ("hull", _) => ClipShape::Hull,
            (_, Some(bounds)) => ClipShape::Bounds(bounds),
            _ if Path::new(text).extension().is_some() => ClipShape::Corners(text.into()),
            _ => return Err("`none`, `box`, `hull`, numbers with commas between them or a file is needed".into()),
        })
    }

    /// Reads the corners from their file, if there is one.
    pub(super) fn read<const D: usize>(&self) -> Result<Shape<D>, Failure> {
        Ok(match self {
            ClipShape::None => Shape::None,
            ClipShape::Box => Shape::Box,
            ClipShape::Hull => Shape::Hull,
            ClipShape::Bounds(numbers) if numbers.len() != 2 * D => {
                let what = format!("--clip needs {} numbers, not {}", 2 * D, numbers.len());
                return Err(Failure::Usage(ErrorKind::ValueValidation, what));
            }
            ClipShape::Bounds(numbers) => {
                Shape::Bounds([0, D].map(|first| std::array::from_fn(|axis| numbers[first + axis])))
            }
            ClipShape::Corners(path) => {
                let corners = read::<D>(&Input::new(path, None)?)?;
                Shape::Corners(Points::from(&corners).iter().collect())
            }
        })
    }
}

/// What is known of the shape before there are points.
pub(super) enum Shape<const D: usize> {
    None,
    Box,
    Hull,
    Bounds([[f64; D]; 2]),
    Corners(Vec<[f64; D]>),
}

impl<const D: usize> Shape<D> {
    /// Returns what the cells of points are clipped to.
    pub(super) fn clip(&self, points: Points<'_, D>) -> Clip<'_, D> {
        match self {
            Shape::None => Clip::None,
            Shape::Box => points.bounds().map_or(Clip::None, Clip::Box),
            Shape::Hull => Clip::Hull,
            Shape::Bounds(bounds) => Clip::Box(*bounds),
            Shape::Corners(corners) => Clip::Convex(corners),
        }
    }
}
