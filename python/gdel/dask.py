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

from gdel import _gdel
from gdel._points import Floats, Points, as_points

__all__ = ["Tiles", "delaunay"]

Piece = dict[str, npt.NDArray[Any]]

#: So many points are in a tile if the caller does not say how many tiles there are to be.
_PER_TILE = 4_000_000


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

    def __init__(self, pieces: list[Delayed], npoints: int, ndim: int, dimension: int) -> None:
        """Create the mesh of these pieces; `delaunay` does."""
        self.pieces, self.npoints, self.ndim, self.dimension = pieces, npoints, ndim, dimension

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
    mesh = f"gdel-{uuid.uuid4().hex[:8]}"
    blocks = _blocks(points, read, mesh)
    lengths, columns = zip(*dask.compute(*[dask.delayed(_shape)(block) for block in blocks]), strict=True)
    if len(set(columns)) != 1 or columns[0] not in (2, 3):
        raise ValueError(f"points must all have 2 or all have 3 coordinates, not {sorted(set(columns))}")
    ndim, npoints = columns[0], sum(lengths)
    if tiles is None:
        tiles = max(1, -(-npoints // _PER_TILE))
    if tiles < 1:
        raise ValueError(f"there must be at least one tile, not {tiles}")
    firsts = [int(first) for first in np.cumsum([0, *lengths[:-1]])]

    def task(function: Callable[..., Any], name: str, *key: int) -> Callable[..., Delayed]:
        label = "-".join([f"gdel-{name}", mesh[5:], *map(str, key)])
        return lambda *arguments: dask.delayed(function)(*arguments, dask_key_name=label)

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
    return Tiles(pieces, npoints, ndim, dimension)


def _blocks(points: da.Array | Sequence[Any], read: Callable[[Any], npt.ArrayLike], mesh: str) -> list[Delayed]:
    """Return the blocks of points that follow each other."""
    if isinstance(points, da.Array):
        if points.ndim != 2:
            raise ValueError(f"points must have two axes, not the shape {points.shape}")
        return [dask.delayed(as_points)(block) for block in points.rechunk({1: -1}).to_delayed().ravel()]
    if isinstance(points, (str, os.PathLike, np.ndarray)):
        points = [points]
    blocks = []
    for item in points:
        if isinstance(item, (str, os.PathLike)):
            item = dask.delayed(read)(os.fspath(item))
        blocks.append(dask.delayed(as_points)(item))
    if not blocks:
        raise ValueError("there are no blocks of points")
    return blocks


def _shape(points: Points) -> tuple[int, int]:
    return points.shape[0], points.shape[1]


def _item(values: Any, key: Any) -> Any:
    return values[key]


def _survey(points: Points, first: int, every: int) -> bytes:
    return _gdel.tiles_survey(points, first, every)


def _split(plan: bytes, points: Points, first: int) -> list[tuple[Floats, npt.NDArray[np.uint32]]]:
    return _gdel.tiles_split(plan, points, first)


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


def _simplices(piece: Piece) -> npt.NDArray[np.uint32]:
    return piece["tetrahedra"] if "tetrahedra" in piece else piece["triangles"]


def _count(piece: Piece) -> int:
    return len(_simplices(piece))


def _shares(piece: Piece, tiles: int) -> list[tuple[npt.NDArray[np.uint32], Floats]]:
    """Return for each tile its points that are vertices here, and the volumes of the simplices around them here."""
    points, simplices = piece["points"], _simplices(piece)
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
