#!/usr/bin/env python3
"""Compares gdel with other programs on the same inputs, in the same run, on one core: a line of JSON per comparison.

    benches/peers.py triangulate [--runs N] [INPUT ...]     CGAL's Delaunay_triangulation_3
    benches/peers.py regular [--runs N] [--points N]        CGAL's Regular_triangulation_3
    benches/peers.py answers [--runs N] [--points N]        CGAL, SciPy, kiddo and voro++

All sides take turns, a fresh process each time. A row has the medians of all sides in seconds, the median of the ratios
of neighbouring runs with its range, and what says on what machine and when. Fails when two sides disagree: about the
number of vertices and, where there is only one triangulation, of tetrahedra; about the queries inside the hull, the
nearest points, or the neighbours of Voronoi cells. Files are under .cache/bench/. Needs g++, CGAL and, for answers,
voro++ and SciPy (Debian: apt-get install g++ libcgal-dev voro++-dev python3-scipy) and Linux.
"""

import argparse
import array
import datetime
import json
import multiprocessing
import os
import pathlib
import random
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = ROOT / ".cache" / "bench"
PEERS = ROOT / "benches" / "peers"
BENCH = ROOT / "target" / "release" / "gdel-bench"
PROGRAM = ROOT / "target" / "release" / "gdel"
DRAGON = ROOT / ".cache" / "dragon.ply"
POINTS, QUERIES = FOLDER / "points.f64", FOLDER / "queries.f64"
# The points of which Voronoi cells are made, at most, as in our program.
FEW = 100_000
# All sides for the baseline of the architecture, no -march=native; CGAL asks for -frounding-math.
CXX = ["g++", "-std=c++17", "-O3", "-DNDEBUG", "-frounding-math"]


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        return next((line.split(":")[1].strip() for line in file if line.startswith("model name")), None)


def report(peer, ours, theirs, **facts):
    """Prints the row of one comparison: the seconds of all runs of both sides, in turn."""
    ratios = [a / b for a, b in zip(ours, theirs)]
    row = {
        "command": " ".join(["benches/peers.py", *sys.argv[1:]]),
        "date": str(datetime.date.today()),
        "processor": processor(),
        "threads": 1,
        **facts,
        "seconds": round(statistics.median(ours), 4),
        "peer": peer,
        "peer_seconds": round(statistics.median(theirs), 4),
        "ratio": round(statistics.median(ratios), 3),
        "ratio_range": [round(min(ratios), 3), round(max(ratios), 3)],
    }
    print(json.dumps(row, ensure_ascii=False), flush=True)


def build_ours():
    packages = ["--package=gdel-bench", "--package=gdel-cli"]
    subprocess.run(["cargo", "build", "--release", *packages, "--locked", "--quiet"], cwd=ROOT, check=True)


def run(command):
    """Returns what a command prints, a JSON object per line, and its peak resident set in bytes."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, env={**os.environ, "OMP_NUM_THREADS": "1"})
    output = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit code {process.returncode}")
    return [json.loads(line) for line in output.splitlines()], usage.ru_maxrss * 1024


# The inputs of `triangulate`: each returns coordinates.


def made(*source):
    """The points of a distribution or a file, as our program has them."""
    path = FOLDER / "made.f64"
    subprocess.run([BENCH, "points", *map(str, source), "-o", path], check=True)
    return array.array("d", path.read_bytes())


def uniform():
    return made("uniform", "--points=1000000")


def sphere():
    return made("sphere", "--points=200000")


def sphere_rounded():
    """The points of `sphere` with coordinates rounded to multiples of 2^-23, as single precision would near 1."""
    return array.array("d", (round(x * 2**23) / 2**23 for x in sphere()))


def grid():
    """200,000 distinct points of a 64^3 grid, in random order."""
    cells = random.Random(1).sample(range(64**3), 200_000)
    return array.array("d", (float(c >> shift & 63) for c in cells for shift in (0, 6, 12)))


def bunny():
    return made(ROOT / "tests/data/bunny.ply")


def dragon():
    return made(DRAGON)


# What is generic, no five points cospherical, has one Delaunay triangulation: the tetrahedra can be compared too.
GENERIC = {"uniform", "sphere"}
MAKERS = {f.__name__: f for f in (uniform, sphere, sphere_rounded, grid, bunny, dragon)}


def write(name, path):
    path.write_bytes(MAKERS[name]())


def triangulate(arguments):
    cgal = FOLDER / "cgal"
    subprocess.run([*CXX, PEERS / "cgal.cpp", "-o", cgal, "-lgmp", "-lmpfr"], check=True)
    for name in arguments.inputs or [name for name in MAKERS if name != "dragon" or DRAGON.exists()]:
        path = FOLDER / f"{name}.f64"
        # In a process of its own: Linux counts the peak memory of the starting process into that of the started one.
        maker = multiprocessing.Process(target=write, args=(name, path))
        maker.start()
        maker.join()
        if maker.exitcode != 0:
            sys.exit(f"{name}: the input could not be made")
        ours, theirs, our_peak, their_peak = [], [], 0, 0
        for _ in range(arguments.runs):
            [mesh], peak = run([BENCH, "run", path, "--backend=cpu", "--threads=1", "--runs=1", "--warm-up=0"])
            ours.append(mesh["ms"] / 1e3)
            our_peak = max(our_peak, peak)
            [other], peak = run([cgal, path])
            theirs.append(other["seconds"])
            their_peak = max(their_peak, peak)
        if mesh["vertices"] != other["vertices"]:
            sys.exit(f"{name}: gdel has {mesh['vertices']} vertices, CGAL {other['vertices']}")
        if name in GENERIC and mesh["simplices"] != other["cells"]:
            sys.exit(f"{name}: gdel has {mesh['simplices']} tetrahedra, CGAL {other['cells']}")
        report(
            f"CGAL {other['cgal']}", ours, theirs, input=name, points=mesh["points"], vertices=mesh["vertices"],
            simplices=mesh["simplices"], bytes=our_peak, peer_bytes=their_peak,
        )


# The largest weights of `regular`, in squares of the mean distance: of few, half and most points are hidden.
LARGEST = (0.4, 4.0, 10.0)


def write_weighted(points, largest, table, raw):
    """Writes uniform points with uniform weights, as text for our program and as numbers for CGAL."""
    randoms = random.Random(1)
    unit = largest * points ** (-2 / 3)
    rows = [(*(randoms.random() for _ in range(3)), unit * randoms.random()) for _ in range(points)]
    raw.write_bytes(array.array("d", (x for row in rows for x in row)))
    with table.open("w", encoding="utf-8") as file:
        file.write("x,y,z,weight\n")
        file.writelines(f"{x!r},{y!r},{z!r},{weight!r}\n" for x, y, z, weight in rows)


def regular(arguments):
    cgal, table, raw = (FOLDER / name for name in ("regular", "weighted.csv", "weighted.f64"))
    subprocess.run([*CXX, PEERS / "regular.cpp", "-o", cgal, "-lgmp", "-lmpfr"], check=True)
    options = ["--weights=weight", "--backend=cpu", "--threads=1", "--stats=json"]
    for largest in LARGEST:
        write_weighted(arguments.points, largest, table, raw)
        ours, theirs = [], []
        for _ in range(arguments.runs):
            [mesh], _ = run([PROGRAM, "triangulate", table, *options])
            ours.append(mesh["seconds"]["total"])
            [other], _ = run([cgal, raw])
            theirs.append(other["seconds"])
        if (arguments.points - mesh["hidden"], mesh["tetrahedra"]) != (other["vertices"], other["cells"]):
            sys.exit(f"weights up to {largest}: gdel and CGAL disagree: {mesh}, {other}")
        facts = {"input": "uniform", "points": arguments.points, "vertices": other["vertices"]}
        report(f"CGAL {other['cgal']}", ours, theirs, **facts)


# What `answers` compares: a name, our tasks, the peer, and its tasks. "gdel" is the triangulation itself.
TASKS = [
    ("location", ["locate"], "CGAL", ["locate"]),
    ("location", ["locate"], "SciPy", ["locate"]),
    ("nearest vertex", ["nearest"], "kiddo", ["nearest"]),
    ("Voronoi cells, with the triangulation", ["triangulate few", "voronoi"], "voro++", ["voronoi"]),
    ("alpha filtration with edges", ["alpha", "alpha, edges"], "gdel", ["triangulate"]),
    ("spanning tree", ["tree"], "gdel", ["triangulate"]),
]


def peers_of_answers(points):
    """Returns the command of each peer that can be built."""
    kiddo = ["cargo", "build", "--release", "--quiet", "--manifest-path", PEERS / "kiddo" / "Cargo.toml"]
    attempts = {
        "CGAL": ([*CXX, PEERS / "locate.cpp", "-o", FOLDER / "locate", "-lgmp", "-lmpfr"],
                 [FOLDER / "locate", POINTS, QUERIES]),
        "voro++": ([*CXX, PEERS / "voronoi.cpp", "-o", FOLDER / "voronoi", "-lvoro++"],
                   [FOLDER / "voronoi", POINTS, str(min(points, FEW))]),
        "kiddo": ([*kiddo, "--target-dir", FOLDER / "kiddo"],
                  [FOLDER / "kiddo" / "release" / "kiddo-nearest", POINTS, QUERIES]),
        "SciPy": ([sys.executable, "-c", "import scipy"], [sys.executable, PEERS / "find_simplex.py", POINTS, QUERIES]),
    }
    commands = {}
    for name, (attempt, command) in attempts.items():
        if subprocess.run(attempt, stderr=subprocess.PIPE).returncode == 0:
            commands[name] = command
        else:
            print(f"{name} is left out: {attempt[0]} failed", file=sys.stderr)
    return commands


def answers(arguments):
    ours = [BENCH, "answers", f"--points={arguments.points}", f"--queries={arguments.points}"]
    for seed, path in ((1, POINTS), (2, QUERIES)):
        source = ["uniform", f"--points={arguments.points}", f"--seed={seed}"]
        subprocess.run([BENCH, "points", *source, "-o", path], check=True)
    commands = {"gdel": ours, **peers_of_answers(arguments.points)}
    runs = {name: [] for name in commands}
    for _ in range(arguments.runs):
        for name, command in commands.items():
            tasks = {}
            for line in run(command)[0]:
                tasks.setdefault(line.pop("name"), {}).update(line)
            runs[name].append(tasks)
    for ours, (name, theirs) in ((run, item) for run in runs["gdel"] for item in runs.items() if item[0] != "gdel"):
        for task, facts in (item for run in theirs for item in run.items()):
            for fact in ("inside", "checksum"):
                if fact in facts and facts[fact] != ours[task][fact]:
                    sys.exit(f"{name} disagrees about {task}: {facts[fact]}, not {ours[task][fact]}")

    def seconds(run, tasks):
        return sum(run[task]["cpu_seconds"] for task in tasks)

    for name, tasks, peer, their_tasks in TASKS:
        if peer in runs:
            report(
                "its triangulation" if peer == "gdel" else peer, [seconds(run, tasks) for run in runs["gdel"]],
                [seconds(run, their_tasks) for run in runs[peer]], input="uniform", points=arguments.points, task=name,
            )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    for command in (triangulate, regular, answers):
        options = commands.add_parser(command.__name__)
        options.set_defaults(command=command)
        options.add_argument("--runs", type=int, default=5, help="runs of each side (default 5)")
        if command is triangulate:
            options.add_argument("inputs", nargs="*", metavar="INPUT", choices=[[], *MAKERS], help=", ".join(MAKERS))
        else:
            options.add_argument("--points", type=int, default=1_000_000, help="points, and queries (default 1000000)")
    arguments = parser.parse_args()
    FOLDER.mkdir(parents=True, exist_ok=True)
    build_ours()
    core = max(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {core})
    arguments.command(arguments)


if __name__ == "__main__":
    main()
