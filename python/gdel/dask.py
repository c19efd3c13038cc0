"""Triangulations of points that are larger than one memory, on any Dask cluster.

>>> import dask.array as da
>>> import gdel.dask
>>> rng = da.random.default_rng(1)
>>> mesh = gdel.dask.delaunay(rng.random((3000, 2), chunks=(1000, 2)), tiles=4)
>>> mesh
<gdel.dask.Tiles: 3000 points in 2D, 4 tiles>
>>> first = mesh.pieces[0].compute()
>>> first["points"][first["triangles"]].shape[1:]
(3, 2)

Each part of space, a tile, is triangulated by itself; then tiles send each other points until nothing changes. The mesh
is that of all points at once, ties included. Every task takes bytes or arrays and returns others, so tasks can be
repeated and workers lost.
"""

from __future__ import annotations

import json
import os
import uuid
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import dask
import dask.array as da
import numpy as np
import numpy.typing as npt
from dask.delayed import Delayed

from gdel import _gdel, _stars
from gdel._points import Floats, Points, as_aligned, as_points, as_queries, as_values
from gdel._stars import Piece, Stars, simplices_of
from gdel._voronoi import Voronoi

__all__ = ["Stars", "Tiles", "delaunay"]

#: So many points are in a tile if the caller does not say how many tiles there are to be.
_PER_TILE = 4_000_000

#: So many queries of a NumPy array are answered by one task.
_PER_BLOCK = 1_000_000


class Tiles:
    """A Delaunay triangulation in pieces, one for each tile, which are computed when they are asked for."""

    pieces: list[Delayed]
    """For each tile a dictionary of arrays, as `docs/tiles.md` describes those of a file: `points`, `indices`, `tiles`,
    `tetrahedra` and `neighbors` or in 2D `triangles` and `halfedges`, `duplicates`, and `links`."""
    npoints: int
    """The number of points."""
    ndim: int
    """The number of coordinates of a point."""
    dimension: int
    """The affine dimension of the points; if it is less than `ndim`, there are no simplices."""
    single: bool
    """Whether all points were given in single precision."""
    threads: int
    """The number of threads of a task."""

    def __init__(
        self, pieces: list[Delayed], npoints: int, ndim: int, dimension: int, *, single: bool = False, threads: int = 1
    ) -> None:
        """Create the mesh of these pieces; `delaunay` does."""
        self.pieces, self.npoints, self.ndim, self.dimension = pieces, npoints, ndim, dimension
        self.single, self.threads = single, threads
        self._stars: list[Delayed] = []
        self._boxes: list[Delayed] = []

    def __repr__(self) -> str:
        """Return a short description."""
        return f"<gdel.dask.Tiles: {self.npoints} points in {self.ndim}D, {len(self.pieces)} tiles>"

    def __len__(self) -> int:
        """Return the number of tiles."""
        return len(self.pieces)

    def map(self, function: Callable[..., Any], *arguments: Any) -> list[Delayed]:
        """Return what a function makes of each piece, with these further arguments, as delayed values.

        >>> import dask.array as da
        >>> mesh = delaunay(da.random.default_rng(1).random((500, 3), chunks=(250, 3)), tiles=2)
        >>> sum(dask.compute(*mesh.map(lambda piece: len(piece["tetrahedra"])))) == mesh.nsimplex
        True
        """
        return [dask.delayed(function)(piece, *arguments) for piece in self.pieces]

    @property
    def nsimplex(self) -> int:
        """The number of simplices, which is computed."""
        return int(sum(dask.compute(*self.map(_count))))

    def star_volumes(self) -> list[Delayed]:
        """Return for each tile its points, by their indices, and the volume of the simplices around each, delayed.

        A duplicate has the volume of the point that stands for it. The density of points as the Delaunay tessellation
        field estimator has it is one more than the dimension, divided by these volumes.

        >>> import dask.array as da
        >>> mesh = delaunay(da.random.default_rng(1).random((500, 2), chunks=(250, 2)), tiles=3)
        >>> indices, volumes = map(np.concatenate, zip(*dask.compute(*mesh.star_volumes())))
        >>> len(indices), bool((volumes > 0).all())
        (500, True)
        """
        shares = self.map(_shares, len(self.pieces))
        return [
            dask.delayed(_sum_shares)(piece, [dask.delayed(_item)(share, tile) for share in shares], tile)
            for tile, piece in enumerate(self.pieces)
        ]

    def stars(self) -> list[Delayed]:
        """Return for each tile the `Stars` of its points, delayed: all simplices around each of them.

        What depends on nothing else is computed from them tile by tile, as the methods below do. They take about as
        much memory as the pieces; `persist` keeps both.

        >>> import dask.array as da
        >>> mesh = delaunay(da.random.default_rng(1).random((500, 2), chunks=(250, 2)), tiles=3)
        >>> def degrees(stars):
        ...     indptr, _ = stars.mesh.vertex_neighbor_vertices
        ...     return np.diff(indptr)[stars.own]
        >>> degree = np.concatenate(dask.compute(*[dask.delayed(degrees)(stars) for stars in mesh.stars()]))
        >>> len(degree), bool(degree.mean() < 6)
        (500, True)
        """
        if self.dimension < self.ndim:
            raise ValueError(
                f"there are no simplices: the points are flat, of dimension {self.dimension} and not {self.ndim}"
            )
        if not self._stars:
            task, tiles = _tasks(uuid.uuid4().hex[:8]), range(len(self))
            known = [task(_stars.known, "known", tile)(piece, len(self)) for tile, piece in enumerate(self.pieces)]
            ends = [task(_stars.outermost_of, "ends", tile)(piece, tile) for tile, piece in enumerate(self.pieces)]
            extent = task(_stars.outermost, "extent")(ends)
            for tile, piece in enumerate(self.pieces):
                shares = [dask.delayed(_item)(share, tile) for share in known]
                arguments = (piece, tile, shares, extent, self.single, self.threads)
                self._stars.append(task(_stars.stars_of, "stars", tile)(*arguments))
            self._boxes = [task(_stars.boxes_of, "box", tile)(self._stars[tile]) for tile in tiles]
        return list(self._stars)

    def persist(self) -> Tiles:
        """Return this mesh with its pieces and stars computed, and kept in memory, on a cluster in that of the workers.

        Without it, every answer that is computed by itself computes them again.

        >>> import dask.array as da
        >>> mesh = delaunay(da.random.default_rng(1).random((500, 2), chunks=(250, 2)), tiles=3).persist()
        >>> mesh.nearest([(0.5, 0.5)]).shape
        (1,)
        """
        stars = self.stars() if self.dimension == self.ndim else []
        pieces, stars, boxes = dask.persist(self.pieces, stars, self._boxes)
        kept = Tiles(pieces, self.npoints, self.ndim, self.dimension, single=self.single, threads=self.threads)
        kept._stars, kept._boxes = stars, boxes
        return kept

    def voronoi_volumes(self, clip: npt.ArrayLike | None = None) -> list[Delayed]:
        """Return for each tile its points, by their indices, and the volumes of their Voronoi cells, delayed.

        They are infinite for unbounded cells, and 0 for duplicates. `clip` is a box, as its lowest and highest corner.

        >>> import dask.array as da
        >>> mesh = delaunay(da.random.default_rng(1).random((500, 2), chunks=(250, 2)), tiles=3)
        >>> volumes = [volumes for _, volumes in dask.compute(*mesh.voronoi_volumes(clip=[(0, 0), (1, 1)]))]
        >>> round(float(np.concatenate(volumes).sum()), 12)
        1.0
        """
        if isinstance(clip, str):
            raise ValueError(f"clip must be a box or None, not {clip!r}: no tile knows the hull of all points")
        box = None if clip is None else np.asarray(clip, np.float64)
        if box is not None and box.shape != (2, self.ndim):
            raise ValueError(f"clip must be two rows of {self.ndim} coordinates, not {box.shape}")
        stars = self.stars()
        # A box that is none is an error now, and not of a task.
        Voronoi(np.eye(self.ndim + 1, self.ndim), clip=box).volumes  # noqa: B018
        task = _tasks(uuid.uuid4().hex[:8])
        return [task(_stars.cell_volumes, "cells", tile)(each, box) for tile, each in enumerate(stars)]

    def alpha_shape(self, alpha: float) -> list[Delayed]:
        """Return for each tile facets of the surface of the alpha shape of a radius, by their indices, delayed.

        All tiles together have those that `gdel.alpha_shape` finds for the mesh of all points, oriented outwards, each
        in the tile of its lowest vertex.

        >>> import dask.array as da
        >>> mesh = delaunay(da.random.default_rng(1).random((500, 2), chunks=(250, 2)), tiles=3)
        >>> np.concatenate(dask.compute(*mesh.alpha_shape(0.1))).shape[1:]
        (2,)
        """
        if isinstance(alpha, str) or not alpha >= 0:
            raise ValueError(f"alpha must be a number that is not negative, not {alpha!r}")
        stars, task = self.stars(), _tasks(uuid.uuid4().hex[:8])
        found = [task(_stars.solid_of, "solid", tile)(each, float(alpha)) for tile, each in enumerate(stars)]
        largest = task(max, "alpha")([dask.delayed(_item)(each, "alpha") for each in found])
        return [
            task(_stars.facets_of, "facets", tile)(*each, largest)
            for tile, each in enumerate(zip(stars, found, strict=True))
        ]

    def nearest(self, xi: Any) -> Any:
        """Return the index of the vertex nearest to each point of `xi`, by exact comparisons, the lowest of several.

        The last axis of `xi` has the coordinates. The answer for a Dask array is one with chunks like its; that for
        anything else is computed. It is −1 for points that are not finite. A query is asked of the tile whose points
        are in the nearest box, and then of those whose boxes are as near as what that tile has found.

        >>> import dask.array as da
        >>> points = da.random.default_rng(1).random((500, 2), chunks=(250, 2))
        >>> mesh = delaunay(points, tiles=3)
        >>> mesh.nearest(points[:3]).compute().tolist()
        [0, 1, 2]
        """
        stars = self.stars()

        def ask(queries: Delayed, task: Callable[..., Any], *block: int) -> Delayed:
            route = task(_stars.to_nearest_boxes, "nearest-route", *block)(queries, self._boxes)
            found: list[Delayed] = []
            for name in ("nearest", "nearer"):
                answers = [
                    task(_stars.nearest_in, f"{name}-in", *block, tile)(each, dask.delayed(_item)(route, tile))
                    for tile, each in enumerate(stars)
                ]
                found.append(task(_stars.nearest_of, name, *block)(queries, [*found, *answers]))
                if name == "nearest":
                    route = task(_stars.to_near_boxes, "nearer-route", *block)(queries, self._boxes, found[0])
            return dask.delayed(_item)(found[1], 1)

        return self._answer(xi, (), np.dtype(np.int64), ask)

    def interpolate(
        self,
        values: da.Array | Sequence[Any] | npt.NDArray[Any],
        xi: Any,
        *,
        fill_value: complex = np.nan,
        read: Callable[[Any], npt.ArrayLike] = np.load,
    ) -> Any:
        """Return linearly interpolated values at the points of `xi`, whose last axis has the coordinates.

        `values` has one value, or one array of values, per point: it is an array, or Dask array, or blocks that follow
        each other, as for `delaunay`. The answer for a Dask array `xi` is one with chunks like its; that for anything
        else is computed. Outside the hull of all points it is `fill_value`, where `LinearNDInterpolator` has it. Of
        equal points, the value of the first one counts. A query is in the same simplex as in the mesh of all points;
        only the order in which its corners are summed may differ.

        >>> import dask.array as da
        >>> points = da.random.default_rng(1).random((500, 2), chunks=(250, 2))
        >>> mesh = delaunay(points, tiles=3)
        >>> mesh.interpolate(points[:, 0] + 2 * points[:, 1], [(0.5, 0.25), (9, 9)]).round(12).tolist()
        [1.0, nan]
        """
        stars = self.stars()
        blocks = _blocks(values, read, _as_block)
        shapes, dtypes = zip(*dask.compute(*[dask.delayed(_shape_and_type)(block) for block in blocks]), strict=True)
        if len({shape[1:] for shape in shapes}) != 1:
            raise ValueError(f"the values of all blocks must have one shape, not {sorted({s[1:] for s in shapes})}")
        lengths = [shape[0] for shape in shapes]
        if sum(lengths) != self.npoints:
            raise ValueError(f"there are {sum(lengths)} values for {self.npoints} points")
        dtype = np.result_type(*dtypes)
        if isinstance(fill_value, complex) and dtype.kind != "c":
            raise ValueError("fill_value is complex, but the values are not")
        firsts = [int(first) for first in np.cumsum([0, *lengths[:-1]])]
        task = _tasks(uuid.uuid4().hex[:8])
        parts: list[list[Delayed]] = []
        for tile, each in enumerate(stars):
            indices = task(_stars.indices_of, "indices", tile)(each)
            picks = [task(_stars.pick, "pick", tile, i)(block, firsts[i], indices) for i, block in enumerate(blocks)]
            parts.append(picks)

        def ask(queries: Delayed, task: Callable[..., Any], *block: int) -> Delayed:
            route = task(_stars.to_containing_boxes, "interpolate-route", *block)(queries, self._boxes, self.single)
            answers = [
                task(_stars.interpolate_in, "interpolate-in", *block, tile)(
                    each, parts[tile], dask.delayed(_item)(route, tile)
                )
                for tile, each in enumerate(stars)
            ]
            merge = task(_stars.interpolated_of, "interpolate", *block)
            return merge(queries, answers, self._boxes, self.single, fill_value)

        return self._answer(xi, shapes[0][1:], dtype, ask)

    def _answer(
        self, xi: Any, columns: tuple[int, ...], dtype: np.dtype[Any], ask: Callable[..., Delayed]
    ) -> npt.NDArray[Any] | da.Array:
        """Return what `ask` makes of rows of queries, block by block, each answer with these further axes."""
        if not isinstance(xi, da.Array):
            rows, shape = as_queries(xi, self.ndim)
            blocks = da.from_array(rows, chunks=(_PER_BLOCK, self.ndim), name=False)
            computed: npt.NDArray[Any] = dask.compute(self._answer(blocks, columns, dtype, ask))[0]
            return computed.reshape(shape + columns)
        if xi.ndim == 0 or xi.shape[-1] != self.ndim:
            raise ValueError(f"the last axis of xi must have {self.ndim} coordinates; the shape is {xi.shape}")
        task = _tasks(uuid.uuid4().hex[:8])
        delayed = xi.rechunk({xi.ndim - 1: -1}).to_delayed()[..., 0]
        answers = np.empty(delayed.shape, object)
        for index in np.ndindex(delayed.shape):
            queries = task(_rows, "queries", *index)(delayed[index], self.ndim)
            answer = task(_reshaped, "answers", *index)(ask(queries, task, *index), delayed[index], columns)
            shape = tuple(chunks[i] for chunks, i in zip(xi.chunks, index, strict=False)) + columns
            answers[index] = da.from_delayed(answer, shape, dtype)
        return _joined(answers)

    def to_folder(self, folder: str | os.PathLike[str]) -> None:
        """Write a folder that all workers see, as `gdel triangulate --tiles` does and `gdel verify` proves.

        Files are written whole or not at all, and `mesh.json` at last. A folder with anything else in it is an error.
        """
        path = Path(folder).absolute()
        path.mkdir(parents=True, exist_ok=True)
        names = [f"tile-{tile:05}.npz" for tile in range(len(self.pieces))]
        if others := {entry.name for entry in path.iterdir()} - {"mesh.json", *names}:
            raise FileExistsError(f"{path} is not empty: it has {min(others)}")
        (path / "mesh.json").unlink(missing_ok=True)
        write = dask.delayed(_write)
        counts = dask.compute(*[write(piece, str(path / name)) for piece, name in zip(self.pieces, names, strict=True)])
        index = {
            "gdel": "mesh in tiles",
            "dim": self.ndim,
            "dimension": self.dimension,
            "points": self.npoints,
            "duplicates": sum(duplicates for _, duplicates in counts),
            "simplices": sum(simplices for simplices, _ in counts),
            "tiles": names,
        }
        partial = path / ".mesh.json"
        partial.write_text(json.dumps(index, indent=2))
        partial.replace(path / "mesh.json")


def delaunay(
    points: da.Array | Sequence[Any],
    *,
    tiles: int | None = None,
    threads: int = 1,
    read: Callable[[Any], npt.ArrayLike] = np.load,
) -> Tiles:
    """Return the Delaunay triangulation of points in 2D or 3D, in pieces.

    `points` is a Dask array with a row for each point, or a sequence whose items follow each other: arrays, delayed
    arrays, or names of files, which `read` turns into arrays on the workers. There is a tile for every four million
    points if `tiles` is not given; each task uses so many `threads`.

    This call runs the exchange of points on the default scheduler, or that of the `distributed.Client` if there is one.
    Pieces are computed afterwards, when they are asked for.
    """
    blocks = _blocks(points, read, as_points)
    shapes, dtypes = zip(*dask.compute(*[dask.delayed(_shape_and_type)(block) for block in blocks]), strict=True)
    lengths, columns = zip(*shapes, strict=True)
    if len(set(columns)) != 1 or columns[0] not in (2, 3):
        raise ValueError(f"points must all have 2 or all have 3 coordinates, not {sorted(set(columns))}")
    ndim, npoints = columns[0], sum(lengths)
    if tiles is None:
        tiles = max(1, -(-npoints // _PER_TILE))
    if tiles < 1:
        raise ValueError(f"there must be at least one tile, not {tiles}")
    firsts = [int(first) for first in np.cumsum([0, *lengths[:-1]])]
    task = _tasks(uuid.uuid4().hex[:8])
    every = min(max(npoints // 256, 1), 1000)
    surveys = [task(_survey, "survey", i)(block, firsts[i], every) for i, block in enumerate(blocks)]
    planned, dimension = task(_gdel.tiles_plan, "plan")(surveys, ndim, tiles).compute()
    plan = dask.delayed(planned)
    parts = [task(_split, "split", i)(plan, block, firsts[i]) for i, block in enumerate(blocks)]
    states = [
        task(_begin, "begin", tile)(plan, tile, [dask.delayed(_item)(part, tile) for part in parts])
        for tile in range(tiles)
    ]
    inboxes: list[list[tuple[int, Delayed]]] = [[] for _ in range(tiles)]
    cores: list[Delayed] = []
    step = 0
    while step < 2 or any(inboxes):
        step += 1
        taken = []
        for tile in range(tiles):
            # A tile that receives nothing stays as it is.
            if step > 2 and not inboxes[tile]:
                continue
            senders = [sender for sender, _ in inboxes[tile]]
            messages = [message for _, message in inboxes[tile]]
            taken.append((tile, task(_step, f"step{step}", tile)(plan, states[tile], senders, messages, step, threads)))
        results = dask.persist(*[result for _, result in taken])
        receivers = dask.compute(*[dask.delayed(_receivers)(result) for result in results])
        inboxes = [[] for _ in range(tiles)]
        for (tile, _), result, to in zip(taken, results, receivers, strict=True):
            states[tile] = dask.delayed(_item)(result, "tile")
            if step == 2:
                cores.append(dask.delayed(_item)(result, "core"))
            for receiver in to:
                inboxes[receiver].append((tile, dask.delayed(_message)(result, receiver)))
    whole = [task(_piece, "piece", tile)(plan, states[tile], cores[tile], threads) for tile in range(tiles)]
    links = task(_gdel.tiles_links, "links")([dask.delayed(_item)(piece, "rim") for piece in whole])
    pieces = [task(_linked, "linked", tile)(piece, links, tile) for tile, piece in enumerate(whole)]
    # As all points together would be in single precision.
    single = all(dtype == np.float32 for dtype in dtypes)
    return Tiles(pieces, npoints, ndim, dimension, single=single, threads=threads)


def _tasks(label: str) -> Callable[..., Callable[..., Delayed]]:
    """Return what delays a function under a name and with a key, which together with the label are unique."""

    def task(function: Callable[..., Any], name: str, *key: int) -> Callable[..., Delayed]:
        full = "-".join([f"gdel-{name}", label, *map(str, key)])
        return lambda *arguments: dask.delayed(function)(*arguments, dask_key_name=full)

    return task


def _blocks(
    rows: da.Array | Sequence[Any] | npt.NDArray[Any], read: Callable[[Any], npt.ArrayLike], convert: Callable[..., Any]
) -> list[Delayed]:
    """Return the blocks of points, or of values, that follow each other, after `convert`."""
    if isinstance(rows, da.Array):
        if convert is as_points and rows.ndim != 2:
            raise ValueError(f"points must have two axes, not the shape {rows.shape}")
        rows = rows.rechunk(dict.fromkeys(range(1, rows.ndim), -1)).to_delayed().ravel().tolist()
    if isinstance(rows, (str, os.PathLike, np.ndarray)):
        rows = [rows]
    blocks = []
    for item in rows:
        if isinstance(item, (str, os.PathLike)):
            item = dask.delayed(read)(os.fspath(item))
        blocks.append(dask.delayed(convert)(item))
    if not blocks:
        raise ValueError(f"there are no blocks of {'points' if convert is as_points else 'values'}")
    return blocks


def _as_block(values: npt.ArrayLike) -> npt.NDArray[Any]:
    """Return a block of values as an array."""
    if np.ndim(values) == 0:
        raise ValueError("values must be an array, or blocks that are arrays, not numbers")
    return as_values(values, len(np.asarray(values)))


def _shape_and_type(rows: npt.NDArray[Any]) -> tuple[tuple[int, ...], np.dtype[Any]]:
    return rows.shape, rows.dtype


def _rows(queries: npt.NDArray[Any], ndim: int) -> Points:
    return as_queries(queries, ndim)[0]


def _reshaped(answers: npt.NDArray[Any], queries: npt.NDArray[Any], columns: tuple[int, ...]) -> npt.NDArray[Any]:
    return answers.reshape(queries.shape[:-1] + columns)


def _joined(blocks: npt.NDArray[Any], axis: int = 0) -> da.Array:
    """Return the array of these blocks, which stand as they do in it."""
    if axis == blocks.ndim:
        return blocks.item()
    parts = [_joined(part, axis + 1) for part in np.split(blocks, blocks.shape[axis], axis)]
    return da.concatenate(parts, axis, allow_unknown_chunksizes=True)


def _item(values: Any, key: Any) -> Any:
    return values[key]


def _survey(points: Points, first: int, every: int) -> bytes:
    # What comes from another worker may not be aligned.
    return _gdel.tiles_survey(as_aligned(points), first, every)


def _split(plan: bytes, points: Points, first: int) -> list[tuple[Floats, npt.NDArray[np.uint32]]]:
    return _gdel.tiles_split(plan, as_aligned(points), first)


def _begin(plan: bytes, tile: int, parts: list[tuple[Floats, npt.NDArray[np.uint32]]]) -> bytes:
    points = np.concatenate([points for points, _ in parts])
    return _gdel.tiles_begin(plan, tile, points, np.concatenate([indices for _, indices in parts]))


def _step(
    plan: bytes, tile: bytes, senders: list[int], messages: list[bytes], step: int, threads: int
) -> dict[str, Any]:
    received = list(zip(senders, messages, strict=True))
    after, sent, core = _gdel.tiles_step(plan, tile, received, step, threads)
    return {"tile": after, "sent": dict(sent), "core": core}


def _receivers(result: dict[str, Any]) -> list[int]:
    return list(result["sent"])


def _message(result: dict[str, Any], receiver: int) -> bytes:
    message: bytes = result["sent"][receiver]
    return message


def _piece(plan: bytes, tile: bytes, core: bytes, threads: int) -> dict[str, Any]:
    arrays, rim = _gdel.tiles_piece(plan, tile, core, threads)
    return {"arrays": arrays, "rim": rim}


def _linked(piece: dict[str, Any], links: list[npt.NDArray[np.uint32]], tile: int) -> Piece:
    return {**piece["arrays"], "links": links[tile]}


def _count(piece: Piece) -> int:
    return len(simplices_of(piece))


def _shares(piece: Piece, tiles: int) -> list[tuple[npt.NDArray[np.uint32], Floats]]:
    """Return for each tile its points that are vertices here, and the volumes of the simplices around them here."""
    points, simplices = piece["points"], simplices_of(piece)
    edges = points[simplices[:, 1:]] - points[simplices[:, :1]]
    volumes = np.abs(np.linalg.det(edges)) / (2 if points.shape[1] == 2 else 6)
    sums = np.zeros(len(points))
    for corner in simplices.T:
        sums += np.bincount(corner, volumes, len(points))
    order = np.argsort(piece["tiles"], kind="stable")
    ends = np.searchsorted(piece["tiles"][order], np.arange(1, tiles))
    return [(piece["indices"][part], sums[part]) for part in np.split(order, ends)]


def _sum_shares(
    piece: Piece, shares: list[tuple[npt.NDArray[np.uint32], Floats]], tile: int
) -> tuple[npt.NDArray[np.uint32], Floats]:
    """Return the tile's points and the sums of what all pieces say of them."""
    indices = piece["indices"][piece["tiles"] == tile]
    volumes = np.zeros(len(indices))
    for of, share in shares:
        np.add.at(volumes, np.searchsorted(indices, of), share)
    duplicates = piece["duplicates"]
    at = np.searchsorted(indices, duplicates)
    volumes[at[:, 0]] = volumes[at[:, 1]]
    return indices, volumes


def _write(piece: Piece, path: str) -> tuple[int, int]:
    """Write a piece, and return how many simplices and duplicates it has."""
    partial = f"{path}.{uuid.uuid4().hex[:8]}.tmp"
    try:
        with open(partial, "wb") as file:
            arrays: dict[str, Any] = dict(piece)
            np.savez(file, **arrays)
        os.replace(partial, path)
    finally:
        Path(partial).unlink(missing_ok=True)
    return _count(piece), len(piece["duplicates"])
