"""Interpolation of values at points."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from gdel._constrained import ConstrainedDelaunay
from gdel._delaunay import Delaunay, State
from gdel._points import Backend, Floats, as_aligned, as_floats, as_points, as_values

Method: TypeAlias = Literal["linear", "laplace", "sibson", "sibson-c1", "clough-tocher"]
Outside: TypeAlias = Literal["fill", "nearest", "linear"]
Duplicates: TypeAlias = Literal["first", "mean", "error"]


def as_coordinates(points: Any, name: str, ndim: int | None = None) -> npt.NDArray[Any]:
    """Return coordinates along the last axis, from an array or from a tuple with one array per coordinate."""
    if isinstance(points, tuple) and len(points) == 1:
        points = points[0]
    if isinstance(points, tuple):
        return np.stack([as_floats(x, name) for x in np.broadcast_arrays(*points)], axis=-1)
    array = as_floats(points, name)
    if array.ndim == 1:
        array = array.reshape(-1, 1) if ndim is None else array.reshape(-1, ndim)
    return array


@dataclass(frozen=True)
class Options:
    """How values are interpolated."""

    method: Method
    outside: Outside
    duplicates: Duplicates
    backend: Backend
    threads: int | None


class Interpolator:
    """What the interpolators have in common."""

    tri: Delaunay
    values: npt.NDArray[Any]
    fill_value: complex
    is_complex: bool

    def __init__(
        self,
        points: Any,
        values: npt.ArrayLike,
        fill_value: complex,
        rescale: bool,
        options: Options,
    ) -> None:
        """Triangulate the points, unless they are a triangulation, and take the values."""
        self._offset: Floats | None = None
        self._scale: Floats | None = None
        if isinstance(points, Delaunay):
            if rescale:
                raise ValueError("Rescaling is not supported when passing a Delaunay triangulation as ``points``.")
            self.tri = points
        else:
            array = as_points(as_coordinates(points, "points"))
            if rescale and len(array):
                self._offset = array.mean(axis=0, dtype=np.float64)
                scale = np.ptp(array, axis=0).astype(np.float64)
                scale[~(scale > 0)] = 1.0
                self._scale = scale
                array = (array - self._offset) / scale
            self.tri = Delaunay(array, backend=options.backend, threads=options.threads)
        self.points = self.tri.points
        self.values = as_values(values, self.tri.npoints)
        self.is_complex = self.values.dtype.kind == "c"
        if isinstance(fill_value, complex) and not self.is_complex:
            raise ValueError("fill_value is complex, but the values are not")
        self.fill_value = fill_value
        self.options = options
        self._gradients: tuple[State, npt.NDArray[Any]] | None = None

    @property
    def grad(self) -> npt.NDArray[Any]:
        """The gradients of the values at the points, of shape (npoints, columns of values, ndim).

        They are found when they are first needed, and again if the points have moved. They can be changed in place.
        """
        state = self.tri._state
        if self._gradients is None or self._gradients[0] is not state:
            columns = self.values.reshape(len(self.values), -1)
            found = np.empty((*columns.shape, state.points.shape[1]), columns.dtype)
            for k in range(columns.shape[1]):
                for part, values in zip(_parts(found[:, k]), _parts(columns[:, k]), strict=True):
                    values = np.ascontiguousarray(values)
                    part[:] = state.mesh.gradients(state.points, values, self.options.duplicates)
            self._gradients = (state, found)
        return self._gradients[1]

    def __getstate__(self) -> dict[str, Any]:
        """Return what is pickled, the gradients too, if they are those of the mesh."""
        known = self._gradients is not None and self._gradients[0] is self.tri._state
        return self.__dict__ | {"_gradients": self.grad if known else None}

    def __setstate__(self, pickled: dict[str, Any]) -> None:
        """Take what was pickled."""
        self.__dict__.update(pickled)
        self.values = as_aligned(self.values)
        if self._gradients is not None:
            self._gradients = (self.tri._state, as_aligned(pickled["_gradients"]))

    def __call__(self, *args: Any) -> npt.NDArray[Any]:
        """Return the values at points: an array with the coordinates in the last axis, or one array per coordinate."""
        state = self.tri._state
        ndim = state.points.shape[1]
        xi = as_coordinates(args[0] if len(args) == 1 else args, "xi", ndim)
        if xi.shape[-1] != ndim:
            raise ValueError(f"number of dimensions in xi does not match x: {xi.shape[-1]}, not {ndim}")
        shape = xi.shape[:-1]
        queries = xi.reshape(-1, ndim)
        if self._offset is not None and self._scale is not None:
            queries = (queries - self._offset) / self._scale
        queries = np.ascontiguousarray(queries)
        columns = self.values.reshape(len(self.values), -1)
        gradients = self.grad if self.options.method in ("sibson-c1", "clough-tocher") else None
        found = np.empty((len(queries), columns.shape[1]), columns.dtype)
        for k in range(columns.shape[1]):
            slopes = itertools.repeat(None) if gradients is None else _parts(gradients[:, k])
            fills = (complex(self.fill_value).real, complex(self.fill_value).imag)
            parts = zip(_parts(found[:, k]), _parts(columns[:, k]), slopes, fills, strict=False)
            for part, values, slope, fill in parts:
                part[:] = self._interpolated(values, slope, queries, fill)
        return found.reshape(shape + self.values.shape[1:])

    def _interpolated(
        self, column: npt.NDArray[Any], gradients: npt.NDArray[Any] | None, queries: npt.NDArray[Any], fill: float
    ) -> Floats:
        state, options = self.tri._state, self.options
        values = np.ascontiguousarray(column)
        slopes = None if gradients is None else np.ascontiguousarray(gradients)
        method = (options.method, options.outside, fill, options.duplicates)
        inside = self.tri.inside if isinstance(self.tri, ConstrainedDelaunay) else None
        return state.mesh.interpolate(state.points, (values, slopes, inside), queries, method)


def _parts(array: npt.NDArray[Any]) -> list[npt.NDArray[Any]]:
    """Return the real and the imaginary part of complex numbers, or the array of real ones."""
    return [array.real, array.imag] if array.dtype.kind == "c" else [array]


class LinearNDInterpolator(Interpolator):
    """Linear interpolation on a triangulation, in the shape of `scipy.interpolate.LinearNDInterpolator`.

    Parameters
    ----------
    points
        The points, as an array or as a tuple of their coordinates, or a `Delaunay` of them.
    values
        One value, or one array of values, per point, real or complex.
    fill_value
        The value outside the convex hull.
    rescale
        Whether the points are scaled to the unit cube before they are triangulated.
    simplex_tolerance
        Accepted and ignored: points outside the hull by no more than rounding count as inside.
    outside
        ``"fill"`` for `fill_value` outside the hull, ``"nearest"`` for the nearest value, ``"linear"`` to continue
        along gradients.
    duplicates
        Which value a vertex has if several points are equal: the ``"first"``, the ``"mean"``, or an ``"error"`` if they
        differ.

    >>> inside = LinearNDInterpolator([(0, 0), (2, 0), (0, 2)], [0.0, 2.0, 4.0])
    >>> inside([(0.5, 0.5), (9, 9)]).tolist()
    [1.5, nan]
    """

    def __init__(
        self,
        points: Any,
        values: npt.ArrayLike,
        fill_value: complex = np.nan,
        rescale: bool = False,
        *,
        simplex_tolerance: float | None = None,
        outside: Outside = "fill",
        duplicates: Duplicates = "first",
        backend: Backend = "auto",
        threads: int | None = None,
    ) -> None:
        """Triangulate the points."""
        super().__init__(points, values, fill_value, rescale, Options("linear", outside, duplicates, backend, threads))


class NaturalNeighborInterpolator(Interpolator):
    """Natural neighbour interpolation: smooth, and exact for linear functions.

    `method` is ``"sibson"``, whose values are smooth except at the points, ``"sibson-c1"``, which are smooth there,
    too, or ``"laplace"``, which takes less time. The others are those of `LinearNDInterpolator`.

    >>> smooth = NaturalNeighborInterpolator([(0, 0), (1, 0), (1, 1), (0, 1)], [1.0, 0.0, 0.0, 0.0])
    >>> float(smooth(0.5, 0.5))
    0.25
    """

    def __init__(
        self,
        points: Any,
        values: npt.ArrayLike,
        fill_value: complex = np.nan,
        rescale: bool = False,
        *,
        method: Literal["sibson", "sibson-c1", "laplace"] = "sibson",
        outside: Outside = "fill",
        duplicates: Duplicates = "first",
        backend: Backend = "auto",
        threads: int | None = None,
    ) -> None:
        """Triangulate the points."""
        if method not in ("sibson", "sibson-c1", "laplace"):
            raise ValueError(f"method must be 'sibson', 'sibson-c1' or 'laplace', not {method!r}")
        super().__init__(points, values, fill_value, rescale, Options(method, outside, duplicates, backend, threads))


class CloughTocher2DInterpolator(Interpolator):
    """A smooth, piecewise cubic interpolant in 2D, in the shape of `scipy.interpolate.CloughTocher2DInterpolator`.

    `tol` and `maxiter` are accepted and ignored: the gradients are found to the last bit in a fixed number of steps.
    They are the attribute `grad`. The others are those of `LinearNDInterpolator`.

    >>> smooth = CloughTocher2DInterpolator([(0, 0), (2, 0), (0, 2), (2, 2)], [0.0, 2.0, 4.0, 6.0])
    >>> round(float(smooth(0.5, 0.25)), 12)
    1.0
    """

    def __init__(
        self,
        points: Any,
        values: npt.ArrayLike,
        fill_value: complex = np.nan,
        tol: float = 1e-6,
        maxiter: int = 400,
        rescale: bool = False,
        *,
        outside: Outside = "fill",
        duplicates: Duplicates = "first",
        backend: Backend = "auto",
        threads: int | None = None,
    ) -> None:
        """Triangulate the points."""
        options = Options("clough-tocher", outside, duplicates, backend, threads)
        super().__init__(points, values, fill_value, rescale, options)
        if self.tri.ndim != 2:
            raise ValueError("Clough-Tocher interpolation is for points in 2D; in 3D, use NaturalNeighborInterpolator")


def griddata(
    points: Any,
    values: npt.ArrayLike,
    xi: Any,
    method: Literal["linear", "nearest", "cubic", "natural", "sibson", "laplace"] = "linear",
    fill_value: float = np.nan,
    rescale: bool = False,
    *,
    outside: Outside = "fill",
    duplicates: Duplicates = "first",
    backend: Backend = "auto",
    threads: int | None = None,
) -> npt.NDArray[Any]:
    """Interpolate values at points in 1D, 2D or 3D, in the shape of `scipy.interpolate.griddata`.

    `method` is ``"linear"``, ``"nearest"``, ``"cubic"`` in 2D (`CloughTocher2DInterpolator`) and, by SciPy, in 1D,
    ``"natural"`` (or ``"sibson"``), or ``"laplace"``.

    >>> griddata([(0, 0), (2, 0), (0, 2)], [0.0, 2.0, 4.0], ([0.5, 1.9], [0.5, 0.0]), method="nearest").tolist()
    [0.0, 2.0]
    """
    along = points.points if isinstance(points, Delaunay) else as_coordinates(points, "points")
    if along.ndim == 2 and along.shape[1] == 1:
        return _on_a_line(along[:, 0], values, xi, method, fill_value)
    if method == "nearest":
        options = Options("linear", "fill", "first", backend, threads)
        nearest = Interpolator(points, values, np.nan, rescale, options)
        ndim = nearest.tri.ndim
        queries = as_coordinates(xi, "xi", ndim)
        if queries.shape[-1] != ndim:
            raise ValueError(f"number of dimensions in xi does not match x: {queries.shape[-1]}, not {ndim}")
        if nearest._offset is not None and nearest._scale is not None:
            queries = (queries - nearest._offset) / nearest._scale
        return _take_nearest(nearest, queries)
    if method == "linear":
        linear = Options("linear", outside, duplicates, backend, threads)
        return Interpolator(points, values, fill_value, rescale, linear)(xi)
    if method in ("natural", "sibson", "laplace"):
        natural = Options("laplace" if method == "laplace" else "sibson", outside, duplicates, backend, threads)
        return Interpolator(points, values, fill_value, rescale, natural)(xi)
    if method == "cubic" and along.shape[-1] == 2:
        cubic = Options("clough-tocher", outside, duplicates, backend, threads)
        return Interpolator(points, values, fill_value, rescale, cubic)(xi)
    names = "'linear', 'nearest', 'cubic' in 2D, 'natural' or 'laplace'"
    raise ValueError(f"unknown interpolation method {method!r} in {along.shape[-1]}D: {names}")


def _on_a_line(
    points: npt.NDArray[Any], values: npt.ArrayLike, xi: Any, method: str, fill_value: float
) -> npt.NDArray[Any]:
    """Interpolate in 1D: linearly, but for the nearest value and SciPy's cubic splines."""
    if method == "cubic":
        from scipy.interpolate import griddata as of_scipy

        splines: npt.NDArray[Any] = of_scipy(points, values, xi, "cubic", fill_value)
        return splines
    if method not in ("linear", "nearest", "natural", "sibson", "laplace"):
        names = "'linear', 'nearest', 'cubic', 'natural' or 'laplace'"
        raise ValueError(f"unknown interpolation method {method!r}: {names}")
    values = as_values(values, len(points))
    order = np.argsort(points, kind="stable")
    points, values = points[order], values[order]
    queries = as_coordinates(xi, "xi", 1)
    queries = queries[..., 0] if queries.shape[-1] == 1 else queries
    if method == "nearest":
        middles = (points[1:] + points[:-1]) / 2
        found: npt.NDArray[Any] = values[np.searchsorted(middles, queries)]
        return found
    columns = values.reshape(len(values), -1).T
    parts = [np.interp(queries, points, column, fill_value, fill_value) for column in columns]
    return np.stack(parts, axis=-1).reshape(queries.shape + values.shape[1:])


def _take_nearest(nearest: Interpolator, queries: npt.NDArray[Any]) -> npt.NDArray[Any]:
    vertices = nearest.tri.nearest(queries)
    found = nearest.values[vertices]
    if (vertices < 0).any():
        found = found.astype(np.result_type(found, np.float64))
        found[vertices < 0] = np.nan
    return found
