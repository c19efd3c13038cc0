"""Meshes for other packages, each imported where it is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import geopandas
    import matplotlib.tri
    import meshio
    import pyvista
    import trimesh

Array = npt.NDArray[Any]


def _in_space(points: Array) -> Array:
    """Return points in 3D."""
    if points.shape[1] == 3:
        return points
    return np.column_stack([points, np.zeros(len(points), points.dtype)])


def to_pyvista(points: Array, simplices: Array) -> pyvista.UnstructuredGrid:
    """Return a grid of tetrahedra or triangles."""
    import pyvista

    corners = simplices.shape[1]
    cell_type = pyvista.CellType.TETRA if corners == 4 else pyvista.CellType.TRIANGLE
    # VTK has 64-bit indices.
    return pyvista.UnstructuredGrid({cell_type: simplices.astype(np.int64)}, _in_space(points))


def to_polydata(points: Array, facets: Array) -> pyvista.PolyData:
    """Return triangles, or lines in 2D."""
    import pyvista

    cells = np.column_stack([np.full(len(facets), facets.shape[1]), facets]).ravel()
    if facets.shape[1] == 2:
        return pyvista.PolyData(_in_space(points), lines=cells)
    return pyvista.PolyData(_in_space(points), faces=cells)


def to_meshio(points: Array, simplices: Array) -> meshio.Mesh:
    """Return a mesh that meshio writes."""
    import meshio

    return meshio.Mesh(points, [("tetra" if simplices.shape[1] == 4 else "triangle", simplices)])


def to_trimesh(vertices: Array, facets: Array) -> trimesh.Trimesh:
    """Return the triangles as they are."""
    import trimesh

    if facets.shape[1] != 3:
        raise ValueError("trimesh has triangles: the points must be in 3D")
    return trimesh.Trimesh(vertices, facets, process=False)


def to_matplotlib(points: Array, simplices: Array) -> matplotlib.tri.Triangulation:
    """Return a triangulation that matplotlib draws."""
    import matplotlib.tri

    if simplices.shape[1] != 3:
        raise ValueError("matplotlib draws triangulations in 2D")
    return matplotlib.tri.Triangulation(points[:, 0], points[:, 1], simplices)


def to_geopandas(polygons: list[Array], points: Array, crs: Any) -> geopandas.GeoDataFrame:
    """Return polygons with the points that they belong to."""
    import geopandas
    import shapely

    shapes = [shapely.Polygon(corners) if len(corners) > 2 else shapely.Polygon() for corners in polygons]
    return geopandas.GeoDataFrame({"x": points[:, 0], "y": points[:, 1]}, geometry=shapes, crs=crs)
