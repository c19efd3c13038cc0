"""Delaunay triangulations."""

from __future__ import annotations

import json
import threading
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from gdel import _gdel
from gdel._balls import BallComplex
from gdel._points import (
    Backend,
    Floats,
    Indices,
    Points,
    Progress,
    as_aligned,
    as_floats,
    as_number,
    as_points,
    as_progress,
    as_queries,
    as_weights,
)

if TYPE_CHECKING:
    import matplotlib.tri
    import meshio
    import pyvista


@dataclass(frozen=True)
class VerifyReport:
    """What an exact check of a triangulation has found. It is true if everything passed."""

    passed: bool
    failures: list[tuple[str, str, int]]
    """The name of each check that failed, its first defect, and how many there are."""
    vertices: int
    dimension: int

    def __bool__(self) -> bool:
        """Return whether everything passed."""
        return self.passed


class State:
    """A mesh with its points, neither of which changes; what is derived from them is kept."""

    def __init__(self, mesh: _gdel.Mesh, points: Points, weight: float = 0.0) -> None:
        """Keep a mesh with its points, and their weight if all have the same, which the mesh does not keep."""
        self.mesh = mesh
        self.points = points
        self.weight = weight

    @cached_property
    def simplices(self) -> Indices:
        """The vertices of each simplex."""
        return self.mesh.simplices

    @cached_property
    def neighbors(self) -> Indices:
        """The neighbours of each simplex."""
        return self.mesh.neighbors

    @cached_property
    def hull(self) -> Indices:
        """The facets of the hull."""
        return self.mesh.hull

    @cached_property
    def vertex_to_simplex(self) -> Indices:
        """A simplex of each point."""
        found = self.mesh.vertex_simplex()
        duplicates = np.flatnonzero(self.mesh.duplicate_of >= 0)
        found[duplicates] = found[self.mesh.duplicate_of[duplicates]]
        return found

    @cached_property
    def coplanar(self) -> Indices:
        """The duplicates, each with a simplex and a vertex."""
        duplicate_of = self.mesh.duplicate_of
        points = np.flatnonzero((duplicate_of >= 0) & (duplicate_of != np.arange(len(duplicate_of))))
        vertices = duplicate_of[points]
        return np.column_stack([points, self.vertex_to_simplex[vertices], vertices]).astype(np.int32)

    @cached_property
    def vertex_neighbor_vertices(self) -> tuple[npt.NDArray[np.intp], Indices]:
        """The neighbours of each vertex."""
        return self.mesh.vertex_neighbors()

    @cached_property
    def edges(self) -> Indices:
        """The edges."""
        return self.mesh.edges()

    @cached_property
    def shapes(self) -> dict[str, Floats]:
        """Circumcentres, circumradii, volumes and ratios of radii."""
        return self.mesh.shapes(self.points)

    @cached_property
    def transform(self) -> Floats:
        """The affine transforms to barycentric coordinates."""
        corners = self.points.astype(np.float64, copy=False)[self.simplices]
        last = corners[:, -1]
        transform = np.empty((len(corners), self.points.shape[1] + 1, self.points.shape[1]))
        edges = (corners[:, :-1] - last[:, None]).transpose(0, 2, 1)
        flat = np.linalg.det(edges) == 0
        edges[flat] = np.eye(edges.shape[1])
        inverse = np.linalg.inv(edges)
        # As SciPy does where rounding leaves nothing of the inverse.
        sizes = np.abs(edges).sum(axis=1).max(axis=1) * np.abs(inverse).sum(axis=1).max(axis=1)
        flat |= ~(sizes * (1000 * np.finfo(float).eps) < 1)
        transform[:, :-1] = inverse
        transform[:, -1] = last
        transform[flat] = np.nan
        return transform

    @cached_property
    def equations(self) -> Floats:
        """The hyperplanes of the lifted simplices."""
        points = self.points.astype(np.float64, copy=False)
        heights = (points**2).sum(axis=1)
        if len(self.mesh.weights):
            heights -= self.mesh.weights
        lifted = np.column_stack([points, heights])[self.simplices]
        edges = lifted[:, 1:] - lifted[:, :1]
        normals = np.ones((len(lifted), lifted.shape[2]))
        if len(lifted):
            # The gradient of the paraboloid's chord, with −1 for the lifted coordinate: the lower side.
            normals[:, :-1] = np.linalg.solve(edges[:, :, :-1], edges[:, :, -1:])[..., 0]
        normals[:, -1] = -1
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        return np.column_stack([normals, -(normals * lifted[:, 0]).sum(axis=1)])

    @cached_property
    def stats(self) -> dict[str, Any]:
        """What the run says about itself."""
        stats: dict[str, Any] = json.loads(self.mesh.stats())
        return stats


class Delaunay:
    """The Delaunay triangulation of points in 2D or 3D, in the shape of `scipy.spatial.Delaunay`.

    Parameters
    ----------
    points
        One row per point, with 2 or 3 columns. C-contiguous arrays of `float32` or `float64` are used without a copy
        and must not be changed afterwards; pass the changed points to `update`.
    furthest_site, incremental, qhull_options
        Accepted for SciPy's sake. There is no furthest-site diagram; points can always be added; nothing is joggled.
    weights
        One number per point: the triangulation is then the regular one, the dual of the power diagram, which `Voronoi`
        makes of it. A point of weight *w* counts as a ball of radius √*w*; only differences count. Points can be
        `hidden`. The CPU computes it. `ball_complex` finds where the balls meet, for which equal weights count as well.
    radii
        One radius per point instead of `weights`, which are the squares.
    backend
        ``"auto"`` takes the GPU where it is faster, ``"cpu"`` and ``"gpu"`` force one.
    threads
        The number of threads of the CPU; by default all.
    progress
        A callable of the phase and the share that is done, or `True` for tqdm. It may raise to stop the run.

    Points on a line, in a plane or no points raise nothing: `nsimplex` is then 0, and `dimension` says why.
    Equal points share one vertex, that of the first of them; `coplanar` lists the others.

    >>> tri = Delaunay([(0, 0), (4, 0), (0, 4), (4, 4), (2, 1)])
    >>> tri.simplices.shape, tri.convex_hull.shape
    ((4, 3), (4, 2))
    >>> bool(tri.verify())
    True
    """

    furthest_site = False
    paraboloid_scale = 1.0
    paraboloid_shift = 0.0

    def __init__(
        self,
        points: npt.ArrayLike,
        furthest_site: bool = False,
        incremental: bool = False,
        qhull_options: str | None = None,
        *,
        weights: npt.ArrayLike | None = None,
        radii: npt.ArrayLike | None = None,
        backend: Backend = "auto",
        threads: int | None = None,
        progress: Progress = None,
    ) -> None:
        """Triangulate points."""
        if furthest_site:
            raise ValueError("there is no furthest-site triangulation: use scipy.spatial.Delaunay")
        array = as_points(points)
        numbers = as_weights(weights, radii)
        mesh = _gdel.triangulate(array, numbers, backend, threads, as_progress(progress))
        self._take(State(mesh, array, _first(numbers)), backend, threads)

    def _take(self, state: State, backend: Backend, threads: int | None) -> None:
        """Take a mesh that was made with these options."""
        self._backend: Backend = backend
        self._threads = threads
        self._closed = False
        self._lock = threading.Lock()
        self._state = state

    def __repr__(self) -> str:
        """Return a short description."""
        state = self._state
        return f"<gdel.Delaunay: {len(state.points)} points, {len(state.simplices)} simplices, {self.ndim}D>"

    def __getstate__(self) -> dict[str, Any]:
        """Return what is pickled: all arrays, so that nothing is triangulated again."""
        arrays, dimension = self._state.mesh.state()
        return {
            "points": self._state.points,
            "weight": self._state.weight,
            "arrays": arrays,
            "dimension": dimension,
            "options": (self._backend, self._threads, self._closed),
        }

    def __setstate__(self, pickled: dict[str, Any]) -> None:
        """Take what was pickled."""
        self._backend, self._threads, self._closed = pickled["options"]
        self._lock = threading.Lock()
        mesh = _gdel.restore(tuple(map(as_aligned, pickled["arrays"])), pickled["dimension"], self._threads)
        self._state = State(mesh, as_aligned(pickled["points"]), pickled["weight"])

    # What SciPy has.

    @property
    def points(self) -> Points:
        """The points, one per row."""
        return self._state.points

    @property
    def simplices(self) -> Indices:
        """The vertices of each simplex, positively oriented: counter-clockwise in 2D. The array is read-only."""
        return self._state.simplices

    @property
    def neighbors(self) -> Indices:
        """The simplices opposite the vertices of each simplex; −1 outside. The array is read-only in 3D."""
        return self._state.neighbors

    @property
    def convex_hull(self) -> Indices:
        """The facets of the convex hull, oriented outwards."""
        return self._state.hull

    @property
    def coplanar(self) -> Indices:
        """The points that are no vertices, since others are equal: rows of (point, simplex, vertex)."""
        return self._state.coplanar

    @property
    def vertex_to_simplex(self) -> Indices:
        """A simplex of each point; −1 if there is none."""
        return self._state.vertex_to_simplex

    @property
    def vertex_neighbor_vertices(self) -> tuple[npt.NDArray[np.intp], Indices]:
        """The neighbours of vertex *k*: ``indices[indptr[k]:indptr[k + 1]]`` of ``(indptr, indices)``."""
        return self._state.vertex_neighbor_vertices

    @property
    def transform(self) -> Floats:
        """The affine transforms to barycentric coordinates, as SciPy has them."""
        return self._state.transform

    @property
    def equations(self) -> Floats:
        """The hyperplane of each simplex lifted to the paraboloid: the normal, which points down, and the offset."""
        return self._state.equations

    @property
    def npoints(self) -> int:
        """The number of points."""
        return len(self._state.points)

    @property
    def ndim(self) -> int:
        """The number of coordinates: 2 or 3."""
        return int(self._state.points.shape[1])

    @property
    def nsimplex(self) -> int:
        """The number of simplices."""
        return len(self._state.simplices)

    @property
    def min_bound(self) -> Points:
        """The least coordinate along each axis."""
        bound: Points = self._state.points.min(axis=0)
        return bound

    @property
    def max_bound(self) -> Points:
        """The largest coordinate along each axis."""
        bound: Points = self._state.points.max(axis=0)
        return bound

    def find_simplex(self, xi: npt.ArrayLike, bruteforce: bool = False, tol: float | None = None) -> Indices:
        """Return the simplex that contains each point of `xi`, whose last axis has the coordinates; −1 outside.

        Signs are exact, so that `bruteforce` and `tol` are ignored. Points outside the hull by no more than rounding
        count as inside.
        """
        queries, shape = as_queries(xi, self.ndim)
        return self._state.mesh.locate(self._state.points, queries).reshape(shape)

    def lift_points(self, x: npt.ArrayLike) -> Floats:
        """Return points with the sum of their squares as one more coordinate."""
        points = as_floats(x, "x").astype(np.float64, copy=False)
        return np.concatenate([points, (points**2).sum(axis=-1, keepdims=True)], axis=-1)

    def plane_distance(self, xi: npt.ArrayLike) -> Floats:
        """Return the distance of each lifted point from each simplex' hyperplane."""
        lifted = self.lift_points(xi)
        distances: Floats = lifted @ self.equations[:, :-1].T + self.equations[:, -1]
        return distances

    def add_points(self, points: npt.ArrayLike, restart: bool = False) -> None:
        """Insert points, as `insert` does; SciPy's name for it."""
        if self._closed:
            raise RuntimeError("the triangulation was closed")
        self.insert(points)

    def close(self) -> None:
        """Allow no more `add_points`."""
        self._closed = True

    # What SciPy does not have.

    @property
    def dimension(self) -> int:
        """The affine dimension of the points: 2 for points of 3D in a plane, 0 for one point or none."""
        return self._state.mesh.dimension

    @property
    def duplicate_of(self) -> Indices:
        """For each point the one that stands for it; −1 for vertices; for removed points, these themselves."""
        return self._state.mesh.duplicate_of

    @property
    def hidden(self) -> Indices:
        """The points that are no vertices because of their weights, in ascending order, without duplicates."""
        return self._state.mesh.hidden

    @property
    def weights(self) -> Floats | None:
        """The weights of the points; `None` for a Delaunay triangulation, which equal weights give as well.

        Equal ones are remembered for `ball_complex`.
        """
        weights = self._state.mesh.weights
        return weights if len(weights) else None

    @property
    def edges(self) -> Indices:
        """The edges, each once."""
        return self._state.edges

    @property
    def volumes(self) -> Floats:
        """The volume of each simplex, the area in 2D."""
        return self._state.shapes["volumes"]

    @property
    def circumcenters(self) -> Floats:
        """The centre of the circumsphere of each simplex."""
        return self._state.shapes["circumcenters"]

    @property
    def circumradii(self) -> Floats:
        """The radius of the circumsphere of each simplex."""
        return self._state.shapes["circumradii"]

    @property
    def radius_ratios(self) -> Floats:
        """How well shaped each simplex is: from 0 for a flat one to 1 for a regular one."""
        return self._state.shapes["radius_ratios"]

    @property
    def stats(self) -> dict[str, Any]:
        """What the run says about itself: the backend and why it was taken, seconds per phase, counts."""
        return self._state.stats

    @property
    def backend(self) -> str:
        """What has computed the triangulation: ``"cpu"`` or ``"gpu"``."""
        return str(self._state.stats["backend"])

    @property
    def threads(self) -> int | None:
        """The number of threads that was asked for."""
        return self._threads

    def nearest(self, xi: npt.ArrayLike, k: int = 1) -> Indices:
        """Return the vertex nearest to each point of `xi`, by exact comparisons, the lowest of several.

        With `k` above 1 there is one more axis, with −1 where there are fewer vertices. Without simplices there are no
        vertices.
        """
        queries, shape = as_queries(xi, self.ndim)
        state = self._state
        if k < 1:
            raise ValueError("k must be at least 1")
        if k == 1:
            return state.mesh.nearest(state.points, queries).reshape(shape)
        indptr, indices = state.mesh.nearest_k(state.points, queries, k)
        found = np.full((len(queries), k), -1, np.int32)
        counts = np.diff(indptr)
        found[np.arange(k) < counts[:, None]] = indices
        return found.reshape(*shape, k)

    def ball_complex(self, alpha: float = 0.0) -> BallComplex:
        """Returns the alpha complex of balls around the points: the atoms of a molecule, the grains of a packing.

        The balls are those of the `weights` or `radii` that the triangulation was made with, also if all are equal;
        with neither, all weights are 0. A simplex, or a face of one, is part of the complex if the balls of its
        vertices meet where the power cells of the vertices do: an edge where two balls meet, a triangle where three do,
        a tetrahedron where four do. So the complex has the components, the tunnels and the voids of the union of the
        balls. Hidden points, duplicates and removed points are no part of it. What is part of it is decided exactly,
        also where balls touch; but radii are squared, which rounds.

        Points in a plane of 3D, or on a line, have no simplices, but the triangles or edges where their balls meet.
        Without weights, the solid is that of `alpha_shape`, but for exactly this alpha, which there counts up to
        rounding.

        Like alpha shapes, it is found without a report of progress, and Ctrl-C is noticed when it is done; other
        threads of Python go on. See Edelsbrunner, *Weighted alpha shapes*, 1992, and *The union of balls and its dual
        shape*, 1995.

        Parameters
        ----------
        alpha
            A number that is not negative, in the unit of the coordinates. Its square is added to the weight of each
            point, which makes the balls larger. At 0 they are what they are; at infinity, all simplices are part.

        Raises
        ------
        TypeError
            If `alpha` is no number.
        ValueError
            If `alpha` is negative or NaN; if the triangulation is a constrained one.

        Two disks that touch, and one that meets neither:

        >>> found = Delaunay([(0, 0), (3, 0), (0, 9)], radii=[2, 1, 1]).ball_complex()
        >>> found.edges.tolist(), found.singular_vertices.tolist()
        ([[0, 1]], [2])
        >>> found.components, found.component_of.tolist()
        (2, [0, 0, 1])
        """
        state = self._state
        return BallComplex(self, **state.mesh.ball_complex(state.points, as_number(alpha, "alpha"), state.weight))

    def update(self, points: npt.ArrayLike, *, progress: Progress = None) -> None:
        """Make this the triangulation of the same points after they have moved. They keep their weights."""
        array = as_points(points)
        with self._lock:
            mesh = self._state.mesh.update(array, self._backend, as_progress(progress))
            self._state = State(mesh, array, self._state.weight)

    def update_weights(
        self,
        weights: npt.ArrayLike | None = None,
        *,
        radii: npt.ArrayLike | None = None,
        progress: Progress = None,
    ) -> None:
        """Make this the regular triangulation of the same points with other weights, or radii."""
        numbers = as_weights(weights, radii)
        if numbers is None:
            raise TypeError("there are neither weights nor radii")
        with self._lock:
            state = self._state
            mesh = state.mesh.update_weights(state.points, numbers, self._backend, as_progress(progress))
            self._state = State(mesh, state.points, _first(numbers))

    def insert(self, points: npt.ArrayLike, *, progress: Progress = None) -> npt.NDArray[np.intp]:
        """Insert points and return their indices. If all points have the same weight, so have these."""
        array = as_points(points)
        with self._lock:
            state = self._state
            old = state.points
            new = np.require(array, old.dtype, ["C"])
            if new.dtype != array.dtype and not np.array_equal(new, array, equal_nan=True):
                # Double precision that single precision cannot hold.
                old, new = old.astype(np.float64), array
            mesh, together = state.mesh.insert(old, new, self._backend, as_progress(progress))
            self._state = State(mesh, together, state.weight)
            return np.arange(len(old), len(together))

    def remove(self, indices: npt.ArrayLike, *, progress: Progress = None) -> None:
        """Remove points. The others keep their indices; `points` keeps the rows, which are no vertices any more."""
        listed = np.atleast_1d(np.asarray(indices))
        if listed.size == 0:
            return
        if listed.dtype.kind not in "iu":
            raise TypeError(f"indices must be whole numbers, not {listed.dtype}")
        with self._lock:
            state = self._state
            if listed.min() < 0 or listed.max() >= len(state.points):
                raise IndexError(f"there are {len(state.points)} points: indices must be below that, and not negative")
            mesh = state.mesh.remove(state.points, listed.ravel().tolist(), self._backend, as_progress(progress))
            self._state = State(mesh, state.points, state.weight)

    def verify(self) -> VerifyReport:
        """Prove that this is the Delaunay triangulation of its points, exactly, whoever has computed it.

        With weights, that it is the regular one, and that each hidden point is none of its vertices.
        """
        return VerifyReport(**self._state.mesh.verify(self._state.points))

    # Bridges.

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """Return the mesh for PyVista."""
        from gdel._bridges import to_pyvista

        return to_pyvista(self.points, self.simplices)

    def to_meshio(self) -> meshio.Mesh:
        """Return the mesh for meshio."""
        from gdel._bridges import to_meshio

        return to_meshio(self.points, self.simplices)

    def to_matplotlib(self) -> matplotlib.tri.Triangulation:
        """Return the 2D mesh for matplotlib."""
        from gdel._bridges import to_matplotlib

        return to_matplotlib(self.points, self.simplices)


def _first(weights: Floats | None) -> float:
    """Return the first of weights, which are all alike if a mesh does not keep them."""
    return 0.0 if weights is None or len(weights) == 0 else float(weights[0])


def tsearch(tri: Delaunay, xi: npt.ArrayLike) -> Indices:
    """Return the simplex that contains each point, as `Delaunay.find_simplex` does."""
    return tri.find_simplex(xi)
