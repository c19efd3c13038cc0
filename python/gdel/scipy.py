"""Classes that fail as SciPy's do: points without simplices raise `QhullError`.

>>> import gdel.scipy
>>> gdel.scipy.Delaunay([(0, 0), (1, 1), (2, 2)])
Traceback (most recent call last):
    ...
gdel.scipy.QhullError: the points are flat: they span 1 of 2 dimensions
"""

from __future__ import annotations

from typing import Any

from gdel import (
    CloughTocher2DInterpolator,
    LinearNDInterpolator,
    NaturalNeighborInterpolator,
    griddata,
    tsearch,
)
from gdel import Delaunay as _Delaunay
from gdel import Voronoi as _Voronoi

__all__ = [
    "CloughTocher2DInterpolator",
    "Delaunay",
    "LinearNDInterpolator",
    "NaturalNeighborInterpolator",
    "QhullError",
    "Voronoi",
    "griddata",
    "tsearch",
]


class QhullError(RuntimeError):
    """The points have no simplices."""


def _check(tri: _Delaunay) -> None:
    if tri.dimension < tri.ndim:
        raise QhullError(f"the points are flat: they span {tri.dimension} of {tri.ndim} dimensions")


class Delaunay(_Delaunay):
    """`gdel.Delaunay` that raises `QhullError` for flat points."""

    def __init__(self, *args: Any, **options: Any) -> None:
        """Triangulate points."""
        super().__init__(*args, **options)
        _check(self)


class Voronoi(_Voronoi):
    """`gdel.Voronoi` that raises `QhullError` for flat points."""

    def __init__(self, *args: Any, **options: Any) -> None:
        """Compute the diagram of points."""
        super().__init__(*args, **options)
        _check(self.tri)
