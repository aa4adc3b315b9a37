# SPDX-License-Identifier: Apache-2.0
"""What is seen at points of the picture: by asking every triangle, and by reading drawings.

Points and what is read have x from the left and y from the bottom, both from 0 to 1. What is seen is the number of a
triangle, from 1 on; 0 is the background.
"""

import math
import random
import re
import zlib


class Points:
    """Random points, found by place."""

    def __init__(self, count, seed=1):
        values = random.Random(seed)
        self.points = [(values.random(), values.random()) for _ in range(count)]
        self.side = max(1, math.isqrt(count))
        self.cells = [[] for _ in range(self.side**2)]
        for i, (x, y) in enumerate(self.points):
            self.cells[int(y * self.side) * self.side + int(x * self.side)].append(i)

    def within(self, x0, y0, x1, y1):
        """The numbers of the points in the box."""
        def cell(value):
            return min(max(int(value * self.side), 0), self.side - 1)
        for row in range(cell(y0), cell(y1) + 1):
            for column in range(cell(x0), cell(x1) + 1):
                for i in self.cells[row * self.side + column]:
                    x, y = self.points[i]
                    if x0 <= x <= x1 and y0 <= y <= y1:
                        yield i


def box_of(corners, margin=0.0):
    xs, ys = [corner[0] for corner in corners], [corner[1] for corner in corners]
    return min(xs) - margin, min(ys) - margin, max(xs) + margin, max(ys) + margin


def distance_squared(x, y, a, b):
    """To the side from a to b."""
    u, v = b[0] - a[0], b[1] - a[1]
    length = u * u + v * v
    part = ((x - a[0]) * u + (y - a[1]) * v) / length if length > 0 else 0
    part = min(1.0, max(0.0, part))
    return (a[0] + part * u - x)**2 + (a[1] + part * v - y)**2


def slope(a, b, c, area):
    """By how much the depth of the triangle's plane changes along the picture, at most."""
    u, v, w, z = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]
    return math.hypot((b[2] - a[2]) * z - (c[2] - a[2]) * v, (c[2] - a[2]) * u - (b[2] - a[2]) * w) / abs(area)


def seen_truly(corners, faces, points, margin):
    """What is seen at each point by asking every triangle; None where a side, or where the two nearest pass through each
    other, may lie within the margin."""
    best = [[(-math.inf, 0, 0)] for _ in points.points]
    doubtful = [False] * len(points.points)
    for number, face in enumerate(faces, 1):
        a, b, c = (corners[i - 1] for i in face)
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        for i in points.within(*box_of((a, b, c), margin)):
            x, y = points.points[i]
            if min(distance_squared(x, y, p, q) for p, q in ((a, b), (b, c), (c, a))) < margin**2:
                doubtful[i] = True
                continue
            u = ((b[0] - x) * (c[1] - y) - (b[1] - y) * (c[0] - x)) / area if area else -1
            v = ((c[0] - x) * (a[1] - y) - (c[1] - y) * (a[0] - x)) / area if area else -1
            if u > 0 and v > 0 and u + v < 1:
                best[i].append((u * a[2] + v * b[2] + (1 - u - v) * c[2], number, slope(a, b, c, area)))
    result = []
    for i, found in enumerate(best):
        first, *others = sorted(found, reverse=True)
        close = any(first[0] - other[0] <= margin * (first[2] + other[2]) for other in others)
        result.append(None if doubtful[i] or close else first[1])
    return result


def encloses(rings, x, y):
    """By the even-odd rule."""
    inside = False
    for ring in rings:
        px, py = ring[-1]
        for qx, qy in ring:
            if (py > y) != (qy > y) and x < px + (y - py) / (qy - py) * (qx - px):
                inside = not inside
            px, py = qx, qy
    return inside


def seen_in(areas, points):
    """What is seen at each point where areas, pairs of a number and rings, are painted in their order."""
    result = [0] * len(points.points)
    for number, rings in areas:
        for i in points.within(*box_of([point for ring in rings for point in ring])):
            if encloses(rings, *points.points[i]):
                result[i] = number
    return result


PATH_TOKEN = re.compile(r"[MmLlHhVvZz]|[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?")


def rings_of(data):
    """The closed ways of the straight path data of an SVG."""
    rings, x, y, command = [], 0.0, 0.0, ""
    tokens = PATH_TOKEN.findall(data)
    i = 0
    while i < len(tokens):
        if tokens[i].isalpha():
            command = tokens[i]
            i += 1
            if command in "zZ":
                x, y = rings[-1][0]
                continue
        near = command.islower()
        if command in "mMlL":
            dx, dy = float(tokens[i]), float(tokens[i + 1])
            x, y = (x + dx, y + dy) if near else (dx, dy)
            i += 2
        elif command in "hH":
            x = float(tokens[i]) + (x if near else 0)
            i += 1
        else:
            y = float(tokens[i]) + (y if near else 0)
            i += 1
        if command in "mM":
            rings.append([])
            command = "l" if near else "L"
        rings[-1].append((x, y))
    return rings


def number_of(colour):
    """Of #rgb, #rrggbb or rgb(r,g,b)."""
    if colour.startswith("#"):
        digits = colour[1:]
        return int(digits if len(digits) == 6 else "".join(2 * digit for digit in digits), 16)
    r, g, b = (int(value) for value in re.findall(r"\d+", colour))
    return r * 65536 + g * 256 + b


SVG_FILL = re.compile(r'<path [^>]*?(?:fill="(#[0-9a-f]+)"|style="fill:(rgb\([^)]*\))[^"]*")')
SVG_DATA = re.compile(r' d="([^"]*)"')


def areas_of_svg(path, left=0.0, top=0.0, pixels=1000.0):
    """The filled areas of an SVG, whose square of so many pixels begins there."""
    with open(path) as file:
        for line in file:
            fill, data = SVG_FILL.search(line), SVG_DATA.search(line)
            if not fill or not data:
                continue
            rings = [[((x - left) / pixels, 1 - (y - top) / pixels) for x, y in ring]
                     for ring in rings_of(data[1])]
            yield number_of(fill[1] or fill[2]), rings


PDF_STREAM = re.compile(rb"stream\r?\n")


def areas_of_pdf(path, pixels):
    """The filled areas of the first page of a PDF that VERA wrote, whose background, the first rectangle, is so many pixels
    wide; x and y in pixels from the upper left."""
    data = path.read_bytes()
    content = zlib.decompressobj().decompress(data[PDF_STREAM.search(data).end():]).decode("ascii")
    numbers, colour, rings, scale = [], 0, [], None
    for word in content.split():
        if word == "re":
            scale = scale or pixels / numbers[2]
        elif word == "rg":
            r, g, b = (round(255 * value) for value in numbers)
            colour = r * 65536 + g * 256 + b
        elif word in ("m", "l"):
            if word == "m":
                rings.append([])
            rings[-1].append((numbers[0] * scale, numbers[1] * scale))
        elif word in ("f", "f*"):
            if rings:
                yield colour, rings
            rings = []
        elif word in ("c", "v", "y", "S", "B"):
            raise ValueError(f"{path}: an area of style ids has no '{word}'")
        try:
            numbers.append(float(word))
        except ValueError:
            numbers = []


SKETCH_FILL = re.compile(r"\\filldraw\[fill=c(\d+)[^\]]*\](\(.*?)--cycle")


def areas_of_sketch(path, size=100.0):
    with open(path) as file:
        for line in file:
            found = SKETCH_FILL.search(line)
            if found:
                numbers = [float(text) / size for text in re.findall(r"[-+.\de]+", found[2].replace("--", " "))]
                yield int(found[1]), [list(zip(numbers[::2], numbers[1::2]))]
