"""Weighted points."""

import pickle

import numpy as np
import pytest

import gdel


def canonical(simplices: np.ndarray) -> list[list[int]]:
    """Return simplices in a form that is equal for equal meshes."""
    return sorted(sorted(simplex) for simplex in simplices.tolist())


@pytest.fixture(params=[2, 3])
def points(request: pytest.FixtureRequest) -> np.ndarray:
    """Return random points."""
    return np.random.default_rng(1).random((200, request.param))


def is_regular(tri: gdel.Delaunay, weights: np.ndarray) -> bool:
    """Return whether no point lies below a lifted simplex, by brute force."""
    heights = (tri.points**2).sum(axis=1) - weights
    lifted = np.column_stack([tri.points, heights])
    return bool((lifted @ tri.equations[:, :-1].T + tri.equations[:, -1]).max() < 1e-9)


def test_the_regular_triangulation(points: np.ndarray) -> None:
    weights = np.random.default_rng(2).random(len(points)) * 0.05
    tri = gdel.Delaunay(points, weights=weights)
    assert len(tri.hidden) > 5
    assert set(tri.hidden).isdisjoint(tri.simplices.ravel())
    assert sorted(set(tri.hidden) | set(tri.simplices.ravel())) == list(range(len(points)))
    assert (tri.vertex_to_simplex[tri.hidden] == -1).all()
    assert np.array_equal(tri.weights, weights)
    assert is_regular(tri, weights)
    assert not is_regular(gdel.Delaunay(points), weights)
    report = tri.verify()
    assert report
    assert report.vertices == len(points) - len(tri.hidden)


def test_only_differences_count(points: np.ndarray) -> None:
    delaunay = gdel.Delaunay(points)
    assert delaunay.weights is None
    assert len(delaunay.hidden) == 0
    equal = gdel.Delaunay(points, weights=np.full(len(points), 7.5))
    assert equal.weights is None
    assert canonical(equal.simplices) == canonical(delaunay.simplices)
    weights = np.random.default_rng(3).integers(0, 8, len(points)) / 256
    one = gdel.Delaunay(points, weights=weights)
    other = gdel.Delaunay(points, weights=weights + 4)
    assert canonical(one.simplices) == canonical(other.simplices)
    by_radii = gdel.Delaunay(points, radii=np.sqrt(weights))
    assert len(by_radii.hidden) == len(one.hidden)


def test_power_cells_and_nearest(points: np.ndarray) -> None:
    weights = np.random.default_rng(4).random(len(points)) * 0.05
    tri = gdel.Delaunay(points, weights=weights)
    box = [[0.0] * points.shape[1], [1.0] * points.shape[1]]
    volumes = gdel.Voronoi(tri, clip=box).volumes
    assert abs(volumes.sum() - 1) < 1e-12
    assert (volumes[tri.hidden] == 0).all()
    queries = np.random.default_rng(5).random((500, points.shape[1]))
    distances = ((queries[:, None] - points) ** 2).sum(axis=2) - weights
    assert np.array_equal(tri.nearest(queries), distances.argmin(axis=1))


def test_weights_change(points: np.ndarray) -> None:
    random = np.random.default_rng(6)
    tri = gdel.Delaunay(points)
    for _ in range(3):
        weights = random.random(len(points)) * 0.05
        tri.update_weights(weights)
        scratch = gdel.Delaunay(points, weights=weights)
        assert canonical(tri.simplices) == canonical(scratch.simplices)
        assert np.array_equal(tri.hidden, scratch.hidden)
    tri.update_weights(radii=np.ones(len(points)))
    assert canonical(tri.simplices) == canonical(gdel.Delaunay(points).simplices)
    assert tri.weights is None


def test_points_move(points: np.ndarray) -> None:
    weights = np.random.default_rng(7).random(len(points)) * 0.05
    tri = gdel.Delaunay(points, weights=weights)
    moved = points + np.random.default_rng(8).random(points.shape) * 0.1
    tri.update(moved)
    scratch = gdel.Delaunay(moved, weights=weights)
    assert canonical(tri.simplices) == canonical(scratch.simplices)
    assert np.array_equal(tri.hidden, scratch.hidden)
    assert np.array_equal(tri.weights, weights)
    assert tri.verify()


def test_pickles(points: np.ndarray) -> None:
    tri = gdel.Delaunay(points, weights=np.linspace(0, 0.1, len(points)))
    again = pickle.loads(pickle.dumps(tri))
    assert np.array_equal(again.simplices, tri.simplices)
    assert np.array_equal(again.hidden, tri.hidden)
    assert np.array_equal(again.weights, tri.weights)
    assert again.verify()


def test_what_is_not_possible(points: np.ndarray) -> None:
    ones = np.ones(len(points))
    for weights, error, message in [
        (ones[1:], ValueError, "199 values for 200 points"),
        (np.where(np.arange(200) == 3, np.nan, ones), ValueError, "weight 3 is not a finite number"),
        (np.ones((200, 1)), ValueError, "one axis"),
        (["a"] * 200, TypeError, "real numbers"),
    ]:
        with pytest.raises(error, match=message):
            gdel.Delaunay(points, weights=weights)
    with pytest.raises(ValueError, match="radius 4"):
        gdel.Delaunay(points, radii=np.where(np.arange(200) == 4, -1, ones))
    with pytest.raises(ValueError, match="both"):
        gdel.Delaunay(points, radii=ones, weights=ones)
    tri = gdel.Delaunay(points, weights=np.linspace(0, 0.1, len(points)))
    before = tri.simplices
    for change in [
        lambda: tri.insert(points + 1),
        lambda: tri.remove([0]),
        lambda: tri.update_weights(ones[1:]),
    ]:
        with pytest.raises(ValueError, match=r"weighted points|199 values"):
            change()
    with pytest.raises(TypeError, match="neither"):
        tri.update_weights()
    assert tri.simplices is before
