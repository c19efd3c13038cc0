"""Semi-discrete optimal transport: weights with which cells have given volumes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy.typing as npt

from gdel import _gdel
from gdel._points import Clip, Floats, Progress, as_clip, as_numbers, as_points, as_progress


@dataclass(frozen=True)
class Transport:
    """Weights with which cells of the power diagram have given volumes."""

    weights: Floats
    """The weight of each point, of which the least is 0: ``Delaunay(points, weights=weights)`` has these cells. Equal
    points have equal ones. The unit is that of the coordinates, squared."""
    volumes: Floats
    """The volume of each point's cell, the area in 2D. Equal points share a cell by their masses; `Voronoi` has all of
    it for the first of them, and 0 for the others."""
    error: float
    """The largest difference between the mass of a cell and its volume, as a share of the mass: at most `tolerance`."""
    steps: int
    """The number of Newton's steps."""

    def __repr__(self) -> str:
        """Return a short description."""
        return f"<gdel.Transport: {len(self.weights)} points, error {self.error:.1e}, {self.steps} steps>"


def transport(
    points: npt.ArrayLike,
    masses: npt.ArrayLike | None = None,
    *,
    normalize: bool = False,
    tolerance: float = 1e-3,
    clip: Clip = "box",
    threads: int | None = None,
    progress: Progress = None,
) -> Transport:
    """Return weights with which each point's cell of the power diagram has a given volume: its mass.

    The cells are the parts of a shape that go to the points if it is divided among them at the least sum of squared
    distances. Such weights exist for any positive masses and are unique up to a constant. They are found by Newton's
    method, in a few steps, each of which triangulates the points once or a few times (Kitagawa, Mérigot and Thibert,
    *Convergence of a Newton algorithm for semi-discrete optimal transport*, 2019). The CPU computes them; they are the
    same for any number of threads.

    Parameters
    ----------
    points
        One row per point, with 2 or 3 columns, as for `Delaunay`. They may be outside the shape, in a plane or on a
        line. Equal points share a cell, and count as one with the sum of their masses.
    masses
        One positive number per point: the volume that its cell is to have, in 2D the area. By default all are equal.
    normalize
        Whether masses are only compared with each other, as the numbers of a treemap are. By default their sum has to
        be the volume of the shape, within a millionth.
    tolerance
        The share of its mass by which the volume of a cell may differ from it, between 0 and 1.
    clip
        The shape: ``"box"`` (the smallest one that contains all points), ``"hull"``, a box as its lowest and highest
        corner, or a convex polygon or polyhedron as its corners, in any order: 3 or more rows. `Voronoi` takes the
        same.
    threads, progress
        As for `Delaunay`. The share that is done is that of the logarithm of the error, in the phase ``"transport"``.

    Raises
    ------
    ValueError
        If a mass or a coordinate is not what it has to be, masses are not one per point or do not fit the shape, or
        the shape has no inside; or if rounding keeps cells from being as exact as `tolerance` demands, as it may where
        points are 10⁻⁹ of the shape apart.

    >>> points, box = [(1, 1), (15, 2), (8, 4), (2, 8), (14, 7)], [(0, 0), (16, 9)]
    >>> found = transport(points, [40, 25, 20, 10, 5], normalize=True, clip=box)
    >>> from gdel import Delaunay, Voronoi
    >>> areas = Voronoi(Delaunay(points, weights=found.weights), clip=box).volumes
    >>> [round(float(percent)) for percent in 100 * areas / areas.sum()]
    [40, 25, 20, 10, 5]
    """
    array = as_points(points)
    wanted = None if masses is None else as_numbers(masses, "masses"), bool(normalize), float(tolerance)
    corners = as_clip(clip, array.shape[1])
    return Transport(**_gdel.transport(array, corners, wanted, threads, as_progress(progress)))
