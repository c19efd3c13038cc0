"""Triangulations of tensors in CUDA memory, whose arrays are in CUDA memory, too: NVIDIA's GPUs under Linux.

`gdel.torch` has the same for PyTorch. Any library that speaks DLPack or has a CUDA array interface can be used:

>>> import cupy, gdel.cuda  # doctest: +SKIP
>>> tri = gdel.cuda.Delaunay(cupy.random.rand(100_000, 3, dtype="float32"))  # doctest: +SKIP
>>> cupy.from_dlpack(tri.indices).shape  # doctest: +SKIP
(674046, 4)

What PyTorch, CuPy and others call a GPU's number is that of CUDA. It needs NVIDIA's driver for Vulkan as well.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from functools import cached_property
from typing import Any, Generic, TypeVar

from gdel import _gdel
from gdel._points import Backend, Indices, Progress, as_progress

if not hasattr(_gdel, "triangulate_cuda"):
    raise ImportError("gdel.cuda is there under Linux only")

__all__ = ["Delaunay"]

A = TypeVar("A")


class _State(Generic[A]):
    """The arrays of a mesh until it is updated, each copied when it is asked for, once."""

    def __init__(self, mesh: _gdel.CudaMesh, convert: Callable[[_gdel.MeshArray], A]) -> None:
        self.mesh = mesh
        self.convert = convert

    @cached_property
    def indices(self) -> A:
        return self.convert(self.mesh.simplices())

    @cached_property
    def links(self) -> A:
        return self.convert(self.mesh.neighbors())

    @cached_property
    def hull(self) -> A:
        return self.convert(self.mesh.hull())

    @cached_property
    def vertex_to_simplex(self) -> A:
        return self.convert(self.mesh.vertex_simplex())

    @cached_property
    def adjacency(self) -> tuple[A, A]:
        offsets, neighbors = self.mesh.adjacency()
        return self.convert(offsets), self.convert(neighbors)

    @cached_property
    def survivors(self) -> A | None:
        survivors = self.mesh.survivors()
        return None if survivors is None else self.convert(survivors)


class Triangulation(Generic[A]):
    """What the triangulations of all libraries have in common; `A` is the library's type of arrays."""

    def __init__(self, points: Any, *, backend: Backend = "auto", progress: Progress = None) -> None:
        """Triangulate points."""
        self._backend: Backend = backend
        self._lock = threading.Lock()
        tensor = self._tensor(points)
        mesh = _gdel.triangulate_cuda(tensor, backend, as_progress(progress))
        self._state: _State[A] = _State(mesh, self._converter(tensor))

    @staticmethod
    def _tensor(points: Any) -> Any:
        """Return what is triangulated for what the caller has passed."""
        return points

    @staticmethod
    def _converter(tensor: Any) -> Callable[[_gdel.MeshArray], A]:
        """Return what makes the caller's arrays, on the GPU of a tensor."""
        raise NotImplementedError

    def __repr__(self) -> str:
        """Return a short description."""
        name = f"{type(self).__module__}.Delaunay"
        return f"<{name}: {self.npoints} points, {self.nsimplex} simplices, {self.ndim}D>"

    @property
    def npoints(self) -> int:
        """The number of points."""
        return self._state.mesh.point_count()

    @property
    def ndim(self) -> int:
        """The number of coordinates: 2 or 3."""
        return self._state.mesh.columns()

    @property
    def nsimplex(self) -> int:
        """The number of simplices."""
        return self._state.mesh.simplex_count()

    @property
    def dimension(self) -> int:
        """The affine dimension of the points: where it is less than `ndim`, there are no simplices."""
        return self._state.mesh.dimension()

    @property
    def indices(self) -> A:
        """The vertices of each simplex, positively oriented, of the shape (nsimplex, ndim + 1)."""
        return self._state.indices

    @property
    def neighbors(self) -> A:
        """The simplices opposite the vertices of each simplex; −1 outside. In 2D there are `halfedges` instead."""
        if self.ndim == 2:
            raise AttributeError("in 2D, there are halfedges: the one against half-edge e of triangle t is [t, e]")
        return self._state.links

    @property
    def halfedges(self) -> A:
        """In 2D, for each half-edge of each triangle the one that runs against it; −1 outside.

        Half-edge *e* is that of triangle ``e // 3`` from its vertex ``e % 3`` to the next.
        """
        if self.ndim == 3:
            raise AttributeError("in 3D, there are neighbors")
        return self._state.links

    @property
    def hull(self) -> A:
        """The facets of the convex hull, oriented outwards; in 2D its vertices in their order."""
        return self._state.hull

    @property
    def vertex_to_simplex(self) -> A:
        """The lowest simplex of each vertex; −1 for other points."""
        return self._state.vertex_to_simplex

    @property
    def adjacency(self) -> tuple[A, A]:
        """The neighbours of point *k*, ascending: ``indices[offsets[k]:offsets[k + 1]]`` of ``(offsets, indices)``."""
        return self._state.adjacency

    @property
    def survivors(self) -> A | None:
        """For each simplex the one that had the same vertices before the last `update`, or −1.

        `None` for a triangulation that was not updated.
        """
        return self._state.survivors

    @property
    def duplicate_of(self) -> Indices:
        """For each point the one that stands for it; −1 for vertices. In the memory of the host."""
        return self._state.mesh.duplicate_of()

    @property
    def stats(self) -> dict[str, Any]:
        """What the run says about itself: the backend and why it was taken, seconds per phase, counts."""
        stats: dict[str, Any] = json.loads(self._state.mesh.stats())
        return stats

    def update(self, points: Any, *, progress: Progress = None) -> None:
        """Make this the triangulation of the same points after they have moved.

        Arrays that were returned before stay as they are.
        """
        tensor = self._tensor(points)
        with self._lock:
            self._state.mesh.update(tensor, self._backend, as_progress(progress))
            self._state = _State(self._state.mesh, self._converter(tensor))


class Delaunay(Triangulation[_gdel.CudaArray]):
    """The Delaunay triangulation of points in CUDA memory.

    Parameters
    ----------
    points
        An object with ``__dlpack__`` or ``__cuda_array_interface__``: `float32` or `float64`, of the shape (n, 2) or
        (n, 3), one row after the other. It must not be written during the call.
    backend
        ``"auto"`` takes the GPU where it is faster, ``"cpu"`` and ``"gpu"`` force one.
    progress
        A callable of the phase and the share that is done, or `True` for tqdm. It may raise to stop the run.

    Arrays are of `int32` and have ``__dlpack__`` and ``__cuda_array_interface__``. They stay in the memory of the GPU,
    and are ready when they are returned.
    """

    @staticmethod
    def _converter(tensor: Any) -> Callable[[_gdel.MeshArray], _gdel.CudaArray]:
        """Return what makes the caller's arrays, on the GPU of a tensor."""
        return _gdel.MeshArray.to_cuda
