"""SciPy's own tests of the classes that gdel has, with gdel's classes. `SCIPY.md` lists those that differ."""

import importlib.util
import types

import pytest
import scipy.interpolate._interpnd
import scipy.spatial._qhull

import gdel.scipy


def with_gdel(module, **names):
    """Return a copy of a module of tests in which names stand for something else."""
    spec = importlib.util.find_spec(module)
    if spec is None:
        pytest.skip(f"this SciPy has no {module}", allow_module_level=True)
    copy = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(copy)
    for name, value in names.items():
        assert hasattr(copy, name)
        setattr(copy, name, value)
    return copy


def instead(module, **names):
    """Return a module with some names replaced."""
    copy = types.ModuleType(module.__name__)
    copy.__dict__.update(module.__dict__)
    copy.__dict__.update(names)
    return copy


QHULL = instead(
    scipy.spatial._qhull,
    Delaunay=gdel.scipy.Delaunay,
    Voronoi=gdel.scipy.Voronoi,
    tsearch=gdel.scipy.tsearch,
    QhullError=gdel.scipy.QhullError,
)
INTERPND = instead(
    scipy.interpolate._interpnd,
    LinearNDInterpolator=gdel.LinearNDInterpolator,
    CloughTocher2DInterpolator=gdel.CloughTocher2DInterpolator,
)

OF_QHULL = with_gdel("scipy.spatial.tests.test_qhull", qhull=QHULL, Voronoi=gdel.scipy.Voronoi)
OF_INTERPND = with_gdel("scipy.interpolate.tests.test_interpnd", qhull=QHULL, interpnd=INTERPND)
OF_GRIDDATA = with_gdel("scipy.interpolate.tests.test_ndgriddata", griddata=gdel.griddata)

TestVertexNeighborVertices = OF_QHULL.TestVertexNeighborVertices
TestDelaunay = OF_QHULL.TestDelaunay
TestVoronoi = OF_QHULL.TestVoronoi
TestLinearNDInterpolation = OF_INTERPND.TestLinearNDInterpolation
TestCloughTocher2DInterpolator = OF_INTERPND.TestCloughTocher2DInterpolator
TestGriddata = OF_GRIDDATA.TestGriddata


class TestUtilities(OF_QHULL.TestUtilities):
    """Without those of `ConvexHull`."""

    test_volume_area = test_random_volume_area = test_incremental_volume_area_random_input = None


def test_issue_8051():
    OF_QHULL.Test_Qhull().test_issue_8051()
