#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the plots of docs/performance.md (docs/images/bench-*.svg) and fills in its tables, from the
results in bench/results/. Nothing is measured, and the same results give the same bytes.

The machine is the one that is named, or else this one where it has results, or else the one that
the document is about already.
"""

import argparse
import math
import re
import statistics
import sys

from machine import RESULTS, ROOT, fail, machine
from measured import (ACROSS, ENGINES, NAMES, QUANTITIES, RAYS, Results, engine_fit, families_of, fitting_build,
                      indexes_of, mean, ratio, scenes_of, speed)
from performance_tables import TABLES
from svg import BLUE, GOLD, GREEN, GREY, INK, SKY, bar_panel, curve_panel, frames, titled

DOCUMENT = ROOT / "docs/performance.md"
IMAGES = ROOT / "docs/images"
WIDTH = 1080

COLOURS = {"mesh": BLUE, "mesh_high": GREEN, "spheres": BLUE, "spheres_high": GREEN, "bvh": SKY, "grid": GOLD,
           "Embree medium": GREY}


# Plots.


def with_mean(scenes, values):
    """Groups of bars, one for each scene, and one of means where there are several; values(scene) is a list."""
    groups = [(scene["name"], values(scene)) for scene in scenes]
    if len(groups) < 2:
        return groups
    firsts = [[value[0] if isinstance(value, tuple) else value for value in column]
              for column in zip(*(values for _, values in groups))]
    return [*groups, ("mean", [mean(column) for column in firsts])]


def key_of(indexes):
    return [(NAMES[index], COLOURS[index]) for index in indexes]


def top_of(panels):
    """The end of the axis for all panels: as far as the highest value goes, and beyond 1."""
    values = [value for _, groups in panels for _, bars in groups for bar in bars if bar is not None
              for value in (bar if isinstance(bar, tuple) else (bar,)) if value is not None]
    return max(1.2, math.ceil(max(values) * 5 + 0.2) / 5)


def draw_bars(title, note, panels, colours, columns, axis, same_axis=False):
    """Panels of bars, of as many columns; colours are pairs of a name and a colour."""
    height, top_margin = 150, 84
    rows = math.ceil(len(panels) / columns)
    drawing = titled(WIDTH, top_margin + rows * (height + 70), title, note, colours)
    for frame, panel in zip(frames(columns, len(panels), WIDTH, top_margin, height, gap=(58, 70)), panels):
        top = top_of(panels if same_axis else [panel])
        bar_panel(drawing, frame, *panel, [colour for _, colour in colours], top, axis)
    return drawing.as_text()


def draw_rays(measurement, title, kinds, wanted):
    """Ratios to Embree for each kind of rays and scene; the mark on a bar is the ratio with Embree's robust flag."""
    scenes = scenes_of(measurement, *kinds)
    indexes = indexes_of(scenes, wanted)
    if not indexes:
        return None

    def bars(kind, one_ray=False):
        def values(scene):
            pairs = []
            for index in indexes:
                plain = speed(scene, kind, index, one_ray=one_ray)
                pairs.append(plain and (plain, speed(scene, kind, index, True, one_ray)))
            return pairs
        return [group for each in kinds for group in with_mean(scenes_of(measurement, each), values)]

    panels = [(name, bars(kind)) for kind, name in RAYS.items()]
    panels += [(f"one at a time: {RAYS[kind]}", bars(kind, True)) for kind in ("diffuse", "shuffled", "ao")]
    panels = [(name, groups) for name, groups in panels if any(any(bars) for _, bars in groups)]
    return draw_bars(title, "red: as fast as Embree; black mark: against Embree's robust flag", panels,
                     key_of(indexes), 3, "VERA by Embree", same_axis=True)


def draw_builds(measurement):
    scenes = scenes_of(measurement, "triangles")
    indexes = indexes_of(scenes, ["mesh", "mesh_high", "bvh"])
    if not indexes:
        return None

    def values(quantity):
        def of(scene):
            builds = [fitting_build(scene, index) for index in indexes]
            return [ours and ratio(ours[quantity], theirs[quantity]) for ours, theirs in builds]
        return with_mean(scenes, of)

    return draw_bars(
        "Building an index, by Embree's build of the same speed", "red: as much as Embree; less is better",
        [("seconds", values("seconds")), ("bytes beside the mesh", values("bytes"))], key_of(indexes), 2,
        "VERA by Embree")


def draw_growth(family):
    quantities = [
        "build seconds", "microseconds for each primary ray", "microseconds for each diffuse ray",
        "bytes", "nodes for each primary ray", "nodes for each diffuse ray"]
    curves = [curve for curve in family["curves"] if curve["exponent"] is not None]
    indexes = [index for index in NAMES if any(curve["index"] == index for curve in curves)]
    drawing = titled(WIDTH, 84 + 2 * 240, f"Growth with the number of triangles: {family['name']}",
                     "fitted: n to the power of", key_of(indexes))
    for frame, quantity in zip(frames(3, len(quantities), WIDTH, 84, 170, gap=(58, 70)), quantities):
        chosen = [curve for index in indexes for curve in curves
                  if curve["index"] == index and curve["quantity"] == quantity]
        curve_panel(drawing, frame, quantity, chosen, COLOURS)
    return drawing.as_text()


def draw_peers(results):
    panels = []
    for side, antialias in sorted({(row["side"], row["antialias"]) for row in results}):
        rows = [row for row in results if (row["side"], row["antialias"]) == (side, antialias)]
        groups = [(row["scene"], [row["trace_ratio"], row["cpu_ratio"]]) for row in rows]
        means = [mean(values) for values in zip(*(values for _, values in groups))]
        title = f"{side} x {side}, {'antialiased' if antialias else 'no antialiasing'}"
        panels.append((title, [*groups, ("mean", means)]))
    return draw_bars("Whole pictures: how many times as fast as POV-Ray", "red: as fast as POV-Ray", panels,
                     [("tracing, by the clock", BLUE), ("processor seconds of the whole program", SKY)],
                     min(2, len(panels)), "times as fast")


# What bench/drawings wrote.

DRAWING = {"vera": "VERA", "envelope": "CGAL's Envelope_3", "three": "three.js", "sketch": "sketch",
           "OCCT": "OpenCASCADE"}
DRAWING_COLOURS = {"vera": BLUE, "envelope": GOLD, "three": GREEN, "sketch": GREY, "OCCT": SKY}
FAMILY_COLOURS = (BLUE, GREEN, SKY, GOLD, GREY, INK)


def slope(curve):
    """The power of the triangles that the values grow by; None of one point."""
    xs, ys = [[math.log(value) for value in curve[key]] for key in ("triangles", "values")]
    if len(xs) < 2:
        return None
    x, y = statistics.fmean(xs), statistics.fmean(ys)
    return sum((a - x) * (b - y) for a, b in zip(xs, ys)) / sum((a - x)**2 for a in xs)


def curve_of(index, points):
    curve = {"index": index, "triangles": [x for x, _ in points], "values": [y for _, y in points]}
    return {**curve, "exponent": slope(curve)}


def draw_drawings(results):
    """A panel for each family, and one for each family of lines; a curve for each program."""
    groups = [(family, [row for row in results["rows"] if row["family"] == family])
              for family in families_of(results["rows"])]
    groups += [(f"{family}, lines", [row for row in results["lines"] if row["family"] == family])
               for family in families_of(results["lines"])]
    names = [name for name in DRAWING if any(row["programs"].get(name) for _, rows in groups for row in rows)]
    rows_of_panels = math.ceil(len(groups) / 4)
    drawing = titled(WIDTH, 84 + rows_of_panels * 240, "Seconds to draw, reading and writing included",
                     "fitted: n to the power of", [(DRAWING[name], DRAWING_COLOURS[name]) for name in names])
    for frame, (title, rows) in zip(frames(4, len(groups), WIDTH, 84, 170, gap=(48, 70)), groups):
        curves = [curve_of(name, [(row["triangles"], row["programs"][name]["seconds"]) for row in rows
                                  if row["programs"].get(name)]) for name in names]
        curve_panel(drawing, frame, title, [curve for curve in curves if curve["values"]], DRAWING_COLOURS)
    return drawing.as_text()


def draw_drawing_costs(results):
    """VERA alone, a curve for each family: drawing, by triangles, by crossings and by what is seen; memory."""
    families = families_of(results["rows"])
    colours = dict(zip(families, FAMILY_COLOURS))
    drawing = titled(WIDTH, 84 + 240, "What drawing takes, by family", "", list(colours.items()))
    panels = [("seconds of drawing alone", "triangles", "draw"),
              ("the same, by what crosses", "pairs of sides that cross", "draw"),
              ("the same, by what is seen", "bytes of the drawing", "draw"),
              ("peak memory, bytes", "triangles", "bytes")]
    for frame, (title, axis, quantity) in zip(frames(4, 4, WIDTH, 84, 170, gap=(48, 70)), panels):
        curves = []
        for family in families:
            points = []
            for row in results["rows"]:
                ours = row["programs"]["vera"]
                across = {"triangles": row["triangles"], "pairs of sides that cross": row["crossings"],
                          "bytes of the drawing": ours["file"]}[axis]
                if row["family"] == family and across:
                    points.append((across, ours[quantity]))
            if points:
                curves.append({**curve_of(family, points), "exponent": None})
        curve_panel(drawing, frame, title, curves, colours, axis)
    return drawing.as_text()


ENGINE_COLOURS = {"cells": BLUE, "sweep": GOLD}
MANY_COLOURS = (*FAMILY_COLOURS, "#c0392b", "#8e44ad", "#e67e22", "#16a085")


def engine_curve(results, family, engine, quantity, across):
    points = [(row[across], row["engines"][engine][quantity]) for row in results["rows"]
              if row["family"] == family and row["engines"][engine] and row[across]]
    fit = engine_fit(results, family, engine, quantity, across) or {"exponent": None, "half_interval": None}
    return {"triangles": [x for x, _ in points], "values": [y for _, y in points],
            "exponent": fit["exponent"], "half_interval": fit["half_interval"]}


def draw_engines(results, quantity):
    """A panel for each family, with both engines."""
    families = families_of(results["rows"])
    rows_of_panels = math.ceil(len(families) / 5)
    drawing = titled(WIDTH, 84 + rows_of_panels * 240, f"Two engines, by family: {QUANTITIES[quantity]}",
                     "fitted: n to the power of", [(name, ENGINE_COLOURS[key]) for key, name in ENGINES.items()])
    for frame, family in zip(frames(5, len(families), WIDTH, 84, 170, gap=(48, 70)), families):
        curves = [{"index": engine, **engine_curve(results, family, engine, quantity, "triangles")} for engine in ENGINES]
        curve_panel(drawing, frame, family, [curve for curve in curves if curve["values"]], ENGINE_COLOURS)
    return drawing.as_text()


def draw_engine_costs(results):
    """Each engine alone, a curve for each family: by triangles, by crossings and by what is seen."""
    families = families_of(results["rows"])
    colours = dict(zip(families, MANY_COLOURS))
    panels = [(engine, quantity, across) for engine in ENGINES for quantity in QUANTITIES for across in ACROSS]
    drawing = titled(WIDTH, 84 + 4 * 240, "What each engine takes, by what grows", "", list(colours.items()))
    for frame, (engine, quantity, across) in zip(frames(3, len(panels), WIDTH, 84, 170, gap=(58, 70)), panels):
        curves = [{"index": family, **engine_curve(results, family, engine, quantity, across), "exponent": None}
                  for family in families]
        curve_panel(drawing, frame, f"{ENGINES[engine]}: {QUANTITIES[quantity]}",
                    [curve for curve in curves if curve["values"]], colours, ACROSS[across])
    return drawing.as_text()


def plots(results):
    """The text of every plot by its file's name."""
    drawn = {}
    one = results.rays_on(1)
    if one:
        drawn["bench-rays-meshes"] = draw_rays(
            one, "Meshes: rays a second by Embree's, one thread", ["triangles"], ["mesh", "mesh_high", "bvh"])
        drawn["bench-rays-round"] = draw_rays(
            one, "Spheres and rotational shapes: rays a second by Embree's, one thread",
            ["spheres", "rotational shapes"], ["spheres", "bvh", "grid"])
        drawn["bench-builds"] = draw_builds(one)
    for family in results.growth["measurements"][0]["families"] if results.growth else []:
        drawn[f"bench-growth-{family['name']}"] = draw_growth(family)
    if results.peers:
        drawn["bench-peers"] = draw_peers(results.peers["results"])
    if results.drawings:
        drawn["bench-drawings"] = draw_drawings(results.drawings)
        drawn["bench-drawings-costs"] = draw_drawing_costs(results.drawings)
    if results.engines:
        drawn["bench-engines"] = draw_engines(results.engines, "seconds")
        drawn["bench-engines-steps"] = draw_engines(results.engines, "steps")
        drawn["bench-engines-costs"] = draw_engine_costs(results.engines)
    return {name: text for name, text in drawn.items() if text}


MACHINE = re.compile(r"<!-- machine: (\S+) -->")
TITLE = re.compile(r"<title>(.*?)</title>")
PART = re.compile(r"(<!-- (table|plot): ([a-z -]+) -->\n).*?(<!-- end -->)", re.DOTALL)


def filled_in(document, results, drawn):
    """The document with its tables, plots and machine as the results give them."""
    def replacement(match):
        before, what, name, after = match.groups()
        if what == "table":
            text = TABLES[name](results)
        else:
            text = f"![{TITLE.search(drawn[name])[1]}](images/{name}.svg)" if name in drawn else None
        return f"{before}\n{text or 'Not measured on this machine.'}\n\n{after}"
    return PART.sub(replacement, MACHINE.sub(f"<!-- machine: {results.machine} -->", document))


def chosen_results(arguments, document):
    known = MACHINE.search(document)[1]
    names = [arguments.machine] if arguments.machine else [known] if arguments.check else [machine()["name"], known]
    for name in names:
        results = Results(name)
        if results.parts():
            return results
    return fail(f"there are no results of {names[-1]} in {RESULTS}")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--machine", help="as in the names of the files of results")
    parser.add_argument("--check", action="store_true",
                        help="write nothing; fail when the document or a plot is not what the results give")
    arguments = parser.parse_args()

    document = DOCUMENT.read_text(encoding="utf-8")
    results = chosen_results(arguments, document)
    drawn = plots(results)
    files = {IMAGES / f"{name}.svg": text for name, text in drawn.items()}
    files[DOCUMENT] = filled_in(document, results, drawn)
    if arguments.check:
        stale = [path for path, text in files.items()
                 if not path.exists() or path.read_text(encoding="utf-8") != text]
        stale += [path for path in IMAGES.glob("bench-*.svg") if path not in files]
        for path in sorted(stale):
            print(f"{path.relative_to(ROOT)} is not what the results give; run ./dev bench plots")
        return 1 if stale else 0
    for path, text in files.items():
        path.write_text(text, encoding="utf-8")
        print(path.relative_to(ROOT))
    return 0


if __name__ == "__main__":
    sys.exit(main())
