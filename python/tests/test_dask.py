"""Meshes in pieces by Dask: any scheduler, lost workers, files."""

import json
import os
import signal

import dask
import dask.array as da
import numpy as np
import pytest

import gdel
import gdel.dask


@pytest.fixture(autouse=True)
def one_thread():
    """Without a cluster, tasks run one after the other."""
    with dask.config.set(scheduler="synchronous"):
        yield


def simplices(mesh):
    """Return the simplices of all pieces by the indices of the whole input, in one order."""
    name = "tetrahedra" if mesh.ndim == 3 else "triangles"
    pieces = dask.compute(*mesh.pieces)
    rows = np.concatenate([piece["indices"][piece[name]] for piece in pieces])
    return np.unique(np.sort(rows.astype(np.int64), axis=1), axis=0)


def expected(points):
    return np.unique(np.sort(gdel.Delaunay(points).simplices, axis=1), axis=0)


@pytest.mark.parametrize("ndim", [2, 3])
@pytest.mark.parametrize("tiles", [1, 2, 7])
def test_the_mesh_is_that_of_all_points(ndim, tiles):
    points = np.random.default_rng(1).random((4000, ndim))
    # Ties, and duplicates across blocks.
    points[:1000] = np.round(points[:1000], 1)
    mesh = gdel.dask.delaunay(da.from_array(points, chunks=(700, 1)), tiles=tiles)
    assert (len(mesh), mesh.npoints, mesh.ndim, mesh.dimension) == (tiles, 4000, ndim, ndim)
    whole = expected(points)
    assert np.array_equal(simplices(mesh), whole)
    assert mesh.nsimplex == len(whole)
    pieces = dask.compute(*mesh.pieces)
    found = np.concatenate([piece["indices"][piece["tiles"] == tile] for tile, piece in enumerate(pieces)])
    assert np.array_equal(np.sort(found), np.arange(4000))
    for piece in pieces:
        assert np.array_equal(piece["points"], points[piece["indices"]])
    # Links lead from one simplex to another with the same facet.
    adjacency = "neighbors" if ndim == 3 else "halfedges"
    names = "tetrahedra" if ndim == 3 else "triangles"
    for piece in pieces:
        assert (piece[adjacency].ravel()[piece["links"][:, 0]] == -1).all()
        for place, tile, entry in piece["links"][:50]:
            other = pieces[tile]
            here = set(piece["indices"][piece[names][place // (ndim + 1)]])
            there = other["indices"][other[names][entry if ndim == 3 else entry // 3]]
            assert len(here & set(there)) == ndim


def test_blocks_are_arrays_files_or_delayed_arrays(tmp_path):
    points = np.random.default_rng(2).random((900, 3)).astype(np.float32)
    np.save(tmp_path / "first.npy", points[:300])
    blocks = [tmp_path / "first.npy", points[300:500], dask.delayed(points[500:])]
    assert np.array_equal(simplices(gdel.dask.delaunay(blocks, tiles=3)), expected(points))
    np.savetxt(tmp_path / "points.txt", points[:300].astype(float))
    mesh = gdel.dask.delaunay([tmp_path / "points.txt"], tiles=2, read=np.loadtxt)
    assert np.array_equal(simplices(mesh), expected(points[:300].astype(float)))
    # Chunks of which Dask does not know the sizes.
    array = da.from_array(points, chunks=(300, 3))
    left = array[array[:, 0] < 0.5]
    assert np.array_equal(simplices(gdel.dask.delaunay(left, tiles=2)), expected(points[points[:, 0] < 0.5]))


def test_volumes_of_stars():
    points = np.random.default_rng(3).random((2000, 3))
    points[7] = points[1900]
    mesh = gdel.dask.delaunay(da.from_array(points, chunks=(500, 3)), tiles=4)
    volumes = np.zeros(2000)
    for indices, found in dask.compute(*mesh.star_volumes()):
        volumes[indices] = found
    tri = gdel.Delaunay(points)
    corners = points[tri.simplices]
    each = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6
    whole = np.zeros(2000)
    for corner in tri.simplices.T:
        np.add.at(whole, corner, each)
    whole[1900] = whole[7]
    assert np.allclose(volumes, whole, rtol=1e-12)


def grid(side, ndim):
    axes = np.meshgrid(*[np.arange(side)] * ndim)
    return np.stack(axes, axis=-1).reshape(-1, ndim).astype(float)


def uniform(rng, ndim):
    return rng.random((200, ndim))


def single_precision(rng, ndim):
    return rng.random((150, ndim)).astype(np.float32)


def ties(rng, ndim):
    return rng.permutation(grid(14 if ndim == 2 else 6, ndim))


def rounded_ties(rng, ndim):
    """Radii, and places on facets, are equal only up to rounding, and the hull is not quite flat."""
    rotation, _ = np.linalg.qr(rng.normal(size=(ndim, ndim)))
    return ties(rng, ndim) * 0.1 @ rotation


def hollow(rng, ndim):
    points = rng.normal(size=(150, ndim))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def clusters(rng, ndim):
    return rng.integers(0, 3, (200, ndim)) + rng.normal(size=(200, ndim)) * 1e-3


def duplicates(rng, ndim):
    points = np.round(rng.random((250, ndim)), 1)
    points[::3] = rng.random(points[::3].shape)
    return points


def nine(rng, ndim):
    """More tiles than that have own points only here and there, or none."""
    return rng.permutation(np.concatenate([np.eye(ndim + 1, ndim), rng.integers(0, 3, (8 - ndim, ndim))]))


INPUTS = [uniform, single_precision, ties, rounded_ties, hollow, clusters, duplicates, nine]


@pytest.fixture(params=[(kind, ndim) for kind in INPUTS for ndim in (2, 3)], ids=lambda p: f"{p[0].__name__}-{p[1]}")
def whole(request):
    """Points, and their triangulation."""
    kind, ndim = request.param
    points = kind(np.random.default_rng(11), ndim)
    return points, gdel.Delaunay(points)


def meshes(points):
    """Return the mesh in so many tiles, of blocks that do not end where tiles do."""
    size = -(-len(points) // 3)
    for tiles in (1, 2, 3, 8):
        yield gdel.dask.delaunay(da.from_array(points, chunks=(size, points.shape[1])), tiles=tiles)


def queries_of(points, tri):
    """Return places in simplices, on facets, edges, vertices and the hull, beside it, between points, and far away."""
    rng, ndim = np.random.default_rng(12), tri.ndim
    corners = points[tri.simplices[rng.integers(0, tri.nsimplex, 40)]].astype(float)
    weights = rng.dirichlet(np.ones(ndim + 1), 40)
    inside = (weights[:, :, None] * corners).sum(axis=1)
    weights[:, 0] = 0
    on_facets = (weights[:, :, None] * corners).sum(axis=1) / weights.sum(axis=1, keepdims=True)
    hull = points[tri.convex_hull].astype(float)
    hull = (rng.dirichlet(np.ones(ndim), len(hull))[:, :, None] * hull).sum(axis=1)
    beside = hull * (1 + rng.integers(-3, 4, hull.shape) * np.finfo(float).eps)
    low, high = points.min(axis=0), points.max(axis=0)
    around = low + (high - low) * (3 * rng.random((40, ndim)) - 1)
    between = points[rng.integers(0, len(points), (40, 2))].astype(float).mean(axis=1)
    middles = corners[:, :2].mean(axis=1)
    not_finite = [[np.nan] * ndim, [np.inf, *[0] * (ndim - 1)]]
    parts = [inside, on_facets, middles, corners[:, 0], hull, beside, around, between, [[1e300] * ndim], not_finite]
    return np.concatenate(parts)


def test_nearest_vertices_are_those_of_the_mesh_of_all_points(whole):
    points, tri = whole
    xi = queries_of(points, tri)
    for mesh in meshes(points):
        assert np.array_equal(mesh.nearest(xi), tri.nearest(xi))


def test_interpolated_values_are_those_of_the_mesh_of_all_points(whole):
    points, tri = whole
    xi = queries_of(points, tri)
    values = np.random.default_rng(13).random((len(points), 2))
    # Of so many values, that of another simplex is seen.
    values[:, 1] *= 1e6
    expected = gdel.LinearNDInterpolator(tri, values)(xi)
    assert np.isnan(expected).any() and np.isfinite(expected).any()
    for mesh in meshes(points):
        found = mesh.interpolate(values, xi)
        assert np.allclose(found, expected, rtol=1e-13, atol=1e-9, equal_nan=True)
        if points.dtype == np.float64:
            # What counts as inside depends on the precision of queries.
            single = xi[np.isfinite(xi).all(axis=1)][:-1].astype(np.float32)
            of_all = gdel.LinearNDInterpolator(tri, values)(single)
            assert np.allclose(mesh.interpolate(values, single), of_all, rtol=1e-13, atol=1e-9, equal_nan=True)


def oriented(facets):
    """Return facets in one order, each with its lowest vertex first."""
    facets = np.array(facets, np.int64)
    columns = (facets.argmin(axis=1)[:, None] + np.arange(facets.shape[1])) % facets.shape[1]
    facets = np.take_along_axis(facets, columns, axis=1)
    return facets[np.lexsort(facets.T)]


def test_alpha_shapes_are_those_of_the_mesh_of_all_points(whole):
    points, tri = whole
    auto = gdel.alpha_shape(tri)
    # The radius of simplices of the grids is written in decimals.
    radii = [0, np.median(auto.radii), auto.radii[0], auto.alpha, 0.05 * np.sqrt(tri.ndim), 0.5 * np.sqrt(tri.ndim)]
    radii = [float(alpha) for alpha in (*radii, np.inf)]
    expected = [oriented(gdel.alpha_shape(tri, alpha).facets) for alpha in radii]
    for mesh in meshes(points):
        pieces, shapes = dask.compute(mesh.pieces, [mesh.alpha_shape(alpha) for alpha in radii])
        for alpha, parts, facets in zip(radii, shapes, expected, strict=True):
            assert np.array_equal(oriented(np.concatenate(parts)), facets), alpha
            for tile, (piece, part) in enumerate(zip(pieces, parts, strict=True)):
                assert np.isin(part.min(axis=1), piece["indices"][piece["tiles"] == tile]).all()


def test_simplices_that_only_a_tile_has_do_not_raise_alpha():
    """A triangle that is nearly flat equals alpha up to a rounding that is larger than what a true one differs by."""
    sliver = np.array([(0, 0), (1, 0), (0.5, -5.6e-4)])
    radius = gdel.alpha_shape(sliver).radii[0]
    angles = np.array([0, 2, 4])
    large = radius * (1 - 2e-10) * np.stack([np.cos(angles), np.sin(angles)], axis=1) - [0, 1000]
    points = np.concatenate([sliver, large])
    stars = gdel.dask.Stars(gdel.Delaunay(points), np.arange(6, dtype=np.uint32), np.arange(6) >= 3)
    alpha = radius * (1 - 5e-10)
    assert gdel.alpha_shape(stars.mesh, alpha).alpha == pytest.approx(radius, rel=1e-12)
    true = stars.mesh.simplices[stars.around]
    assert [3, 4, 5] in np.sort(true).tolist() and [0, 1, 2] not in np.sort(true).tolist()
    found = gdel._stars.solid_of(stars, alpha)
    assert found["alpha"] == alpha
    assert not found["solid"][np.sort(true).tolist().index([3, 4, 5])]


def test_voronoi_volumes_are_those_of_the_mesh_of_all_points(whole):
    points, tri = whole
    low, high = points.min(axis=0).astype(float), points.max(axis=0).astype(float)
    clips = [low, high], [low - 1, high + (high - low) / 2], None
    for mesh in meshes(points):
        for clip, parts in zip(clips, *dask.compute([mesh.voronoi_volumes(clip) for clip in clips]), strict=True):
            volumes = np.full(len(points), np.nan)
            for indices, found in parts:
                volumes[indices] = found
            expected = gdel.Voronoi(tri, clip=clip).volumes
            # Cells whose vertices are nearly at infinity have volumes that are no more than rounding.
            usual = (clip is not None) | np.isinf(expected) | (np.abs(expected) < 1e3)
            assert usual.sum() > len(points) / 2
            assert np.allclose(volumes[usual], expected[usual], rtol=1e-9, atol=1e-12)


def test_stars_have_all_simplices_around_own_points(whole):
    points, tri = whole
    rows = np.sort(tri.simplices.astype(np.int64), axis=1)
    for mesh in meshes(points):
        pieces, found = dask.compute(mesh.pieces, mesh.stars())
        for tile, stars in enumerate(found):
            own = stars.indices[stars.own]
            assert np.array_equal(own, pieces[tile]["indices"][pieces[tile]["tiles"] == tile])
            assert (np.diff(stars.indices.astype(np.int64)) > 0).all()
            assert np.array_equal(stars.mesh.points, points[stars.indices])
            assert stars.mesh.points.dtype == points.dtype
            found = np.sort(stars.indices[stars.mesh.simplices[stars.around]].astype(np.int64), axis=1)
            around = rows[np.isin(rows, own).any(axis=1)]
            assert np.array_equal(np.unique(found, axis=0).reshape(-1, tri.ndim + 1), np.unique(around, axis=0))
            assert len(found) == len(around)


def test_tiles_take_hulls_of_their_own_for_none_of_all_points():
    """A query that is outside of what a tile knows by a rounding is inside the whole hull, or the other way around."""
    rng = np.random.default_rng(14)
    # Points near the origin, where roundings are small, and few far away.
    points = np.concatenate([rounded_ties(rng, 2), [[4000.0, 4000.0], [-4000.0, 1000.0]]])
    tri = gdel.Delaunay(points)
    hull = points[tri.convex_hull]
    xi = np.concatenate([hull.mean(axis=1) * (1 + k * 1e-15) for k in range(-4, 5)])
    values = rng.random(len(points))
    expected = gdel.LinearNDInterpolator(tri, values)(xi)
    for mesh in meshes(points):
        assert np.allclose(mesh.interpolate(values, xi), expected, rtol=1e-9, equal_nan=True)


def test_dask_arrays_have_answers_of_their_shape(tmp_path):
    rng = np.random.default_rng(15)
    points, values = rng.random((300, 2)), rng.random(300)
    tri = gdel.Delaunay(points)
    mesh = gdel.dask.delaunay([points], tiles=3)
    xi = 1.2 * rng.random((20, 15, 2))
    lazy = da.from_array(xi, chunks=(8, 5, 1))
    nearest = mesh.nearest(lazy)
    assert (nearest.chunks, nearest.dtype) == (((8, 8, 4), (5, 5, 5)), np.int64)
    assert np.array_equal(nearest.compute(), tri.nearest(xi))
    # Parts are computed alone, and answers with others.
    assert np.array_equal(nearest[-1].compute(), tri.nearest(xi[-1]))
    assert np.array_equal((nearest + 1).compute(), tri.nearest(xi) + 1)

    for columns in (values, np.stack([values, points[:, 0]], axis=1), values * (1 + 2j), points[:, 0] > 0.5):
        expected = gdel.LinearNDInterpolator(tri, columns, fill_value=-1)(xi)
        blocks = [columns[:50], dask.delayed(columns[50:120]), columns[120:]]
        np.save(tmp_path / "values.npy", columns)
        of_dask = da.from_array(columns, chunks=(70, *[1] * (columns.ndim - 1)))
        for given in (columns, of_dask, blocks, [tmp_path / "values.npy"]):
            found = mesh.interpolate(given, lazy, fill_value=-1)
            assert (found.shape, found.dtype) == (expected.shape, expected.dtype)
            assert np.allclose(found.compute(), expected, rtol=1e-13, atol=1e-14)
    # Chunks of which Dask does not know the sizes.
    rows = da.from_array(xi.reshape(-1, 2), chunks=(70, 2))
    left = rows[rows[:, 0] < 0.5]
    assert np.array_equal(mesh.nearest(left).compute(), tri.nearest(left.compute()))
    assert np.allclose(
        mesh.interpolate(columns, left).compute(),
        gdel.LinearNDInterpolator(tri, columns)(left.compute()),
        equal_nan=True,
    )


def test_what_is_kept_is_not_computed_again():
    points = np.random.default_rng(22).random((200, 2))
    mesh = gdel.dask.delaunay([points], tiles=3).persist()
    tasks = []
    with dask.callbacks.Callback(pretask=lambda key, *_: tasks.append(str(key))):
        assert mesh.nearest(points).tolist() == list(range(200))
        assert mesh.nsimplex == gdel.Delaunay(points).nsimplex
    assert any("nearest" in task for task in tasks)
    assert not [task for task in tasks if task.startswith(("gdel-stars", "gdel-linked", "gdel-piece", "gdel-known"))]
    flat = gdel.dask.delaunay([np.ones((9, 2))], tiles=2).persist()
    assert (flat.dimension, flat.nsimplex) == (0, 0)


def test_few_queries_and_none():
    points = np.random.default_rng(16).random((100, 3))
    mesh = gdel.dask.delaunay([points], tiles=2)
    assert mesh.nearest(points[7].tolist()).shape == ()
    assert mesh.nearest(points[7].tolist()) == 7
    assert mesh.interpolate(points[:, 1], points[7]) == points[7, 1]
    assert mesh.nearest(da.from_array(points[7])).compute() == 7
    assert mesh.nearest(np.empty((0, 3))).shape == (0,)
    assert mesh.interpolate(points, np.empty((4, 0, 3))).shape == (4, 0, 3)
    assert mesh.nearest(da.empty((0, 3))).compute().shape == (0,)
    assert mesh.nearest(np.full((2, 3), np.nan)).tolist() == [-1, -1]


def test_values_of_equal_points_are_that_of_the_first():
    points = np.random.default_rng(17).random((200, 2))
    points[150:] = points[20:70]
    mesh = gdel.dask.delaunay(da.from_array(points, chunks=(60, 2)), tiles=3)
    values = np.arange(200.0)
    assert mesh.nearest(points[150:]).tolist() == list(range(20, 70))
    assert mesh.interpolate(values, points[150:]).tolist() == list(range(20, 70))
    volumes = dict(pair for part in dask.compute(*mesh.voronoi_volumes()) for pair in zip(*part, strict=True))
    assert len(volumes) == 200 and all(volumes[k] == 0 for k in range(150, 200))


def test_distances_beyond_the_range_of_numbers():
    """Squares of distances that are zero or infinite are compared as well."""
    for scale in (1e-200, 1e-160, 1e200):
        points = np.random.default_rng(18).random((60, 2)) * scale
        xi = np.random.default_rng(19).random((300, 2)) * scale
        tri = gdel.Delaunay(points)
        for mesh in meshes(points):
            assert np.array_equal(mesh.nearest(xi), tri.nearest(xi))


def test_flat_points_have_no_answers():
    points = np.random.default_rng(5).random((50, 3))
    points[:, 2] = 1
    mesh = gdel.dask.delaunay([points], tiles=2)
    answers = [
        mesh.stars,
        mesh.voronoi_volumes,
        lambda: mesh.alpha_shape(1),
        lambda: mesh.nearest([(0, 0, 1)]),
        lambda: mesh.interpolate(points[:, 0], [(0, 0, 1)]),
    ]
    for answer in answers:
        with pytest.raises(ValueError, match="the points are flat, of dimension 2 and not 3"):
            answer()
    with pytest.raises(ValueError, match="of dimension 0 and not 2"):
        gdel.dask.delaunay([np.empty((0, 2))]).nearest([(0, 0)])


def test_bad_questions():
    points = np.random.default_rng(20).random((30, 2))
    mesh = gdel.dask.delaunay([points], tiles=2)
    values = points[:, 0]
    for xi in ([(0, 0, 0)], 7, da.zeros((5, 3)), da.zeros(())):
        with pytest.raises(ValueError, match="the last axis of xi must have 2 coordinates"):
            mesh.nearest(xi)
        with pytest.raises(ValueError, match="the last axis of xi must have 2 coordinates"):
            mesh.interpolate(values, xi)
    with pytest.raises(TypeError, match="xi"):
        mesh.nearest([("a", "b")])
    wrong = [
        (values[:-1], "there are 29 values for 30 points"),
        ([values, values[:1]], "there are 31 values for 30 points"),
        ([], "there are no blocks of values"),
        (values.tolist(), "not numbers"),
        ([points[:15], values[15:]], "must have one shape"),
    ]
    for given, message in wrong:
        with pytest.raises(ValueError, match=message):
            mesh.interpolate(given, [(0, 0)])
    with pytest.raises(TypeError, match="values must be numbers"):
        mesh.interpolate(np.array(["a"] * 30), [(0, 0)])
    with pytest.raises(ValueError, match="fill_value is complex"):
        mesh.interpolate(values, [(0, 0)], fill_value=1j)
    for alpha in (-1, np.nan, "auto"):
        with pytest.raises(ValueError, match="alpha must be a number that is not negative"):
            mesh.alpha_shape(alpha)
    with pytest.raises(ValueError, match="no tile knows the hull"):
        mesh.voronoi_volumes("hull")
    with pytest.raises(ValueError, match="the box has no inside"):
        mesh.voronoi_volumes([(1, 1), (0, 0)])


def test_a_folder_is_what_the_command_line_writes(tmp_path):
    points = np.random.default_rng(4).random((1000, 2))
    mesh = gdel.dask.delaunay([points], tiles=3)
    mesh.to_folder(tmp_path / "mesh")
    names = sorted(entry.name for entry in (tmp_path / "mesh").iterdir())
    assert names == ["mesh.json", "tile-00000.npz", "tile-00001.npz", "tile-00002.npz"]
    index = json.loads((tmp_path / "mesh" / "mesh.json").read_text())
    assert (index["gdel"], index["dim"]) == ("mesh in tiles", 2)
    assert (index["points"], index["simplices"]) == (1000, mesh.nsimplex)
    with np.load(tmp_path / "mesh" / "tile-00001.npz") as tile:
        types = {name: str(tile[name].dtype) for name in tile.files}
    words = dict.fromkeys(["indices", "tiles", "triangles", "duplicates", "links"], "uint32")
    assert types == {"points": "float64", "halfedges": "int32", **words}
    mesh.to_folder(tmp_path / "mesh")
    (tmp_path / "mesh" / "letter.txt").write_text("dear")
    with pytest.raises(FileExistsError, match=r"letter\.txt"):
        mesh.to_folder(tmp_path / "mesh")


def test_flat_points_have_no_simplices():
    points = np.random.default_rng(5).random((300, 3))
    points[:, 2] = 1
    mesh = gdel.dask.delaunay([points], tiles=2)
    assert (mesh.dimension, mesh.nsimplex) == (2, 0)
    assert "300 points in 3D, 2 tiles" in repr(mesh)


def test_bad_input():
    with pytest.raises(ValueError, match="2 or all have 3 coordinates"):
        gdel.dask.delaunay([np.zeros((3, 3)), np.zeros((3, 2))])
    with pytest.raises(ValueError, match="two axes"):
        gdel.dask.delaunay(da.zeros(7))
    with pytest.raises(ValueError, match="no blocks"):
        gdel.dask.delaunay([])
    with pytest.raises(ValueError, match="at least one tile"):
        gdel.dask.delaunay([np.zeros((3, 3))], tiles=0)
    with pytest.raises(ValueError, match="point 4: the y coordinate is NaN"):
        gdel.dask.delaunay([np.zeros((3, 2)), np.array([[0, 1], [0, np.nan]])])
    with pytest.raises(ValueError, match="not a message"):
        gdel._gdel.tiles_plan([b"nothing"], 3, 2)


def test_blocks_of_other_workers_are_not_aligned():
    points = np.random.default_rng(21).random((40, 2))
    received = np.frombuffer(b"-" + points.tobytes(), np.uint8)[1:].view(float).reshape(40, 2)
    assert not received.flags.aligned
    plan, _ = gdel._gdel.tiles_plan([gdel.dask._survey(received, 0, 1)], 2, 2)
    parts = gdel.dask._split(plan, received, 0)
    assert np.array_equal(np.sort(np.concatenate([indices for _, indices in parts])), np.arange(40))


def _kills_once(points, mark):
    """Return the points; the first worker that is asked dies."""
    from distributed import get_worker

    get_worker()
    if not os.path.exists(mark):
        open(mark, "w").close()
        os.kill(os.getpid(), signal.SIGKILL)
    return points


@pytest.mark.filterwarnings("ignore")
def test_workers_may_be_lost(tmp_path):
    distributed = pytest.importorskip("distributed")
    points = np.random.default_rng(6).random((3000, 3))
    whole = expected(points)
    with (
        dask.config.set(
            {
                "distributed.scheduler.allowed-failures": 10,
                # However slow the machine is.
                "distributed.comm.timeouts.connect": "600s",
                "distributed.comm.timeouts.tcp": "600s",
            }
        ),
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50) as cluster,
        distributed.Client(cluster) as client,
        dask.config.set(scheduler="distributed"),
    ):
        # One dies with a block of points, …
        blocks = [dask.delayed(_kills_once)(points[:1000], str(tmp_path / "killed")), points[1000:]]
        mesh = gdel.dask.delaunay(blocks, tiles=4)
        assert (tmp_path / "killed").exists()
        # … another one after the exchange, with tiles in its memory.
        client.wait_for_workers(2)
        worker = next(iter(client.run(os.getpid).values()))
        os.kill(worker, signal.SIGKILL)
        assert np.array_equal(simplices(mesh), whole)
        # Stars go from one worker to another as well.
        xi = points[::100]
        assert np.array_equal(mesh.nearest(da.from_array(xi, chunks=(10, 3))).compute(), np.arange(0, 3000, 100))
        assert np.allclose(mesh.interpolate(points[:, 0], xi), xi[:, 0])
