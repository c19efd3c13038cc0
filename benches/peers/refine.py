"""Refinement to 30° beside Shewchuk's Triangle: a letter, a lake, and a map of 10,080 segments.

Needs the packages `gdel` and, in an environment of its own, `triangle`, whose licence forbids to depend on it. Prints a line of
JSON per input: triangles inside, the smallest angle, and the best time of both.
"""

import json
import math
import pathlib
import time

import gdel
import numpy as np
import triangle

FILES = pathlib.Path(__file__).parents[2] / "tests/data/refine"
ANGLE = 30


def read(path):
    """Return the points, segments and holes of a .poly file."""
    rows = [
        line.split()
        for line in path.read_text().splitlines()
        if not line.startswith("#")
    ]

    def section():
        count = int(rows.pop(0)[0])
        return [[float(number) for number in rows.pop(0)[1:3]] for _ in range(count)]

    points, segments, holes = section(), section(), section()
    return (
        np.array(points),
        np.array(segments, np.int32),
        np.array(holes).reshape(-1, 2),
    )


class Numbers:
    """Numbers from 0 to 1 that are the same everywhere."""

    def __init__(self, seed):
        self.state = seed

    def __call__(self):
        self.state = (self.state * 6364136223846793005 + 1442695040888963407) % 2**64
        return (self.state >> 33) / 2**31


def draw_map(cells=20, pieces=12):
    """Return a square of cells with borders that wind, without crossings."""
    random, points, segments, corners = Numbers(5), [], [], {}
    for i in range(cells + 1):
        for j in range(cells + 1):
            corners[i, j] = len(points)
            moved = [
                at if at in (0, cells) else at + (random() - 0.5) * 0.5 for at in (i, j)
            ]
            points.append([round(x, 4) for x in moved])

    def border(start, end, straight):
        (px, py), (qx, qy) = points[start], points[end]
        waves = [(random() - 0.5) * 0.16 / (k + 1) for k in range(6)]
        last = start
        for k in range(1, pieces):
            t = k / pieces
            off = (
                0
                if straight
                else sum(
                    wave * math.sin(math.pi * (q + 1) * t)
                    for q, wave in enumerate(waves)
                )
            )
            t += 0 if straight else (random() - 0.5) * 0.5 / pieces
            points.append(
                [
                    round(px + (qx - px) * t - (qy - py) * off, 5),
                    round(py + (qy - py) * t + (qx - px) * off, 5),
                ]
            )
            segments.append([last, len(points) - 1])
            last = len(points) - 1
        segments.append([last, end])

    for i in range(cells + 1):
        for j in range(cells):
            border(corners[i, j], corners[i, j + 1], i in (0, cells))
            border(corners[j, i], corners[j + 1, i], i in (0, cells))
    return np.array(points), np.array(segments, np.int32), np.empty((0, 2))


def smallest_angles(points, triangles):
    """Return the smallest angle of each triangle in degrees."""
    corners = points[triangles]
    sides = [corners[:, (k + 1) % 3] - corners[:, k] for k in range(3)]
    angles = []
    for k in range(3):
        u, v = sides[k], -sides[k - 1]
        angles.append(np.arctan2(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], (u * v).sum(1)))
    return np.degrees(np.abs(angles).min(0))


def best(run, repeats=20):
    """Return the result of a function, and the least number of milliseconds that it takes."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        result = run()
        times.append(1e3 * (time.perf_counter() - start))
    return result, round(min(times), 3)


def measure(name, points, segments, holes):
    """Print a line for an input."""

    def ours():
        made = gdel.ConstrainedDelaunay(
            points, edges=segments, holes=holes, fill="enclosed", backend="cpu"
        )
        return made.refine(min_angle=ANGLE)

    given = {"vertices": points, "segments": segments} | (
        {"holes": holes} if len(holes) else {}
    )
    made, ms = best(ours)
    peer, peer_ms = best(lambda: triangle.triangulate(given, f"pq{ANGLE}"))
    assert made.verify()
    line = {"input": name, "segments": len(segments)}
    for who, p, t, taken in [
        ("gdel", made.points, made.inside_simplices, ms),
        ("triangle", peer["vertices"], peer["triangles"], peer_ms),
    ]:
        angles = smallest_angles(p, t)
        below = int((angles < ANGLE - 1e-9).sum())
        line[who] = {
            "triangles": len(t),
            "smallest": round(float(angles.min()), 3),
            "below": below,
            "ms": taken,
        }
    print(json.dumps(line))


if __name__ == "__main__":
    for file in ("letter-a.poly", "lake.poly"):
        measure(file, *read(FILES / file))
    measure("map", *draw_map())
