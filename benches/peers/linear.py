"""Prints SciPy's linear interpolation of x·y + z at queries: `linear.py POINTS QUERIES`, the oracle in
tests/data/derived/linear.txt."""

import sys

import numpy
from scipy.interpolate import LinearNDInterpolator

points, queries = (numpy.fromfile(path).reshape(-1, 3) for path in sys.argv[1:3])
values = points[:, 0] * points[:, 1] + points[:, 2]
for value in LinearNDInterpolator(points, values)(queries):
    print(repr(float(value)))
