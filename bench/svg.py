# SPDX-License-Identifier: Apache-2.0
"""Charts as SVG text: panels of bars and of curves, all of one look. The same input gives the same bytes."""

import math
from html import escape

INK, FAINT, GRID = "#1c2833", "#5d6d7e", "#e3e7eb"
BLUE, GREEN, SKY, GOLD, GREY = "#1f618d", "#117a65", "#7fb3d5", "#d4ac0d", "#7b7d7d"
DARK = (BLUE, GREEN, GREY)  # what white text is read on
FONT = "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif"


def number(value):
    """A coordinate, short."""
    return f"{value:.1f}".removesuffix(".0")


def significant(value, digits=3):
    """As 0.0123, 1.23, 12.3, 123."""
    if value == 0:
        return "0"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:.{decimals}f}"


class Drawing:
    """SVG elements, drawn one upon the other."""

    def __init__(self, width, height, title):
        self.width = width
        self.height = height
        self.parts = [
            "<!-- SPDX-License-Identifier: Apache-2.0 -->",
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
            f'viewBox="0 0 {width} {height}" font-family="{FONT}">',
            f"<title>{escape(title, quote=False)}</title>"]
        self.rectangle(0, 0, width, height, "#ffffff")

    def rectangle(self, x, y, width, height, fill):
        self.parts.append(f'<rect x="{number(x)}" y="{number(y)}" width="{number(width)}" '
                          f'height="{number(height)}" fill="{fill}"/>')

    def line(self, x1, y1, x2, y2, stroke=GRID, width=1.0):
        self.parts.append(f'<line x1="{number(x1)}" y1="{number(y1)}" x2="{number(x2)}" y2="{number(y2)}" '
                          f'stroke="{stroke}" stroke-width="{width}"/>')

    def curve(self, points, stroke):
        text = " ".join(f"{number(x)},{number(y)}" for x, y in points)
        self.parts.append(f'<polyline points="{text}" fill="none" stroke="{stroke}" stroke-width="1.8"/>')
        for x, y in points:
            self.parts.append(f'<circle cx="{number(x)}" cy="{number(y)}" r="2.4" fill="{stroke}"/>')

    def text(self, x, y, text, size=11, anchor="middle", fill=INK, weight="normal", turned=0, above=""):
        """`above` stands behind the text, raised and small, as an exponent does."""
        turn = f' transform="rotate({turned} {number(x)} {number(y)})"' if turned else ""
        bold = f' font-weight="{weight}"' if weight != "normal" else ""
        raised = f'<tspan dy="-4" font-size="{size - 2}">{escape(above, quote=False)}</tspan>' if above else ""
        self.parts.append(f'<text x="{number(x)}" y="{number(y)}" font-size="{size}" text-anchor="{anchor}" '
                          f'fill="{fill}"{bold}{turn}>{escape(text, quote=False)}{raised}</text>')

    def key(self, x, y, entries):
        """Squares of colour and what they stand for, from left to right: pairs of name and colour."""
        for name, colour in entries:
            self.rectangle(x, y - 9, 10, 10, colour)
            self.text(x + 15, y, name, anchor="start")
            x += 33 + 6.6 * len(name)

    def as_text(self):
        return "\n".join([*self.parts, "</svg>"]) + "\n"


def titled(width, height, title, note, entries):
    """A drawing with a title on the left, a note on the right, and a key below them."""
    drawing = Drawing(width, height, title)
    drawing.text(58, 24, title, 15, "start", weight="bold")
    drawing.text(width - 16, 24, note, 11, "end", FAINT)
    drawing.key(58, 46, entries)
    return drawing


class Frame:
    """Where a panel's values are drawn: the space within its axes."""

    def __init__(self, left, top, width, height):
        self.left, self.top, self.width, self.height = left, top, width, height
        self.right, self.bottom = left + width, top + height


def frames(columns, count, width, top, height, gap=(58, 78), margin=(58, 16)):
    """Frames for so many panels, row by row."""
    inner = (width - sum(margin) - (columns - 1) * gap[0]) / columns
    return [Frame(margin[0] + i % columns * (inner + gap[0]), top + i // columns * (height + gap[1]), inner, height)
            for i in range(count)]


def even_steps(top):
    """0 and some round numbers up to the top."""
    step = next(s * 10**e for e in range(-3, 9) for s in (1, 2, 5) if top / (s * 10**e) <= 6)
    return [i * step for i in range(math.floor(top / step + 1e-9) + 1)]


def draw_bar(drawing, x, width, top, bottom, mark, value, colour):
    """With its value at its foot, or above where it is too short for that; and a mark across it, if any."""
    drawing.rectangle(x, top, width, bottom - top, colour)
    if mark is not None:
        drawing.line(x, mark, x + width, mark, INK, 2)
    upright = width >= 20
    if width < 10 or not upright and bottom - top < 28:
        return
    within = bottom - top > 14
    above = min(top, mark if mark is not None else top) - 4
    ink = "#ffffff" if within and colour in DARK else INK
    if upright:
        drawing.text(x + width / 2, bottom - 5 if within else above, significant(value, 2), 8, fill=ink)
    else:
        drawing.text(x + width / 2 + 3, bottom - 4, significant(value, 2), 8, "start", ink, turned=-90)


def bar_panel(drawing, frame, title, groups, colours, top, axis, reference=1):
    """Bars from 0 to the top: groups are pairs of a label and a value, or none, for each colour. A value may be
    a pair: then the second is a mark across the bar. The axis has a name, and a line at the reference."""

    def height(value):
        return frame.bottom - frame.height * min(value, top) / top

    drawing.text(frame.left, frame.top - 10, title, 12, "start", weight="bold")
    drawing.text(frame.left - 34, frame.top + frame.height / 2, axis, 10, fill=FAINT, turned=-90)
    for step in even_steps(top):
        drawing.line(frame.left, height(step), frame.right, height(step))
        drawing.text(frame.left - 6, height(step) + 4, f"{step:g}", 10, "end", FAINT)
    across = frame.width / max(len(groups), 1)
    bar = across * 0.8 / len(colours)
    for i, (label, values) in enumerate(groups):
        for j, value in enumerate(values):
            if value is None:
                continue
            value, mark = value if isinstance(value, tuple) else (value, None)
            draw_bar(drawing, frame.left + across * (i + 0.1) + bar * j, bar - 1, height(value), frame.bottom,
                     mark and height(mark), value, colours[j])
        drawing.text(frame.left + across * (i + 0.6), frame.bottom + 14, label, 10, "end", turned=-28)
    drawing.line(frame.left, height(reference), frame.right, height(reference), "#c0392b", 1.4)
    drawing.line(frame.left, frame.bottom, frame.right, frame.bottom, FAINT)


def decades(values):
    return math.floor(math.log10(min(values)) + 1e-9), math.ceil(math.log10(max(values)) - 1e-9)


def power_of_ten(drawing, x, y, power, anchor):
    if -2 <= power <= 2:
        drawing.text(x, y, f"{10.0**power:g}", 10, anchor, FAINT)
    else:
        drawing.text(x, y, "10", 10, anchor, FAINT, above=str(power))


def curve_panel(drawing, frame, title, curves, colours, axis="triangles"):
    """Curves on logarithmic axes: each a dictionary of index, triangles, values and exponent, or None for none, and perhaps
    of half of its interval; a colour for each index. The axis is what goes to the right."""
    first, last = decades([x for curve in curves for x in curve["triangles"]])
    lowest, highest = decades([y for curve in curves for y in curve["values"]])
    last, highest = max(last, first + 1), max(highest, lowest + 1)
    across = frame.width / (last - first)
    upward = frame.height / (highest - lowest)

    def place(x, y):
        return (frame.left + (math.log10(x) - first) * across, frame.bottom - (math.log10(y) - lowest) * upward)

    drawing.text(frame.left, frame.top - 10, title, 12, "start", weight="bold")
    for power in range(lowest, highest + 1):
        y = place(10.0**first, 10.0**power)[1]
        drawing.line(frame.left, y, frame.right, y)
        power_of_ten(drawing, frame.left - 6, y + 4, power, "end")
    for power in range(first, last + 1):
        x = place(10.0**power, 10.0**lowest)[0]
        drawing.line(x, frame.top, x, frame.bottom)
        power_of_ten(drawing, x, frame.bottom + 16, power, "middle")
    drawing.text((frame.left + frame.right) / 2, frame.bottom + 32, axis, 10, fill=FAINT)
    for i, curve in enumerate(curves):
        colour = colours[curve["index"]]
        drawing.curve([place(x, y) for x, y in zip(curve["triangles"], curve["values"])], colour)
        if curve["exponent"] is not None:
            interval = f" ± {curve['half_interval']:.2f}" if curve.get("half_interval") is not None else ""
            drawing.text(frame.left + 8, frame.top + 14 + 14 * i, "n", 11, "start", colour, "bold",
                         above=f"{curve['exponent']:.2f}{interval}")
    drawing.line(frame.left, frame.bottom, frame.right, frame.bottom, FAINT)
