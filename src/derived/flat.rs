//! Points in a plane, on a line or in one place, in their own dimension.
//!
//! Which points have an edge is exact. On a line it is the order of a coordinate. A plane that is perpendicular to an
//! axis is projected along it, which changes no distance. In any other plane the edges are those of the tetrahedra of
//! the points and one more point beside the plane: their spheres cut the circles of the triangles out of the plane. So
//! do the spheres of weighted points. Projected along an axis, such a plane keeps its lines and what is on which side
//! of them; what is measured in it needs coordinates that are rounded.

use super::complex::Complex;
use crate::{
    cpu::{self, Incremental, MeshOf},
    d2::Mesh2,
    d3::Mesh3,
    dimension::Dimension,
    error::Error,
    geometry::{below_on_line, facet, vector},
    index::NONE,
    input::points::Points,
    mesh::{Csr, MeshInfo},
    options::Options,
};
use rustc_hash::FxHashMap;

/// The vertices of a mesh without simplices, as those of a triangulation in their own dimension.
#[derive(Debug)]
pub struct Flat {
    /// The vertices that each point has an edge to.
    pub(super) neighbors: Csr,
    pub(super) shape: Shape,
    /// The hidden points of weighted ones. The lists of vertices have those of a plane, too.
    pub(super) hidden: Vec<u32>,
}

/// What the vertices are in.
#[derive(Debug)]
pub(super) enum Shape {
    /// The vertices along their line; one if all points are equal.
    Line {
        vertices: Vec<u32>,
        axis: usize,
    },
    Plane(Box<Plane>),
}

/// The vertices of a plane.
#[derive(Debug)]
pub(super) struct Plane {
    pub(super) frame: Frame,
    /// The vertices, by their numbers in `points`, `shadows` and `mesh`.
    pub(super) vertices: Vec<u32>,
    /// Their coordinates in the plane.
    pub(super) points: Vec<[f64; 2]>,
    /// A frame that changes distances and angles, but rounds nothing, and their coordinates there.
    pub(super) shadow: Frame,
    pub(super) shadows: Vec<[f64; 2]>,
    /// The Delaunay triangles, exactly. They are counter-clockwise among the shadows.
    pub(super) mesh: Mesh2,
}

/// Coordinates in a plane.
#[derive(Debug, Clone, Copy)]
pub(super) enum Frame {
    /// Perpendicular to an axis, at this coordinate: the two axes after it in turn.
    Aligned { axis: usize, at: f64 },
    /// The origin and two orthonormal vectors.
    Slanted { origin: [f64; 3], axes: [[f64; 3]; 2] },
}

impl Frame {
    /// Returns the coordinates in the plane of the place that is nearest to a point.
    pub(super) fn project(&self, p: [f64; 3]) -> [f64; 2] {
        match self {
            Frame::Aligned { axis, .. } => [p[(axis + 1) % 3], p[(axis + 2) % 3]],
            Frame::Slanted { origin, axes } => axes.map(|axis| vector::dot(vector::minus(p, *origin), axis)),
        }
    }

    /// Returns the unit vectors along which the coordinates are measured.
    pub(super) fn axes(&self) -> [[f64; 3]; 2] {
        match *self {
            Frame::Aligned { axis, .. } => [1, 2].map(|next| {
                let mut unit = [0.0; 3];
                unit[(axis + next) % 3] = 1.0;
                unit
            }),
            Frame::Slanted { axes, .. } => axes,
        }
    }

    /// Returns the point with these coordinates in the plane.
    pub(super) fn lift(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        match *self {
            Frame::Aligned { axis, at } => {
                let mut p = [at; 3];
                (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (x, y);
                p
            }
            Frame::Slanted { origin, axes: [u, v] } => {
                vector::plus(origin, vector::plus(vector::times(x, u), vector::times(y, v)))
            }
        }
    }
}

/// Returns a point with three coordinates.
pub(super) fn in_space<const D: usize>(p: [f64; D]) -> [f64; 3] {
    std::array::from_fn(|axis| p.get(axis).copied().unwrap_or(0.0))
}

impl Flat {
    /// Triangulates the vertices of a mesh without simplices in their own dimension; `None` if there are
    /// simplices, or no points.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfMemory`].
    pub(super) fn new<const D: usize, const N: usize>(complex: &Complex<'_, D, N>) -> Result<Option<Self>, Error> {
        if !complex.simplices.is_empty() {
            return Ok(None);
        }
        let vertices: Vec<u32> = complex.vertices().collect();
        let points: Vec<[f64; 3]> = vertices.iter().map(|&v| in_space(complex.point(v))).collect();
        let Some(&first) = points.first() else { return Ok(None) };
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let dimension = Dimension::<3>::spanning_first(Points::F64(&points), &mut order);
        if usize::from(dimension) >= D {
            return Ok(None);
        }
        let weight = |v: u32| complex.weight(v);
        let (mut edges, mut hidden) = (Vec::new(), Vec::new());
        let shape = if dimension < 2 {
            // Distinct points of a line differ in each coordinate in which any two of them do.
            let last = points[points.len() - 1];
            let axis = (0..3).find(|&axis| first[axis] != last[axis]).unwrap_or(0);
            order.sort_unstable_by(|&i, &j| points[i as usize][axis].total_cmp(&points[j as usize][axis]));
            let mut vertices: Vec<u32> = order.iter().map(|&i| vertices[i as usize]).collect();
            if !complex.weights.is_empty() {
                (vertices, hidden) = lower_chain(&vertices, |v| (in_space(complex.point(v)), weight(v)), axis);
            }
            edges.extend(vertices.windows(2).map(|pair| [pair[0], pair[1]]));
            Shape::Line { vertices, axis }
        } else {
            let weights =
                if complex.weights.is_empty() { Vec::new() } else { vertices.iter().copied().map(weight).collect() };
            let plane = Plane::new(vertices, &points, &weights, &order)?;
            hidden.extend(plane.mesh.hidden.iter().map(|&i| plane.vertices[i as usize]));
            edges.extend(plane.triangles().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]));
            Shape::Plane(Box::new(plane))
        };
        edges = edges.iter().flat_map(|&[v, w]| [[v, w], [w, v]]).collect();
        edges.sort_unstable();
        edges.dedup();
        let mut neighbors = Csr::default();
        let mut rest = edges.as_slice();
        for v in 0..complex.points().len() as u32 {
            let (own, others) = rest.split_at(rest.partition_point(|&[from, _]| from == v));
            neighbors.push(own.iter().map(|&[_, to]| to));
            rest = others;
        }
        Ok(Some(Flat { neighbors, shape, hidden }))
    }

    /// Returns a vertex to start from on the way to the one nearest to a point.
    pub(super) fn start<const D: usize, const N: usize>(&self, complex: &Complex<'_, D, N>, query: [f64; D]) -> u32 {
        match &self.shape {
            Shape::Line { vertices, axis } => {
                let after = vertices.partition_point(|&v| in_space(complex.point(v))[*axis] < in_space(query)[*axis]);
                vertices[after.min(vertices.len() - 1)]
            }
            Shape::Plane(plane) => plane.triangles().next().map_or(plane.vertices[0], |[v, ..]| v),
        }
    }

    /// Returns the edges, each once, the lower vertex first.
    pub(super) fn edges(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let vertices = 0..self.neighbors.len() as u32;
        vertices.flat_map(|v| self.neighbors.of(v).iter().filter(move |&&w| v < w).map(move |&w| [v, w]))
    }
}

impl Plane {
    /// Triangulates points of a plane, of which the first three in `order` are not on a line.
    fn new(vertices: Vec<u32>, points: &[[f64; 3]], weights: &[f64], order: &[u32]) -> Result<Self, Error> {
        let first = points[0];
        let is_aligned = |&axis: &usize| points.iter().all(|p| p[axis] == first[axis]);
        let aligned = (0..3).find(is_aligned);
        let (frame, axis) = match aligned {
            Some(axis) => (Frame::Aligned { axis, at: first[axis] }, axis),
            None => slanted(points, order),
        };
        let shadow = Frame::Aligned { axis, at: first[axis] };
        let project = |frame: Frame| points.iter().map(|&p| frame.project(p)).collect::<Vec<_>>();
        let (in_plane, shadows) = (project(frame), project(shadow));
        let mesh = match aligned {
            Some(_) => triangulate(&shadows, weights)?,
            None => mesh_of(base_of_cone(points, weights, axis)?, points.len(), weights),
        };
        Ok(Plane { frame, vertices, points: in_plane, shadow, shadows, mesh })
    }

    /// Returns the triangles by their vertices.
    pub(super) fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.mesh.triangles.iter().map(|triangle| triangle.map(|v| self.vertices[v as usize]))
    }
}

/// Returns the Delaunay triangulation of points, or the regular one if they have weights.
///
/// # Errors
///
/// [`Error::OutOfMemory`].
pub(super) fn triangulate<const D: usize>(points: &[[f64; D]], weights: &[f64]) -> Result<MeshOf<D>, Error>
where
    Dimension<D>: Incremental<D>,
{
    let options = Options::default();
    match weights {
        [] => cpu::delaunay(Points::F64(points), &options),
        _ => cpu::regular(Points::F64(points), weights, &options),
    }
}

/// Returns those of some weighted points of a line, given in the order of their coordinate along an axis, that are
/// vertices of the regular triangulation, and the hidden ones.
fn lower_chain(points: &[u32], at: impl Fn(u32) -> ([f64; 3], f64), axis: usize) -> (Vec<u32>, Vec<u32>) {
    let (mut chain, mut hidden) = (Vec::new(), Vec::new());
    let is_hidden = |[a, b, c]: [u32; 3]| {
        let all = [a, b, c].map(&at);
        match below_on_line(all.map(|(p, _)| p), all.map(|(_, weight)| weight), axis) {
            // Points of a lower index are raised more.
            0 => b < a.min(c),
            sign => sign < 0,
        }
    };
    for &c in points {
        while let &[.., a, b] = &chain[..]
            && is_hidden([a, b, c])
        {
            chain.pop();
            hidden.push(b);
        }
        chain.push(c);
    }
    (chain, hidden)
}

/// Returns the Delaunay triangles of points of a plane that is no less steep along another axis than along
/// this one. They are counter-clockwise as seen from where the axis points.
fn base_of_cone(points: &[[f64; 3]], weights: &[f64], axis: usize) -> Result<Vec<[u32; 3]>, Error> {
    let first = points[0];
    let reach = points.iter().map(|p| (p[axis] - first[axis]).abs()).fold(0.0, f64::max).min(f64::MAX);
    let is_below = first[axis] > 0.0;
    let mut apex = first;
    apex[axis] += if is_below { -reach } else { reach };
    let with_apex: Vec<[f64; 3]> = points.iter().copied().chain([apex]).collect();
    // Which weight the apex has does not matter: it is a vertex, and not of the base.
    let with_its: Vec<f64> = weights.iter().chain(weights.first()).copied().collect();
    let cone: Mesh3 = triangulate(&with_apex, &with_its)?;
    let top = points.len() as u32;
    // The facets opposite the apex are counter-clockwise as seen from the other side.
    let base = |tetrahedron: &[u32; 4]| {
        let k = tetrahedron.iter().position(|&v| v == top)?;
        let [a, b, c] = facet::<_, 3, 4>(tetrahedron, k);
        Some(if is_below { [a, b, c] } else { [a, c, b] })
    };
    Ok(cone.tetrahedra.iter().filter_map(base).collect())
}

/// Returns triangles of so many vertices with their neighbours.
fn mesh_of(triangles: Vec<[u32; 3]>, points: usize, weights: &[f64]) -> Mesh2 {
    let edges = triangles
        .iter()
        .enumerate()
        .flat_map(|(t, &[a, b, c])| [[a, b], [b, c], [c, a]].into_iter().zip(3 * t as u32..));
    let halfedge_of: FxHashMap<[u32; 2], u32> = edges.collect();
    let across = |from, to| halfedge_of.get(&[to, from]).copied().unwrap_or(NONE);
    let halfedges = triangles.iter().map(|&[a, b, c]| [across(a, b), across(b, c), across(c, a)]).collect();
    let mut mesh = Mesh2 { triangles, halfedges, dimension: 2, duplicate_of: vec![NONE; points], ..Mesh2::default() };
    if !weights.is_empty() {
        mesh.set_weights(weights);
    }
    mesh
}

/// Returns the frame of a plane that is not perpendicular to an axis, and the axis that is farthest from it,
/// which points to the side from which the frame is counter-clockwise.
fn slanted(points: &[[f64; 3]], order: &[u32]) -> (Frame, usize) {
    let origin = points[order[0] as usize];
    let far = points.iter().flat_map(|p| vector::minus(*p, origin)).fold(0.0f64, |far, x| far.max(x.abs()));
    let scaled = |p: [f64; 3]| vector::minus(p, origin).map(|x| x / far);
    let unit = |u: [f64; 3]| vector::times(1.0 / vector::norm(u), u);
    let farthest = |distance: &dyn Fn([f64; 3]) -> f64| {
        let all = points.iter().map(|&p| scaled(p));
        all.max_by(|&p, &q| distance(p).total_cmp(&distance(q))).unwrap_or([0.0; 3])
    };
    let u = unit(farthest(&vector::norm));
    let other = farthest(&|p| vector::norm(vector::cross(u, p)));
    let normal = unit(vector::cross(u, other));
    let axis = (0..3).max_by(|&i, &j| normal[i].abs().total_cmp(&normal[j].abs())).unwrap_or(0);
    let v = vector::times(normal[axis].signum(), vector::cross(normal, u));
    (Frame::Slanted { origin, axes: [u, v] }, axis)
}
