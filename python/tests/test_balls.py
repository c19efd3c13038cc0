"""The alpha complex of balls."""

import itertools
import pickle
import threading

import numpy as np
import pytest

import gdel

GRID = np.array(list(itertools.product(range(6), repeat=3)), float)
ARRAYS = [
    "solid",
    "surface",
    "facets",
    "edges",
    "vertices",
    "singular_facets",
    "singular_edges",
    "singular_vertices",
    "component_of",
]


def faces(rows: np.ndarray) -> set[tuple[int, ...]]:
    """Return faces in a form that is equal for equal ones."""
    return {tuple(sorted(row)) for row in rows.tolist()}


def same(found: gdel.BallComplex, expected: gdel.BallComplex) -> bool:
    """Return whether two complexes of points have the same faces, of simplices in any order."""
    assert faces(found.tri.simplices[found.solid]) == faces(expected.tri.simplices[expected.solid])
    for name in ["surface", "facets", "edges", "singular_facets", "singular_edges"]:
        assert faces(getattr(found, name)) == faces(getattr(expected, name)), name
    for name in ["vertices", "singular_vertices", "component_of"]:
        assert getattr(found, name).tolist() == getattr(expected, name).tolist(), name
    return found.components == expected.components


def test_balls_of_a_grid_touch() -> None:
    lattice = {(i, j) for i, j in itertools.combinations(range(216), 2) if abs(GRID[i] - GRID[j]).sum() == 1}
    found = gdel.Delaunay(GRID, radii=np.full(216, 0.5)).ball_complex()
    assert faces(found.edges) == lattice
    assert np.array_equal(found.singular_edges, found.edges)
    assert (found.edges[:, 0] < found.edges[:, 1]).all()
    assert found.facets.shape == found.singular_facets.shape == found.surface.shape == (0, 3)
    assert len(found.solid) == 0
    assert np.array_equal(found.vertices, np.arange(216))
    assert len(found.singular_vertices) == 0
    assert (found.components, found.component_of.tolist(), found.alpha) == (1, [0] * 216, 0.0)
    assert repr(found) == "<gdel.BallComplex: 216 vertices, 540 edges, 0 triangles, 0 simplices, 1 components>"
    for name in ARRAYS:
        assert getattr(found, name).dtype == np.int32, name

    apart = gdel.Delaunay(GRID, radii=np.full(216, np.nextafter(0.5, 0))).ball_complex()
    assert apart.edges.shape == (0, 2)
    assert np.array_equal(apart.singular_vertices, np.arange(216))
    assert (apart.components, apart.component_of.tolist()) == (216, list(range(216)))

    # Where the eight balls of a cube meet in its middle, and nothing is left out.
    full = gdel.Delaunay(GRID, weights=np.full(216, 0.75)).ball_complex()
    assert len(full.solid) == full.tri.nsimplex
    assert len(full.surface) == 6 * 25 * 2
    short = gdel.Delaunay(GRID, weights=np.full(216, np.nextafter(0.75, 0))).ball_complex()
    assert len(short.solid) == 0
    assert len(short.singular_facets) == len(short.facets) > 0


def test_equal_radii_stay() -> None:
    points = np.random.default_rng(1).random((300, 3))
    radii = np.full(300, 0.09)
    tri = gdel.Delaunay(points, radii=radii)
    assert tri.weights is None
    found = tri.ball_complex()
    # What a mesh with weights finds: one ball far away differs.
    other = gdel.Delaunay(np.vstack([points, [(9, 9, 9)]]), radii=[*radii, 0.01]).ball_complex()
    assert faces(found.edges) == faces(other.edges)
    assert faces(found.facets) == faces(other.facets)
    assert found.component_of.tolist() == other.component_of[:300].tolist()
    assert 1 < found.components == other.components - 1 < 300
    assert same(gdel.Delaunay(points).ball_complex(0.09), found)
    assert same(pickle.loads(pickle.dumps(tri)).ball_complex(), found)

    moved = points * [1.5, 1, 1]
    tri.update(moved)
    assert same(tri.ball_complex(), gdel.Delaunay(moved, radii=radii).ball_complex())
    more = np.random.default_rng(2).random((50, 3))
    tri.add_points(more)
    together = np.vstack([moved, more])
    assert same(tri.ball_complex(), gdel.Delaunay(together, radii=np.full(350, 0.09)).ball_complex())
    tri.remove(range(40))
    rest = tri.ball_complex()
    without = gdel.Delaunay(together[40:], radii=np.full(310, 0.09)).ball_complex()
    assert faces(rest.edges) == faces(without.edges + 40)
    assert (rest.component_of[:40] == -1).all()
    assert rest.component_of[40:].tolist() == without.component_of.tolist()
    assert rest.components == without.components


def test_weights_change() -> None:
    points = np.random.default_rng(3).random((200, 2))
    different = np.random.default_rng(4).random(200) * 0.1
    tri = gdel.Delaunay(points)
    for radii in [np.full(200, 0.05), different, np.full(200, 0.03), np.zeros(200)]:
        tri.update_weights(radii=radii)
        assert same(tri.ball_complex(), gdel.Delaunay(points, radii=radii).ball_complex())
        tri.update(points + 1)
        assert same(tri.ball_complex(0.01), gdel.Delaunay(points + 1, radii=radii).ball_complex(0.01))
        tri.update(points)
    before = gdel.Delaunay(points, radii=different)
    # A failure changes nothing.
    equal = gdel.Delaunay(points, radii=np.full(200, 0.05))
    for each in [before, equal]:
        expected = each.ball_complex()
        with pytest.raises(ValueError, match="199 values"):
            each.update_weights(np.ones(199))
        with pytest.raises(ValueError, match="point 3"):
            each.update(np.where(np.arange(200)[:, None] == 3, np.nan, points))
        assert same(each.ball_complex(), expected)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_hidden_points(dtype: type) -> None:
    # Two balls that overlap, one that is within the first, a duplicate of the second, one far away, and one whose
    # square is negative.
    points = np.array([(0, 0, 0), (3, 0, 0), (0.5, 0, 0), (3, 0, 0), (0, 0, 9), (0, 9, 0)], dtype)
    tri = gdel.Delaunay(points, weights=[4, 4, 0.25, 4, 1, -1])
    assert tri.hidden.tolist() == [2]
    found = tri.ball_complex()
    assert found.edges.tolist() == [[0, 1]]
    assert found.vertices.tolist() == [0, 1, 4]
    assert found.singular_vertices.tolist() == [4]
    assert (found.components, found.component_of.tolist()) == (2, [0, 0, -1, -1, 1, -1])
    # A larger alpha makes a ball of it, but does not reach the others.
    assert tri.ball_complex(1).vertices.tolist() == [0, 1, 4, 5]
    assert tri.ball_complex(np.inf).solid.tolist() == list(range(tri.nsimplex))


@pytest.mark.parametrize("ndim", [2, 3])
def test_without_weights_it_is_the_alpha_complex(ndim: int) -> None:
    tri = gdel.Delaunay(np.random.default_rng(5).random((400, ndim)))
    for alpha in [0.0, 0.05, 0.08, 0.2, 10.0]:
        found, shape = tri.ball_complex(alpha), gdel.alpha_shape(tri, alpha)
        assert (found.tri, found.alpha) == (tri, alpha)
        assert np.array_equal(found.solid, shape.solid)
        # Oriented as well.
        rolled = [
            {tuple(np.roll(row, -row.argmin())) if ndim == 3 else tuple(row) for row in rows}
            for rows in (found.surface, shape.facets)
        ]
        assert rolled[0] == rolled[1]
        # Each by brute force: an edge is there if its smallest disk is empty and small, or it belongs to a larger face.
        middle = tri.points[tri.edges].mean(axis=1)
        squares = ((tri.points[tri.edges[:, 0]] - middle) ** 2).sum(axis=1)
        nearest = ((tri.points - middle[:, None]) ** 2).sum(axis=2).min(axis=1)
        own = tri.edges[(squares <= alpha**2) & (nearest > squares * (1 - 1e-9))]
        larger = (
            {edge for facet in faces(found.facets) for edge in itertools.combinations(facet, 2)}
            if ndim == 3
            else {edge for simplex in faces(tri.simplices[found.solid]) for edge in itertools.combinations(simplex, 2)}
        )
        assert faces(found.edges) == faces(own) | larger
        assert faces(found.singular_edges) == faces(found.edges) - larger
        if ndim == 2:
            assert faces(found.facets) == faces(found.edges)
            assert faces(found.singular_facets) == faces(found.singular_edges)
        ends = set(found.edges.ravel().tolist())
        assert found.vertices.tolist() == list(range(400))
        assert found.singular_vertices.tolist() == [v for v in range(400) if v not in ends]
        assert found.components == len(set(found.component_of.tolist()))
        assert (found.component_of[found.edges[:, 0]] == found.component_of[found.edges[:, 1]]).all()


def test_flat_points() -> None:
    plane = np.array([(0, 7, 0), (2, 7, 0), (0, 7, 2), (9, 7, 9)], float)
    found = gdel.Delaunay(plane, radii=[2, 2, 2, 1]).ball_complex()
    assert found.solid.tolist() == []
    assert faces(found.facets) == faces(found.singular_facets) == {(0, 1, 2)}
    assert len(found.surface) == 2
    assert found.component_of.tolist() == [0, 0, 0, 1]
    line = np.array([(0, 0, 0), (1, 2, 3), (2, 4, 6)], float)
    found = gdel.Delaunay(line, radii=[2, 2, 1]).ball_complex()
    assert (found.edges.tolist(), found.facets.shape) == ([[0, 1]], (0, 3))
    found = gdel.Delaunay(line[:, :2], radii=[2, 1, 1]).ball_complex()
    assert faces(found.facets) == faces(found.singular_edges) == {(0, 1)}
    assert found.components == 2
    one = gdel.Delaunay([(1, 1), (1, 1)], radii=[1, 1]).ball_complex()
    assert (one.singular_vertices.tolist(), one.component_of.tolist()) == ([0], [0, -1])
    for ndim in (2, 3):
        none = gdel.Delaunay(np.empty((0, ndim)), radii=[]).ball_complex()
        assert [getattr(none, name).shape for name in ARRAYS[1:4]] == [(0, ndim), (0, ndim), (0, 2)]
        assert (none.components, len(none.component_of), len(none.solid)) == (0, 0, 0)


def test_what_is_not_possible() -> None:
    tri = gdel.Delaunay([(0, 0), (3, 0), (0, 9)], radii=[2, 1, 1])
    for alpha in [-1, -1e-300, np.nan, -np.inf]:
        with pytest.raises(ValueError, match="alpha must be a number that is not negative"):
            tri.ball_complex(alpha)
    for alpha in ["auto", "1", b"1", None, [1], 1j, {}]:
        with pytest.raises(TypeError, match="alpha must be a number, not "):
            tri.ball_complex(alpha)
    assert tri.ball_complex(np.float32(0.5)).alpha == tri.ball_complex(alpha=0.5).alpha == 0.5
    constrained = gdel.ConstrainedDelaunay([(0, 0), (3, 0), (0, 9)], edges=[(0, 1)])
    with pytest.raises(ValueError, match="constraints"):
        constrained.ball_complex()
    with pytest.raises(AttributeError, match="alpha"):
        tri.ball_complex().alpha = 1.0


def test_other_threads_go_on() -> None:
    points = np.random.default_rng(6).random((30_000, 3))
    tri = gdel.Delaunay(points, radii=np.full(len(points), 0.03), threads=1)
    counts, is_done = [0], threading.Event()

    def count() -> None:
        while not is_done.wait(0.002):
            counts[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    before = counts[0]
    found = tri.ball_complex()
    after = counts[0]
    is_done.set()
    thread.join()
    assert after - before > 3
    assert same(gdel.Delaunay(points, radii=np.full(len(points), 0.03)).ball_complex(), found)
