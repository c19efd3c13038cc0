"""Constrained Delaunay triangulations in 2D."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from gdel import _gdel
from gdel._delaunay import Delaunay, State, VerifyReport
from gdel._points import Backend, Floats, Indices, Points, Progress, as_aligned, as_floats, as_points, as_progress

Fill: TypeAlias = Literal["all", "evenodd", "nonzero", "enclosed"]
Crossings: TypeAlias = Literal["error", "split"]

_Segments: TypeAlias = npt.NDArray[np.uint32]


@dataclass(frozen=True)
class Refinement:
    """What `ConstrainedDelaunay.refine` has done, and what is left."""

    points_on_segments: int
    points_inside: int
    min_angle: float
    """The smallest angle of the simplices inside, in degrees."""
    at_input_angles: int
    """Simplices with a smaller angle than asked for where segments meet under less than 60°."""
    too_fine: int
    """Those with a smaller angle because coordinates are too coarse for more points there."""
    beyond_limit: int
    """Those with a smaller angle because there were to be no more points."""
    too_large: int
    """Simplices that are larger than asked for, for either of the last two reasons."""
    limited: bool
    """Whether more points were needed than allowed."""


class ConstrainedDelaunay(Delaunay):
    """The triangulation of points in 2D that has given segments as edges, and is as Delaunay as these allow.

    Parameters
    ----------
    points
        One row of two coordinates per point, or `None`.
    edges
        Segments that bound nothing, such as breaklines: rows of two indices of points.
    rings
        Boundaries through given points: closed polygons as lists of indices.
    polygons
        Boundaries that bring their own points, which follow the given ones: polygons as lists of rings of positions,
        or objects with a `__geo_interface__`, such as Shapely's polygons and multi-polygons.
    holes
        Places in holes, rows of two coordinates: the region around each is outside, whatever the fill rule.
    fill
        Which triangles are inside: ``"all"``; ``"evenodd"``, those from which a way out crosses boundaries an odd
        number of times; ``"nonzero"``, those around which boundaries wind; ``"enclosed"``, those from which no way
        leads out without crossing a segment. The default is ``"evenodd"`` with rings or polygons, else ``"all"``.
    crossings
        What becomes of segments that cross where there is no point: ``"error"``, a `CrossingError`, or ``"split"``, a
        point there, rounded to the nearest coordinates, after all others.
    backend, threads, progress
        As for `Delaunay`.

    The triangulation is unique, whatever the order of the segments. One that leads through a point is two segments
    there, exactly. Segments may overlap, and may be given several times; those whose ends are equal are ignored.

    Interpolated values do not cross constrained edges, and end at boundaries. What only a Delaunay triangulation has
    raises `ValueError`: smooth interpolation, `Voronoi`, alpha shapes, surfaces, spanning trees, and changes.

    >>> square, hole = [(0, 0), (9, 0), (9, 9), (0, 9)], [(3, 3), (6, 3), (6, 6), (3, 6)]
    >>> tri = ConstrainedDelaunay(None, polygons=[[square, hole]])
    >>> len(tri.inside_simplices), float(tri.volumes[tri.inside].sum())
    (8, 72.0)
    >>> tri.is_constrained(4, 7), bool(tri.verify())
    (True, True)
    """

    def __init__(
        self,
        points: npt.ArrayLike | None,
        *,
        edges: npt.ArrayLike | None = None,
        rings: Iterable[npt.ArrayLike] | None = None,
        polygons: Iterable[Any] | None = None,
        holes: npt.ArrayLike | None = None,
        fill: Fill | None = None,
        crossings: Crossings = "error",
        backend: Backend = "auto",
        threads: int | None = None,
        progress: Progress = None,
    ) -> None:
        """Triangulate points."""
        array = np.empty((0, 2)) if points is None else as_points(points)
        if array.shape[1] != 2:
            what = "constraints are possible in 2D only"
            raise ValueError(f"points must have 2 coordinates, not {array.shape[1]}: {what}")
        segments = as_edges(edges, len(array))
        boundary = sides_of(rings, len(array))
        own = _positions(polygons or [])
        if own:
            array = np.vstack([array, *own]).astype(np.float64, copy=False)
            ends = np.cumsum([len(ring) for ring in own]) + (len(array) - sum(map(len, own)))
            boundary += [_closed(np.arange(end - len(ring), end)) for ring, end in zip(own, ends, strict=True)]
        has_boundary = rings is not None or polygons is not None
        given = given_to(segments, boundary, holes, fill or ("evenodd" if has_boundary else "all"), crossings)
        mesh, found = _gdel.constrain(array, given, backend, threads, as_progress(progress))
        added: Floats = found.pop("added")
        if len(added):
            array = np.vstack([array, added]).astype(np.float64, copy=False)
        self._found: dict[str, Any] = {**found, "added": np.arange(len(array) - len(added), len(array))}
        self._take(State(mesh, array), backend, threads)

    @classmethod
    def _of(
        cls, mesh: _gdel.Mesh, points: Points, found: dict[str, Any], backend: Backend, threads: int | None
    ) -> ConstrainedDelaunay:
        """Return the triangulation of a mesh, with what became of the segments."""
        result = cls.__new__(cls)
        result._found = found
        result._take(State(mesh, points), backend, threads)
        return result

    def __repr__(self) -> str:
        """Return a short description."""
        counts = f"{self.npoints} points, {self.nsimplex} simplices, {len(self.constraints)} constrained edges"
        return f"<gdel.ConstrainedDelaunay: {counts}>"

    def __getstate__(self) -> dict[str, Any]:
        """Return what is pickled."""
        return {**super().__getstate__(), "found": self._found}

    def __setstate__(self, pickled: dict[str, Any]) -> None:
        """Take what was pickled."""
        found = pickled["found"].items()
        self._found = {name: as_aligned(part) if isinstance(part, np.ndarray) else part for name, part in found}
        super().__setstate__(pickled)

    @property
    def constraints(self) -> Indices:
        """The constrained edges: rows of two vertices, the lower one first, in ascending order."""
        return self._state.mesh.constraints

    @property
    def inside(self) -> npt.NDArray[np.bool_]:
        """Whether each simplex is inside the boundaries."""
        inside: npt.NDArray[np.bool_] = self._found["inside"]
        return inside

    @property
    def inside_simplices(self) -> Indices:
        """The simplices inside the boundaries."""
        return self.simplices[self.inside]

    @property
    def regions(self) -> Indices:
        """The number of the region of each simplex; constrained edges separate regions."""
        regions: Indices = self._found["regions"]
        return regions

    @property
    def segments(self) -> Indices:
        """The segments, edges before rings and polygons, cut where a point was put on them."""
        segments: Indices = self._found["segments"]
        return segments

    @property
    def zero_length(self) -> int:
        """The number of segments that were ignored, since their ends are equal."""
        return int(self._found["zero_length"])

    @property
    def added(self) -> npt.NDArray[np.intp]:
        """The points that were put at crossings, and those of refinement."""
        added: npt.NDArray[np.intp] = self._found["added"]
        return added

    @property
    def moved(self) -> float:
        """The greatest distance of such a point from its crossing."""
        return float(self._found["moved"])

    def is_constrained(self, a: int, b: int) -> bool:
        """Return whether there is a constrained edge between two points, which may be duplicates."""
        low, high = sorted(i if self.duplicate_of[i] < 0 else int(self.duplicate_of[i]) for i in (a, b))
        return bool(((self.constraints[:, 0] == low) & (self.constraints[:, 1] == high)).any())

    def refine(
        self,
        *,
        min_angle: float = 20.0,
        max_area: float | None = None,
        size: npt.ArrayLike | None = None,
        max_points: int | None = None,
    ) -> ConstrainedDelaunay:
        """Return a new triangulation, with points added until all simplices inside are as asked for.

        No angle is below `min_angle`, in degrees, at most 34, except where segments meet under small angles; no area is
        larger than `max_area`, and no edge longer than `size`, one number or one for each point. Where the hull bounds
        what is inside, its edges count as segments. At most `max_points` are added. `refinement` says what was done,
        and `segment_of` of which segment each of the `segments`, which are pieces now, is a part.

        >>> long = ConstrainedDelaunay(None, polygons=[[[(0, 0), (9, 0), (9, 1), (0, 1)]]])
        >>> fine = long.refine(min_angle=30, max_area=0.1)
        >>> fine.refinement.min_angle >= 30, bool(fine.volumes.max() <= 0.1), bool(fine.verify())
        (True, True, True)
        """
        sizes = None if size is None else np.asarray(size, np.float64)
        if sizes is not None and sizes.ndim > 1:
            raise ValueError(f"size must be a number or one for each point, not an array of shape {sizes.shape}")
        options = SimpleNamespace(
            min_angle=float(min_angle),
            max_area=None if max_area is None else float(max_area),
            size=float(sizes) if sizes is not None and sizes.ndim == 0 else None,
            sizes=np.ascontiguousarray(sizes) if sizes is not None and sizes.ndim == 1 else None,
            max_points=max_points,
        )
        state = self._state
        mesh, found = state.mesh.refine(state.points, self.inside, self.segments, options)
        added: Floats = found.pop("added")
        array = np.vstack([state.points, added]).astype(np.float64, copy=False) if len(added) else state.points
        found = {
            **self._found,
            **found,
            # Of the segments that were given.
            "zero_length": self.zero_length,
            "moved": self.moved,
            "refinement": Refinement(**found["refinement"]),
            "added": np.concatenate([self.added, np.arange(len(array) - len(added), len(array))]),
        }
        return self._of(mesh, array, found, self._backend, self.threads)

    @property
    def refinement(self) -> Refinement | None:
        """What refinement has done, if this is its result."""
        refinement: Refinement | None = self._found.get("refinement")
        return refinement

    @property
    def segment_of(self) -> Indices:
        """The segment that each of the segments is a piece of, before the last refinement; -1 for edges of the hull."""
        given: Indices = self._found.get("segment_of", np.arange(len(self.segments), dtype=np.int32))
        return given

    def verify(self) -> VerifyReport:
        """Prove that this is the constrained Delaunay triangulation of its points and segments, exactly."""
        return VerifyReport(**self._state.mesh.verify_constrained(self._state.points, self.segments))


def _as_indices(values: npt.ArrayLike, name: str, count: int) -> npt.NDArray[np.int64]:
    """Return indices of points."""
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise ValueError(f"{name} cannot be an array: {error}") from None
    if array.size and array.dtype.kind not in "iu":
        raise TypeError(f"{name} must be whole numbers, not {array.dtype}")
    wrong = array[(array < 0) | (array >= count)] if array.size else array
    if wrong.size:
        raise ValueError(f"{name} has {wrong.flat[0]}, which is not the index of one of the {count} points")
    return array.astype(np.int64)


def as_edges(edges: npt.ArrayLike | None, count: int) -> _Segments:
    """Return segments between so many points."""
    array = _as_indices([] if edges is None else edges, "edges", count)
    if array.size and (array.ndim != 2 or array.shape[1] != 2):
        raise ValueError(f"edges must be rows of two indices, not an array of shape {array.shape}")
    return np.require(array.reshape(-1, 2), np.uint32, ["C"])


def sides_of(rings: Iterable[npt.ArrayLike] | None, count: int) -> list[_Segments]:
    """Return the sides of rings through so many points."""
    return [_closed(_as_indices(ring, f"rings[{i}]", count)) for i, ring in enumerate(rings or [])]


def given_to(
    edges: _Segments, boundary: list[_Segments], holes: npt.ArrayLike | None, fill: Fill, crossings: Crossings
) -> SimpleNamespace:
    """Return constraints as Rust takes them."""
    if crossings not in ("error", "split"):
        raise ValueError(f"crossings must be 'error' or 'split', not {crossings!r}")
    places = np.empty((0, 2)) if holes is None else as_points(holes, "holes")
    if places.shape[1] != 2:
        raise ValueError(f"holes must have 2 coordinates, not {places.shape[1]}")
    return SimpleNamespace(
        edges=edges,
        boundary=np.vstack([np.empty((0, 2), np.uint32), *boundary]).astype(np.uint32),
        holes=places.astype(np.float64),
        fill=fill,
        is_split=crossings == "split",
    )


def _closed(ring: npt.NDArray[Any]) -> _Segments:
    """Return the sides of a ring, whose last vertex may be the first one."""
    if ring.ndim != 1:
        raise ValueError(f"a ring must be a list of indices, not an array of shape {ring.shape}")
    if len(ring) > 1 and ring[0] == ring[-1]:
        ring = ring[1:]
    return np.column_stack([ring, np.roll(ring, -1)]).astype(np.uint32)


def _positions(polygons: Iterable[Any]) -> list[Floats]:
    """Return the positions of all rings of polygons, without those that repeat a first one."""
    rings: list[Floats] = []
    for p, polygon in enumerate(polygons):
        for r, ring in enumerate(ring for rings in _rings(polygon, p) for ring in rings):
            name = f"ring {r} of polygons[{p}]"
            array = as_floats(ring, name)
            if array.size == 0:
                continue
            if array.ndim != 2 or array.shape[1] < 2:
                raise ValueError(f"{name} must have rows of two coordinates or more; its shape is {array.shape}")
            positions = array[:, :2].astype(np.float64)
            if len(positions) > 1 and (positions[0] == positions[-1]).all():
                positions = positions[:-1]
            rings.append(positions)
    return rings


def _rings(polygon: Any, p: int) -> Sequence[Sequence[Any]]:
    """Return the rings of each part of a polygon."""
    geometry = getattr(polygon, "__geo_interface__", None)
    if geometry is None:
        return [polygon]
    if geometry["type"] == "Polygon":
        return [geometry["coordinates"]]
    if geometry["type"] == "MultiPolygon":
        parts: Sequence[Sequence[Any]] = geometry["coordinates"]
        return parts
    raise TypeError(f"polygons[{p}] must be a polygon or a multi-polygon, not a {geometry['type']}")
