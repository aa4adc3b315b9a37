# SPDX-License-Identifier: Apache-2.0
"""Families of triangles to draw, each of any size and the same on every machine.

All are seen along -z by parallel rays; the picture is the square from (0, 0) to (1, 1). A triangle is three corners
(x, y, z) that run counterclockwise.
"""

import math
import random
from pathlib import Path


def turned_to_viewer(a, b, c):
    area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return (a, b, c) if area > 0 else (a, c, b)


def scatter(count):
    """Small triangles anywhere, five one behind the other on the average, each in a layer of its own. What is seen
    and what crosses grows in proportion to their number."""
    values = random.Random(f"scatter {count}")
    layers = list(range(count))
    values.shuffle(layers)
    for layer in layers:
        x, y, first = values.random(), values.random(), values.random() * math.tau
        angles = [first, first + values.uniform(1.5, 2.6), first + values.uniform(3.6, 4.8)]
        shape = [(math.cos(angle), math.sin(angle)) for angle in angles]
        area = abs((shape[1][0] - shape[0][0]) * (shape[2][1] - shape[0][1])
                   - (shape[1][1] - shape[0][1]) * (shape[2][0] - shape[0][0])) / 2
        radius = math.sqrt(5 / count / area)
        yield turned_to_viewer(*((x + radius * u, y + radius * v, layer + 0.9 * values.random()) for u, v in shape))


def balls(count):
    """64 closed balls, four one behind the other, ever finer: a mesh."""
    values = random.Random("balls")
    rings = max(3, round(math.sqrt(count / 128)))
    for place in range(64):
        cell = [place % 4, place // 4 % 4, place // 16]
        radius = values.uniform(0.08, 0.115)
        middle = [(part + 0.5) / 4 + values.uniform(-1, 1) * (0.125 - radius) for part in cell]
        yield from ball(middle, radius, rings)


def ball(middle, radius, rings):
    def corner(i, j):
        polar, around = math.pi * i / rings, math.tau * (j % rings) / rings
        u, v, w = math.sin(polar) * math.cos(around), math.cos(polar), math.sin(polar) * math.sin(around)
        # The axis slants, so that no pole is seen from above alone.
        return (middle[0] + radius * u, middle[1] + radius * (0.8 * v - 0.6 * w),
                middle[2] + radius * (0.6 * v + 0.8 * w))

    for i in range(rings):
        for j in range(rings):
            if i > 0:
                yield corner(i, j), corner(i, j + 1), corner(i + 1, j)
            if i + 1 < rings:
                yield corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j)


def terrain(count):
    """A landscape seen at a slant, ever finer: hills hide what lies behind them."""
    values = random.Random("terrain")
    waves = [(values.uniform(-1, 1) * 2**octave * math.tau, values.uniform(-1, 1) * 2**octave * math.tau,
              values.random() * math.tau, 0.1 / 2**octave) for octave in range(1, 6) for _ in range(3)]
    columns = max(2, round(math.sqrt(count / 2)))

    def corner(i, j):
        u, v = i / columns, j / columns
        height = sum(size * math.sin(a * u + b * v + phase) for a, b, phase, size in waves)
        return u, 0.15 + 0.45 * v + 0.6 * height, -v + 0.3 * height

    below = [corner(i, 0) for i in range(columns + 1)]
    for j in range(columns):
        above = [corner(i, j + 1) for i in range(columns + 1)]
        for i in range(columns):
            yield below[i], below[i + 1], above[i]
            yield below[i + 1], above[i + 1], above[i]
        below = above


def grate(count):
    """Two bundles of slivers that cross: their square crosses, and all of it is seen in the gaps."""
    each = count // 2
    for i in range(each):
        middle, half = (i + 0.5) / each, 0.2 / each
        yield (middle - half, 0.02, 1), (middle + half, 0.02, 1), (middle, 0.98, 1)
    for i in range(each):
        middle, half = (i + 0.5) / each, 0.2 / each
        yield (0.02, middle + half, 0), (0.02, middle - half, 0), (0.98, middle, 0)


def hidden_grate(count):
    """The same behind one triangle that hides it."""
    yield (-1, -0.5, 2), (2, -0.5, 2), (0.5, 3, 2)
    yield from grate(count - 1)


def tilted(count):
    """Triangles in every direction, which pass through each other: nobody can sort them."""
    values = random.Random(f"tilted {count}")
    size = math.sqrt(5 / count)
    for _ in range(count):
        x, y, z = values.random(), values.random(), values.random()
        yield turned_to_viewer(*((x + size * values.uniform(-1, 1), y + size * values.uniform(-1, 1),
                                  z + size * values.uniform(-1, 1)) for _ in range(3)))


def cycles(count):
    """Rings of three slivers of which each lies over the next, so that none of them can be painted first, at random places
    in layers."""
    values = random.Random(f"cycles {count}")
    for ring in range(count // 3):
        x, y, turn = values.random(), values.random(), values.random() * math.tau
        size = math.sqrt(3 / count)
        for i in range(3):
            along = turn + i * math.tau / 3
            u, v = math.cos(along), math.sin(along)
            # Past the middle at a distance, from low to high.
            near, far, wide = (-1.0, 0.25, -0.2), (1.0, 0.25, 0.8), 0.12
            corners = [(near[0], near[1] - wide, near[2]), (far[0], far[1] - wide, far[2]), (far[0], far[1] + wide, far[2])]
            yield turned_to_viewer(*((x + size * (u * a - v * b), y + size * (v * a + u * b), ring + 0.5 + 0.4 * c)
                                     for a, b, c in corners))


def deep(count):
    """Triangles of one size, however many there are, each in a layer of its own: ever more lie one behind the other, and
    their square crosses. What is seen is soon that of the nearest few."""
    values = random.Random(f"deep {count}")
    layers = list(range(count))
    values.shuffle(layers)
    for layer in layers:
        x, y = values.random(), values.random()
        yield turned_to_viewer(*((x + values.uniform(-0.1, 0.1), y + values.uniform(-0.1, 0.1),
                                  layer + 0.9 * values.random()) for _ in range(3)))


def stripes(count):
    """Slivers side by side from one side of the picture to the other, at a slant, none of which crosses another: each lies
    in as many cells as the picture is wide."""
    for i in range(count):
        middle, half = 0.02 + 0.6 * (i + 0.5) / count, 0.12 / count
        yield (0.02, middle + half, i % 7), (0.02, middle - half, i % 7), (0.98, middle + 0.35, i % 7)


def cluster(count):
    """The same as scatter in a thousandth of the picture's width, in one corner of a large empty triangle: cells of one
    size hold all of it in a few."""
    yield (0.0, 0.0, -1.0), (1.0, 0.0, -1.0), (0.0, 1.0, -1.0)
    for triangle in scatter(count - 1):
        yield tuple((0.3 + 0.001 * x, 0.3 + 0.001 * y, z) for x, y, z in triangle)


def sizes(count):
    """As scatter, but of very different sizes: how many are larger than a size falls with its square, from as large as the
    picture down to a thousandth of it."""
    values = random.Random(f"sizes {count}")
    layers = list(range(count))
    values.shuffle(layers)
    least = max(0.001, 1 / math.sqrt(count))
    for layer in layers:
        size = least / math.sqrt(1 - values.random() * (1 - least**2))
        x, y = values.random(), values.random()
        yield turned_to_viewer(*((x + size * values.uniform(-0.5, 0.5), y + size * values.uniform(-0.5, 0.5),
                                  layer + 0.9 * values.random()) for _ in range(3)))


FAMILIES = {"scatter": scatter, "balls": balls, "terrain": terrain, "grate": grate,
            "hidden grate": hidden_grate, "tilted": tilted, "deep": deep, "stripes": stripes, "cluster": cluster,
            "sizes": sizes, "cycles": cycles}


def write_mesh(triangles, path):
    """An OBJ whose equal corners are one; the number of its triangles, those of no area left out, and them with the
    numbers that stand there."""
    numbers, read, faces = {}, [], []
    with path.open("w") as file:
        for triangle in triangles:
            corners = []
            for corner in triangle:
                text = "%.7g %.7g %.9g" % corner
                if text not in numbers:
                    numbers[text] = len(numbers) + 1
                    file.write(f"v {text}\n")
                corners.append(numbers[text])
            file.write("f %d %d %d\n" % tuple(corners))
            faces.append(tuple(corners))
    read = [tuple(map(float, text.split())) for text in numbers]
    return read, faces


def write_scene(folder, name, triangles):
    """NAME.obj and NAME.vera, which shows it; its corners, and its triangles as numbers of corners from 1 on."""
    read = write_mesh(triangles, folder / f"{name}.obj")
    (folder / f"{name}.vera").write_text(
        "PARALLEL 0 0 -1   0 0 0   1 0 0   0 1 0\n"
        f'MESH "{name}.obj"\n')
    return read


def scene_of(family, count, folder):
    folder = Path(folder)
    name = f"{family.replace(' ', '_')}_{count}"
    corners, faces = write_scene(folder, name, FAMILIES[family](count))
    return folder / name, corners, faces


def crossings(corners, faces, samples=500):
    """How many pairs of sides cross, about: those of some sides are counted."""
    sides = list({(min(a, b), max(a, b)) for face in faces for a, b in zip(face, face[1:] + face[:1])})
    count = max(1, math.isqrt(len(sides)))

    def cells(side):
        """Of a raster, those along the side."""
        (x0, y0, _), (x1, y1, _) = corners[side[0] - 1], corners[side[1] - 1]
        steps = int(max(abs(x1 - x0), abs(y1 - y0)) * count) + 1
        found = set()
        for i in range(steps):
            xs = sorted((x0 + (x1 - x0) * (i + part) / steps) * count for part in (0, 1))
            ys = sorted((y0 + (y1 - y0) * (i + part) / steps) * count for part in (0, 1))
            found.update((column, row) for column in range(int(xs[0]), int(xs[1]) + 1)
                         for row in range(int(ys[0]), int(ys[1]) + 1))
        return found

    def turn(a, b, c):
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

    def cross(side, other):
        if set(side) & set(other):
            return False
        a, b, c, d = (corners[i - 1] for i in (*side, *other))
        return turn(a, b, c) * turn(a, b, d) < 0 and turn(c, d, a) * turn(c, d, b) < 0

    chosen = random.Random("crossings").sample(sides, min(samples, len(sides)))
    wanted = {cell for side in chosen for cell in cells(side)}
    raster = {cell: [] for cell in wanted}
    for side in sides:
        for cell in cells(side) & wanted:
            raster[cell].append(side)
    met = sum(cross(side, other) for side in chosen for other in {each for cell in cells(side) for each in raster[cell]})
    return met * len(sides) / len(chosen) / 2
