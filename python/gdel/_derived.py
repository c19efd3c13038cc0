"""Alpha shapes, surfaces, minimum spanning trees and nearest points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from gdel import _gdel
from gdel._delaunay import Delaunay
from gdel._points import Floats, Indices, as_points

if TYPE_CHECKING:
    import pyvista
    import trimesh


def as_delaunay(points: npt.ArrayLike | Delaunay) -> Delaunay:
    """Return the triangulation of points, unless they are one."""
    return points if isinstance(points, Delaunay) else Delaunay(points)


@dataclass(frozen=True)
class AlphaShape:
    """The solid of the simplices up to a radius, and its surface."""

    tri: Delaunay
    alpha: float
    """The radius."""
    solid: Indices
    """The indices of the simplices that belong to the solid."""
    facets: Indices
    """The facets of its surface, oriented outwards."""
    radii: Floats
    """The circumradius of each simplex of the triangulation."""

    @property
    def volume(self) -> float:
        """The volume of the solid, the area in 2D."""
        return float(self.tri.volumes[self.solid].sum())

    def to_trimesh(self) -> trimesh.Trimesh:
        """Return the surface for trimesh."""
        from gdel._bridges import to_trimesh

        return to_trimesh(self.tri.points, self.facets)

    def to_pyvista(self) -> pyvista.PolyData:
        """Return the surface for PyVista."""
        from gdel._bridges import to_polydata

        return to_polydata(self.tri.points, self.facets)


def alpha_shape(
    points: npt.ArrayLike | Delaunay, alpha: float | Literal["auto"] = "auto", *, components: int = 1
) -> AlphaShape:
    """Return the alpha shape of points, or of those of a triangulation.

    `alpha` is a circumradius; ``"auto"`` is the least one at which all points belong to a solid of at most so many
    components.

    >>> alpha_shape([(0, 0), (1, 0), (0, 1), (1, 1)]).volume
    1.0
    """
    tri = as_delaunay(points)
    if isinstance(alpha, str) and alpha != "auto":
        raise ValueError(f"alpha must be a number or 'auto', not {alpha!r}")
    if components < 1:
        raise ValueError("components must be at least 1")
    state = tri._state
    found = state.mesh.alpha_shape(state.points, None if isinstance(alpha, str) else float(alpha), components)
    return AlphaShape(tri, found["alpha"], found["solid"], found["surface"], found["radii"])


@dataclass(frozen=True)
class Surface:
    """A surface through points, and the solid that it encloses. In 2D, curves and their area."""

    vertices: Floats
    facets: Indices
    """The vertices of each triangle, in 2D of each edge, oriented outwards."""
    sources: Indices
    """The point that each vertex is; −1 for those that `refine` has made."""
    solid: Indices
    """The simplices of the solid."""
    sides: npt.NDArray[np.int8]
    """For each point 1 if it is inside, 0 on the surface, −1 outside."""
    volume: float
    area: float
    components: int
    genus: int
    boundaries: int
    """The number of boundary curves of an open surface."""
    evidence: str
    """What has decided which side is inside: "normals", "sensors", "below", "hull", or "guess"."""
    isolated: int
    """The number of points that were dropped since they are far from all others."""
    noise: float
    closed: bool

    def to_trimesh(self) -> trimesh.Trimesh:
        """Return the surface for trimesh."""
        from gdel._bridges import to_trimesh

        return to_trimesh(self.vertices, self.facets)

    def to_pyvista(self) -> pyvista.PolyData:
        """Return the surface for PyVista."""
        from gdel._bridges import to_polydata

        return to_polydata(self.vertices, self.facets)


def surface(
    points: npt.ArrayLike | Delaunay,
    *,
    normals: npt.ArrayLike | None = None,
    sensors: npt.ArrayLike | None = None,
    up: npt.ArrayLike | None = None,
    open: Literal["never", "auto"] = "never",
    refine: bool = False,
    smooth: int | None = None,
    min_part: float = 0.01,
    drop_isolated: bool = True,
) -> Surface:
    """Return the surface that was scanned: closed and oriented, whatever the points.

    Parameters
    ----------
    normals
        The normals of the points, outwards; zero where one is unknown.
    sensors
        The position of the sensor for each point, or one row for all: what a point was seen through is outside.
    up
        The direction that is up, if what is below all points is inside, as in airborne scans.
    open
        ``"auto"`` leaves out triangles that only close gaps, if they are more than a tenth of the area.
    refine
        Whether each triangle is split into four, with new vertices on quadrics through the points around.
    smooth
        How often points are moved onto quadrics through their neighbours; by default twice if there is noise.
    min_part, drop_isolated
        Pieces smaller than this share of the largest one are dropped, and so are points far from all others.
    """
    tri = as_delaunay(points)
    options: dict[str, Any] = {
        "open": open,
        "refine": bool(refine),
        "min_part": float(min_part),
        "drop_isolated": bool(drop_isolated),
    }
    if smooth is not None:
        options["smooth"] = int(smooth)
    if normals is not None:
        options["normals"] = as_points(normals, "normals")
    if sensors is not None:
        options["sensors"] = as_points(np.atleast_2d(np.asarray(sensors)), "sensors")
    if up is not None:
        options["up"] = np.asarray(up, np.float64).ravel().tolist()
    state = tri._state
    return Surface(**state.mesh.surface(state.points, options))


class SpanningTree:
    """The shortest connection of all points."""

    edges: Indices
    """The edges in the order of their lengths, the lower vertex first. Duplicates have none."""
    lengths: Floats
    """The length of each edge."""

    def __init__(self, tree: _gdel.Tree) -> None:
        """Take the arrays."""
        self._tree = tree
        self.edges = tree.edges()
        self.lengths = tree.lengths()

    def clusters(self, count: int) -> Indices:
        """Return the cluster of each point after the longest edges were cut: `count` single-linkage clusters."""
        if count < 1:
            raise ValueError("count must be at least 1")
        return self._tree.clusters(count)

    def clusters_within(self, distance: float) -> Indices:
        """Return the cluster of each point after the edges longer than a distance were cut."""
        return self._tree.clusters_within(distance)


def minimum_spanning_tree(points: npt.ArrayLike | Delaunay) -> SpanningTree:
    """Return the Euclidean minimum spanning tree of points, or of those of a triangulation.

    >>> tree = minimum_spanning_tree([(0, 0), (1, 0), (0, 2), (9, 0), (9, 4)])
    >>> tree.clusters(2).tolist()
    [0, 0, 0, 1, 1]
    """
    state = as_delaunay(points)._state
    return SpanningTree(state.mesh.spanning_tree(state.points))


def nearest(points: npt.ArrayLike | Delaunay, xi: npt.ArrayLike, k: int = 1) -> Indices:
    """Return the point nearest to each point of `xi`, or the `k` nearest ones: see `Delaunay.nearest`.

    >>> nearest([(0, 0), (2, 0), (0, 2)], (1.5, 9.0)).tolist()
    2
    """
    return as_delaunay(points).nearest(xi, k)
