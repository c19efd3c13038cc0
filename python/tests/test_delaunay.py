"""Triangulations: against SciPy, and what SciPy does not have."""

import numpy as np
import pytest
import scipy.spatial
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import gdel


def simplices(tri):
    return sorted(map(tuple, np.sort(tri.simplices, axis=1).tolist()))


@pytest.mark.parametrize("ndim", [2, 3])
@pytest.mark.parametrize("count", [10, 300, 25_000])
def test_is_scipys(ndim, count):
    points = np.random.default_rng(count).random((count, ndim))
    tri, other = gdel.Delaunay(points), scipy.spatial.Delaunay(points)
    assert simplices(tri) == simplices(other)
    assert tri.simplices.dtype == tri.neighbors.dtype == np.int32
    assert (tri.npoints, tri.ndim, tri.nsimplex) == (count, ndim, other.nsimplex)
    assert {tuple(sorted(f)) for f in tri.convex_hull.tolist()} == {
        tuple(sorted(f)) for f in other.convex_hull.tolist()
    }
    np.testing.assert_array_equal(tri.min_bound, other.min_bound)
    np.testing.assert_array_equal(tri.max_bound, other.max_bound)
    ours, theirs = tri.vertex_neighbor_vertices, other.vertex_neighbor_vertices
    for k in range(0, count, max(count // 50, 1)):
        mine = ours[1][ours[0][k] : ours[0][k + 1]]
        assert sorted(mine) == sorted(theirs[1][theirs[0][k] : theirs[0][k + 1]])
    assert tri.verify()


@pytest.mark.parametrize("ndim", [2, 3])
def test_neighbors_are_opposite(ndim):
    tri = gdel.Delaunay(np.random.default_rng(1).random((200, ndim)))
    for t, across in enumerate(tri.neighbors):
        for k, u in enumerate(across):
            if u >= 0:
                assert tri.simplices[t, k] not in tri.simplices[u]
                assert len(set(tri.simplices[t]) & set(tri.simplices[u])) == ndim


@pytest.mark.parametrize("ndim", [2, 3])
def test_simplices_are_found(ndim):
    rng = np.random.default_rng(2)
    points, queries = rng.random((500, ndim)), rng.uniform(-0.2, 1.2, (40, 50, ndim))
    tri, other = gdel.Delaunay(points), scipy.spatial.Delaunay(points)
    found, theirs = tri.find_simplex(queries), other.find_simplex(queries)
    assert found.shape == (40, 50)
    np.testing.assert_array_equal(found < 0, theirs < 0)
    inside = found >= 0
    mine, theirs = tri.simplices[found[inside]], other.simplices[theirs[inside]]
    np.testing.assert_array_equal(np.sort(mine), np.sort(theirs))
    queries[3, 4, 0] = np.nan
    assert tri.find_simplex(queries)[3, 4] == -1
    assert tri.find_simplex(queries[0, 0]).shape == ()


def test_transforms_are_barycentric():
    points = np.random.default_rng(3).random((100, 3))
    tri = gdel.Delaunay(points)
    centres = points[tri.simplices].mean(axis=1)
    rest = centres - tri.transform[:, 3]
    np.testing.assert_allclose(np.einsum("ijk,ik->ij", tri.transform[:, :3], rest), 0.25, atol=1e-6)
    other = scipy.spatial.Delaunay(points)
    assert (tri.plane_distance(centres[0]) > 0).sum() == (other.plane_distance(centres[0]) > 0).sum()


def test_shapes():
    tri = gdel.Delaunay([(0, 0), (3, 0), (0, 4)])
    assert tri.volumes.tolist() == [6]
    assert tri.circumradii.tolist() == [2.5]
    assert tri.circumcenters.tolist() == [[1.5, 2]]
    assert tri.edges.tolist() == [[0, 1], [1, 2], [2, 0]]
    assert 0 < tri.radius_ratios[0] <= 1


@pytest.mark.parametrize(
    ("points", "dimension"),
    [
        (np.empty((0, 2)), 0),
        (np.empty((0, 3)), 0),
        ([(1, 2)] * 4, 0),
        ([(0, 0, 0), (1, 1, 1), (2, 2, 2)], 1),
        (np.eye(3), 2),
    ],
)
def test_flat_points_are_no_error(points, dimension):
    tri = gdel.Delaunay(points)
    assert (tri.nsimplex, tri.dimension) == (0, dimension)
    assert tri.simplices.shape == tri.neighbors.shape == (0, tri.ndim + 1)
    assert tri.convex_hull.shape == (0, tri.ndim)
    assert tri.find_simplex(np.zeros((5, tri.ndim))).tolist() == [-1] * 5
    assert tri.transform.shape == (0, tri.ndim + 1, tri.ndim)
    assert tri.verify()


def test_duplicates():
    tri = gdel.Delaunay([(0, 0), (1, 0), (0, 1), (1, 0)])
    assert tri.duplicate_of.tolist() == [-1, -1, -1, 1]
    assert tri.coplanar.tolist() == [[3, 0, 1]]
    assert tri.vertex_to_simplex.tolist() == [0, 0, 0, 0]


def test_grids_have_no_flat_simplices():
    # scipy issue 16094
    grid = np.stack(np.meshgrid(range(3), range(3), range(2)), axis=-1).reshape(-1, 3)
    tri = gdel.Delaunay(grid)
    assert (tri.volumes > 0).all()
    assert tri.volumes.sum() == pytest.approx(4)


def test_points_come_and_go():
    rng = np.random.default_rng(4)
    points = rng.random((60, 3))
    tri = gdel.Delaunay(points[:40])
    before = tri.simplices.copy(), tri.simplices
    assert tri.insert(points[40:]).tolist() == list(range(40, 60))
    assert simplices(tri) == simplices(gdel.Delaunay(points))
    # What was handed out does not change.
    np.testing.assert_array_equal(*before)
    tri.remove([3, 59])
    kept = np.delete(np.arange(60), [3, 59])
    expected = kept[gdel.Delaunay(points[kept]).simplices]
    assert simplices(tri) == sorted(map(tuple, np.sort(expected, axis=1).tolist()))
    assert tri.verify()
    with pytest.raises(IndexError, match="3"):
        tri.remove([3])
    with pytest.raises(IndexError):
        tri.remove(-1)
    with pytest.raises(TypeError):
        tri.remove([0.5])
    tri.add_points([(0.5, 0.5, 0.5)])
    tri.close()
    with pytest.raises(RuntimeError):
        tri.add_points([(0.5, 0.5, 0.5)])


def test_moved_points():
    rng = np.random.default_rng(5)
    points = rng.random((300, 2))
    tri = gdel.Delaunay(points)
    moved = points + 0.01 * rng.standard_normal(points.shape)
    tri.update(moved)
    assert simplices(tri) == simplices(gdel.Delaunay(moved))
    assert tri.points is moved
    with pytest.raises(ValueError, match="300"):
        tri.update(moved[1:])


def test_double_precision_into_single():
    tri = gdel.Delaunay(np.eye(2, dtype=np.float32).repeat(2, axis=0)[:3] * [[1], [2], [1]])
    tri.insert([(0.1, 0.2)])
    assert tri.points.dtype == np.float64
    assert tri.points[-1].tolist() == [0.1, 0.2]


def test_nearest():
    rng = np.random.default_rng(6)
    points, queries = rng.random((400, 3)), rng.uniform(-1, 2, (30, 10, 3))
    tri = gdel.Delaunay(points)
    tree = scipy.spatial.KDTree(points)
    np.testing.assert_array_equal(tri.nearest(queries), tree.query(queries)[1])
    np.testing.assert_array_equal(tri.nearest(queries, 5), tree.query(queries, 5)[1])
    assert tri.nearest(queries[0, 0], 500)[400:].tolist() == [-1] * 100


def test_what_a_run_says():
    tri = gdel.Delaunay(np.random.default_rng(7).random((100, 2)), backend="cpu", threads=1)
    assert (tri.backend, tri.threads, tri.stats["backend"]) == ("cpu", 1, "cpu")
    assert "100 points" in repr(tri)
    with pytest.raises(ValueError, match="backend"):
        gdel.Delaunay(np.eye(3), backend="tpu")
    with pytest.raises(ValueError, match="threads"):
        gdel.Delaunay(np.eye(3), threads=0)
    with pytest.raises(ValueError, match="furthest"):
        gdel.Delaunay(np.eye(3), furthest_site=True)


@settings(max_examples=60, deadline=None)
@given(
    st.integers(2, 3).flatmap(
        lambda n: hnp.arrays(np.int8, st.tuples(st.integers(0, 30), st.just(n)), elements=st.integers(-3, 3))
    )
)
def test_any_lattice_points_pass_the_exact_check(points):
    tri = gdel.Delaunay(points)
    report = tri.verify()
    assert report, report.failures
    if tri.nsimplex:
        hull = scipy.spatial.ConvexHull(points)
        assert tri.volumes.sum() == pytest.approx(hull.volume)


@pytest.mark.parametrize(("ndim", "count"), [(2, 40), (3, 9)])
def test_grids_have_transforms(ndim, count):
    # SciPy's test_more_barycentric_transforms
    ticks = np.linspace(0, 1, count)
    grid = np.stack(np.meshgrid(*[ticks] * ndim), axis=-1).reshape(-1, ndim)
    rng = np.random.default_rng(1234)
    moved = rng.random(len(grid)) < 0.2
    perturbed = grid.copy()
    perturbed[moved] += 2 * np.finfo(float).eps * (rng.random((moved.sum(), ndim)) - 0.5)
    for points in (grid, perturbed, np.vstack([grid, grid])):
        tri = gdel.Delaunay(points)
        centres = points[tri.simplices].mean(axis=1)
        shares = np.einsum("ijk,ik->ij", tri.transform[:, :ndim], centres - tri.transform[:, ndim])
        flat = np.isnan(tri.transform[:, 0, 0])
        assert (tri.volumes[flat] < 1e-8).all()
        np.testing.assert_allclose(shares[~flat], 1 / (ndim + 1), rtol=0.1)
        assert (tri.find_simplex(centres)[~flat] >= 0).all()
