#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes src/vera/image/blue_noise.cpp: a mask of blue noise, by the void-and-cluster method (Ulichney 1993).

Everything is in whole numbers, so that every machine makes the same mask. --check compares the file with what
would be written.
"""

import pathlib
import random
import sys

SIDE = 64
CELLS = SIDE * SIDE
REACH = 8
FILE = pathlib.Path(__file__).resolve().parent.parent / "src/vera/image/blue_noise.cpp"

# exp(-d^2 / (2 * 1.9^2)) in 2^20ths, for d^2 up to 2 * REACH^2, by products of one rounded factor.
FACTOR = 913021  # exp(-1 / 7.22) * 2^20
WEIGHTS = [1 << 20]
for _ in range(2 * REACH * REACH):
    WEIGHTS.append(WEIGHTS[-1] * FACTOR >> 20)
KERNEL = [(x, y, WEIGHTS[x * x + y * y]) for y in range(-REACH, REACH + 1) for x in range(-REACH, REACH + 1)]


class Pattern:
    """Cells that are on or off, and how crowded each is."""

    def __init__(self, on):
        self.on = [False] * CELLS
        self.crowd = [0] * CELLS
        for cell in on:
            self.turn(cell)

    def turn(self, cell):
        self.on[cell] = not self.on[cell]
        sign = 1 if self.on[cell] else -1
        row, column = divmod(cell, SIDE)
        for x, y, weight in KERNEL:
            self.crowd[(row + y) % SIDE * SIDE + (column + x) % SIDE] += sign * weight

    def tightest_cluster(self):
        return max((cell for cell in range(CELLS) if self.on[cell]), key=self.crowd.__getitem__)

    def largest_void(self):
        return min((cell for cell in range(CELLS) if not self.on[cell]), key=self.crowd.__getitem__)


def mask():
    chosen = random.Random(1988).sample(range(CELLS), CELLS // 10)
    pattern = Pattern(chosen)
    while True:
        cluster = pattern.tightest_cluster()
        pattern.turn(cluster)
        void = pattern.largest_void()
        pattern.turn(void)
        if void == cluster:
            break
    start = [cell for cell in range(CELLS) if pattern.on[cell]]
    ranks = [0] * CELLS
    for rank in range(len(start) - 1, -1, -1):
        cluster = pattern.tightest_cluster()
        pattern.turn(cluster)
        ranks[cluster] = rank
    pattern = Pattern(start)
    for rank in range(len(start), CELLS):
        void = pattern.largest_void()
        pattern.turn(void)
        ranks[void] = rank
    return ranks


def text():
    ranks = mask()
    lines = [
        "// SPDX-License-Identifier: Apache-2.0",
        "// Made by tools/make_blue_noise.py.",
        '#include "vera/image/dither.h"',
        "",
        "namespace vera::detail {",
        "",
        "// clang-format off",
        "const std::array<std::uint16_t, blue_noise_side * blue_noise_side> blue_noise = {",
    ]
    lines += ["    " + ", ".join(map(str, ranks[i:i + 16])) + "," for i in range(0, CELLS, 16)]
    lines += ["};", "// clang-format on", "", "} // namespace vera::detail", ""]
    return "\n".join(lines)


def main():
    if sys.argv[1:] == ["--check"]:
        if FILE.read_text() != text():
            sys.exit(f"{FILE.name} is not what tools/make_blue_noise.py makes; run it")
    elif len(sys.argv) > 1:
        sys.exit(__doc__)
    else:
        FILE.write_text(text())


if __name__ == "__main__":
    main()
