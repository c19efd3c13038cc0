"""Weights with which cells have given volumes."""

import os
import signal
import threading

import numpy as np
import pytest

import gdel


def volumes(points, weights, clip):
    """Return the volumes of the cells that weights have, computed anew."""
    return gdel.Voronoi(gdel.Delaunay(points, weights=weights), clip=clip).volumes


@pytest.mark.parametrize("ndim", [2, 3])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_equal_cells(ndim, dtype):
    points = np.random.default_rng(1).random((300, ndim)).astype(dtype)
    box = [(0,) * ndim, (1,) * ndim]
    found = gdel.transport(points, clip=box)
    assert found.weights.shape == found.volumes.shape == (300,)
    assert found.weights.min() == 0
    assert 0 < found.error <= 1e-3
    assert 1 <= found.steps < 20
    assert repr(found) == f"<gdel.Transport: 300 points, error {found.error:.1e}, {found.steps} steps>"
    again = volumes(points, found.weights, box)
    np.testing.assert_allclose(again, 1 / 300, rtol=1.001e-3)
    np.testing.assert_allclose(found.volumes, again, rtol=1e-9)
    for threads in [1, 2]:
        assert np.array_equal(gdel.transport(points, clip=box, threads=threads).weights, found.weights)


@pytest.mark.parametrize("ndim", [2, 3])
def test_masses_and_tolerance(ndim):
    random = np.random.default_rng(2)
    points, masses = random.random((200, ndim)), random.integers(1, 100, 200)
    coarse = gdel.transport(points, masses, normalize=True)
    fine = gdel.transport(points, masses, normalize=True, tolerance=1e-9)
    assert fine.error <= 1e-9 < coarse.error <= 1e-3
    for found, tolerance in [(coarse, 1.001e-3), (fine, 1e-6)]:
        again = volumes(points, found.weights, "box")
        shares = masses / masses.sum()
        np.testing.assert_allclose(again / again.sum(), shares, rtol=tolerance)
    # Masses that fit are what the volumes are, whatever they are listed as.
    fitting = masses / masses.sum() * again.sum()
    for listed in [fitting, fitting.tolist(), np.repeat(fitting, 2)[::2]]:
        found = gdel.transport(points, listed)
        np.testing.assert_allclose(found.weights, coarse.weights, atol=1e-12)
        np.testing.assert_allclose(found.volumes, fitting, rtol=1.001e-3)


def test_convex_shapes():
    random = np.random.default_rng(3)
    hexagon = np.column_stack([np.cos(np.arange(6) * np.pi / 3), np.sin(np.arange(6) * np.pi / 3)])
    # Many of the points are outside.
    points = random.normal(size=(100, 2))
    found = gdel.transport(points, clip=hexagon)
    area = 1.5 * np.sqrt(3)
    np.testing.assert_allclose(found.volumes, area / 100, rtol=1e-3)
    np.testing.assert_allclose(volumes(points, found.weights, hexagon), area / 100, rtol=1.001e-3)
    octahedron = np.concatenate([np.eye(3), -np.eye(3)])
    points = random.normal(size=(50, 3))
    np.testing.assert_allclose(gdel.transport(points, clip=octahedron).volumes, 4 / 3 / 50, rtol=1e-3)
    points = random.random((50, 2))
    hull = gdel.Delaunay(points).volumes.sum()
    np.testing.assert_allclose(gdel.transport(points, clip="hull").volumes, hull / 50, rtol=1e-3)


def test_flat_and_equal_points():
    # In a plane of space, cells are polygons of it.
    square = np.random.default_rng(4).random((50, 2))
    found = gdel.transport(np.column_stack([square, square[:, 0]]), clip="hull")
    area = gdel.Delaunay(square).volumes.sum() * np.sqrt(2)
    np.testing.assert_allclose(found.volumes, area / 50, rtol=1e-3)
    # Equal ones share a cell by their masses.
    points = [(0, 0), (4, 0), (0, 4), (4, 4), (1, 1), (1, 1)]
    masses = [1, 2, 3, 4, 4, 2]
    found = gdel.transport(points, masses, clip=[(0, 0), (4, 4)])
    np.testing.assert_allclose(found.volumes, masses, rtol=1e-3)
    assert found.weights[4] == found.weights[5]
    tri = gdel.Delaunay(points, weights=found.weights)
    cells = gdel.Voronoi(tri, clip="box").volumes
    np.testing.assert_allclose(cells, [1, 2, 3, 4, 6, 0], rtol=1e-3)
    none = gdel.transport(np.empty((0, 3)))
    assert (none.weights.shape, none.volumes.shape, none.error, none.steps) == ((0,), (0,), 0.0, 0)
    one = gdel.transport([(2, 3)], clip=[(0, 0), (1, 1)])
    assert (one.weights.tolist(), one.volumes.tolist()) == ([0.0], [1.0])


def test_what_is_not_possible():
    points = np.random.default_rng(5).random((9, 2))
    box = [(0, 0), (1, 1)]
    ones = np.ones(9)

    def without(bad):
        return np.where(np.arange(9) == 3, bad, ones)

    for masses, error, message in [
        (without(np.nan), ValueError, "mass 3 is not a positive number"),
        (without(np.inf), ValueError, "mass 3 is not a positive number"),
        (without(-1), ValueError, "mass 3 is not a positive number"),
        (without(0), ValueError, "mass 3 is not a positive number"),
        (ones[1:], ValueError, "8 values for 9 points"),
        (np.ones((9, 1)), ValueError, "masses must have one axis"),
        (["a"] * 9, TypeError, "masses must be real numbers"),
    ]:
        with pytest.raises(error, match=message):
            gdel.transport(points, masses, clip=box, normalize=True)
    with pytest.raises(ValueError, match=r"sum of the masses is 9\.0, but the volume .* is 1\.0"):
        gdel.transport(points, ones, clip=box)
    for clip, message in [
        (None, "a box, a convex shape or the hull"),
        ("circle", "clip must be 'box', 'hull' or corners, not \"circle\""),
        ([(0, 0), (0, 1)], "box"),
        ([(0, 0), (1, 1), (2, 2)], "corners"),
        ([(0, 0), (1, np.nan)], "finite"),
        ([(0, 0, 0), (1, 1, 1)], "row of 2 coordinates"),
    ]:
        with pytest.raises(ValueError, match=message):
            gdel.transport(points, clip=clip)
    for tolerance in [0, 1, -1, np.nan]:
        with pytest.raises(ValueError, match="tolerance"):
            gdel.transport(points, clip=box, tolerance=tolerance)
    with pytest.raises(ValueError, match="point 2"):
        gdel.transport([(0, 0), (1, 0), (np.nan, 1)], clip=box)
    with pytest.raises(ValueError, match="2 or 3 coordinates"):
        gdel.transport(np.ones((5, 4)))
    with pytest.raises(ValueError, match="threads"):
        gdel.transport(points, threads=0)
    # More exact than numbers are.
    with pytest.raises(ValueError, match="cells with these masses were not found"):
        gdel.transport(points, clip=box, tolerance=1e-300)


def test_progress():
    points = np.random.default_rng(6).random((4000, 3))
    seen = []
    found = gdel.transport(points, progress=lambda phase, fraction: seen.append((phase, fraction)))
    fractions = [fraction for _, fraction in seen]
    assert fractions == sorted(fractions)
    assert seen[-1] == ("done", 1.0)
    assert {phase for phase, _ in seen} == {"transport", "done"}
    assert np.array_equal(found.weights, gdel.transport(points).weights)

    def stop(phase, fraction):
        raise LookupError(phase)

    with pytest.raises(LookupError, match="transport"):
        gdel.transport(points, progress=stop)


@pytest.mark.skipif(not hasattr(signal, "SIGINT") or os.name == "nt", reason="signals of POSIX")
def test_ctrl_c():
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    # Fewer points than those of a triangulation that could be interrupted: this takes longer.
    points = np.random.default_rng(7).random((15_000, 3))
    thread = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
    thread.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            gdel.transport(points, tolerance=1e-9)
    finally:
        thread.join()
        signal.signal(signal.SIGINT, before)
