"""What follows from the simplices around the points of one tile: functions of arrays, for any scheduler."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from gdel import _gdel
from gdel._delaunay import Delaunay
from gdel._interpolate import LinearNDInterpolator
from gdel._points import Floats, Indices, Points
from gdel._voronoi import Voronoi

Piece: TypeAlias = dict[str, npt.NDArray[Any]]
Numbers: TypeAlias = npt.NDArray[np.uint32]
Bools: TypeAlias = npt.NDArray[np.bool_]
#: Indices in the whole input, and the points.
Named: TypeAlias = tuple[Numbers, Floats]
#: For each tile which queries it is asked, and these.
Routes: TypeAlias = list[tuple[npt.NDArray[np.intp], Points]]
#: Which queries a tile answers, the indices of the nearest points, and these.
NearestAnswer: TypeAlias = tuple[npt.NDArray[np.intp], npt.NDArray[np.int64], Floats]
#: Which queries a tile answers, the simplices by the indices of the whole input, their corners, and the values.
Interpolated: TypeAlias = tuple[npt.NDArray[np.intp], Numbers, Floats, npt.NDArray[Any]]

#: More than the relative error of a squared distance.
_ERROR = 1e-14
#: More than what underflow takes from one.
_TINY = 1e-290

#: The vertices of the facet opposite each vertex of a positive simplex, as seen from outside.
_FACETS = {2: [[1, 2], [2, 0], [0, 1]], 3: [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]}


@dataclass(frozen=True)
class Stars:
    """The simplices around the points of a tile.

    What is known of a point by the simplices around it is known here of all points of the tile: its degree, its Voronoi
    cell, a gradient, a curvature.
    """

    mesh: Delaunay
    """The triangulation of the points of the tile, all their neighbours, and the outermost points of the whole input
    along each axis. Not all of its simplices are those of the whole mesh, but `around` is."""
    indices: Numbers
    """The index of each point of `mesh` in the whole input. They ascend, so ties are those of the whole mesh."""
    own: Bools
    """Whether each point of `mesh` belongs to the tile."""

    @property
    def around(self) -> npt.NDArray[np.intp]:
        """Which simplices of `mesh` have a point of the tile: these are simplices of the whole mesh."""
        return np.flatnonzero(self.own[self.mesh.simplices].any(axis=1))

    @property
    def coordinates(self) -> Floats:
        """The points of `mesh` in double precision."""
        return self.mesh.points.astype(np.float64, copy=False)


def simplices_of(piece: Piece) -> Numbers:
    """Return the simplices of a piece."""
    return piece["tetrahedra"] if "tetrahedra" in piece else piece["triangles"]


def known(piece: Piece, tiles: int) -> list[Named]:
    """Return for each tile the vertices of those simplices of a piece that have a point of the tile."""
    owners, simplices = piece["tiles"], simplices_of(piece)
    found = [(piece["indices"][:0], piece["points"][:0])] * tiles
    for tile in np.unique(owners):
        vertices = np.unique(simplices[(owners[simplices] == tile).any(axis=1)])
        found[tile] = piece["indices"][vertices], piece["points"][vertices]
    return found


def outermost(parts: Sequence[Named]) -> Named:
    """Return the lowest and the highest points along each axis, of several that are as low the first."""
    indices, points = (np.concatenate(arrays) for arrays in zip(*parts, strict=True))
    if len(points) == 0:
        return indices, points
    rows = np.unique(np.concatenate([points.argmin(axis=0), points.argmax(axis=0)]))
    return indices[rows], points[rows]


def outermost_of(piece: Piece, tile: int) -> Named:
    """Return the outermost points of a tile. None is a duplicate, since the first of equal points is taken."""
    own = piece["tiles"] == tile
    return outermost([(piece["indices"][own], piece["points"][own])])


def stars_of(piece: Piece, tile: int, shares: list[Named], extent: Named, single: bool, threads: int) -> Stars:
    """Triangulate the points of a tile and what all pieces know of their neighbours.

    With the outermost points the mesh has the bounds of the whole one, and so what is decided up to rounding, which is
    relative to them, is decided in the same way.
    """
    own = piece["tiles"] == tile
    parts = [(piece["indices"][own], piece["points"][own]), *shares, extent]
    indices, first = np.unique(np.concatenate([part[0] for part in parts]), return_index=True)
    points = np.concatenate([part[1] for part in parts])[first]
    mesh = Delaunay(points.astype(np.float32) if single else points, backend="cpu", threads=threads)
    return Stars(mesh, indices, np.isin(indices, piece["indices"][own]))


def indices_of(stars: Stars) -> Numbers:
    """Return the indices of the points."""
    return stars.indices


def boxes_of(stars: Stars) -> Floats:
    """Return the corners of the box of the tile's points, and of that of the simplices around them."""
    points = stars.coordinates
    parts = [points[stars.own], points[stars.mesh.simplices[stars.around].ravel()]]
    # Of no points, what no query is in, and what is farther than all others.
    return np.array([[part.min(axis=0, initial=np.inf), part.max(axis=0, initial=-np.inf)] for part in parts])


def cell_volumes(stars: Stars, clip: Any) -> tuple[Numbers, Floats]:
    """Return the tile's points, by their indices, and the volumes of their Voronoi cells."""
    indices = stars.indices[stars.own]
    if len(indices) == 0:
        return indices, np.empty(0)
    return indices, Voronoi(stars.mesh, clip=clip).volumes[stars.own]


# Nearest points.


def _squared_distances(queries: Floats, box: Floats) -> Floats:
    """Return the squared distances of queries from a box; infinite ones from the box of no points only."""
    low, high = box
    if low[0] > high[0]:
        return np.full(len(queries), np.inf)
    with np.errstate(over="ignore", invalid="ignore"):
        beside = np.maximum(np.maximum(low - queries, queries - high), 0)
        squared: Floats = np.minimum((beside**2).sum(axis=1), np.finfo(float).max)
    return squared


def _comparable(queries: Points) -> Floats:
    """Return queries in double precision, with NaN, which is neither near nor inside, where one is not finite."""
    rows: Floats = queries.astype(np.float64)
    rows[~np.isfinite(rows).all(axis=1)] = np.nan
    return rows


def _nearest_tiles(queries: Floats, boxes: list[Floats]) -> npt.NDArray[np.intp]:
    """Return the tile whose box is nearest to each query, −1 for NaN."""
    tiles, least = np.full(len(queries), -1), np.full(len(queries), np.inf)
    for tile, (box, _) in enumerate(boxes):
        distances = _squared_distances(queries, box)
        nearer = distances < least
        tiles[nearer], least[nearer] = tile, distances[nearer]
    return tiles


def to_nearest_boxes(queries: Points, boxes: list[Floats]) -> Routes:
    """Return for each tile the queries to which its box is nearest."""
    tiles = _nearest_tiles(_comparable(queries), boxes)
    rows = [np.flatnonzero(tiles == tile) for tile in range(len(boxes))]
    return [(each, queries[each]) for each in rows]


def to_near_boxes(queries: Points, boxes: list[Floats], found: NearestAnswer) -> Routes:
    """Return for each tile the queries to which its box is as near as what was found, but not nearest."""
    places = _comparable(queries)
    tiles = _nearest_tiles(places, boxes)
    with np.errstate(over="ignore"):
        bound = ((places - found[2]) ** 2).sum(axis=1) * (1 + _ERROR) + _TINY
    routes: Routes = []
    for tile, (box, _) in enumerate(boxes):
        is_near = (_squared_distances(places, box) <= bound) & (tiles != tile) & (box[0, 0] <= box[1, 0])
        rows = np.flatnonzero(is_near)
        routes.append((rows, queries[rows]))
    return routes


def nearest_in(stars: Stars, asked: tuple[npt.NDArray[np.intp], Points]) -> NearestAnswer:
    """Return the nearest of a tile's points and their neighbours for each query."""
    rows, queries = asked
    vertices = stars.mesh.nearest(queries) if len(rows) else np.empty(0, np.int32)
    return rows, stars.indices[vertices].astype(np.int64), stars.coordinates[vertices]


def nearest_of(queries: Points, answers: list[NearestAnswer]) -> NearestAnswer:
    """Return the nearest of all answers for each query, of several that are as near the one of the lowest index.

    It is −1 where there is no answer.
    """
    places = queries.astype(np.float64)
    nearest, points = np.full(len(places), -1), np.full(places.shape, np.nan)
    for rows, indices, candidates in answers:
        better = _are_nearer(places[rows], (indices, candidates), (nearest[rows], points[rows]))
        nearest[rows[better]], points[rows[better]] = indices[better], candidates[better]
    return np.arange(len(places)), nearest, points


def _are_nearer(
    queries: Floats, new: tuple[npt.NDArray[np.int64], Floats], old: tuple[npt.NDArray[np.int64], Floats]
) -> Bools:
    """Return which new points are nearer than the old ones, or as near and of a lower index; all where none is old."""
    with np.errstate(over="ignore", invalid="ignore"):
        a, b = (((queries - points) ** 2).sum(axis=1) for _, points in (new, old))
        is_certain = np.abs(a - b) > _ERROR * (a + b) + _TINY
    nearer: Bools = np.where(old[0] < 0, True, is_certain & (a < b))

    def key(row: int, indices: npt.NDArray[np.int64], points: Floats) -> tuple[Fraction, int]:
        """Return the exact square of the distance, and the index."""
        pairs = zip(queries[row].tolist(), points[row].tolist(), strict=True)
        return sum(((Fraction(x) - Fraction(y)) ** 2 for x, y in pairs), Fraction()), int(indices[row])

    for row in np.flatnonzero(~is_certain & (old[0] >= 0) & (new[0] != old[0])).tolist():
        nearer[row] = key(row, *new) < key(row, *old)
    return nearer


# Interpolation.


def pick(block: npt.NDArray[Any], first: int, indices: Numbers) -> npt.NDArray[Any]:
    """Return the rows of a block, whose first row has the index `first`, that have these indices, which ascend."""
    start, end = np.searchsorted(indices, [first, first + len(block)])
    picked: npt.NDArray[Any] = block[indices[start:end].astype(np.int64) - first]
    return picked


def _reach(boxes: list[Floats], single: bool) -> Floats:
    """Return how far outside the hull along each axis a query counts as inside, as `Delaunay` has it."""
    corners = np.concatenate([box for box, _ in boxes])
    largest = np.abs(corners[np.isfinite(corners).all(axis=1)]).max(axis=0, initial=0)
    with np.errstate(over="ignore"):
        reach: Floats = largest * (4 * float(np.finfo(np.float32 if single else np.float64).eps))
    return np.minimum(reach, np.finfo(float).max)


def to_containing_boxes(queries: Points, boxes: list[Floats], single: bool) -> Routes:
    """Return for each tile the queries in the box of its stars, or beside it by no more than rounding."""
    places = _comparable(queries)
    margin = 2 * _reach(boxes, single or queries.dtype == np.float32)
    routes: Routes = []
    for _, (low, high) in boxes:
        rows = np.flatnonzero(((low - margin <= places) & (places <= high + margin)).all(axis=1))
        routes.append((rows, queries[rows]))
    return routes


def interpolate_in(
    stars: Stars, parts: list[npt.NDArray[Any]], asked: tuple[npt.NDArray[np.intp], Points]
) -> Interpolated:
    """Return values at those queries that are in a simplex around a point of the tile."""
    rows, queries = asked
    mesh, values = stars.mesh, np.concatenate(parts)
    found = mesh.find_simplex(queries) if len(rows) else np.empty(0, np.int32)
    simplices = mesh.simplices[found]
    answered = (found >= 0) & stars.own[simplices].any(axis=1)
    simplices = simplices[answered]
    at = LinearNDInterpolator(mesh, values)(queries[answered]) if answered.any() else values[:0]
    return rows[answered], np.sort(stars.indices[simplices], axis=1), stars.coordinates[simplices], at


def interpolated_of(
    queries: Points, answers: list[Interpolated], boxes: list[Floats], single: bool, fill_value: complex
) -> npt.NDArray[Any]:
    """Return the value at each query, of several answers that which the whole mesh gives.

    A tile may take the hull of the points it knows for that of all; a query outside of it by no more than rounding then
    is in a simplex beside the right one. And only the tile of a vertex of the facet that a query is on knows all
    simplices there, of which the first one counts.
    """
    reach = _reach(boxes, single or queries.dtype == np.float32)
    dtype = np.result_type(*[at for *_, at in answers])
    values = np.full((len(queries), *answers[0][3].shape[1:]), fill_value, dtype)
    columns = queries.shape[1] + 1
    chosen = np.full((len(queries), columns), -1, np.int64)
    places = np.zeros((len(queries), columns, queries.shape[1]))
    for rows, simplices, corners, at in answers:
        better = chosen[rows, 0] < 0
        for k in np.flatnonzero(~better & (chosen[rows] != simplices).any(axis=1)):
            asked = _around(queries[rows[k]].astype(np.float64), reach)
            new = _first_inside(corners[k], asked), simplices[k].tolist()
            better[k] = new < (_first_inside(places[rows[k]], asked), chosen[rows[k]].tolist())
        taken = rows[better]
        chosen[taken], places[taken], values[taken] = simplices[better], corners[better], at[better]
    return values


def _around(query: Floats, reach: Floats) -> list[list[Fraction]]:
    """Return a query, and in `Delaunay`'s order the corners of the box around it that stand for it outside the hull."""
    largest = float(np.finfo(float).max)
    with np.errstate(over="ignore"):
        ends = np.clip([query - reach, query + reach], -largest, largest)
    corners = [[ends[bits >> axis & 1, axis] for axis in range(len(query))] for bits in range(1 << len(query))]
    return [[Fraction(float(x)) for x in place] for place in [list(query), *corners]]


def _first_inside(corners: Floats, places: list[list[Fraction]]) -> int:
    """Return which place is the first in a simplex, exactly; their number if none is."""
    simplex = [[Fraction(x) for x in corner] for corner in corners.tolist()]
    whole = _measure(simplex)
    for number, place in enumerate(places):
        parts = [_measure([*simplex[:k], place, *simplex[k + 1 :]]) for k in range(len(simplex))]
        if all(part * whole >= 0 for part in parts):
            return number
    return len(places)


def _measure(simplex: list[list[Fraction]]) -> Fraction:
    """Return the signed volume of a simplex, times a constant."""
    first, *others = simplex
    return _determinant([[x - y for x, y in zip(corner, first, strict=True)] for corner in others])


def _determinant(rows: list[list[Fraction]]) -> Fraction:
    if len(rows) == 1:
        return rows[0][0]
    minors = ([row[:k] + row[k + 1 :] for row in rows[1:]] for k in range(len(rows)))
    terms = ((-1) ** k * rows[0][k] * _determinant(minor) for k, minor in enumerate(minors))
    return sum(terms, Fraction())


# Alpha shapes.


def solid_of(stars: Stars, alpha: float) -> dict[str, Any]:
    """Return which simplices around the tile's points have no larger circumradius, all radii, and the radius.

    This is `alpha`, or the largest of a simplex that equals it up to rounding.
    """
    around = stars.around
    if len(around) == 0:
        return {"alpha": alpha, "solid": np.empty(0, bool), "radii": np.empty(0)}
    state = stars.mesh._state
    arrays, dimension = state.mesh.state()
    # A mesh of these simplices alone: no other one makes alpha larger.
    rows: Indices = np.ascontiguousarray(state.simplices[around])
    alone = _gdel.restore((rows, np.full_like(rows, -1), *arrays[2:]), dimension, stars.mesh.threads)
    found = alone.alpha_shape(state.points, alpha, 1)
    solid = np.zeros(len(around), bool)
    solid[found["solid"]] = True
    return {"alpha": found["alpha"], "solid": solid, "radii": found["radii"]}


def facets_of(stars: Stars, found: dict[str, Any], alpha: float) -> Numbers:
    """Return the facets of the surface of the solid whose lowest vertex belongs to the tile, by their indices.

    `alpha` is the largest radius that any tile has found.
    """
    mesh, around = stars.mesh, stars.around
    ndim = mesh.ndim
    if len(around) == 0:
        return np.empty((0, ndim), np.uint32)
    is_solid = found["solid"].copy()
    if alpha > found["alpha"]:
        # What another tile has found to equal alpha is a little larger.
        for k in np.flatnonzero(~is_solid & (found["radii"] <= alpha * (1 + 1e-9))):
            is_solid[k] = _has_radius(stars.coordinates[mesh.simplices[around[k]]], alpha)
    solid = np.zeros(mesh.nsimplex, bool)
    solid[around] = is_solid
    neighbors = mesh.neighbors
    is_outer = solid[:, None] & ((neighbors < 0) | ~solid[neighbors])
    simplices, opposite = np.nonzero(is_outer)
    facets = mesh.simplices[simplices[:, None], np.array(_FACETS[ndim])[opposite]]
    numbers: Numbers = stars.indices[facets[stars.own[facets.min(axis=1)]]]
    return numbers


def _has_radius(corners: Floats, alpha: float) -> bool:
    """Return whether the circumradius of a simplex is at most alpha, exactly."""
    first, *others = [[Fraction(x) for x in corner] for corner in corners.tolist()]
    edges = [[x - y for x, y in zip(corner, first, strict=True)] for corner in others]
    squares = [sum((x * x for x in edge), Fraction()) for edge in edges]
    whole = _determinant(edges)
    # Cramer's rule for twice the circumcentre, of which the first corner is the origin.
    columns = range(len(edges))
    replaced = ([[*row[:k], s, *row[k + 1 :]] for row, s in zip(edges, squares, strict=True)] for k in columns)
    center = [_determinant(rows) / whole for rows in replaced]
    return sum((x * x for x in center), Fraction()) <= 4 * Fraction(alpha) ** 2
