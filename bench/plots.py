#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the plots of docs/performance.md (docs/images/bench-*.svg) and fills in its tables, from the
results in bench/results/. Nothing is measured, and the same results give the same bytes.

The machine is the one that is named, or else this one where it has results, or else the one that
the document is about already.
"""

import argparse
import json
import math
import re
import statistics
import sys

from fits import part_of_bound
from machine import RESULTS, ROOT, fail, machine
from svg import BLUE, GOLD, GREEN, GREY, INK, SKY, bar_panel, curve_panel, frames, significant, titled

DOCUMENT = ROOT / "docs/performance.md"
IMAGES = ROOT / "docs/images"
WIDTH = 1080

NAMES = {"mesh": "MeshIndex", "mesh_high": "MeshIndex, high quality", "spheres": "SphereIndex",
         "spheres_high": "SphereIndex, high quality", "bvh": "boxes of the scene",
         "grid": "grids of the scene", "Embree medium": "Embree"}
COLOURS = {"mesh": BLUE, "mesh_high": GREEN, "spheres": BLUE, "spheres_high": GREEN, "bvh": SKY, "grid": GOLD,
           "Embree medium": GREY}
RAYS = {"primary": "view rays", "shadow": "shadow rays", "mirror": "mirrored rays", "diffuse": "diffuse rays",
        "shuffled": "diffuse rays, shuffled", "ao": "any hit of diffuse rays"}


class Results:
    """What was measured on a machine; None for a part that was not."""

    KINDS = ("peers", "errors", "rays", "growth", "billion", "drawings", "engines", "faces", "leaks", "sizes")

    def __init__(self, name):
        self.machine = name
        (self.peers, self.errors, self.rays, self.growth, self.billion, self.drawings, self.engines, self.faces, self.leaks,
         self.sizes) = (self.load(kind) for kind in self.KINDS)

    def load(self, kind):
        path = RESULTS / f"{kind}-{self.machine}.json"
        return json.loads(path.read_text()) if path.exists() else None

    def parts(self):
        """By kind, those that were."""
        return {kind: getattr(self, kind) for kind in self.KINDS if getattr(self, kind)}

    def rays_on(self, threads):
        """The measurement with so many threads; None where there is none."""
        for measurement in self.rays["measurements"] if self.rays else []:
            if measurement["threads"] == threads:
                return measurement
        return None


def mean(values):
    """The geometric mean; None of nothing."""
    values = [value for value in values if value is not None]
    return math.exp(statistics.fmean(map(math.log, values))) if values else None


def ratio(ours, theirs):
    return ours / theirs if ours is not None and theirs is not None else None


# What rays_bench wrote: scenes, of each the kinds of rays.


def rays_of(scene, kind):
    return next((rays for rays in scene["rays"] if rays["kind"] == kind), None)


def our_rate(rays, index, one_ray=False):
    return max((each["rate"] for each in rays["ours"]
                if each["index"] == index and (each["call"] == "one") == one_ray), default=None)


def embree_rate(rays, robust=False, one_ray=False):
    """Of its fastest call; with one_ray, of its fastest for one ray."""
    return max((each["rate"] for each in rays["embree"]
                if each["robust"] == robust and (each["one_ray"] or not one_ray)), default=None)


def speed(scene, kind, index, robust=False, one_ray=False):
    """Our rate by Embree's; None where there is no such."""
    rays = rays_of(scene, kind)
    return rays and ratio(our_rate(rays, index, one_ray), embree_rate(rays, robust, one_ray))


def scenes_of(measurement, *kinds):
    return [scene for scene in measurement["scenes"] if scene["kind"] in kinds]


def indexes_of(scenes, wanted):
    """Those of the wanted indexes that some scene was measured with."""
    found = {each["index"] for scene in scenes for rays in scene["rays"] for each in rays["ours"]}
    return [index for index in wanted if index in found]


def with_mean(scenes, values):
    """Groups of bars, one for each scene, and one of means where there are several; values(scene) is a list."""
    groups = [(scene["name"], values(scene)) for scene in scenes]
    if len(groups) < 2:
        return groups
    firsts = [[value[0] if isinstance(value, tuple) else value for value in column]
              for column in zip(*(values for _, values in groups))]
    return [*groups, ("mean", [mean(column) for column in firsts])]


# Plots.


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


def fitting_build(scene, index):
    """Of Embree's builds, the one whose rays are nearest in speed to those of our index, and our build."""
    def build(wanted):
        return next((each for each in scene["builds"]
                     if each["index"] == wanted or each.get("quality") == wanted and not each["robust"]), None)

    def difference(quality):
        speeds = [ratio(our_rate(rays, index),
                        max((each["rate"] for each in rays["embree"]
                             if each["quality"] == quality and not each["robust"]), default=None))
                  for rays in scene["rays"]]
        return abs(math.log(mean(speeds) or 1))

    qualities = [each["quality"] for each in scene["builds"] if each.get("robust") is False]
    return build(index), build(min(qualities, key=difference))


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


def families_of(rows):
    return list(dict.fromkeys(row["family"] for row in rows))


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


ENGINES = {"cells": "cells", "sweep": "plane sweep"}
ENGINE_COLOURS = {"cells": BLUE, "sweep": GOLD}
ACROSS = {"triangles": "triangles, n", "crossings": "crossings of edges, k", "corners": "corners of what is seen, v"}
QUANTITIES = {"seconds": "seconds", "steps": "counted steps"}
MANY_COLOURS = (*FAMILY_COLOURS, "#c0392b", "#8e44ad", "#e67e22", "#16a085")


def engine_fit(results, family, engine, quantity, across):
    """The exponent and half its interval; None where nothing was fitted."""
    return next((fit for fit in results["fits"] if (fit["family"], fit["engine"], fit["quantity"], fit["across"])
                 == (family, engine, quantity, across)), None)


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


# Tables.


def table(head, rows):
    lines = [head, ["---", *["---:"] * (len(head) - 1)], *rows]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


def cell(value, digits=3):
    return "" if value is None else significant(value, digits)


def machine_table(results):
    """A column for each machine of the name: what is measured anew need not be measured on the same one."""
    machines = {}
    for kind, part in results.parts().items():
        host = {key: str(value) for key, value in part["machine"].items() if key not in ("name", "system")}
        machines.setdefault(tuple(host.items()), []).append(kind)
    if not machines:
        return None
    names = {"cpu": "processor", "family": "its family", "processors": "processors", "instructions": "instructions",
             "memory": "memory"}
    rows = [["measured", *(", ".join(kinds) for kinds in machines.values())]]
    rows += [[name, *(dict(host).get(key, "") for host in machines)] for key, name in names.items()]
    if results.rays:
        embree = results.rays["measurements"][0]["embree"]
        rows.append(["Embree", *(embree if "rays" in kinds else "" for kinds in machines.values())])
    head = ["| | " + " | ".join("" for _ in machines) + "|", "| --- | " + " | ".join("---" for _ in machines) + " |"]
    return "\n".join([*head, *("| " + " | ".join(row) + " |" for row in rows)])


def means_table(results):
    """Geometric means over the scenes: a row for each index, kind of scene and number of threads."""
    rows = []
    for measurement in results.rays["measurements"] if results.rays else []:
        for kind in ("triangles", "spheres", "rotational shapes"):
            scenes = scenes_of(measurement, kind)
            for index in indexes_of(scenes, NAMES):
                for robust in (False, True):
                    values = [mean(speed(scene, rays, index, robust) for scene in scenes) for rays in RAYS]
                    rows.append([
                        f"{kind}, {NAMES[index]}{', against the robust flag' if robust else ''}",
                        str(measurement["threads"]), *(cell(value, 2) for value in values)])
    return table(["scenes and index", "threads", *RAYS.values()], rows) if rows else None


def rates_table(results):
    """Million rays a second of ours and of Embree on one thread, by scene."""
    measurement = results.rays_on(1)
    rows = []
    for scene in measurement["scenes"] if measurement else []:
        for index in indexes_of([scene], NAMES):
            rows.append([f"{scene['name']}, {NAMES[index]}"]
                        + [cell(rays and our_rate(rays, index))
                           for rays in (rays_of(scene, kind) for kind in RAYS)])
        for robust in (False, True):
            rows.append([f"{scene['name']}, Embree{' robust' if robust else ''}"]
                        + [cell(rays and embree_rate(rays, robust))
                           for rays in (rays_of(scene, kind) for kind in RAYS)])
    return table(["million rays a second", *RAYS.values()], rows) if rows else None


def one_ray_table(results):
    rows = []
    measurement = results.rays_on(1)
    kinds = ("diffuse", "shuffled", "ao")
    scenes = scenes_of(measurement, "triangles") if measurement else []
    for scene in scenes:
        for index in indexes_of([scene], ["mesh", "mesh_high"]):
            row = [f"{scene['name']}, {NAMES[index]}"]
            for kind in kinds:
                rays = rays_of(scene, kind)
                row += [cell(our_rate(rays, index, True)), cell(embree_rate(rays, one_ray=True)),
                        cell(speed(scene, kind, index, one_ray=True), 2)]
            rows.append(row)
    if not rows:
        return None
    columns = [name for kind in kinds for name in (RAYS[kind], "Embree", "ratio")]
    return table(["million rays a second", *columns], rows)


def builds_table(results):
    rows = []
    measurement = results.rays_on(1)
    for scene in scenes_of(measurement, "triangles", "spheres") if measurement else []:
        for index in indexes_of([scene], NAMES):
            ours, theirs = fitting_build(scene, index)
            each = scene["primitives"]
            rows.append([
                f"{scene['name']}, {NAMES[index]}", str(each), cell(ours["seconds"]), cell(theirs["seconds"]),
                cell(ratio(ours["seconds"], theirs["seconds"]), 2), cell(ours["bytes"] / each),
                cell(theirs["bytes"] / each), theirs["quality"]])
    head = ["scene and index", "primitives", "seconds", "Embree", "ratio", "bytes each", "Embree", "its quality"]
    return table(head, rows) if rows else None


def exponents_table(results):
    rows = []
    families = results.growth["measurements"][0]["families"] if results.growth else []
    indexes = [name for name in NAMES
               if any(curve["index"] == name for family in families for curve in family["curves"])]
    for family in families:
        for quantity in dict.fromkeys(curve["quantity"] for curve in family["curves"]):
            found = {curve["index"]: curve["exponent"] for curve in family["curves"]
                     if curve["quantity"] == quantity and curve["exponent"] is not None}
            rows.append([f"{family['name']}: {quantity}",
                         *(f"{found[index]:.2f}" if index in found else "" for index in indexes)])
    return table(["n to the power of", *(NAMES[index] for index in indexes)], rows) if rows else None


def peers_table(results):
    rows = []
    for row in results.peers["results"] if results.peers else []:
        rows.append([
            f"{row['scene']}, {row['side']}{', antialiased' if row['antialias'] else ''}",
            cell(row["vera"]["trace"]), cell(row["povray"]["trace"]), cell(row["trace_ratio"], 2),
            cell(row["vera"]["cpu"]), cell(row["povray"]["cpu"]), cell(row["cpu_ratio"], 2)])
    head = ["picture", "trace seconds", "POV-Ray", "ratio", "CPU seconds", "POV-Ray", "ratio"]
    return table(head, rows) if rows else None


def errors_table(results):
    rows = [[f"{row['scene']}, {row['side']}", str(row["samples"]), *(f"{row[program][i]:.2f}" for i in range(3) for program in ("vera", "povray"))]
            for row in (results.errors["rows"] if results.errors else [])]
    head = ["of 255", "`--samples`", "mean", "POV-Ray", "root mean square", "POV-Ray", "% of pixels over 8", "POV-Ray"]
    return table(head, rows) if rows else None


def tachyon_table(results):
    rows = []
    for row in results.peers.get("tachyon", []) if results.peers else []:
        rows.append([f"{row['scene']}, {row['side']}", *(
            cell(value, digits) for value, digits in (
                (row["vera"]["trace"], 3), (row["tachyon"]["trace"], 3), (row["trace_ratio"], 2),
                (row["vera"]["cpu"], 3), (row["tachyon"]["cpu"], 3), (row["cpu_ratio"], 2)))])
    if not rows:
        return None
    means = [cell(mean([row[name] for row in results.peers["tachyon"]]), 2) for name in ("trace_ratio", "cpu_ratio")]
    rows.append(["geometric mean", "", "", means[0], "", "", means[1]])
    head = ["picture", "trace seconds", "Tachyon", "ratio", "CPU seconds", "Tachyon", "ratio"]
    return table(head, rows)


def billion_table(results):
    if not results.billion:
        return None
    found = results.billion
    return table(["triangles", "raster", "seconds", "peak memory, MiB"],
                 [[f"{found['primitives']:,}".replace(",", " "), found["raster"], cell(found["seconds"]),
                   f"{found['peak_bytes'] / 2**20:.0f}"]])


def share(value):
    return "" if value is None else "0" if value == 0 else f"{100 * value:.2f} %"


def drawings_table(results):
    rows = []
    for row in results.drawings["rows"] if results.drawings else []:
        ours = row["programs"]["vera"]
        cells = [row["family"], str(row["triangles"]), cell(ours["seconds"]), cell(ours["draw"]),
                 cell((ours["bytes"] - ours["file"]) / row["triangles"]), cell(ours["file"] / 1e6)]
        for name in ("envelope", "three", "sketch"):
            found = row["programs"].get(name)
            cells += [cell(found["seconds"]), cell(found["seconds"] / ours["seconds"], 2), share(found.get("wrong"))] \
                if found else ["", "", ""]
        cells.insert(6, share(ours.get("wrong")))
        rows.append(cells)
    head = ["fills", "triangles", "seconds", "of them drawing", "memory, bytes each", "MB written", "wrong",
            "Envelope_3", "ratio", "wrong", "three.js", "ratio", "wrong", "sketch", "ratio", "wrong"]
    return table(head, rows) if rows else None


def drawn_lines_table(results):
    rows = []
    for row in results.drawings["lines"] if results.drawings else []:
        ours, theirs = row["programs"]["vera"], row["programs"].get("OCCT")
        rows.append([row["family"], str(row["triangles"]), cell(ours["seconds"]), cell(theirs and theirs["seconds"]),
                     cell(theirs and theirs["seconds"] / ours["seconds"], 2)])
    return table(["lines", "triangles", "seconds", "OpenCASCADE", "ratio"], rows) if rows else None


def drawing_exponents_table(results):
    fits = results.drawings["exponents"] if results.drawings else []
    quantities = {"seconds": "seconds", "draw": "of them drawing", "bytes": "peak memory", "file": "bytes written"}
    rows = []
    for family in families_of(fits):
        found = {fit["quantity"]: fit for fit in fits if fit["family"] == family}
        rows.append([family, *(f"{found[name]['exponent']:.2f} ± {found[name]['half_interval']:.2f}"
                               for name in quantities)])
    return table(["n to the power of", *quantities.values()], rows) if rows else None


def engines_table(results):
    rows = []
    for row in results.engines["rows"] if results.engines else []:
        cells, sweep = (row["engines"][name] for name in ENGINES)
        n, k = row["triangles"], row["crossings"]
        rows.append([
            row["family"], str(n), "" if k is None else str(k), str(row["corners"]),
            cell(cells and cells["seconds"]), cell(sweep and sweep["seconds"]),
            cell(cells and sweep and sweep["seconds"] / cells["seconds"], 2),
            cell(cells and cells["steps"] / n), cell(sweep and sweep["steps"] / n),
            cell(sweep and part_of_bound(sweep["steps"], n, k)), cell(sweep and sweep["moved"] / n)])
    head = ["family", "n", "k", "v", "cells, seconds", "sweep", "ratio", "cells, steps by n", "sweep",
            "by (n + k) log n", "moved, by n"]
    return table(head, rows) if rows else None


def engine_exponents_table(results):
    rows = []
    for family in families_of(results.engines["rows"]) if results.engines else []:
        for engine, name in ENGINES.items():
            found = [engine_fit(results.engines, family, engine, quantity, across)
                     for quantity in QUANTITIES for across in ACROSS]
            rows.append([f"{family}, {name}", *(
                f"{fit['exponent']:.2f} ± {fit['half_interval']:.2f}" if fit else "" for fit in found)])
    head = ["power of", *(f"{quantity} by {letter}" for quantity in ("seconds", "steps") for letter in "nkv")]
    return table(head, rows) if rows else None


def faces_table(results):
    rows = []
    for row in results.faces["rows"] if results.faces else []:
        files = [text for each in row["files"].values() for text in
                 (str(each["differing"]), str(each["far"]), f"{each['farthest']:.4f}")]
        rows.append([row["scene"], str(row["triangles"]), *(str(count) for count in (
            row["map"]["wrong"], row["map"]["coincident"], row["map"]["close"], row["uncut"]["wrong"],
            row["holes"] + row["unsound"])), f"{row['area_error']:.0e}", *files])
    head = ["scene", "facets", "wrong", "coincident", "close", "uncut", "holes", "area", "SVG: differing", "far", "farthest",
            "PDF: differing", "far", "farthest"]
    return table(head, rows) if rows else None


def leaks_table(results):
    rows = []
    found = results.leaks["rows"] if results.leaks else []
    for zoom in sorted({row["zoom"] for row in found}):
        chosen = [row for row in found if row["zoom"] == zoom]
        rows.append([f"{zoom:g}", str(len(chosen)), str(sum(row["interior"] for row in chosen)), *(
            str(sum(row["programs"][name]["pixels"] for row in chosen)) for name in chosen[0]["programs"])])
    head = ["times its size", "scenes", "interior pixels", *(found[0]["programs"] if found else [])]
    return table(head, rows) if rows else None


def sizes_table(results):
    rows = [[row["scene"], str(row["regions"]), str(row["bytes"]), f"{row['bytes'] / row['needed']:.3f}"]
            for row in (results.sizes["rows"] if results.sizes else [])]
    return table(["scene", "regions", "bytes", "by what they need"], rows) if rows else None


TABLES = {"drawings": drawings_table, "drawn lines": drawn_lines_table, "drawing exponents": drawing_exponents_table,
          "engines": engines_table, "engine exponents": engine_exponents_table, "faces": faces_table,
          "leaks": leaks_table, "sizes": sizes_table, "machine": machine_table, "means": means_table, "rates": rates_table, "one ray": one_ray_table,
          "builds": builds_table, "exponents": exponents_table, "peers": peers_table, "errors": errors_table, "tachyon": tachyon_table,
          "billion": billion_table}

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
