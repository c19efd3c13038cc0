#!/usr/bin/env python3
"""Compares what gdel derives from a mesh with CGAL, SciPy, kiddo and voro++, in one run, on one core.

    benches/answers.py [--runs N] [--points N] [--queries N] [--peers CGAL,SciPy,kiddo,voro++]
    benches/answers.py --equal [POINTS]

Runs all sides in turn, a fresh process each time, and prints a table in Markdown: medians of the seconds of processor
time without file access, and their ratio with the range over the runs. Fails when two sides disagree: about the number
of queries inside the hull, the nearest points, or the neighbours of Voronoi cells. Needs g++, CGAL and voro++ (Debian:
apt-get install g++ libcgal-dev voro++-dev), and SciPy; a side whose program is missing is left out with a note.

With --equal, compares answers instead of times, number by number, and fails where one is not as near to the other as
BARS says: linear interpolation with SciPy's, the weights of natural neighbours with what they have to reproduce, the
alpha intervals of all simplices and the radius `auto` with CGAL's, spanning trees with brute force; the `auto` surface
has to be closed and to have the solid inside. It needs all of CGAL, SciPy and NumPy.
"""

import argparse
import datetime
import json
import os
import pathlib
import platform
import shutil
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = ROOT / ".cache" / "bench"
PEERS = ROOT / "benches" / "peers"
POINTS, QUERIES = FOLDER / "points.f64", FOLDER / "queries.f64"
VORONOI_POINTS = "100000"


FLAGS = ["-std=c++17", "-O3", "-DNDEBUG", "-frounding-math"]


def build_bench(name):
    """Returns the path of one of our programs."""
    cargo = ["cargo", "bench", "--locked", "--no-default-features", "--bench", name, "--no-run"]
    messages = subprocess.run(
        [*cargo, "--message-format=json"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True
    ).stdout
    artifacts = (json.loads(line) for line in messages.splitlines())
    return next(a["executable"] for a in artifacts if a.get("executable") and a["target"]["name"] == name)


def build(peers):
    """Returns the command of each side that can be built."""
    commands = {"gdel": [build_bench("derived")]}
    kiddo = ["cargo", "build", "--release", "--quiet", "--manifest-path", PEERS / "kiddo" / "Cargo.toml"]
    kiddo += ["--target-dir", FOLDER / "kiddo"]
    attempts = {
        "CGAL": (["g++", *FLAGS, PEERS / "locate.cpp", "-o", FOLDER / "locate", "-lgmp", "-lmpfr"],
                 [FOLDER / "locate", POINTS, QUERIES]),
        "voro++": (["g++", *FLAGS, PEERS / "voronoi.cpp", "-o", FOLDER / "voronoi", "-lvoro++"],
                   [FOLDER / "voronoi", POINTS, VORONOI_POINTS]),
        "kiddo": (kiddo, [FOLDER / "kiddo" / "release" / "kiddo-nearest", POINTS, QUERIES]),
        "SciPy": ([sys.executable, "-c", "import scipy"], [sys.executable, PEERS / "find_simplex.py", POINTS, QUERIES]),
    }
    for name, (attempt, command) in ((name, attempts[name]) for name in peers):
        if subprocess.run(attempt, stderr=subprocess.PIPE).returncode == 0:
            commands[name] = command
        else:
            print(f"{name} is left out: {attempt[0]} failed", file=sys.stderr)
    return commands


def measure(command):
    """Returns what a program says about each task."""
    environment = {**os.environ, "RAYON_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    output = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=environment).stdout
    tasks = {}
    for line in output.splitlines():
        report = json.loads(line)
        tasks.setdefault(report.pop("name"), {}).update(report)
    return tasks


def seconds(run, *tasks):
    return sum(run[task]["cpu_seconds"] for task in tasks)


# What is compared: the name, our tasks, the peer and its tasks, and the bar.
ROWS = [
    ("location", ["locate"], "CGAL", ["locate"], 0.5),
    ("location", ["locate"], "SciPy", ["locate"], 0.1),
    ("nearest vertex", ["nearest"], "kiddo", ["nearest"], 1.5),
    ("Voronoi cells, with the triangulation", ["triangulate, 100,000 points", "voronoi, 100,000 points"],
     "voro++", ["voronoi"], 0.5),
    ("alpha filtration", ["alpha", "alpha, edges"], "gdel", ["triangulate"], 1.5),
    ("spanning tree", ["tree"], "gdel", ["triangulate"], 0.5),
]


# How far answers may be from what they are compared with, relative to it.
BARS = {
    "linear interpolation and SciPy's": 1e-12,
    "sum of Sibson's weights and 1": 1e-12,
    "sum of Laplace's weights and 1": 1e-12,
    "Sibson's interpolation and linear functions": 1e-10,
    "Laplace's interpolation and linear functions": 1e-10,
    "circumradii and CGAL's": 1e-10,
    "alpha intervals of facets and CGAL's": 1e-10,
    "alpha intervals of edges and CGAL's": 1e-10,
    "alpha intervals of vertices and CGAL's": 1e-10,
    "`auto` and CGAL's find_optimal_alpha(1)": 1e-15,
    "volume inside the `auto` surface and the solid's": 1e-9,
    "spanning tree and brute force": 1e-12,
}


def compare(only):
    """Compares the answers for all points, or those whose names begin so. Prints a row for each answer, and returns
    whether all are as near as they have to be."""
    import numpy

    gdel, alpha = build_bench("answers"), FOLDER / "alpha"
    subprocess.run(["g++", *FLAGS, PEERS / "alpha.cpp", "-o", alpha, "-lgmp", "-lmpfr"], check=True)
    random = numpy.random.default_rng(1)
    bunny = (ROOT / "tests" / "data" / "bunny.ply").read_bytes()
    bunny = numpy.frombuffer(bunny.split(b"end_header\n", 1)[1], "<f4").reshape(-1, 3).astype(float)
    directions = random.normal(size=(3000, 3))
    side = numpy.arange(16.0)
    # Points and queries; brute force takes the square of the number of points.
    clouds = {
        "uniform, 100,000": (random.random((100_000, 3)), 100_000),
        "uniform in 2D, 100,000": (random.random((100_000, 2)), 100_000),
        "bunny, 35,947": (bunny, 1000),
        "grid, 16³": (numpy.stack(numpy.meshgrid(side, side, side), axis=-1).reshape(-1, 3), 1000),
        "sphere, 3000": (directions / numpy.linalg.norm(directions, axis=1)[:, None], 100),
    }
    print("| points | | number | largest difference, relative | bar |\n| --- | --- | --- | --- | --- |")
    all_near = True

    def row(cloud, what, count, difference):
        nonlocal all_near
        is_near = difference <= BARS[what]
        all_near = all_near and bool(is_near)
        print(f"| {cloud} | {what} | {count:,} | {difference:.1e} | {BARS[what]:.0e}{'' if is_near else ' missed'} |")

    def difference(ours, theirs):
        """Returns the largest relative difference of two arrays; infinities and NaN have to be the same."""
        ours, theirs = numpy.asarray(ours), numpy.asarray(theirs)
        if ours.shape != theirs.shape or (numpy.isfinite(ours) != numpy.isfinite(theirs)).any():
            return numpy.inf
        ours, theirs = ours[numpy.isfinite(theirs)], theirs[numpy.isfinite(theirs)]
        with numpy.errstate(invalid="ignore"):
            return numpy.nan_to_num(numpy.abs(ours - theirs) / numpy.abs(theirs)).max(initial=0.0)

    for name, (points, queries) in clouds.items():
        if not name.startswith(only):
            continue
        dimension = points.shape[1]
        folder = FOLDER / "equal"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        points.tofile(folder / "points.f64")
        if queries > 0:
            low, high = points.min(axis=0), points.max(axis=0)
            (low + random.random((queries, dimension)) * (high - low)).tofile(folder / "queries.f64")
        run = [gdel, str(dimension), folder]
        ours = json.loads(subprocess.run(run, check=True, stdout=subprocess.PIPE, text=True).stdout)
        if name.startswith("uniform"):
            linear = [sys.executable, PEERS / "linear.py", str(dimension), folder / "points.f64", folder / "queries.f64"]
            theirs = subprocess.run(linear, check=True, stdout=subprocess.PIPE, text=True).stdout.split()
            values = numpy.fromfile(folder / "linear.f64")
            row(name, "linear interpolation and SciPy's", len(values), difference(values, numpy.array(theirs, float)))
        for method in ["sibson", "laplace"] if queries > 0 else []:
            count, sum_error, linear_error = ours[method]
            row(name, f"sum of {method.capitalize()}'s weights and 1", count, sum_error)
            row(name, f"{method.capitalize()}'s interpolation and linear functions", count, linear_error)
        if len(points) <= 50_000:
            length = prim(points)
            row(name, "spanning tree and brute force", ours["tree_edges"], difference(ours["tree_length"], length))
        if dimension == 3 and len(points) <= 50_000:
            intervals = [alpha, folder / "points.f64", "--intervals", folder]
            theirs = subprocess.run(intervals, check=True, stdout=subprocess.PIPE, text=True).stdout.split()
            faces = {"cells": "circumradii and CGAL's"}
            faces.update({kind: f"alpha intervals of {kind} and CGAL's" for kind in ["facets", "edges", "vertices"]})
            for kind, what in faces.items():
                values, others = (numpy.fromfile(folder / f"{prefix}{kind}.f64") for prefix in ["", "cgal-"])
                row(name, what, len(values) // (1 if kind == "cells" else 3), difference(values, others))
            row(name, "`auto` and CGAL's find_optimal_alpha(1)", 1, difference(ours["auto"], float(theirs[1])))
            enclosed = difference(ours["enclosed"], ours["solid"]) if ours["open_edges"] == 0 else numpy.inf
            row(name, "volume inside the `auto` surface and the solid's", ours["triangles"], enclosed)
            print(f"{name}: {ours['edges_of_four']} edges of its `auto` surface have four triangles", file=sys.stderr)
    return all_near


def prim(points):
    """Returns the length of the minimum spanning tree, by Prim's algorithm over all pairs of points."""
    import numpy

    is_open = numpy.ones(len(points), bool)
    nearest = numpy.full(len(points), numpy.inf)
    place, lengths = 0, []
    for _ in range(len(points) - 1):
        is_open[place] = False
        nearest = numpy.minimum(nearest, ((points - points[place]) ** 2).sum(axis=1))
        place = numpy.where(is_open, nearest, numpy.inf).argmin()
        lengths.append(nearest[place])
    return numpy.sqrt(lengths).sum()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--equal", metavar="POINTS", nargs="?", const="")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--queries", type=int, default=1_000_000)
    parser.add_argument("--peers", type=lambda names: names.split(","), default=["CGAL", "SciPy", "kiddo", "voro++"])
    arguments = parser.parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
    if arguments.equal is not None:
        sys.exit(not compare(arguments.equal))
    commands = build(arguments.peers)
    commands["gdel"] += ["--points", str(arguments.points), "--queries", str(arguments.queries)]
    subprocess.run([*commands["gdel"], "--write", FOLDER], check=True)
    runs = {name: [] for name in commands}
    for _ in range(arguments.runs):
        for name, command in commands.items():
            runs[name].append(measure(command))
    for ours, (name, theirs) in ((run, item) for run in runs["gdel"] for item in runs.items() if item[0] != "gdel"):
        for run in theirs:
            for task, facts in run.items():
                for fact in ("inside", "checksum"):
                    if fact in facts and facts[fact] != ours[task][fact]:
                        sys.exit(f"{name} disagrees about {task}: {facts[fact]}, not {ours[task][fact]}")
    print(f"{platform.machine()}, {datetime.date.today()}, {arguments.points:,} points, {arguments.queries:,} queries,")
    print(f"processor time, medians of {arguments.runs}\n")
    print("| | gdel, s | against | its s | ratio (range) | bar |\n| --- | --- | --- | --- | --- | --- |")
    for name, tasks, peer, their_tasks, bar in ROWS:
        if peer not in runs:
            continue
        ours = [seconds(run, *tasks) for run in runs["gdel"]]
        theirs = [seconds(run, *their_tasks) for run in runs[peer]]
        ratios = [a / b for a, b in zip(ours, theirs)]
        against = "its triangulation" if peer == "gdel" else peer
        print(f"| {name} | {statistics.median(ours):.3f} | {against} | {statistics.median(theirs):.3f} "
              f"| {statistics.median(ratios):.2f} ({min(ratios):.2f}–{max(ratios):.2f}) | {bar} |")
    sibson = [seconds(run, "sibson, 10,000 queries") for run in runs["gdel"]]
    print(f"| Sibson, 10,000 queries | {statistics.median(sibson):.3f} | | | | 0.3 s |")


main()
