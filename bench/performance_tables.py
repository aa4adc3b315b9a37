# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/performance.md, as Markdown; None for what was not measured."""

from fits import part_of_bound
from measured import (ACROSS, ENGINES, NAMES, QUANTITIES, RAYS, embree_rate, engine_fit, families_of, fitting_build,
                      indexes_of, mean, our_rate, ratio, rays_of, scenes_of, speed)
from svg import significant


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
    pictures = results.peers["results"] if results.peers else []
    for row in pictures:
        rows.append([
            f"{row['scene']}, {row['side']}{', antialiased' if row['antialias'] else ''}",
            cell(row["vera"]["trace"]), cell(row["povray"]["trace"]), cell(row["trace_ratio"], 2),
            cell(row["vera"]["cpu"]), cell(row["povray"]["cpu"]), cell(row["cpu_ratio"], 2)])
    for side, antialias in dict.fromkeys((row["side"], row["antialias"]) for row in pictures):
        alike = [row for row in pictures if (row["side"], row["antialias"]) == (side, antialias)]
        means = [cell(mean([row[name] for row in alike]), 2) for name in ("trace_ratio", "cpu_ratio")]
        rows.append([f"geometric mean, {side}{', antialiased' if antialias else ''}", "", "", means[0], "", "", means[1]])
    head = ["picture", "trace seconds", "POV-Ray", "ratio", "CPU seconds", "POV-Ray", "ratio"]
    return table(head, rows) if rows else None


def errors_table(results):
    rows = [[f"{row['scene']}, {row['side']}", str(row["samples"]), f"{row['tolerance']}/255", *(f"{row[program][i]:.2f}" for i in range(3) for program in ("vera", "povray"))]
            for row in (results.errors["rows"] if results.errors else [])]
    head = ["of 255", "`--samples`", "`--tolerance`", "mean", "POV-Ray", "root mean square", "POV-Ray", "% of pixels over 8", "POV-Ray"]
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
    programs = list(results.leaks["rows"][0]["programs"]) if results.leaks else []
    for style, found in (("flat", results.leaks), ("shaded", results.shaded_leaks if results.leaks else None)):
        measured = found["rows"] if found else []
        for zoom in sorted({row["zoom"] for row in measured}):
            chosen = [row for row in measured if row["zoom"] == zoom]
            rows.append([style, f"{zoom:g}", str(len(chosen)), str(sum(row["interior"] for row in chosen)), *(
                str(sum(row["programs"][name]["pixels"] for row in chosen)) for name in programs)])
    return table(["style", "times its size", "scenes", "interior pixels", *programs], rows) if rows else None


def sizes_table(results):
    rows = [[row["scene"], str(row["regions"]), str(row["bytes"]), f"{row['bytes'] / row['needed']:.3f}"]
            for row in (results.sizes["rows"] if results.sizes else [])]
    return table(["scene", "regions", "bytes", "by what they need"], rows) if rows else None


TABLES = {"drawings": drawings_table, "drawn lines": drawn_lines_table, "drawing exponents": drawing_exponents_table,
          "engines": engines_table, "engine exponents": engine_exponents_table, "faces": faces_table,
          "leaks": leaks_table, "sizes": sizes_table, "machine": machine_table, "means": means_table, "rates": rates_table, "one ray": one_ray_table,
          "builds": builds_table, "exponents": exponents_table, "peers": peers_table, "errors": errors_table, "tachyon": tachyon_table,
          "billion": billion_table}
