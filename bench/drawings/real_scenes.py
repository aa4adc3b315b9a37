# SPDX-License-Identifier: Apache-2.0
"""The scenes of the repository and the models beside it, and drawings of them."""

import os
from pathlib import Path

from machine import ROOT, measured

MODELS = Path(os.environ.get("VERA_MODELS", ROOT / "../shared/models")).resolve()
RASTER = (640, 480)


def all_scenes():
    """Each scene and its control file, or None."""
    found = []
    for scene in sorted([*(ROOT / "scenes").glob("*.vera"), *(ROOT / "scenes").glob("*.nff")]):
        control = scene.with_suffix(".ctl")
        found.append((scene, control if control.exists() else None))
    return found + [(model, None) for model in sorted(MODELS.glob("*.obj"))]


def chosen_scenes(names):
    """Those whose name has one of the names as a part; all when there is no name."""
    return [(scene, control) for scene, control in all_scenes()
            if not names or any(part in scene.stem for part in names)]


def draw(vera, scene, control, out, *options):
    measured([vera, "draw", scene, *(["-c", control] if control else []), "--raster", "x".join(map(str, RASTER)), *options,
              "-q", "-o", out])
