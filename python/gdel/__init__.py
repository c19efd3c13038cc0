"""Exact Delaunay triangulation of points in 2D and 3D, on the CPU and the GPU, in SciPy's shape.

>>> import gdel
>>> tri = gdel.Delaunay([(0, 0), (2, 0), (2, 1), (0, 1)])
>>> tri.nsimplex
2
>>> int(tri.find_simplex((9, 9)))
-1

Every sign is exact: grids, spheres, duplicates and flat input are ordinary input, and no simplex is flat.
"""

from gdel._balls import BallComplex
from gdel._constrained import ConstrainedDelaunay, Refinement
from gdel._delaunay import Delaunay, VerifyReport, tsearch
from gdel._derived import AlphaShape, SpanningTree, Surface, alpha_shape, minimum_spanning_tree, nearest, surface
from gdel._gdel import CrossingError, GpuError, __version__, adapters
from gdel._interpolate import (
    CloughTocher2DInterpolator,
    LinearNDInterpolator,
    NaturalNeighborInterpolator,
    griddata,
)
from gdel._tin import Tin, tin
from gdel._transport import Transport, transport
from gdel._voronoi import Voronoi

__all__ = [
    "AlphaShape",
    "BallComplex",
    "CloughTocher2DInterpolator",
    "ConstrainedDelaunay",
    "CrossingError",
    "Delaunay",
    "GpuError",
    "LinearNDInterpolator",
    "NaturalNeighborInterpolator",
    "Refinement",
    "SpanningTree",
    "Surface",
    "Tin",
    "Transport",
    "VerifyReport",
    "Voronoi",
    "__version__",
    "adapters",
    "alpha_shape",
    "griddata",
    "minimum_spanning_tree",
    "nearest",
    "surface",
    "tin",
    "transport",
    "tsearch",
]
