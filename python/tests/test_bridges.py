"""Other packages, where they are installed."""

import subprocess
import sys

import numpy as np
import pytest

import gdel

PLANE = gdel.Delaunay(np.random.default_rng(0).random((30, 2)))
SPACE = gdel.Delaunay(np.random.default_rng(0).random((30, 3)))


def test_nothing_is_imported_before_it_is_asked_for():
    code = (
        "import sys, gdel; print([n for n in ('scipy', 'pyvista', 'matplotlib', 'xarray', 'tqdm') if n in sys.modules])"
    )
    assert subprocess.check_output([sys.executable, "-c", code], text=True).strip() == "[]"


def test_pyvista():
    pytest.importorskip("pyvista")
    grid = SPACE.to_pyvista()
    assert (grid.n_cells, grid.n_points) == (SPACE.nsimplex, 30)
    assert grid.volume == pytest.approx(SPACE.volumes.sum())
    assert PLANE.to_pyvista().n_cells == PLANE.nsimplex
    assert gdel.alpha_shape(SPACE).to_pyvista().n_cells > 0
    assert gdel.surface(PLANE).to_pyvista().n_lines > 0


def test_meshio(tmp_path):
    meshio = pytest.importorskip("meshio")
    SPACE.to_meshio().write(tmp_path / "mesh.vtu")
    np.testing.assert_array_equal(meshio.read(tmp_path / "mesh.vtu").cells_dict["tetra"], SPACE.simplices)
    assert PLANE.to_meshio().cells[0].type == "triangle"


def test_trimesh():
    pytest.importorskip("trimesh")
    z, turn = np.linspace(-1, 1, 500), 2.399963 * np.arange(500)
    sphere = np.column_stack([np.sqrt(1 - z * z) * np.cos(turn), np.sqrt(1 - z * z) * np.sin(turn), z])
    found = gdel.surface(sphere)
    assert found.to_trimesh().is_watertight
    assert found.to_trimesh().volume == pytest.approx(found.volume)
    shape = gdel.alpha_shape(sphere)
    assert shape.to_trimesh().volume == pytest.approx(shape.volume)
    with pytest.raises(ValueError, match="3D"):
        gdel.alpha_shape(PLANE).to_trimesh()


def test_matplotlib():
    pytest.importorskip("matplotlib")
    triangulation = PLANE.to_matplotlib()
    np.testing.assert_array_equal(triangulation.triangles, PLANE.simplices)
    with pytest.raises(ValueError, match="2D"):
        SPACE.to_matplotlib()


def test_geopandas():
    pytest.importorskip("geopandas")
    vor = gdel.Voronoi(PLANE, clip=[(0, 0), (1, 1)])
    frame = vor.to_geopandas(crs="EPSG:25832")
    np.testing.assert_allclose(frame.geometry.area, vor.volumes)
    assert (
        frame.contains(
            frame.set_geometry(__import__("geopandas").points_from_xy(frame.x, frame.y, crs=frame.crs)).geometry
        )
    ).all()
    with pytest.raises(ValueError, match="2D"):
        gdel.Voronoi(SPACE).to_geopandas()


def test_xarray():
    xarray = pytest.importorskip("xarray")
    import gdel.xarray  # noqa: F401

    x, y = PLANE.points.T
    stations = xarray.DataArray(
        np.stack([x, y]), dims=("of", "station"), coords={"x": ("station", x), "y": ("station", y), "of": ["x", "y"]}
    )
    grid = stations.gdel.grid(x=[0.4, 0.5, 0.6], y=[0.45, 0.55])
    assert grid.dims == ("x", "y", "of")
    np.testing.assert_allclose(grid.sel(of="x"), np.array([[0.4] * 2, [0.5] * 2, [0.6] * 2]))
    with pytest.raises(ValueError, match="dimension"):
        stations.gdel.grid(x=[0.5])
