"""Constrained Delaunay triangulations."""

import pickle
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import gdel

POINTS = np.array([(0, 0), (9, 0), (9, 9), (0, 9), (3, 3), (6, 3), (6, 6), (3, 6), (5, 5)], np.float32)
RINGS = [[0, 1, 2, 3], [4, 5, 6, 7, 4]]
SQUARE = [(0, 0, 7), (9, 0, 7), (9, 9, 7), (0, 9, 7), (0, 0, 7)]
HOLE = [(3, 3), (6, 3), (6, 6), (3, 6)]


def area(tri: gdel.ConstrainedDelaunay) -> float:
    """Return the area inside, of a triangulation that is right."""
    report = tri.verify()
    assert report, report.failures
    return float(tri.volumes[tri.inside].sum())


def test_rings_and_fill_rules() -> None:
    tri = gdel.ConstrainedDelaunay(POINTS, rings=RINGS)
    assert (tri.nsimplex, len(tri.inside_simplices), area(tri)) == (12, 8, 72)
    assert tri.constraints.tolist() == [[0, 1], [0, 3], [1, 2], [2, 3], [4, 5], [4, 7], [5, 6], [6, 7]]
    assert tri.is_constrained(7, 4)
    assert not tri.is_constrained(0, 4)
    assert len(set(tri.regions)) == 2
    assert (tri.zero_length, len(tri.added), tri.moved) == (0, 0, 0)
    assert tri.points.dtype == np.float32
    holes = [(4, 5), (100, 100)]
    assert area(gdel.ConstrainedDelaunay(POINTS, rings=RINGS, fill="enclosed", holes=holes)) == 72
    for fill, inside in [("all", 81), ("evenodd", 72), ("nonzero", 81), ("enclosed", 81)]:
        assert area(gdel.ConstrainedDelaunay(POINTS, rings=RINGS, fill=fill)) == inside


def test_polygons_bring_their_points() -> None:
    tri = gdel.ConstrainedDelaunay(None, polygons=[[SQUARE, HOLE, []], []])
    assert (tri.npoints, area(tri)) == (8, 72)
    shape = SimpleNamespace(__geo_interface__={"type": "MultiPolygon", "coordinates": [[SQUARE], [HOLE]]})
    both = gdel.ConstrainedDelaunay([(1, 1), (20, 20)], edges=[(0, 0)], polygons=[shape])
    assert (both.npoints, area(both), both.zero_length) == (10, 72, 1)
    assert both.points[2].tolist() == [0, 0]
    nothing = gdel.ConstrainedDelaunay(None, polygons=[])
    assert (nothing.nsimplex, len(nothing.constraints)) == (0, 0)
    flat = gdel.ConstrainedDelaunay(None, polygons=[[[(0, 0), (1, 1), (2, 2)]]])
    assert (flat.dimension, len(flat.constraints)) == (1, 2)
    assert area(flat) == 0


def test_edges_lead_through_points() -> None:
    tri = gdel.ConstrainedDelaunay(POINTS, edges=np.array([[0, 2], [8, 2]], np.uint8))
    assert tri.constraints.tolist() == [[0, 4], [2, 6], [4, 8], [6, 8]]
    assert tri.inside.all()
    assert tri.verify()
    plain = gdel.ConstrainedDelaunay(POINTS)
    assert sorted(map(sorted, plain.simplices.tolist())) == sorted(
        map(sorted, gdel.Delaunay(POINTS).simplices.tolist())
    )


def test_crossings() -> None:
    points = [(0, 0), (3, 0), (3, 3), (0, 3)]
    with pytest.raises(gdel.CrossingError, match="0–2 and 1–3") as raised:
        gdel.ConstrainedDelaunay(points, edges=[(0, 2), (1, 3)])
    assert raised.value.pairs == [((0, 2), (1, 3))]
    assert isinstance(raised.value, ValueError)
    tri = gdel.ConstrainedDelaunay(points, edges=[(0, 2), (1, 3)], crossings="split")
    assert tri.points[tri.added].tolist() == [[1.5, 1.5]]
    assert tri.segments.tolist() == [[0, 4], [4, 2], [1, 4], [4, 3]]
    assert tri.verify()


def test_the_verifier_looks_at_the_segments() -> None:
    tri = gdel.ConstrainedDelaunay(POINTS, rings=RINGS)
    tri._found["segments"] = tri.segments[1:]
    assert not tri.verify()


def test_pickling_keeps_constraints() -> None:
    tri = gdel.ConstrainedDelaunay(POINTS, rings=RINGS)
    copy = pickle.loads(pickle.dumps(tri))
    assert copy.constraints.tolist() == tri.constraints.tolist()
    assert area(copy) == 72
    assert copy.inside[copy.find_simplex((1, 1))]
    with pytest.raises(ValueError, match="constraints"):
        copy.update(POINTS)


def test_places_and_values_inside() -> None:
    tri = gdel.ConstrainedDelaunay(POINTS, rings=RINGS)
    # Inside, on the boundary of the hole, in the hole, outside the hull.
    queries = [(1, 1), (3, 4.5), (4, 4), (20, 20)]
    places = tri.find_simplex(queries)
    assert (places >= 0).tolist() == [True, True, True, False]
    assert not tri.inside[places[2]]
    assert tri.nearest(queries).tolist() == [0, 4, 4, 2]
    values = POINTS @ np.array([2.0, -1.0])
    for interpolator in [gdel.LinearNDInterpolator, gdel.NaturalNeighborInterpolator]:
        np.testing.assert_allclose(interpolator(tri, values)(queries), [1, 1.5, np.nan, np.nan], atol=1e-12)


def test_values_do_not_cross_a_breakline() -> None:
    grid = np.array([(x, y) for x in range(-4, 5) if x for y in range(-4, 5)] + [(0, -4), (0, 4)])
    tri = gdel.ConstrainedDelaunay(grid, edges=[(len(grid) - 2, len(grid) - 1)])
    values = np.where(grid[:, 0] < 0, 0.0, 1.0)
    found = gdel.NaturalNeighborInterpolator(tri, values)([(0, 0.5), (0.25, 0.5), (3.25, -0.5)])
    np.testing.assert_allclose(found, 1, atol=1e-12)


def test_what_needs_a_delaunay_triangulation() -> None:
    tri = gdel.ConstrainedDelaunay(POINTS, rings=RINGS)
    for call in [
        lambda: tri.update(POINTS),
        lambda: tri.insert([(1, 1)]),
        lambda: tri.remove([0]),
        lambda: gdel.CloughTocher2DInterpolator(tri, np.zeros(9))((1, 1)),
        lambda: gdel.Voronoi(tri).vertices,
        lambda: gdel.alpha_shape(tri),
    ]:
        with pytest.raises(ValueError, match="constraints"):
            call()
    assert tri.to_matplotlib().triangles.shape == (12, 3)
    assert "8 constrained edges" in repr(tri)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"edges": [0, 1]}, "rows of two indices"),
        ({"edges": [(0, 9)]}, "edges has 9, which is not the index of one of the 9 points"),
        ({"edges": [(0, -1)]}, "edges has -1"),
        ({"edges": [(0, 1), (2,)]}, "edges cannot be an array"),
        ({"rings": [[0, 1, 17]]}, r"rings\[0\] has 17"),
        ({"rings": [[(0, 1)]]}, "a ring must be a list of indices"),
        ({"polygons": [[[(0,)]]]}, r"ring 0 of polygons\[0\] must have rows of two coordinates"),
        ({"polygons": [[[(0, np.nan), (0, 1)]]]}, "point 9: the y coordinate is NaN"),
        ({"rings": RINGS, "fill": "odd"}, "fill must be"),
        ({"rings": RINGS, "crossings": "keep"}, "crossings must be"),
    ],
)
def test_bad_constraints(options: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        gdel.ConstrainedDelaunay(POINTS, **options)


def test_wrong_types() -> None:
    with pytest.raises(TypeError, match="whole numbers"):
        gdel.ConstrainedDelaunay(POINTS, edges=[(0.0, 1.0)])
    with pytest.raises(ValueError, match="2D only"):
        gdel.ConstrainedDelaunay(np.zeros((3, 3)))
    line = SimpleNamespace(__geo_interface__={"type": "LineString", "coordinates": SQUARE})
    with pytest.raises(TypeError, match="not a LineString"):
        gdel.ConstrainedDelaunay(None, polygons=[line])


def angles(tri: gdel.ConstrainedDelaunay) -> np.ndarray:
    """Return the angles of the simplices inside, in degrees."""
    corners = tri.points[tri.inside_simplices]
    sides = [corners[:, (k + 1) % 3] - corners[:, k] for k in range(3)]
    turn = [(sides[k], -sides[k - 1]) for k in range(3)]
    return np.degrees(
        [np.arccos((u * v).sum(1) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)) for u, v in turn]
    )


def test_refinement() -> None:
    tri = gdel.ConstrainedDelaunay(POINTS, rings=RINGS)
    assert tri.refinement is None
    assert tri.segment_of.tolist() == list(range(8))
    fine = tri.refine(min_angle=30)
    assert isinstance(fine, gdel.ConstrainedDelaunay)
    assert (tri.npoints, area(fine)) == (9, 72)
    assert fine.points[:9].tolist() == tri.points.tolist()
    assert angles(fine).min() > 29.999
    refinement = fine.refinement
    assert refinement is not None
    assert abs(refinement.min_angle - angles(fine).min()) < 1e-6
    assert refinement.points_on_segments + refinement.points_inside == len(fine.added) == fine.npoints - 9
    assert not refinement.limited
    # Pieces in order: the first side goes from point 0 to point 1.
    first = fine.segments[fine.segment_of == 0]
    assert (first[0][0], first[-1][1]) == (0, 1)
    assert (first[1:, 0] == first[:-1, 1]).all()
    small = tri.refine(max_area=0.25, min_angle=25)
    assert small.volumes[small.inside].max() <= 0.25
    short = tri.refine(size=0.5)
    corners = short.points[short.inside_simplices]
    assert np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max() <= 0.5
    graded = tri.refine(size=[0.1, 3, 3, 3, 3, 3, 3, 3, 3])
    middles = graded.points[graded.inside_simplices].mean(axis=1)
    assert (middles.sum(axis=1) < 4.5).sum() > (middles.sum(axis=1) > 13.5).sum()
    limited = tri.refine(max_area=0.01, max_points=20)
    assert len(limited.added) == 20
    assert limited.refinement is not None
    assert limited.refinement.limited
    assert limited.verify()
    again = pickle.loads(pickle.dumps(fine))
    assert again.refinement == refinement
    assert again.refine(min_angle=30, max_area=1).verify()


def test_refinement_of_what_cannot_be_refined() -> None:
    flat = gdel.ConstrainedDelaunay([(0, 0), (1, 1), (2, 2)], edges=[(0, 2)]).refine()
    assert (flat.nsimplex, len(flat.constraints)) == (0, 2)
    tri = gdel.ConstrainedDelaunay(POINTS)
    cases: list[dict[str, Any]] = [
        {"min_angle": 35},
        {"max_area": -1},
        {"size": 0},
        {"size": [1, 2]},
        {"size": [[1, 2]]},
    ]
    for wrong in cases:
        with pytest.raises(ValueError, match=r"must be|there are"):
            tri.refine(**wrong)


def test_refinement_keeps_what_became_of_segments() -> None:
    points = [(0, 0), (3, 0), (3, 3), (0, 3), (1, 0.1)]
    tri = gdel.ConstrainedDelaunay(points, edges=[(0, 2), (4, 3), (1, 1)], crossings="split")
    assert tri.zero_length == 1
    assert tri.moved > 0
    fine = tri.refine(min_angle=25)
    assert (fine.zero_length, fine.moved) == (tri.zero_length, tri.moved)
