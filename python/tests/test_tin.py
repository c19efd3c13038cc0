"""Terrain."""

import pickle

import numpy as np
import pytest

import gdel


def valley(n: int = 20) -> gdel._points.Floats:
    """Return points on the walls of a valley along y."""
    x, y = np.meshgrid(np.arange(n, dtype=np.float64), np.arange(n, dtype=np.float64))
    return np.column_stack([x.ravel(), y.ravel(), abs(x - n // 2).ravel()])


def heights(terrain: gdel.Tin, at: gdel._points.Floats) -> gdel._points.Floats:
    """Return how high the surface is at places."""
    return np.asarray(gdel.LinearNDInterpolator(terrain.delaunay, terrain.vertices[:, 2])(at))


def test_few_points_are_near_to_all() -> None:
    points = valley()
    terrain = gdel.tin(points, max_error=0.1)
    assert (len(terrain.vertices), terrain.start, terrain.limited) == (6, 4, False)
    assert (points[terrain.sources] == terrain.vertices).all()
    assert terrain.delaunay.verify()
    assert abs(heights(terrain, points[:, :2]) - points[:, 2]).max() <= terrain.max_error + 1e-12 <= 0.1 + 1e-12
    rough = points + np.array([0, 0, 1]) * np.random.default_rng(1).random((len(points), 3))
    sizes = [len(gdel.tin(rough, max_error=error).vertices) for error in (0.5, 0.25, 0)]
    assert sizes[0] < sizes[1] < sizes[2] == len(points)
    few = gdel.tin(rough, max_points=50)
    assert (len(few.vertices), few.limited) == (50, True)
    assert abs(heights(few, rough[:, :2]) - rough[:, 2]).max() == pytest.approx(few.max_error)


def test_breaklines_and_boundaries_are_edges() -> None:
    points = valley()
    edge = (3, 3 + 20 * 19)
    terrain = gdel.tin(points, max_error=0.1, edges=[edge])
    ends = [int(np.flatnonzero(terrain.sources == end)[0]) for end in edge]
    assert terrain.delaunay.segments.tolist() == [ends]
    assert terrain.delaunay.is_constrained(*ends)
    inner = gdel.tin(points, max_error=0.1, rings=[[0, 10, 210, 200]])
    area = inner.delaunay.volumes[inner.delaunay.inside].sum()
    assert (area, inner.outside) == (100, 400 - 121)
    with pytest.raises(gdel.CrossingError):
        gdel.tin(points, edges=[(0, 399), (19, 380)])
    crossed = gdel.tin(points, max_error=5, edges=[(0, 399), (19, 380)], crossings="split")
    assert (
        crossed.vertices[crossed.sources < 0, :2].tolist() == crossed.delaunay.points[crossed.delaunay.added].tolist()
    )


def test_places_with_several_heights_and_pickling() -> None:
    points = np.vstack([valley(), np.add(valley(), (0, 0, 1)), valley()])
    terrain = gdel.tin(points, max_error=0.1)
    assert (len(terrain.vertices), terrain.duplicates, terrain.other_heights) == (6, 800, 400)
    copy = pickle.loads(pickle.dumps(terrain))
    assert (copy.vertices == terrain.vertices).all()
    assert (copy.triangles == terrain.triangles).all()
    assert repr(copy) == "<gdel.Tin: 6 vertices, 4 triangles>"


def test_bad_input_is_said() -> None:
    with pytest.raises(ValueError, match="points must have 3 coordinates, not 2: terrain needs heights"):
        gdel.tin([(0, 0), (1, 0)])
    for error in (-1, np.nan):
        with pytest.raises(ValueError, match="largest error"):
            gdel.tin(valley(), max_error=error)
    with pytest.raises(ValueError, match="point 1"):
        gdel.tin([(0, 0, 0), (1, np.nan, 0), (0, 1, 0)])
    with pytest.raises(ValueError, match="edges has 400"):
        gdel.tin(valley(), edges=[(0, 400)])
    with pytest.raises(OverflowError):
        gdel.tin(valley(), max_points=-1)
    assert len(gdel.tin(np.empty((0, 3))).vertices) == 0
    reports: list[str] = []
    gdel.tin(
        np.random.default_rng(0).random((30_000, 3)), max_error=0.2, progress=lambda phase, _: reports.append(phase)
    )
    assert reports[-1] == "done"
