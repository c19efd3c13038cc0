"""Voronoi diagrams: against SciPy, and their measures."""

import numpy as np
import pytest
import scipy.spatial

import gdel


def ridges(vor):
    """Return the corners of each ridge by its points."""
    found = {}
    for pair, vertices in zip(vor.ridge_points.tolist(), vor.ridge_vertices, strict=True):
        corners = sorted(tuple(np.round(vor.vertices[v], 6).tolist()) for v in vertices if v >= 0)
        found[tuple(sorted(pair))] = (corners, -1 in vertices)
    return found


@pytest.mark.parametrize("ndim", [2, 3])
def test_is_scipys(ndim):
    points = np.random.default_rng(ndim).random((80, ndim))
    ours, theirs = gdel.Voronoi(points), scipy.spatial.Voronoi(points)
    assert ridges(ours) == ridges(theirs)
    for i in range(80):
        mine, other = (
            sorted(tuple(np.round(vor.vertices[v], 6)) if v >= 0 else () for v in vor.regions[vor.point_region[i]])
            for vor in (ours, theirs)
        )
        assert mine == other
    assert ours.ridge_dict.keys() == {tuple(pair) for pair in ours.ridge_points.tolist()}


def test_grids_have_square_cells():
    grid = np.stack(np.meshgrid(range(4), range(4)), axis=-1).reshape(-1, 2)
    vor = gdel.Voronoi(grid)
    assert ridges(vor) == ridges(scipy.spatial.Voronoi(grid))
    assert vor.vertices.shape == (9, 2)
    assert len(vor.ridge_points) == 24
    cube = np.stack(np.meshgrid(range(4), range(4), range(4)), axis=-1).reshape(-1, 3)
    vor = gdel.Voronoi(cube, clip=[(-0.5,) * 3, (3.5,) * 3])
    assert vor.vertices.shape == (27, 3)
    np.testing.assert_allclose(vor.volumes, 1)
    np.testing.assert_allclose(vor.centroids, cube, atol=1e-12)
    inner = [vertices for vertices in vor.ridge_vertices if -1 not in vertices]
    assert {len(vertices) for vertices in inner} == {4}


def test_clipping():
    points = np.random.default_rng(1).random((200, 2))
    tri = gdel.Delaunay(points)
    assert gdel.Voronoi(tri, clip="hull").volumes.sum() == pytest.approx(tri.volumes.sum())
    vor = gdel.Voronoi(tri, clip=[(0, 0), (1, 1)])
    assert vor.volumes.sum() == pytest.approx(1)
    polygons = vor.polygons()
    x, y = polygons[5].T
    assert (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2 == pytest.approx(vor.volumes[5])
    indptr, neighbors, areas = vor.cell_neighbors
    assert len(neighbors) == len(areas) == indptr[-1]
    assert np.isinf(gdel.Voronoi(tri).volumes).any()
    with pytest.raises(ValueError, match="clip"):
        gdel.Voronoi(tri, clip="circle").volumes  # noqa: B018
    low, high = points.min(axis=0), points.max(axis=0)
    by_name, by_corners = (gdel.Voronoi(tri, clip=clip).volumes for clip in ("box", [low, high]))
    assert np.array_equal(by_name, by_corners)
    for bad in ([(0, 0)], [(0, 0, 0), (1, 1, 1)], [0, 1]):
        with pytest.raises(ValueError, match="row of 2 coordinates"):
            gdel.Voronoi(tri, clip=bad)
    with pytest.raises(ValueError, match="box"):
        gdel.Voronoi(tri, clip=[(0, 0), (0, 1)]).volumes  # noqa: B018


def test_convex_shapes():
    points = np.random.default_rng(1).random((200, 2))
    hexagon = 0.5 + 0.7 * np.column_stack([np.cos(np.arange(6) * np.pi / 3), np.sin(np.arange(6) * np.pi / 3)])
    area = 1.5 * np.sqrt(3) * 0.7**2
    vor = gdel.Voronoi(points, clip=np.random.default_rng(2).permutation(hexagon))
    assert vor.volumes.sum() == pytest.approx(area)
    corners = [corner for polygon in vor.polygons() for corner in polygon.tolist()]
    assert all(np.linalg.norm(corners - corner, axis=1).min() < 1e-12 for corner in hexagon)
    # The shape is not what the caller makes of the array afterwards.
    changing = hexagon.copy()
    vor = gdel.Voronoi(points, clip=changing)
    changing[:] = 0
    assert vor.volumes.sum() == pytest.approx(area)
    tetrahedron = [(0, 0, 0), (3, 0, 0), (0, 3, 0), (0, 0, 3)]
    vor = gdel.Voronoi(np.random.default_rng(3).random((50, 3)), clip=tetrahedron)
    assert vor.volumes.sum() == pytest.approx(4.5)
    with pytest.raises(ValueError, match="corners"):
        gdel.Voronoi(points, clip=[*hexagon, (0.5, 0.5)]).volumes  # noqa: B018


def test_points_come():
    vor = gdel.Voronoi([(0, 0), (4, 0), (0, 4), (4, 4)], incremental=True)
    vor.add_points([(2, 2), (0, 0)])
    assert vor.vertices.shape == (4, 2)
    assert vor.point_region[5] == vor.point_region[0]
    assert len(vor.regions) == 6
    vor.close()
    with pytest.raises(RuntimeError):
        vor.add_points([(1, 1)])
    with pytest.raises(ValueError, match="furthest"):
        gdel.Voronoi([(0, 0)], furthest_site=True)


def test_flat_points():
    vor = gdel.Voronoi([(0, 0), (2, 2), (1, 1)])
    np.testing.assert_array_equal(vor.vertices, [(0.5, 0.5), (1.5, 1.5)])
    assert vor.ridge_dict == {(0, 2): [0], (1, 2): [1]}
    assert vor.regions == [[], [-1, 0], [-1, 1], [0, 1]]
    np.testing.assert_array_equal(vor.volumes, [np.inf, np.inf, np.sqrt(2)])
    assert [polygon.shape for polygon in vor.polygons()] == [(0, 2)] * 3
    vor = gdel.Voronoi([(0, 0), (2, 2)], clip=[(0, 0), (2, 2)])
    np.testing.assert_array_equal(vor.volumes, [2, 2])
    assert [polygon.shape for polygon in vor.polygons()] == [(3, 2)] * 2


def test_points_in_a_plane_of_space():
    square = [(0, 0), (4, 0), (0, 4), (4, 4), (2, 2)]
    flat, vor = gdel.Voronoi(square), gdel.Voronoi([(x, y, x - y) for x, y in square])
    assert vor.vertices.shape == (4, 3)
    assert sorted(map(sorted, vor.ridge_points.tolist())) == sorted(map(sorted, flat.ridge_points.tolist()))
    assert [len(region) for region in vor.regions] == [len(region) for region in flat.regions]
    # An edge along the first axis is longer in the plane.
    np.testing.assert_allclose(gdel.Voronoi(vor.tri, clip="hull").volumes.sum(), 16 * np.sqrt(3))


def test_equal_points():
    vor = gdel.Voronoi([(1, 1), (1, 1)])
    assert vor.ridge_vertices == []
    assert vor.regions == [[], []]
