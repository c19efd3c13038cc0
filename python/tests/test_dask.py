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
