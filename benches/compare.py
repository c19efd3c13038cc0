#!/usr/bin/env python3
"""Compares gdel's CPU engine with CGAL's Delaunay_triangulation_3 on the same inputs, in the same run, on one core.

    benches/compare.py [--runs N] [INPUT ...]

Builds both sides, makes the inputs under .cache/bench/, runs the two alternately (a fresh process each time) and prints
a table in Markdown: medians of the seconds without file access, their ratio with the range over the pairs of
neighbouring runs, and peak memory. Fails when the two disagree about the vertices, or about the tetrahedra where the
input has only one Delaunay triangulation. Needs g++ and CGAL (Debian: apt-get install g++ libcgal-dev) and Linux.
"""

import argparse
import array
import datetime
import json
import multiprocessing
import os
import pathlib
import platform
import random
import statistics
import struct
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
INPUTS = ROOT / ".cache" / "bench"
GDEL = ROOT / "target" / "release" / "gdel"
CGAL = INPUTS / "cgal"
DRAGON = ROOT / ".cache" / "dragon.ply"


def build():
    subprocess.run(["cargo", "build", "--release", "--features", "cli", "--locked", "--quiet"], cwd=ROOT, check=True)
    # Both sides for the baseline of the architecture, no -march=native on either; CGAL asks for
    # -frounding-math.
    flags = ["-std=c++17", "-O3", "-DNDEBUG", "-frounding-math"]
    subprocess.run(["g++", *flags, ROOT / "benches/peers/cgal.cpp", "-o", CGAL, "-lgmp", "-lmpfr"], check=True)


def generate(kind, count, path):
    subprocess.run([GDEL, "generate", kind, str(count), "--seed", "1", "--force", "-o", path], check=True)


def uniform(path):
    generate("uniform", 1_000_000, path)


def sphere(path):
    generate("sphere", 200_000, path)


def sphere_rounded(path):
    """The points of `sphere` with coordinates rounded to multiples of 2^-23, as single precision would near 1."""
    sphere(path)
    coordinates = array.array("d", path.read_bytes())
    path.write_bytes(array.array("d", (round(x * 2**23) / 2**23 for x in coordinates)))


def grid(path):
    """200,000 distinct points of a 64^3 grid, in random order."""
    cells = random.Random(1).sample(range(64**3), 200_000)
    path.write_bytes(array.array("d", (float(c >> shift & 63) for c in cells for shift in (0, 6, 12))))


def ply(source, path):
    """The vertices of a PLY file whose vertices come first and begin with three floats x, y, z."""
    with open(source, "rb") as file:
        header = []
        while not header or header[-1] != b"end_header":
            header.append(file.readline().strip())
        count = next(int(line.split()[2]) for line in header if line.startswith(b"element vertex"))
        if b"format ascii 1.0" in header:
            vertices = array.array("f", (float(x) for _ in range(count) for x in file.readline().split()[:3]))
        else:
            assert b"format binary_little_endian 1.0" in header, source
            vertices = struct.unpack(f"<{3 * count}f", file.read(12 * count))
    path.write_bytes(array.array("d", vertices))


def bunny(path):
    ply(ROOT / "tests/data/bunny.ply", path)


def dragon(path):
    ply(DRAGON, path)


# What is generic, no five points cospherical, has one Delaunay triangulation: the tetrahedra can be
# compared too.
GENERIC = {"uniform", "sphere"}
MAKERS = {f.__name__: f for f in (uniform, sphere, sphere_rounded, grid, bunny, dragon)}


def run(command):
    """What a command prints, one JSON object, and its peak resident set in bytes."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE)
    output = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit code {process.returncode}")
    return json.loads(output), usage.ru_maxrss * 1024


def compare(name, runs):
    path = INPUTS / f"{name}.f64"
    # In a process of its own: Linux counts the peak memory of the starting process into that of the
    # started one.
    maker = multiprocessing.Process(target=MAKERS[name], args=(path,))
    maker.start()
    maker.join()
    if maker.exitcode != 0:
        sys.exit(f"{name}: the input could not be made")

    ours, theirs, our_peak, their_peak = [], [], 0, 0
    for _ in range(runs):
        mesh, peak = run([GDEL, "triangulate", path, "--backend", "cpu", "--threads", "1", "--stats", "json"])
        ours.append(mesh["seconds"]["total"])
        our_peak = max(our_peak, peak)
        cgal, peak = run([CGAL, path])
        theirs.append(cgal["seconds"])
        their_peak = max(their_peak, peak)

    vertices = mesh["points"] - mesh["duplicates"]
    if vertices != cgal["vertices"]:
        sys.exit(f"{name}: gdel has {vertices} vertices, CGAL {cgal['vertices']}")
    if name in GENERIC and mesh["tetrahedra"] != cgal["cells"]:
        sys.exit(f"{name}: gdel has {mesh['tetrahedra']} tetrahedra, CGAL {cgal['cells']}")

    ratios = [a / b for a, b in zip(ours, theirs)]
    a, b = statistics.median(ours), statistics.median(theirs)
    print(
        f"| {name} | {vertices:,} | {mesh['tetrahedra']:,} | {a:.3f} | {b:.3f} "
        f"| {a / b:.2f} ({min(ratios):.2f}–{max(ratios):.2f}) | {our_peak / 1e6:.0f} | {their_peak / 1e6:.0f} |",
        flush=True,
    )
    return cgal["cgal"]


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        model = next((line.split(":")[1].strip() for line in file if line.startswith("model name")), "")
    return model or platform.machine()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--runs", type=int, default=5, help="runs of each side (default 5)")
    parser.add_argument("inputs", nargs="*", metavar="INPUT", help=f"of {', '.join(MAKERS)} (default: all)")
    arguments = parser.parse_args()
    unknown = [name for name in arguments.inputs if name not in MAKERS]
    if unknown or arguments.runs < 1:
        parser.error(f"no such input: {', '.join(unknown)}" if unknown else "--runs must be at least 1")

    inputs = arguments.inputs or list(MAKERS)
    if "dragon" in inputs and not DRAGON.exists():
        if "dragon" in arguments.inputs:
            sys.exit("the dragon is not there: run scripts/fetch-dragon.sh")
        inputs.remove("dragon")
        print("(without the dragon: scripts/fetch-dragon.sh fetches it)\n")

    INPUTS.mkdir(parents=True, exist_ok=True)
    build()
    core = max(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {core})

    print("| input | vertices | tetrahedra | gdel, s | CGAL, s | gdel / CGAL | gdel, MB | CGAL, MB |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |", flush=True)
    versions = {compare(name, arguments.runs) for name in inputs}
    print(
        f"\n{datetime.date.today()}, one core of {machine()}, CGAL {', '.join(versions)}, "
        f"medians of {arguments.runs}; MB is peak resident memory, 10^6 bytes."
    )


if __name__ == "__main__":
    main()
