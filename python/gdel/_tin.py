"""Terrain: triangles between a few of many points with heights."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from gdel import _gdel
from gdel._constrained import ConstrainedDelaunay, Crossings, Fill, as_edges, given_to, sides_of
from gdel._points import Floats, Indices, Progress, as_points, as_progress


@dataclass(frozen=True)
class Tin:
    """The surface over some of the points that is near to all of them."""

    delaunay: ConstrainedDelaunay
    """The constrained Delaunay triangulation of the vertices, as seen from above."""
    vertices: Floats
    """Rows of x, y and z: the corners of the hull, the ends of segments and points where these cross, in the order of
    the points; other crossings; then all others, in the order in which they were needed."""
    sources: Indices
    """The point that each vertex is; -1 for those at crossings."""
    max_error: float
    """How far from the surface the farthest point is that counts."""
    start: int
    """The number of vertices at the start: corners of the hull, ends of segments, and crossings."""
    duplicates: int
    """The number of points that have the x and y of another one that counts in their place."""
    other_heights: int
    """The number of these that have another height than that one."""
    outside: int
    """The number of places of points outside the boundaries, whose heights do not matter."""
    limited: bool
    """Whether more vertices were needed than allowed."""

    @property
    def triangles(self) -> Indices:
        """The triangles inside the boundaries, counter-clockwise as seen from above."""
        return self.delaunay.inside_simplices

    def __repr__(self) -> str:
        """Return a short description."""
        return f"<gdel.Tin: {len(self.vertices)} vertices, {len(self.triangles)} triangles>"


def tin(
    points: npt.ArrayLike,
    *,
    max_error: float = 0.0,
    max_points: int | None = None,
    edges: npt.ArrayLike | None = None,
    rings: Iterable[npt.ArrayLike] | None = None,
    holes: npt.ArrayLike | None = None,
    fill: Fill | None = None,
    crossings: Crossings = "error",
    threads: int | None = None,
    progress: Progress = None,
) -> Tin:
    """Return terrain: as few of the points as it takes for all to be near to the triangles between them.

    It begins with the corners of the convex hull, as seen from above, and with the ends of `edges` and `rings`, which
    become edges: breaklines and boundaries, as for `ConstrainedDelaunay`. Then the point that is farthest from the
    surface becomes a vertex, until none is more than `max_error` above or below it, or until there are `max_points`
    vertices. Of points with the same x and y, one counts: the end of an edge, else the lowest.

    >>> x, y = np.meshgrid(np.arange(10.0), np.arange(10.0))
    >>> valley = np.column_stack([x.ravel(), y.ravel(), abs(x - 5).ravel()])
    >>> terrain = tin(valley, max_error=0.1)
    >>> len(terrain.vertices), terrain.max_error <= 0.1
    (6, True)
    >>> bool((valley[terrain.sources] == terrain.vertices).all())
    True
    """
    array = as_points(points)
    if array.shape[1] != 3:
        raise ValueError(f"points must have 3 coordinates, not {array.shape[1]}: terrain needs heights")
    rule: Fill = fill or ("all" if rings is None else "evenodd")
    given = given_to(as_edges(edges, len(array)), sides_of(rings, len(array)), holes, rule, crossings)
    mesh, found = _gdel.tin(array, given, float(max_error), max_points, threads, as_progress(progress))
    vertices: Floats = found.pop("vertices")
    counts = found.pop("stats")
    sources: Indices = found.pop("sources")
    error: float = found.pop("max_error")
    found["added"] = np.arange(len(vertices))[sources < 0]
    plan = np.ascontiguousarray(vertices[:, :2])
    delaunay = ConstrainedDelaunay._of(mesh, plan, found, "cpu", threads)
    return Tin(delaunay=delaunay, vertices=vertices, sources=sources, max_error=error, **counts)
