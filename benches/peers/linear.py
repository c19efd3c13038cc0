"""Prints SciPy's linear interpolation at queries: `linear.py DIMENSION POINTS QUERIES`, of x·y + z, in 2D of x·y + y, the oracle
in tests/data/derived/linear.txt."""

import sys

import numpy
from scipy.interpolate import LinearNDInterpolator

dimension = int(sys.argv[1])
points, queries = (numpy.fromfile(path).reshape(-1, dimension) for path in sys.argv[2:4])
values = points[:, 0] * points[:, 1] + points[:, -1]
for value in LinearNDInterpolator(points, values)(queries):
    print(repr(float(value)))
