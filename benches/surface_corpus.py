#!/usr/bin/env python3
"""Finds surfaces of scans of known shapes with `gdel surface`, and checks them without it: a line of JSON per scan.

    benches/surface_corpus.py [--gdel PATH] [--points N] [--peers] [--only NAME] [-- OPTIONS OF gdel surface]

Twelve shapes of known volume, genus and number of surfaces, each as thirteen scans: dense, sparse (an eighth of the points),
with noise of 0.25 and of 0.6 of the distance between points, with 1 % of outliers, with three holes, with coordinates
that are multiples of 1/500, and what one to six viewpoints see. Nothing outside sees a cavity, so that it is no part of what
is right for viewpoints. A row says whether the surface is closed (every edge has one triangle in each direction),
whether it intersects itself (if Open3D is installed), whether genus and number of surfaces are right, the error of
the volume, and the mean distance of its area from the shape in units of the distance between points. `--peers` adds
Open3D's screened Poisson with estimated and with true normals at the best of three depths (6 to 8 for 15,000 points), its ball pivoting and its
alpha shape, and PyVista's `delaunay_3d`, these at the best of three radii: the best has the right genus, else the
least distance. If g++ and CGAL are there (Debian: libcgal-dev), also its advancing front and its scale space. The last lines sum up each kind
of scan. Needs NumPy; by default it takes target/release/gdel.
"""

import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile
from fractions import Fraction

import numpy as np

try:
    import open3d
except (ImportError, OSError):
    open3d = None
try:
    import pyvista
except (ImportError, OSError):
    pyvista = None

ROOT = pathlib.Path(__file__).resolve().parent.parent
CGAL = ROOT / ".cache" / "bench" / "surface"


def length(p):
    return np.sqrt((p * p).sum(-1))


def sphere(center, radius):
    return lambda p: length(p - np.array(center)) - radius


def box(low, high):
    middle, half = (np.array(low) + high) / 2, (np.array(high, float) - low) / 2

    def distance(p):
        q = np.abs(p - middle) - half
        return length(np.maximum(q, 0)) + np.minimum(q.max(-1), 0)

    return distance


def torus(center, axis, major, minor):
    others = [k for k in range(3) if k != axis]

    def distance(p):
        q = p - np.array(center)
        return np.hypot(length(q[:, others]) - major, q[:, axis]) - minor

    return distance


def cylinder(center, radius, half):
    def distance(p):
        q = p - np.array(center)
        d = np.stack([length(q[:, :2]) - radius, np.abs(q[:, 2]) - half], -1)
        return length(np.maximum(d, 0)) + np.minimum(d.max(-1), 0)

    return distance


def capsule(half, radius):
    return lambda p: length(np.stack([p[:, 0], p[:, 1], p[:, 2] - np.clip(p[:, 2], -half, half)], -1)) - radius


def union(*shapes):
    return lambda p: np.min([shape(p) for shape in shapes], axis=0)


def without(shape, *holes):
    return lambda p: np.max([shape(p)] + [-hole(p) for hole in holes], axis=0)


BALL = 4 / 3 * math.pi
# Signed distance, bounds, volume, genus of all surfaces together, number of surfaces.
SHAPES = {
    "sphere": (sphere([0, 0, 0], 1), 1, BALL, 0, 1),
    "torus": (torus([0, 0, 0], 2, 0.7, 0.28), 1, 2 * math.pi**2 * 0.7 * 0.28**2, 1, 1),
    "cube": (box([-0.8] * 3, [0.8] * 3), 0.9, 1.6**3, 0, 1),
    "plate": (box([-1, -1, -0.05], [1, 1, 0.05]), 1.1, 0.4, 0, 1),
    "cylinder": (cylinder([0, 0, 0], 0.5, 0.9), 1, math.pi * 0.25 * 1.8, 0, 1),
    "capsule": (capsule(0.7, 0.3), 1.1, math.pi * 0.09 * 1.4 + BALL * 0.027, 0, 1),
    "tube": (without(cylinder([0, 0, 0], 0.7, 0.8), cylinder([0, 0, 0], 0.45, 2)), 1,
             math.pi * (0.49 - 0.2025) * 1.6, 1, 1),
    "frame": (without(box([-1, -0.7, -0.2], [1, 0.7, 0.2]), box([-0.75, -0.4, -1], [-0.15, 0.4, 1]),
                      box([0.15, -0.4, -1], [0.75, 0.4, 1])), 1.1, (2 * 1.4 - 2 * 0.6 * 0.8) * 0.4, 2, 1),
    "two balls": (union(sphere([-0.55, 0, 0], 0.4), sphere([0.5, 0, 0], 0.45)), 1, BALL * (0.4**3 + 0.45**3), 0, 2),
    "hollow ball": (without(sphere([0, 0, 0], 0.95), sphere([0.1, 0, 0], 0.55)), 1, BALL * (0.95**3 - 0.55**3), 0, 2),
    "chain": (union(torus([-0.3, 0, 0], 2, 0.5, 0.15), torus([0.3, 0, 0], 1, 0.5, 0.15)), 1.1,
              4 * math.pi**2 * 0.5 * 0.15**2, 2, 2),
    "three holes": (without(cylinder([0, 0, 0], 0.95, 0.25), *[cylinder([0.5 * math.cos(a), 0.5 * math.sin(a), 0], 0.25, 1)
                    for a in (0, 2.094, 4.189)]), 1, math.pi * (0.95**2 - 3 * 0.0625) * 0.5, 3, 1),
}
# What viewpoints can know of shapes with cavities.
SEEN = {"hollow ball": (sphere([0, 0, 0], 0.95), 1, BALL * 0.95**3, 0, 1)}


def on_surface(distance, bound, count, random):
    """Random points of a shape: those near it, moved there."""
    found, shell, step = [], 0.01, 1e-5
    while sum(map(len, found)) < count:
        p = random.uniform(-bound, bound, (400_000, 3))
        p = p[np.abs(distance(p)) < shell]
        for _ in range(2):
            slope = np.stack([distance(p + step * e) - distance(p - step * e) for e in np.eye(3)], -1) / (2 * step)
            p = p - slope * (distance(p) / np.maximum((slope * slope).sum(-1), 1e-9))[:, None]
        found.append(p[np.abs(distance(p)) < 1e-6])
    return np.concatenate(found)[:count]


def slopes(distance, points, step=1e-5):
    """The normals of a shape near its surface."""
    slope = np.stack([distance(points + step * e) - distance(points - step * e) for e in np.eye(3)], -1)
    return slope / np.maximum(length(slope), 1e-30)[:, None]


# Around the shapes, so that each sees what the ones before do not.
VIEWPOINTS = np.array([[1, 0.3, 0.4], [-1, -0.4, 0.3], [0.2, 1, -0.5], [0.3, -1, -0.3], [-0.4, 0.2, 1], [0.2, 0.1, -1]])


def visible(distance, points, viewpoint, steps=160):
    """Which points of a shape a viewpoint sees: the shape is not between."""
    is_seen = np.ones(len(points), bool)
    for share in np.linspace(0, 1, steps + 1)[1:] ** 1.5:
        is_seen[is_seen] = distance(points[is_seen] + share * (viewpoint - points[is_seen])) > -1e-4
    return is_seen


def scans(points, distance, distance_between, bound, random):
    """The scans of a shape, by name."""
    yield "dense", points
    yield "sparse", points[: len(points) // 8]
    for noise in (0.25, 0.6):
        yield f"noise {noise}", points + random.normal(size=points.shape) * noise * distance_between
    yield "outliers", np.concatenate([points, random.uniform(-1.2 * bound, 1.2 * bound, (len(points) // 100, 3))])
    centers = points[random.integers(len(points), size=3)]
    far = np.min([length(points - center) for center in centers], axis=0)
    yield "holes", points[far > 4 * distance_between]
    yield "quantised", np.round(points * 500) / 500
    is_seen = np.zeros(len(points), bool)
    for count, direction in enumerate(VIEWPOINTS, 1):
        is_seen |= visible(distance, points, 3 * bound * direction)
        yield f"{count} viewpoint{'s' if count > 1 else ''}", points[is_seen]


def read_ply(path):
    """Vertices and triangles of a binary file of `gdel`."""
    header, data = path.read_bytes().split(b"end_header\n", 1)
    counts = [int(line.split()[2]) for line in header.decode().splitlines() if line.startswith("element")]
    number = "<f8" if b"property double x" in header else "<f4"
    vertices = np.frombuffer(data, number, 3 * counts[0]).reshape(-1, 3).astype(float)
    rows = np.frombuffer(data, [("n", "u1"), ("t", "<i4", 3)], counts[1], offset=vertices.size * int(number[2]))
    return vertices, rows["t"].astype(np.int64)


def components(count, edges):
    """The number of sets of vertices that edges connect."""
    root = np.arange(count)
    while True:
        low = np.minimum(root[edges[:, 0]], root[edges[:, 1]])
        new = root.copy()
        np.minimum.at(new, root[edges[:, 0]], low)
        np.minimum.at(new, root[edges[:, 1]], low)
        new = new[new]
        if (new == root).all():
            return len(np.unique(root))
        root = new


def check(vertices, triangles, shape, distance_between, random):
    """What can be said of a surface by counting."""
    distance, _, volume, genus, surfaces = shape
    used, triangles = np.unique(triangles, return_inverse=True)
    vertices, triangles = vertices[used], triangles.reshape(-1, 3)
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = length(normals)
    if not area.sum() > 0:
        return {"closed": True, "right": False, "triangles": 0, "volume": -1, "distance": None}
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    ids = np.sort(edges[:, 0] * len(vertices) + edges[:, 1])
    reverse = np.sort(edges[:, 1] * len(vertices) + edges[:, 0])
    closed = bool((ids[1:] != ids[:-1]).all() and (ids == reverse).all())
    pieces = components(len(vertices), edges)
    euler = len(vertices) - len(np.unique(np.minimum(ids, reverse) if closed else ids)) + len(triangles)
    if closed:
        euler = len(vertices) - len(edges) // 2 + len(triangles)
    found = (normals * corners[:, 0]).sum() / 6
    chosen = corners[random.choice(len(triangles), 50_000, p=area / area.sum())]
    s, t = random.uniform(size=(2, 50_000, 1))
    s, t = np.where(s + t > 1, 1 - s, s), np.where(s + t > 1, 1 - t, t)
    places = chosen[:, 0] + s * (chosen[:, 1] - chosen[:, 0]) + t * (chosen[:, 2] - chosen[:, 0])
    row = {"closed": closed, "right": closed and pieces == surfaces and 2 * pieces - euler == 2 * genus,
           "triangles": len(triangles), "volume": float(found / volume - 1),
           "distance": float(np.abs(distance(places)).mean() / distance_between)}
    return row


def orientation(*points):
    """The sign of the determinant of four points, exactly."""
    (a, b, c), d = [[Fraction(float(x)) for x in p] for p in points[:3]], points[3]
    a, b, c = ([x - Fraction(float(y)) for x, y in zip(p, d)] for p in (a, b, c))
    value = sum(a[i] * (b[j] * c[k] - b[k] * c[j]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)))
    return (value > 0) - (value < 0)


def intersects(vertices, triangles):
    """Whether an edge of a surface passes through the inside of one of its triangles; `None` without Open3D.

    Open3D finds pairs of triangles that may intersect, by floating point; where they touch, it often says so, too.
    """
    if not open3d:
        return None
    mesh = open3d.geometry.TriangleMesh(open3d.utility.Vector3dVector(vertices),
                                        open3d.utility.Vector3iVector(triangles.astype(np.int32)))

    def passes(p, q, triangle):
        a, b, c = triangle
        if orientation(a, b, c, p) * orientation(a, b, c, q) >= 0:
            return False
        return abs(orientation(p, q, a, b) + orientation(p, q, b, c) + orientation(p, q, c, a)) == 3

    pairs = vertices[triangles[np.asarray(mesh.get_self_intersecting_triangles(), int).reshape(-1, 2)]]
    edges = ((0, 1), (1, 2), (2, 0))
    return any(passes(s[i], s[j], t) or passes(t[i], t[j], s) for s, t in pairs for i, j in edges)


def best(meshes, shape, distance_between, random):
    """The best of some surfaces."""
    rows = []
    for option, mesh in meshes:
        vertices, triangles = mesh[0], mesh[1].astype(np.int64)
        row = check(vertices, triangles, shape, distance_between, random) | {"option": option}
        rows.append((not row["right"], math.inf if row["distance"] is None else row["distance"], len(rows), row, mesh))
    *_, row, mesh = min(rows)
    return row | {"intersects": intersects(*mesh)}


def build_cgal():
    """Compiles the program of CGAL's surfaces, if that is possible."""
    CGAL.parent.mkdir(parents=True, exist_ok=True)
    command = ["g++", "-std=c++17", "-O3", "-DNDEBUG", "-frounding-math", ROOT / "benches" / "peers" / "surface.cpp",
               "-o", CGAL, "-lgmp", "-lmpfr"]
    try:
        subprocess.run(command, check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        CGAL.unlink(missing_ok=True)
        print("without CGAL: peers/surface.cpp does not compile", file=sys.stderr)


def cgal(method, points):
    """What CGAL makes of a scan."""
    with tempfile.NamedTemporaryFile(suffix=".f64") as file:
        points.astype(np.float64).tofile(file.name)
        run = subprocess.run([CGAL, method, file.name], capture_output=True, check=True)
    return points, np.frombuffer(run.stdout, np.uint32).reshape(-1, 3)


def arrays_of(mesh):
    return np.asarray(mesh.vertices), np.asarray(mesh.triangles)


def peers(points, shape, distance_between, random):
    """What other programs make of a scan, by name."""
    judged = lambda meshes: best(meshes, shape, distance_between, random)
    if CGAL.exists():
        yield "cgal advancing front", judged([(None, cgal("front", points))])
        yield "cgal scale space", judged([(None, cgal("scale", points))])
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    radii = [distance_between * factor for factor in (2, 4, 8)]
    mesh_of = open3d.geometry.TriangleMesh
    alpha = mesh_of.create_from_point_cloud_alpha_shape
    yield "open3d alpha", judged([(radius, arrays_of(alpha(cloud, radius))) for radius in radii])
    if pyvista:
        grid = pyvista.PolyData(points)
        hulls = [(radius, grid.delaunay_3d(alpha=radius).extract_geometry().triangulate()) for radius in radii]
        faces = lambda hull: hull.faces.reshape(-1, 4)[:, 1:] if hull.n_cells else np.zeros((0, 3), int)
        yield "pyvista", judged([(radius, (np.asarray(hull.points, float), faces(hull))) for radius, hull in hulls])
    first = round(math.log2(2 / distance_between))
    poisson = lambda: [(depth, arrays_of(mesh_of.create_from_point_cloud_poisson(cloud, depth=depth)[0]))
                       for depth in range(first, first + 3)]
    cloud.normals = open3d.utility.Vector3dVector(slopes(shape[0], points))
    yield "poisson, true normals", judged(poisson())
    cloud.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(20))
    cloud.orient_normals_consistent_tangent_plane(20)
    yield "poisson", judged(poisson())
    pivoting = mesh_of.create_from_point_cloud_ball_pivoting(cloud, open3d.utility.DoubleVector(radii))
    yield "ball pivoting", judged([(None, arrays_of(pivoting))])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--gdel", type=pathlib.Path, default=ROOT / "target" / "release" / "gdel")
    parser.add_argument("--points", type=int, default=15_000)
    parser.add_argument("--peers", action="store_true")
    parser.add_argument("--only", help="the name of one shape")
    parser.add_argument("options", nargs="*")
    arguments = parser.parse_args()
    if arguments.peers and not open3d:
        parser.error("--peers needs Open3D: pip install open3d")
    if arguments.peers:
        build_cgal()
    sums = {}
    with tempfile.TemporaryDirectory() as folder:
        scan, output = pathlib.Path(folder, "scan.npy"), pathlib.Path(folder, "surface.ply")
        for name, shape in SHAPES.items():
            if arguments.only not in (None, name):
                continue
            random = np.random.default_rng(1)
            points = on_surface(shape[0], shape[1], arguments.points, random)
            # The number of points in a unit of the area, by the shell around the surface.
            probe = random.uniform(-shape[1], shape[1], (1_000_000, 3))
            area = (np.abs(shape[0](probe)) < 0.01).mean() * (2 * shape[1]) ** 3 / 0.02
            for kind, seen in scans(points, shape[0], math.sqrt(area / len(points)), shape[1], random):
                # What a viewpoint does not see is no matter of density.
                between = math.sqrt(area / (len(points) if "viewpoint" in kind else len(seen)))
                truth = SEEN.get(name, shape) if "viewpoint" in kind else shape
                np.save(scan, seen)
                command = [arguments.gdel, "surface", scan, "-f", "-o", output, "--stats", "json", "--backend", "cpu"]
                run = subprocess.run(command + arguments.options, capture_output=True, text=True, check=True)
                seconds = json.loads(run.stdout)["seconds"]["total"]
                mesh = read_ply(output)
                row = check(*mesh, truth, between, random)
                rows = {"gdel": row | {"intersects": intersects(*mesh), "seconds": seconds}}
                if arguments.peers:
                    rows |= dict(peers(seen, truth, between, random))
                for side, row in rows.items():
                    print(json.dumps({"shape": name, "scan": kind, "side": side} | row), flush=True)
                    sums.setdefault((side, kind), []).append(row)
    for (side, kind), rows in sums.items():
        share = lambda key: sum(bool(row.get(key)) for row in rows) / len(rows)
        middle = lambda key: float(np.median([abs(row[key]) for row in rows if row[key] is not None]))
        print(json.dumps({"side": side, "scan": kind, "shapes": len(rows), "closed": share("closed"),
                          "intersects": share("intersects"), "right": share("right"),
                          "volume": middle("volume"), "distance": middle("distance")}))


if __name__ == "__main__":
    main()
