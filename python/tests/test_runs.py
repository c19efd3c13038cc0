"""How runs behave: threads, Ctrl-C, progress, other processes."""

import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import gdel

POINTS = np.random.default_rng(0).random((100_000, 3))


def test_progress():
    seen = []
    gdel.Delaunay(POINTS, backend="cpu", progress=lambda phase, fraction: seen.append((phase, fraction)))
    fractions = [fraction for _, fraction in seen]
    assert fractions == sorted(fractions)
    assert seen[-1] == ("done", 1.0)
    assert {phase for phase, _ in seen} <= {"sort", "insert", "finish", "done"}
    seen.clear()
    gdel.Delaunay(POINTS[:10], progress=lambda *now: seen.append(now))
    assert seen == [("done", 1.0)]
    with pytest.raises(TypeError, match="progress"):
        gdel.Delaunay(POINTS[:10], progress=3)


def test_progress_by_tqdm(capsys):
    pytest.importorskip("tqdm")
    gdel.Delaunay(POINTS, backend="cpu", progress=True)
    assert "100 %" in capsys.readouterr().err


def test_an_exception_in_the_callback_stops_the_run():
    def stop(phase, fraction):
        raise LookupError(phase)

    with pytest.raises(LookupError):
        gdel.Delaunay(POINTS, backend="cpu", progress=stop)


@pytest.fixture
def answering():
    """Has the process answer Ctrl-C: a shell starts background processes so that they ignore it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.skipif(not hasattr(signal, "SIGINT") or os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize("threads", [None, 1, 2])
def test_ctrl_c(threads, answering):
    points = np.random.default_rng(1).random((1_000_000, 3))
    goes_on = threading.Event()
    seen = []

    def press():
        goes_on.wait()
        os.kill(os.getpid(), signal.SIGINT)

    def progress(phase, fraction):
        seen.append(fraction)
        goes_on.set()

    thread = threading.Thread(target=press)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        gdel.Delaunay(points, backend="cpu", threads=threads, progress=progress)
    thread.join()
    assert seen[-1] < 1.0


def test_the_lock_is_released():
    count = 0
    done = threading.Event()

    def work():
        gdel.Delaunay(POINTS, backend="cpu", threads=1)
        done.set()

    thread = threading.Thread(target=work)
    thread.start()
    while not done.is_set():
        count += 1
        time.sleep(0.001)
    thread.join()
    assert count > 10


def test_threads_share_an_object():
    points = POINTS[:5000]
    tri = gdel.Delaunay(points)
    expected = tri.find_simplex(points[:500] + 1e-3)
    values = np.arange(5000.0)
    errors = []

    def work(number):
        try:
            for i in range(5):
                interpolator = gdel.LinearNDInterpolator(tri, values)
                assert interpolator(points[:100]).shape == (100,)
                if number == 0:
                    tri.insert(POINTS[5000 + i : 5001 + i])
                    values.setflags(write=False)
                elif number == 1:
                    tri.nearest(points[:100], 3)
                else:
                    tri.find_simplex(points[:500])
        except ValueError as error:
            # The interpolator saw the triangulation with a point more.
            assert "values for" in str(error)
        except BaseException as error:
            errors.append(error)

    threads = [threading.Thread(target=work, args=(number,)) for number in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not errors
    assert len(tri.points) > 5000
    np.testing.assert_array_equal(gdel.Delaunay(points).find_simplex(points[:500] + 1e-3) < 0, expected < 0)


@pytest.mark.parametrize("ndim", [2, 3])
@pytest.mark.parametrize("protocol", [2, 5])
def test_pickling(ndim, protocol):
    tri = gdel.Delaunay(np.ascontiguousarray(POINTS[:500, :ndim]), threads=2)
    tri.remove([7])
    other = pickle.loads(pickle.dumps(tri, protocol))
    np.testing.assert_array_equal(other.simplices, tri.simplices)
    np.testing.assert_array_equal(other.neighbors, tri.neighbors)
    np.testing.assert_array_equal(other.convex_hull, tri.convex_hull)
    assert other.threads == 2
    assert other.verify()
    other.insert(POINTS[600:610, :ndim])
    assert other.verify()
    voronoi = pickle.loads(pickle.dumps(gdel.Voronoi(tri), protocol))
    assert len(voronoi.ridge_points)


def received(item):
    """Return what another process gets: arrays that lie at odd places of a message."""
    buffers = []
    pickled = pickle.dumps(item, 5, buffer_callback=buffers.append)
    return pickle.loads(pickled, buffers=[memoryview(b"-" + buffer.raw().tobytes())[1:] for buffer in buffers])


@pytest.mark.parametrize("ndim", [2, 3])
def test_what_other_processes_receive_is_not_aligned(ndim):
    assert not received(np.zeros(9)).flags.aligned
    points = np.ascontiguousarray(POINTS[:300, :ndim])
    tri = gdel.Delaunay(points)
    other = received(tri)
    np.testing.assert_array_equal(other.nearest(points), np.arange(300))
    assert other.verify()
    for kind in (gdel.LinearNDInterpolator, gdel.NaturalNeighborInterpolator):
        smooth = kind(tri, points[:, 0], **({} if kind is gdel.LinearNDInterpolator else {"method": "sibson-c1"}))
        expected = smooth(points[:50])
        np.testing.assert_array_equal(received(smooth)(points[:50]), expected)
    if ndim == 2:
        assert received(gdel.ConstrainedDelaunay(points[:20], edges=[(0, 1)])).verify()


def count_simplices(points):
    return gdel.Delaunay(points, backend="cpu").nsimplex


def test_joblib():
    joblib = pytest.importorskip("joblib")
    parts = np.split(POINTS[:4000], 4)
    found = joblib.Parallel(n_jobs=2)(joblib.delayed(count_simplices)(part) for part in parts)
    assert found == [count_simplices(part) for part in parts]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_children_of_a_process_with_threads():
    expected = count_simplices(POINTS)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        result = pool.map_async(count_simplices, [POINTS] * 2)
        assert result.get(120) == [expected] * 2


FORK = """
import os, sys
import numpy as np
import gdel

points = np.random.default_rng(0).random((20_000, 3))
try:
    gdel.Delaunay(points, backend="gpu")
except gdel.GpuError as error:
    print("no GPU", error)
child = os.fork()
if child == 0:
    try:
        gdel.Delaunay(points, backend="gpu")
        print("no error")
    except gdel.GpuError as error:
        print("child:", error)
    print("auto:", gdel.Delaunay(points).backend)
    sys.stdout.flush()
    os._exit(0)
os.waitpid(child, 0)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
def test_a_gpu_is_not_used_after_fork():
    run = subprocess.run([sys.executable, "-W", "ignore", "-c", FORK], capture_output=True, text=True, timeout=300)
    assert "child: the GPU cannot be used: this process was forked" in run.stdout, run.stdout + run.stderr
    assert "auto: cpu" in run.stdout


def test_adapters():
    for adapter in gdel.adapters():
        assert adapter["name"]
        assert adapter["software"] in (True, False)
