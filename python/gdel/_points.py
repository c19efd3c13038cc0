"""Points of the caller as arrays that Rust can borrow."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

Backend: TypeAlias = Literal["auto", "cpu", "gpu"]
Progress: TypeAlias = bool | Callable[[str, float], object] | None
Clip: TypeAlias = Literal["box", "hull"] | npt.ArrayLike
Points: TypeAlias = npt.NDArray[np.float32] | npt.NDArray[np.float64]
Indices: TypeAlias = npt.NDArray[np.int32]
Floats: TypeAlias = npt.NDArray[np.float64]


def as_floats(values: npt.ArrayLike, name: str) -> Points:
    """Return an array of floating-point numbers, contiguous and without a copy where there already is one."""
    if type(values) is np.ndarray and (values.dtype == np.float64 or values.dtype == np.float32):
        # What nearly all callers pass.
        if values.flags.c_contiguous and values.flags.aligned:
            return values
        return np.array(values, order="C")
    if np.ma.isMaskedArray(values):
        raise ValueError(f"{name} cannot be a masked array: drop the masked rows")
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise ValueError(f"{name} cannot be an array: {_ragged(values) or error}") from None
    if array.dtype == object:
        array = _from_objects(array, name)
    elif array.dtype.kind not in "fiub":
        raise TypeError(f"{name} must be real numbers, not {array.dtype}")
    dtype = np.float32 if array.dtype.kind == "f" and array.dtype.itemsize <= 4 else np.float64
    return np.require(array, dtype, ["C", "A"])


def as_aligned(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return an array that Rust can borrow: a copy if it lies where a message from another process has left it."""
    return np.require(array, requirements=["C", "A"])


def as_number(value: float, name: str) -> float:
    """Return a number, which can be one of NumPy's."""
    if not isinstance(value, (str, bytes, bytearray)):
        try:
            return float(value)
        except TypeError:
            pass
    raise TypeError(f"{name} must be a number, not {value!r}")


def as_numbers(values: npt.ArrayLike, name: str) -> Floats:
    """Return numbers as an array of one axis."""
    array = as_floats(values, name)
    if array.ndim != 1:
        raise ValueError(f"{name} must have one axis, not the shape {array.shape}")
    numbers: Floats = array.astype(np.float64, copy=False)
    return numbers


def as_clip(clip: Clip | None, ndim: int) -> str | Floats | None:
    """Return what cells are clipped to: nothing, a name, or an array of corners, two of which are those of a box."""
    if clip is None or isinstance(clip, str):
        return clip
    corners = as_floats(clip, "clip")
    if corners.ndim != 2 or corners.shape[1] != ndim or len(corners) < 2:
        raise ValueError(f"clip must have one row of {ndim} coordinates per corner, two for a box: {corners.shape}")
    if not np.isfinite(corners).all():
        raise ValueError("clip must have finite coordinates")
    # A copy, which the caller does not change.
    return np.array(corners, np.float64)


def as_weights(weights: npt.ArrayLike | None, radii: npt.ArrayLike | None) -> Floats | None:
    """Return weights as an array of one axis, or those of radii, which are their squares."""
    if weights is not None and radii is not None:
        raise ValueError("weights and radii cannot both be given: weights are the squares of radii")
    name, given = ("weights", weights) if radii is None else ("radii", radii)
    if given is None:
        return None
    numbers = as_numbers(given, name)
    if radii is None:
        return numbers
    bad = np.flatnonzero(~(numbers >= 0))
    if len(bad):
        raise ValueError(f"radius {bad[0]} is not a number from 0 on")
    squares: Floats = numbers**2
    return squares


def as_points(values: npt.ArrayLike, name: str = "points") -> Points:
    """Return points as an array of 2 or 3 columns."""
    array = as_floats(values, name)
    if array.ndim != 2:
        raise ValueError(f"{name} must be an array of one row per point, not one of shape {array.shape}")
    if array.shape[1] not in (2, 3):
        raise ValueError(
            f"{name} must have 2 or 3 coordinates, not {array.shape[1]}: "
            "scipy.spatial.Delaunay takes points of other dimensions"
        )
    return array


def as_queries(values: npt.ArrayLike, ndim: int) -> tuple[Points, tuple[int, ...]]:
    """Return queries as rows, and the shape that the answers have."""
    array = as_floats(values, "xi")
    if array.ndim == 0 or array.shape[-1] != ndim:
        raise ValueError(f"the last axis of xi must have {ndim} coordinates; the shape is {array.shape}")
    return array.reshape(-1, ndim), array.shape[:-1]


def as_values(values: npt.ArrayLike, count: int) -> npt.NDArray[Any]:
    """Return one row of values per point, real or complex."""
    array = np.asarray(values)
    if array.dtype == object:
        array = _from_objects(array, "values")
    if array.dtype.kind not in "fiubc":
        raise TypeError(f"values must be numbers, not {array.dtype}")
    if array.ndim == 0 or len(array) != count:
        raise ValueError(f"there are {len(array) if array.ndim else 1} values for {count} points")
    return array.astype(np.complex128 if array.dtype.kind == "c" else np.float64, copy=False)


def _from_objects(array: npt.NDArray[Any], name: str) -> npt.NDArray[np.float64]:
    for i, row in enumerate(array if array.ndim else [array]):
        try:
            np.asarray(row).astype(np.float64)
        except (TypeError, ValueError) as error:
            raise TypeError(f"{name}[{i}] is not a row of numbers: {error}") from None
    try:
        return array.astype(np.float64)
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name} are not numbers: {error}") from None


def _ragged(values: npt.ArrayLike) -> str | None:
    if not isinstance(values, Sequence) or not values:
        return None
    lengths = [len(row) if isinstance(row, (Sequence, np.ndarray)) else 0 for row in values]
    for i, length in enumerate(lengths):
        if length != lengths[0]:
            return f"row {i} has {length} entries, and row 0 has {lengths[0]}"
    return None


class Bar:
    """Shows progress by tqdm."""

    def __init__(self, bar: Any) -> None:
        """Take a bar that goes to 1."""
        self.bar = bar

    def __call__(self, phase: str, fraction: float) -> None:
        """Move the bar."""
        self.bar.set_description_str(phase, refresh=False)
        self.bar.update(fraction - self.bar.n)
        if fraction >= 1:
            self.bar.close()


def as_progress(progress: Progress) -> Callable[[str, float], object] | None:
    """Return what is called with the phase and the share that is done; with `True` that is tqdm, if it is there."""
    if progress is None or progress is False:
        return None
    if progress is True:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            return None
        return Bar(tqdm(total=1.0, bar_format="{desc}: {percentage:3.0f} %|{bar}| {elapsed}"))
    if not callable(progress):
        raise TypeError("progress must be a callable of a phase and a share, or True")
    return progress
