# SPDX-License-Identifier: Apache-2.0
"""What is told of growth: powers fitted to what was measured, and bounds."""

import math
import statistics

STUDENT = {1: 12.71, 2: 4.303, 3: 3.182, 4: 2.776, 5: 2.571, 6: 2.447, 7: 2.365, 8: 2.306}


def exponent(sizes, values):
    """The power of the sizes that the values grow by, by least squares of the logarithms, and half its interval of 95 %
    (Student's t)."""
    xs, ys = [math.log(size) for size in sizes], [math.log(value) for value in values]
    x, y = statistics.fmean(xs), statistics.fmean(ys)
    spread = sum((each - x)**2 for each in xs)
    slope = sum((a - x) * (b - y) for a, b in zip(xs, ys)) / spread
    freedom = len(xs) - 2
    if freedom < 1:
        return {"exponent": slope, "half_interval": None}
    rest = sum((b - y - slope * (a - x))**2 for a, b in zip(xs, ys))
    return {"exponent": slope, "half_interval": STUDENT[min(freedom, 8)] * math.sqrt(rest / freedom / spread)}


def part_of_bound(steps, triangles, crossings):
    """The steps by (n + k) log n, the logarithm to the base of 2."""
    return steps / ((triangles + crossings) * math.log2(triangles))
