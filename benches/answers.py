#!/usr/bin/env python3
"""Compares what gdel derives from a mesh with CGAL, SciPy, kiddo and voro++, in one run, on one core.

    benches/answers.py [--runs N] [--points N] [--queries N] [--peers CGAL,SciPy,kiddo,voro++]

Runs all sides in turn, a fresh process each time, and prints a table in Markdown: medians of the seconds of processor
time without file access, and their ratio with the range over the runs. Fails when two sides disagree: about the number
of queries inside the hull, the nearest points, or the neighbours of Voronoi cells. Needs g++, CGAL and voro++ (Debian:
apt-get install g++ libcgal-dev voro++-dev), and SciPy; a side whose program is missing is left out with a note.
"""

import argparse
import datetime
import json
import os
import pathlib
import platform
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = ROOT / ".cache" / "bench"
PEERS = ROOT / "benches" / "peers"
POINTS, QUERIES = FOLDER / "points.f64", FOLDER / "queries.f64"
VORONOI_POINTS = "100000"


def build(peers):
    """Returns the command of each side that can be built."""
    cargo = ["cargo", "bench", "--locked", "--no-default-features", "--bench", "derived", "--no-run"]
    messages = subprocess.run(
        [*cargo, "--message-format=json"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True
    ).stdout
    artifacts = (json.loads(line) for line in messages.splitlines())
    gdel = next(a["executable"] for a in artifacts if a.get("executable") and a["target"]["name"] == "derived")
    commands = {"gdel": [gdel]}
    flags = ["-std=c++17", "-O3", "-DNDEBUG", "-frounding-math"]
    kiddo = ["cargo", "build", "--release", "--quiet", "--manifest-path", PEERS / "kiddo" / "Cargo.toml"]
    kiddo += ["--target-dir", FOLDER / "kiddo"]
    attempts = {
        "CGAL": (["g++", *flags, PEERS / "locate.cpp", "-o", FOLDER / "locate", "-lgmp", "-lmpfr"],
                 [FOLDER / "locate", POINTS, QUERIES]),
        "voro++": (["g++", *flags, PEERS / "voronoi.cpp", "-o", FOLDER / "voronoi", "-lvoro++"],
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


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--queries", type=int, default=1_000_000)
    parser.add_argument("--peers", type=lambda names: names.split(","), default=["CGAL", "SciPy", "kiddo", "voro++"])
    arguments = parser.parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
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
