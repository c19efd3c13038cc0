"""Values at scattered points on a grid, for xarray. Importing this module registers the accessor ``gdel``.

>>> import numpy, xarray, gdel.xarray  # doctest: +SKIP
>>> stations = xarray.DataArray(
...     [0.0, 1.0, 2.0, 3.0], dims="station",
...     coords={"x": ("station", [0, 1, 0, 1]), "y": ("station", [0, 0, 1, 1])},
... )  # doctest: +SKIP
>>> stations.gdel.grid(x=[0.25, 0.75], y=[0.5])  # doctest: +SKIP
"""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import numpy.typing as npt
import xarray

from gdel._interpolate import griddata


@xarray.register_dataarray_accessor("gdel")  # type: ignore[no-untyped-call]
class GdelAccessor:
    """What gdel does with an array of values at scattered points."""

    def __init__(self, array: xarray.DataArray) -> None:
        """Take the array."""
        self._array = array

    def grid(
        self,
        method: Literal["linear", "nearest", "natural", "sibson", "laplace"] = "linear",
        fill_value: float = np.nan,
        rescale: bool = False,
        **axes: npt.ArrayLike,
    ) -> xarray.DataArray:
        """Return the values on a grid.

        `axes` are the coordinates of the grid by the names of the array's coordinates: ``grid(x=…, y=…)``. Those of the
        array must be along one dimension; its other dimensions stay.
        """
        array = self._array
        names = list(axes)
        dimensions = {array.coords[name].dims for name in names}
        if len(names) not in (2, 3) or len(dimensions) != 1 or len(next(iter(dimensions))) != 1:
            raise ValueError("two or three coordinates along one dimension are needed: grid(x=…, y=…)")
        (dimension,) = next(iter(dimensions))
        values = array.transpose(dimension, ...)
        points = np.stack([np.asarray(array.coords[name], np.float64) for name in names], axis=-1)
        ticks = [np.asarray(axes[name]) for name in names]
        queries = np.stack(np.meshgrid(*(tick.astype(np.float64) for tick in ticks), indexing="ij"), axis=-1)
        found = griddata(points, values.to_numpy(), queries, method, fill_value, rescale)
        others = values.dims[1:]
        coordinates: dict[Any, Any] = dict(zip(names, ticks, strict=True))
        coordinates.update({name: array.coords[name] for name in others if name in array.coords})
        return xarray.DataArray(found, dims=(*names, *others), coords=coordinates, name=array.name, attrs=array.attrs)
