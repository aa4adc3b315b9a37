# SPDX-License-Identifier: Apache-2.0
"""What was measured on a machine, as the results in bench/results/ have it: what plots.py draws and
performance_tables.py tabulates."""

import json
import math
import statistics

from machine import RESULTS

NAMES = {"mesh": "MeshIndex", "mesh_high": "MeshIndex, high quality", "spheres": "SphereIndex",
         "spheres_high": "SphereIndex, high quality", "bvh": "boxes of the scene",
         "grid": "grids of the scene", "Embree medium": "Embree"}
RAYS = {"primary": "view rays", "shadow": "shadow rays", "mirror": "mirrored rays", "diffuse": "diffuse rays",
        "shuffled": "diffuse rays, shuffled", "ao": "any hit of diffuse rays"}
ENGINES = {"cells": "cells", "sweep": "plane sweep"}
ACROSS = {"triangles": "triangles, n", "crossings": "crossings of edges, k", "corners": "corners of what is seen, v"}
QUANTITIES = {"seconds": "seconds", "steps": "counted steps"}


class Results:
    """What was measured on a machine; None for a part that was not."""

    KINDS = ("peers", "errors", "rays", "growth", "billion", "drawings", "engines", "faces", "leaks",
             "shaded_leaks", "sizes")

    def __init__(self, name):
        self.machine = name
        (self.peers, self.errors, self.rays, self.growth, self.billion, self.drawings, self.engines, self.faces, self.leaks,
         self.shaded_leaks, self.sizes) = (self.load(kind) for kind in self.KINDS)

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


# What is measured of drawings: rows of families.


def families_of(rows):
    return list(dict.fromkeys(row["family"] for row in rows))


def engine_fit(results, family, engine, quantity, across):
    """The exponent and half its interval; None where nothing was fitted."""
    return next((fit for fit in results["fits"] if (fit["family"], fit["engine"], fit["quantity"], fit["across"])
                 == (family, engine, quantity, across)), None)
