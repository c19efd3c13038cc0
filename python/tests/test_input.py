"""What may be passed as points: nothing crashes, and errors name what is wrong."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import gdel

POINTS = np.random.default_rng(0).random((50, 3))
EXPECTED = gdel.Delaunay(POINTS)


def same(tri):
    np.testing.assert_array_equal(np.sort(np.sort(tri.simplices), axis=0), np.sort(np.sort(EXPECTED.simplices), axis=0))


def test_no_copy():
    assert gdel.Delaunay(POINTS).points is POINTS
    single = POINTS.astype(np.float32)
    assert gdel.Delaunay(single).points is single
    tri = gdel.Delaunay(POINTS)
    assert not tri.simplices.flags.owndata
    assert tri.simplices is tri.simplices
    with pytest.raises(ValueError, match="read-only"):
        tri.simplices[0, 0] = 1


def test_arrays_outlive_what_they_are_of():
    tri = gdel.Delaunay(POINTS)
    simplices, neighbors, expected = tri.simplices, tri.neighbors, tri.simplices.copy()
    del tri
    np.testing.assert_array_equal(simplices, expected)
    assert neighbors.max() == len(simplices) - 1


@pytest.mark.parametrize(
    "make",
    [
        np.asfortranarray,
        lambda p: np.repeat(p, 2, axis=0)[::2],
        lambda p: np.hstack([p, p])[:, :3],
        lambda p: p[::-1][::-1],
        lambda p: p.astype(">f8"),
        lambda p: p.astype(np.longdouble),
        lambda p: p.astype(object),
        lambda p: p.tolist(),
        lambda p: tuple(map(tuple, p)),
        lambda p: np.frombuffer(b"\0" + p.tobytes(), np.uint8)[1:].view(np.float64).reshape(p.shape),
        lambda p: p.view(np.ndarray),
        lambda p: np.ma.array(p).data,
    ],
)
def test_all_forms(make):
    points = make(POINTS.copy())
    same(gdel.Delaunay(points))
    same(gdel.Delaunay(points, threads=2))


def test_read_only():
    points = POINTS.copy()
    points.setflags(write=False)
    same(gdel.Delaunay(points))
    assert EXPECTED.find_simplex(points).min() >= 0


def test_integers_and_halves():
    grid = np.stack(np.meshgrid(range(4), range(3)), axis=-1).reshape(-1, 2)
    volumes = [
        gdel.Delaunay(grid.astype(dtype)).volumes.sum() for dtype in (np.int64, np.uint8, np.float16, bool, np.int16)
    ]
    assert volumes == [6, 6, 6, 1, 6]
    assert gdel.Delaunay(grid.astype(np.float16)).points.dtype == np.float32


@pytest.mark.parametrize(
    ("points", "error", "words"),
    [
        ([[0, 0], [1, np.nan]], ValueError, "point 1: the y"),
        ([[0, 0, np.inf]], ValueError, "point 0: the z"),
        ([[0, 0], [1]], ValueError, "row 1"),
        ([[0, 0], [1, "x"]], TypeError, "<U"),
        (np.array([[0, 0], [1, None]], object), ValueError, "point 1: the y"),
        (np.array([[0, 0], [{}, 1]], object), TypeError, r"points\[1\]"),
        ([[0, 1j]], TypeError, "complex"),
        (np.zeros((2, 2), "datetime64[s]"), TypeError, "datetime"),
        (np.zeros(4), ValueError, "shape"),
        (5, ValueError, "shape"),
        ([], ValueError, "shape"),
        (None, ValueError, "shape"),
        (np.zeros((3, 4)), ValueError, "2 or 3"),
        (np.zeros((3, 1)), ValueError, "2 or 3"),
        (np.zeros((3, 0)), ValueError, "2 or 3"),
        (np.zeros((2, 2, 2)), ValueError, "shape"),
        (np.ma.masked_all((3, 2)), ValueError, "masked"),
        ("points", TypeError, "<U"),
        ({"x": 1}, TypeError, r"points\[0\]"),
    ],
)
def test_errors_name_what_is_wrong(points, error, words):
    with pytest.raises(error, match=words):
        gdel.Delaunay(points)


def test_wrong_queries():
    with pytest.raises(ValueError, match="3 coordinates"):
        EXPECTED.find_simplex(np.zeros((4, 2)))
    with pytest.raises(ValueError, match="3 coordinates"):
        EXPECTED.find_simplex(3.0)
    with pytest.raises(ValueError, match="k must"):
        EXPECTED.nearest(np.zeros(3), 0)
    assert EXPECTED.find_simplex(np.empty((0, 3))).shape == (0,)
    assert EXPECTED.nearest(np.empty((0, 3)), 2).shape == (0, 2)


NUMBERS = st.one_of(
    hnp.floating_dtypes(),
    hnp.integer_dtypes(),
    hnp.complex_number_dtypes(),
    hnp.boolean_dtypes(),
    hnp.unicode_string_dtypes(),
    st.just(np.dtype(object)),
)


@settings(max_examples=150, deadline=None)
@given(st.data())
def test_nothing_crashes(data):
    dtype = data.draw(NUMBERS)
    shape = data.draw(
        st.one_of(
            hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=8),
            st.tuples(st.integers(0, 12), st.integers(2, 3)),
        )
    )
    elements = st.one_of(st.floats(), st.none(), st.text(max_size=2)) if dtype.kind == "O" else None
    array = data.draw(hnp.arrays(dtype, shape, elements=elements))
    array = data.draw(st.sampled_from([array, array[::-1], array.T, np.asfortranarray(array)])) if array.ndim else array
    if data.draw(st.booleans()):
        array.setflags(write=False)
    try:
        tri = gdel.Delaunay(array)
    except (ValueError, TypeError):
        return
    assert tri.verify()
    assert tri.points.shape == array.shape
