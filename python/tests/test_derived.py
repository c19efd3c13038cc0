"""Alpha shapes, surfaces and spanning trees."""

import numpy as np
import pytest
import scipy.sparse.csgraph
import scipy.spatial

import gdel
import gdel.scipy


def sphere(count):
    z = 1 - (2 * np.arange(count) + 1) / count
    turn = 2.399963 * np.arange(count)
    r = np.sqrt(1 - z * z)
    return np.column_stack([r * np.cos(turn), r * np.sin(turn), z])


def test_alpha_shapes():
    grid = np.stack(np.meshgrid(*[range(5)] * 3), axis=-1).reshape(-1, 3)
    shape = gdel.alpha_shape(grid)
    assert shape.facets.shape == (6 * 16 * 2, 3)
    assert shape.volume == pytest.approx(64)
    assert shape.alpha == pytest.approx(np.sqrt(0.75))
    tri = shape.tri
    np.testing.assert_allclose(shape.radii, tri.circumradii)
    assert len(gdel.alpha_shape(tri, 0.5).solid) == 0
    with pytest.raises(ValueError, match="alpha"):
        gdel.alpha_shape(tri, -1)
    with pytest.raises(ValueError, match="auto"):
        gdel.alpha_shape(tri, "best")


def test_surfaces():
    points = np.vstack([sphere(1000), np.zeros((1, 3))])
    found = gdel.surface(points)
    assert (found.closed, found.components, found.genus, found.isolated) == (True, 1, 0, 1)
    assert found.facets.shape == (1996, 3)
    assert found.volume == pytest.approx(4 / 3 * np.pi, rel=0.02)
    assert found.sides[1000] == -1
    inward = gdel.surface(points[:-1], normals=points[:-1], refine=True)
    assert inward.evidence == "normals"
    assert len(inward.facets) == 4 * 1996
    assert gdel.surface(points[:-1], sensors=[(9, 0, 0), (0, 9, 0)][0]).evidence == "sensors"
    with pytest.raises(ValueError, match="open"):
        gdel.surface(points, open="always")
    with pytest.raises(ValueError, match="min_part"):
        gdel.surface(points, min_part=2)
    with pytest.raises(ValueError, match="values"):
        gdel.surface(points, normals=points[1:])


def test_spanning_trees():
    points = np.random.default_rng(0).random((200, 3))
    tree = gdel.minimum_spanning_tree(points)
    distances = scipy.spatial.distance_matrix(points, points)
    assert tree.lengths.sum() == pytest.approx(scipy.sparse.csgraph.minimum_spanning_tree(distances).sum())
    np.testing.assert_allclose(tree.lengths, np.linalg.norm(np.diff(points[tree.edges], axis=1)[:, 0], axis=1))
    assert len(set(tree.clusters(7).tolist())) == 7
    assert len(set(tree.clusters_within(0.0).tolist())) == 200
    with pytest.raises(ValueError, match="count"):
        tree.clusters(0)


def test_errors_as_scipy_has_them():
    with pytest.raises(gdel.scipy.QhullError, match="flat"):
        gdel.scipy.Delaunay([(0, 0), (1, 1)])
    with pytest.raises(gdel.scipy.QhullError, match="flat"):
        gdel.scipy.Voronoi(np.eye(3))
    assert gdel.scipy.Delaunay(np.eye(3)[:, :2]).nsimplex == 1
