"""Voronoi diagrams."""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from gdel._delaunay import Delaunay
from gdel._points import Backend, Clip, Floats, Indices, Points, Progress, as_clip

if TYPE_CHECKING:
    import geopandas


class Diagram:
    """What one set of points has."""

    def __init__(self, tri: Delaunay, has_empty_region: bool, clip: Any) -> None:
        """Take a triangulation."""
        self.tri = tri
        self.has_empty_region = has_empty_region
        self.clip = clip

    @cached_property
    def ridges(self) -> dict[str, Any]:
        """Ridges and regions as flat arrays."""
        state = self.tri._state
        return state.mesh.voronoi_ridges(state.points)

    @cached_property
    def cells(self) -> dict[str, Any]:
        """The clipped cells."""
        state = self.tri._state
        return state.mesh.voronoi(state.points, self.clip)

    @cached_property
    def ridge_vertices(self) -> list[list[int]]:
        """The vertices of each ridge."""
        return _lists(self.ridges["ridge_ends"], self.ridges["ridge_vertices"])

    @cached_property
    def regions(self) -> list[list[int]]:
        """The vertices of each region."""
        regions = _lists(self.ridges["region_ends"], self.ridges["region_vertices"])
        is_vertex = self.tri.duplicate_of < 0
        kept = [region for region, kept in zip(regions, is_vertex, strict=True) if kept]
        return [[], *kept] if self.has_empty_region else kept

    @cached_property
    def point_region(self) -> npt.NDArray[np.intp]:
        """The region of each point."""
        duplicate_of = self.tri.duplicate_of
        is_vertex = duplicate_of < 0
        region = np.cumsum(is_vertex) - 1 + int(self.has_empty_region)
        region[~is_vertex] = region[duplicate_of[~is_vertex]]
        region[duplicate_of == np.arange(len(duplicate_of))] = -1
        return region


def _lists(ends: npt.NDArray[np.intp], flat: Indices) -> list[list[int]]:
    starts = [0, *ends.tolist()]
    values = flat.tolist()
    return [values[start:end] for start, end in pairwise(starts)]


class Voronoi:
    """The Voronoi diagram of points in 2D or 3D, in the shape of `scipy.spatial.Voronoi`.

    Parameters
    ----------
    points, furthest_site, incremental, qhull_options, backend, threads, progress
        As for `Delaunay`. As in SciPy, there is an empty region unless `qhull_options` lacks ``Qz``.
    clip
        What `volumes`, `centroids` and `cell_neighbors` are clipped to: `None`, ``"box"`` (the smallest one that
        contains all points), ``"hull"``, a box as its lowest and highest corner, or a convex polygon or polyhedron as
        its corners, in any order: 3 or more rows. The other attributes are those of the diagram that is not clipped.
        Points in a plane or on a line have polygons or segments as cells, unless these are clipped to a shape that has
        an inside.

    >>> vor = Voronoi([(0, 0), (2, 0), (0, 2), (2, 2), (1, 1)], clip=[(0, 0), (2, 2)])
    >>> vor.volumes.tolist()
    [0.5, 0.5, 0.5, 0.5, 2.0]
    >>> vor.vertices.shape
    (4, 2)
    """

    furthest_site = False

    def __init__(
        self,
        points: npt.ArrayLike | Delaunay,
        furthest_site: bool = False,
        incremental: bool = False,
        qhull_options: str | None = None,
        *,
        clip: Clip | None = None,
        backend: Backend = "auto",
        threads: int | None = None,
        progress: Progress = None,
    ) -> None:
        """Compute the diagram of points, or of those of a triangulation."""
        if furthest_site:
            raise ValueError("there is no furthest-site diagram: use scipy.spatial.Voronoi")
        if isinstance(points, Delaunay):
            tri = points
        else:
            tri = Delaunay(points, backend=backend, threads=threads, progress=progress)
        has_empty_region = qhull_options is None or "Qz" in qhull_options
        self._closed = False
        self._diagram = Diagram(tri, has_empty_region, as_clip(clip, tri.ndim))

    def __repr__(self) -> str:
        """Return a short description."""
        return f"<gdel.Voronoi: {self.npoints} points, {self.ndim}D>"

    @property
    def tri(self) -> Delaunay:
        """The triangulation that the diagram is the dual of."""
        return self._diagram.tri

    @property
    def points(self) -> Points:
        """The points."""
        return self.tri.points

    @property
    def vertices(self) -> Floats:
        """The vertices. Simplices on one sphere have one vertex."""
        vertices: Floats = self._diagram.ridges["vertices"]
        return vertices

    @property
    def ridge_points(self) -> Indices:
        """The two points that each ridge is between."""
        points: Indices = self._diagram.ridges["ridge_points"]
        return points

    @property
    def ridge_vertices(self) -> list[list[int]]:
        """The vertices of each ridge, in their order around it; −1 is at infinity."""
        return self._diagram.ridge_vertices

    @property
    def ridge_dict(self) -> dict[tuple[int, int], list[int]]:
        """The vertices of the ridge between two points."""
        return {
            (i, j): vertices for (i, j), vertices in zip(self.ridge_points.tolist(), self.ridge_vertices, strict=True)
        }

    @property
    def regions(self) -> list[list[int]]:
        """The vertices of each region, in 2D in their order around it; −1 is at infinity."""
        return self._diagram.regions

    @property
    def point_region(self) -> npt.NDArray[np.intp]:
        """The region of each point; −1 for points that were removed."""
        return self._diagram.point_region

    @property
    def npoints(self) -> int:
        """The number of points."""
        return self.tri.npoints

    @property
    def ndim(self) -> int:
        """The number of coordinates: 2 or 3."""
        return self.tri.ndim

    @property
    def min_bound(self) -> Points:
        """The least coordinate along each axis."""
        return self.tri.min_bound

    @property
    def max_bound(self) -> Points:
        """The largest coordinate along each axis."""
        return self.tri.max_bound

    @property
    def volumes(self) -> Floats:
        """The volume of each point's clipped cell, the area in 2D: infinite if unbounded, 0 for duplicates."""
        volumes: Floats = self._diagram.cells["volumes"]
        return volumes

    @property
    def centroids(self) -> Floats:
        """The centre of mass of each point's clipped cell; NaN for unbounded and empty ones."""
        centroids: Floats = self._diagram.cells["centroids"]
        return centroids

    @property
    def cell_neighbors(self) -> tuple[npt.NDArray[np.intp], Indices, Floats]:
        """``(indptr, neighbors, areas)``: the facets of cell *k* are those from ``indptr[k]`` to ``indptr[k + 1]``.

        A neighbour is −1 where the cell was clipped.
        """
        cells = self._diagram.cells
        return cells["cells"], cells["neighbors"], cells["areas"]

    def add_points(self, points: npt.ArrayLike, restart: bool = False) -> None:
        """Insert points."""
        if self._closed:
            raise RuntimeError("the diagram was closed")
        diagram = self._diagram
        diagram.tri.insert(points)
        self._diagram = Diagram(diagram.tri, diagram.has_empty_region, diagram.clip)

    def close(self) -> None:
        """Allow no more `add_points`."""
        self._closed = True

    def polygons(self) -> list[Floats]:
        """Return the corners of each clipped cell of a 2D diagram, counter-clockwise; none for cells of no area."""
        if self.ndim != 2:
            raise ValueError("cells are polygons in 2D only")
        cells = self._diagram.cells
        offsets, indices = cells["facets"]
        # Both ends of each edge; an unbounded edge has one.
        starts = indices[np.minimum(offsets[:-1], max(len(indices) - 1, 0))] if len(indices) else indices
        # The cells of collinear points are segments, unless they are clipped to a box.
        bounded = np.isfinite(cells["volumes"]) & (np.diff(cells["cells"]) > 2)
        return [
            cells["vertices"][starts[first:last]] if is_bounded else np.empty((0, 2))
            for first, last, is_bounded in zip(cells["cells"], cells["cells"][1:], bounded, strict=False)
        ]

    def to_geopandas(self, crs: Any = None) -> geopandas.GeoDataFrame:
        """Return the clipped cells of a 2D diagram as polygons, one row per point; cells without an area are empty."""
        from gdel._bridges import to_geopandas

        return to_geopandas(self.polygons(), self.points, crs)
