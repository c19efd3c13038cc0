"""SciPy's point location, for peers.py."""

import json
import sys
import time

import numpy
from scipy.spatial import Delaunay

points, queries = (numpy.fromfile(path).reshape(-1, 3) for path in sys.argv[1:3])
start = time.process_time()
mesh = Delaunay(points)
print(json.dumps({"name": "triangulate", "cpu_seconds": time.process_time() - start}))
start = time.process_time()
inside = int((mesh.find_simplex(queries) >= 0).sum())
print(json.dumps({"name": "locate", "cpu_seconds": time.process_time() - start}))
print(json.dumps({"name": "locate", "inside": inside}))
