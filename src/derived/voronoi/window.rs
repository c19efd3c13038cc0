//! The convex shapes that cells are clipped to.

use super::{Clip, VoronoiShapes, frame::Frame};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, vector},
    input::points::Points,
};

/// What a diagram is clipped to, in the coordinates of its frame.
#[derive(Debug, Clone)]
pub(super) enum Window<const D: usize> {
    /// All of the plane or of space.
    All,
    /// The convex hull of the points.
    Hull,
    Convex(Convex<D>),
}

/// A convex polygon or polyhedron: what of a box is on the inner sides of lines or planes.
#[derive(Debug, Clone)]
pub(in super::super) struct Convex<const D: usize> {
    pub(super) bounds: [[f64; D]; 2],
    /// The outer normals, and their products with the points of the lines or planes.
    pub(super) planes: Vec<([f64; D], f64)>,
}

impl<const D: usize> Window<D> {
    /// Creates what a diagram is clipped to.
    pub(super) fn new<const N: usize>(clip: Clip<'_, D>, frame: Option<Frame<D>>) -> Result<Self, Error>
    where
        Euclidean: VoronoiShapes<D, N>,
    {
        let inner = |p: [f64; D]| frame.map_or(p, |frame| frame.inner(p));
        match clip {
            Clip::None => Ok(Window::All),
            Clip::Hull => Ok(Window::Hull),
            Clip::Box(bounds) => {
                check_box(bounds, |_| false)?;
                Ok(Window::Convex(Convex { bounds: bounds.map(inner), planes: Vec::new() }))
            }
            Clip::Convex(corners) => {
                let inner: Vec<[f64; D]> = corners.iter().map(|&p| inner(p)).collect();
                let facets = facets(corners)?;
                let planes = facets.iter().map(|facet| Euclidean::plane(&facet.map(|v| inner[v as usize]))).collect();
                let bounds = Points::F64(&inner).bounds().expect("a shape with facets has corners");
                Ok(Window::Convex(Convex { bounds, planes }))
            }
        }
    }
}

impl<const D: usize> Convex<D> {
    /// Creates the shape of a clip in the coordinates of the points, unless it is the hull or nothing. Returns a point
    /// inside with it.
    pub(in super::super) fn new<const N: usize>(clip: Clip<'_, D>) -> Result<Option<(Self, [f64; D])>, Error>
    where
        Euclidean: VoronoiShapes<D, N>,
    {
        let corners = match clip {
            Clip::Box(ref bounds) => &bounds[..],
            Clip::Convex(corners) => corners,
            _ => return Ok(None),
        };
        let shape = match (clip, Window::new(clip, None)) {
            (_, Ok(Window::Convex(shape))) => shape,
            // A box without an inside, as points in a plane may have.
            (Clip::Box(bounds), _) => Convex { bounds, planes: Vec::new() },
            (_, result) => return result.map(|_| None),
        };
        let middle = corners.iter().fold([0.0; D], |sum, &p| vector::plus(sum, p));
        Ok(Some((shape, vector::times(1.0 / corners.len() as f64, middle))))
    }

    /// Returns whether a point is inside.
    pub(in super::super) fn contains(&self, p: [f64; D]) -> bool {
        let [low, high] = self.bounds;
        (0..D).all(|axis| low[axis] <= p[axis] && p[axis] <= high[axis])
            && self.planes.iter().all(|&(normal, offset)| vector::dot(normal, p) <= offset)
    }

    /// Returns how many times a vector can be added to a point inside before it is outside.
    pub(in super::super) fn reach(&self, from: [f64; D], along: [f64; D]) -> f64 {
        let [low, high] = self.bounds;
        let sides = (0..D).filter(|&axis| low[axis] < high[axis]).map(|axis| {
            let end = if along[axis] < 0.0 { low[axis] } else { high[axis] };
            (end - from[axis]) / along[axis]
        });
        let planes = self.planes.iter().map(|&(normal, offset)| {
            let speed = vector::dot(normal, along);
            if speed > 0.0 { (offset - vector::dot(normal, from)) / speed } else { f64::INFINITY }
        });
        sides.chain(planes).fold(f64::INFINITY, f64::min)
    }
}

/// Checks that a box has an extent along each axis that `is_flat` does not excuse.
pub(in super::super) fn check_box<const D: usize>(
    [low, high]: [[f64; D]; 2],
    is_flat: impl Fn(usize) -> bool,
) -> Result<(), Error> {
    let has_extent = |axis: usize| low[axis] < high[axis] && (high[axis] - low[axis]).is_finite();
    match (0..D).find(|&axis| !has_extent(axis) && !is_flat(axis)) {
        Some(axis) => Err(Error::EmptyBox { axis: ['x', 'y', 'z'][axis] }),
        None => Ok(()),
    }
}

/// Returns a facet of the convex hull of corners for each line or plane of it.
fn facets<const D: usize, const N: usize>(corners: &[[f64; D]]) -> Result<Vec<[u32; D]>, Error>
where
    Euclidean: VoronoiShapes<D, N>,
{
    let wrong = |range| Err(Error::BadOption { option: "the corners that cells are clipped to", range });
    if Points::F64(corners).validate().is_err() {
        return wrong("finite");
    }
    let hull = Euclidean::hull(corners)?;
    if hull.is_empty() {
        return wrong(if D == 2 {
            "those of a polygon with an inside"
        } else {
            "those of a polyhedron with an inside"
        });
    }
    let at = |v: u32| corners[v as usize];
    let is_on = |p: [f64; D]| hull.iter().flatten().any(|&v| at(v) == p);
    if !corners.iter().all(|&p| is_on(p)) {
        return wrong("on their convex hull: cells are clipped to convex shapes");
    }
    let mut facets: Vec<[u32; D]> = Vec::new();
    for facet in hull {
        let is_in_plane = |other: &[u32; D]| facet.iter().all(|&v| Euclidean::side(&other.map(at), at(v)) == 0);
        if !facets.iter().any(is_in_plane) {
            facets.push(facet);
        }
    }
    Ok(facets)
}
