"""Interpolation: against SciPy, and what it does not have."""

import pickle

import numpy as np
import pytest
import scipy.interpolate

import gdel

RNG = np.random.default_rng(0)
POINTS = {2: RNG.random((300, 2)), 3: RNG.random((300, 3))}
QUERIES = {2: RNG.uniform(-0.1, 1.1, (40, 20, 2)), 3: RNG.uniform(-0.1, 1.1, (40, 20, 3))}


@pytest.mark.parametrize("ndim", [2, 3])
@pytest.mark.parametrize("rescale", [False, True])
@pytest.mark.parametrize("shape", [(), (2,), (2, 3)])
@pytest.mark.parametrize("is_complex", [False, True])
def test_is_scipys(ndim, rescale, shape, is_complex):
    points = POINTS[ndim] * [1, 100, 3][:ndim]
    queries = QUERIES[ndim] * [1, 100, 3][:ndim]
    values = RNG.random((300, *shape)) + (1j * RNG.random((300, *shape)) if is_complex else 0)
    ours = gdel.LinearNDInterpolator(points, values, rescale=rescale)(queries)
    theirs = scipy.interpolate.LinearNDInterpolator(points, values, rescale=rescale)(queries)
    np.testing.assert_allclose(ours, theirs, atol=1e-9)
    assert ours.dtype == theirs.dtype
    ours = gdel.griddata(points, values, queries, "nearest", rescale=rescale)
    theirs = scipy.interpolate.griddata(points, values, queries, "nearest", rescale=rescale)
    np.testing.assert_array_equal(ours, theirs)


@pytest.mark.parametrize("ndim", [2, 3])
@pytest.mark.parametrize("method", ["sibson", "laplace", "natural", "linear"])
def test_linear_functions_are_reproduced(ndim, method):
    weights = np.array([1.0, -2.0, 0.5])[:ndim]
    found = gdel.griddata(POINTS[ndim], POINTS[ndim] @ weights, QUERIES[ndim], method, fill_value=7)
    inside = gdel.Delaunay(POINTS[ndim]).find_simplex(QUERIES[ndim]) >= 0
    np.testing.assert_allclose(found[inside], (QUERIES[ndim] @ weights)[inside], atol=1e-9)
    assert (found[~inside] == 7).all()


def test_calls():
    interpolator = gdel.LinearNDInterpolator((POINTS[2][:, 0], POINTS[2][:, 1]), POINTS[2][:, 0])
    grid = np.meshgrid(np.linspace(0.2, 0.8, 5), np.linspace(0.3, 0.7, 4))
    expected = grid[0]
    np.testing.assert_allclose(interpolator(*grid), expected)
    np.testing.assert_allclose(interpolator(tuple(grid)), expected)
    np.testing.assert_allclose(interpolator(np.stack(grid, axis=-1)), expected)
    assert interpolator(0.5, 0.5).shape == ()
    assert np.isnan(interpolator(np.nan, 0.5))
    assert interpolator(np.empty((0, 2))).shape == (0,)


def test_values_that_are_not_finite():
    points, values = [(0, 0), (2, 0), (0, 2), (2, 2)], [np.nan, 1.0, 2.0, 3.0]
    interpolator = gdel.LinearNDInterpolator(points, values, fill_value=-1)
    assert np.isnan(interpolator(0.1, 0.1))
    assert interpolator(9, 9) == -1


def test_outside_and_duplicates():
    points, values = [(0, 0), (1, 0), (0, 1), (0, 0)], [1.0, 2.0, 3.0, 5.0]
    queries = [(-1, -1), (0, 0)]
    assert gdel.griddata(points, values, queries, fill_value=-7).tolist() == [-7, 1]
    assert gdel.griddata(points, values, queries, outside="nearest").tolist() == [1, 1]
    assert gdel.griddata(points, values, queries, outside="linear").tolist() == [-2, 1]
    mean = gdel.LinearNDInterpolator(points, values, duplicates="mean")
    assert mean(queries)[1] == 3
    with pytest.raises(ValueError, match="3"):
        gdel.NaturalNeighborInterpolator(points, values, duplicates="error")(queries)
    with pytest.raises(ValueError, match="outside"):
        gdel.griddata(points, values, queries, outside="cubic")


def test_wrong_calls():
    tri = gdel.Delaunay(POINTS[2])
    with pytest.raises(ValueError, match="Rescaling"):
        gdel.LinearNDInterpolator(tri, np.zeros(300), rescale=True)
    with pytest.raises(ValueError, match="2 values for 300"):
        gdel.LinearNDInterpolator(tri, [1, 2])
    with pytest.raises(TypeError, match="numbers"):
        gdel.LinearNDInterpolator(tri, ["a"] * 300)
    with pytest.raises(ValueError, match="complex"):
        gdel.LinearNDInterpolator(tri, np.zeros(300), fill_value=1j)
    with pytest.raises(ValueError, match="method"):
        gdel.NaturalNeighborInterpolator(tri, np.zeros(300), method="linear")
    with pytest.raises(ValueError, match="cubic"):
        gdel.griddata(POINTS[3], np.zeros(300), QUERIES[3], "cubic")
    with pytest.raises(ValueError, match="2D"):
        gdel.CloughTocher2DInterpolator(POINTS[3], np.zeros(300))
    with pytest.raises(ValueError, match="dimensions"):
        gdel.LinearNDInterpolator(tri, np.zeros(300))(np.zeros((3, 3)))


def test_flat_points():
    assert gdel.griddata([(0, 0), (1, 1)], [1, 2], (0.5, 0.5)) == 1.5
    assert np.isnan(gdel.griddata([(0, 0), (1, 1)], [1, 2], (0.5, 0.25)))


def test_pickling():
    interpolator = gdel.NaturalNeighborInterpolator(POINTS[3], POINTS[3][:, 0], rescale=True)
    other = pickle.loads(pickle.dumps(interpolator))
    np.testing.assert_array_equal(other(QUERIES[3]), interpolator(QUERIES[3]))


def test_gradients_are_found_once_kept_and_taken():
    points, queries = POINTS[2].copy(), QUERIES[2]
    values = np.stack([points @ [1.0, -2.0], points @ [0.5, 0.25]], axis=1) @ [[1, 2j], [1j, 0]]
    tri = gdel.Delaunay(points)
    smooth = gdel.CloughTocher2DInterpolator(tri, values)
    expected = np.stack([np.array([1.0, -2.0]) + 1j * np.array([0.5, 0.25]), 2j * np.array([1.0, -2.0])])
    np.testing.assert_allclose(smooth.grad, np.broadcast_to(expected, smooth.grad.shape), atol=1e-12)
    assert smooth.grad is smooth.grad

    before = smooth(queries)
    smooth.grad[...] *= 2
    inside = ~np.isnan(before)
    assert (smooth(queries)[inside] != before[inside]).any()
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(smooth))(queries), smooth(queries))
    tri.update(points[::-1].copy())
    moved = gdel.CloughTocher2DInterpolator(points[::-1].copy(), values)
    np.testing.assert_array_equal(smooth(queries), moved(queries))


def test_cubic_interpolation_is_scipys():
    points, queries = POINTS[2], QUERIES[2]
    values = np.sin(3 * points[:, 0]) + np.cos(5 * points[:, 1])
    ours = gdel.CloughTocher2DInterpolator(points, values)
    theirs = scipy.interpolate.CloughTocher2DInterpolator(points, values, tol=1e-15, maxiter=10000)
    np.testing.assert_allclose(ours(queries), theirs(queries), atol=1e-10)
    np.testing.assert_array_equal(gdel.griddata(points, values, queries, "cubic"), ours(queries))
    complex_values = values + 2j * values
    np.testing.assert_allclose(
        gdel.CloughTocher2DInterpolator(points, complex_values)(queries), ours(queries) * (1 + 2j), atol=1e-12
    )
    smooth = gdel.NaturalNeighborInterpolator(points, points @ [1.0, -2.0], method="sibson-c1")
    np.testing.assert_allclose(smooth(queries), np.where(np.isnan(ours(queries)), np.nan, queries @ [1.0, -2.0]))
