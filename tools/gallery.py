#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes docs/gallery: the figures of the VERA paper, each as a picture and as a drawing, with what they cost.

A figure whose scene is not in scenes/ is left out. With the numbers of figures, such as 2c, only these are made
anew, and their parts of the page. With --check nothing is made: the page must name every
figure that is there, and the files must be as small as the repository wants them.

usage: gallery.py [--vera PROGRAM] [--check] [FIGURE ...]
"""

import argparse
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = ROOT / "docs" / "gallery"
LARGEST = {".png": 150_000, ".svg": 350_000}

LINES = ["--style", "lines", "--precision", "0.1", "--line", "silhouette:width=1.1",
         "--line", "crease:width=0.5"]
SHADED = ["--style", "shaded", "--deviation", "0.25", "--precision", "0.1"]

# For leaves by the thousand.
THIN = ["--style", "lines", "--precision", "0.1", "--line", "silhouette:width=0.5",
        "--line", "crease:width=0.3"]

COARSE = ["--style", "shaded", "--deviation", "2", "--precision", "0.1", "--color-tolerance", "42"]

# The figure, its title, the scene, the raster, the drawing's options, and what there is to see.
FIGURES = [
    ("1f", "The principle of ray tracing", "principle", "480x320",
     [*SHADED, "--color-tolerance", "4"],
     "From the eye a ray (blue) goes through a pixel of the screen. Where it meets the ball, one ray (yellow) asks whether the "
     "light is hidden, and another (orange) goes on in the mirror direction, to where the same begins again. The scene is made "
     "for drawings: the rays are cylinders and cones."),
    ("2a", "A black and white still life", "still_life", "360x360", SHADED,
     "The paper's own example, word for word. The drawing has the same light and shadows; what the mirror shows it "
     "leaves out."),
    ("2b", "The tree of grids", "gambit", "480x320", None,
     "The cells of the grids of figure 2d's board that hold something, from the second level on: the pieces' grids stand in the "
     "cells of the game's, and the battlements' in those of the rooks."),
    ("2c", "A ficus", "ficus", "360x480", LINES, "Grown leaf by leaf, each of a thousand triangles."),
    ("2d", "A game of chess", "gambit", "480x320", LINES,
     "The pieces are turned from straight lines, arcs and conic sections, the knights too. The drawing has their silhouettes and "
     "creases, and arcs where they are arcs."),
    ("2e", "Difficult materials", "bearing", "450x300", LINES,
     "Chromed steel, brass, copper, glass and lacquer show what is around them, and so the scene is a whole room with windows "
     "and lamps behind the viewer."),
    ("2f", "A tree", "tree", "480x360", THIN, "Made by a procedure that calls itself."),
    ("2g", "A cooling rotor", "rotor", "320x240", COARSE,
     "A turned hub with nine blades and nine shorter ones between them, of patches whose normals are interpolated. In the "
     "drawing each face is a gradient, and each shadow an area with an exact border."),
    ("2h", "A still life", "supper", "480x360", LINES,
     "A carafe and a glass of wine, fruit, silver, a candle. Wine colours the light that passes it: TAB filters shadows as well."),
    ("2i", "A snail's shell", "shell", "480x360", LINES, "A surface over two parameters, cut into patches."),
]
LADDER = ["1-flat", "2-antialiased", "3-diffuse", "4-highlights", "5-rays"]


def shown():
    return [figure for figure in FIGURES if (ROOT / "scenes" / f"{figure[2]}.vera").exists()]


def scene_arguments(scene):
    arguments = [f"scenes/{scene}.vera"]
    if (ROOT / "scenes" / f"{scene}.ctl").exists():
        arguments += ["-c", f"scenes/{scene}.ctl"]
    return arguments


def run(program, arguments):
    done = subprocess.run([program, *arguments], cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"gallery: vera {' '.join(arguments)} failed:\n{done.stderr}")
    return json.loads(done.stdout) if "--json" in arguments else None


def small_png(source, target):
    """The same picture in fewer bytes: its pixels are deflated as far as zlib can, and its texts left out."""
    data = source.read_bytes()
    place, pixels, head = 8, b"", b""
    while place < len(data):
        length, kind = struct.unpack(">I4s", data[place:place + 8])
        body = data[place + 8:place + 8 + length]
        if kind == b"IHDR":
            head = body
        elif kind == b"IDAT":
            pixels += body
        place += 12 + length

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    packed = zlib.compress(zlib.decompress(pixels), 9)
    target.write_bytes(data[:8] + chunk(b"IHDR", head) + chunk(b"IDAT", packed) + chunk(b"IEND", b""))


def render_command(figure):
    number, _, scene, raster, drawing, _ = figure
    if number == "2b":
        return ["info", f"scenes/{scene}.vera", "--grid-from", "2", "--raster", raster]
    return ["render", *scene_arguments(scene), "--raster", raster]


def draw_command(figure):
    number, _, scene, raster, drawing, _ = figure
    if number == "2b":
        return render_command(figure)
    return ["draw", *scene_arguments(scene), "--raster", raster, *drawing]


def without_raster(command):
    """As it is shown: for any size, and so that tests run it small."""
    place = command.index("--raster")
    return command[:place] + command[place + 2:]


def output_option(figure):
    return "--draw-grid" if figure[0] == "2b" else "-o"


def make(program, figure):
    """Makes a figure's files, and returns what they cost as text."""
    name = figure[0]
    with tempfile.TemporaryDirectory() as folder:
        raw = pathlib.Path(folder) / "raw.png"
        option = output_option(figure)
        rendered = run(program, [*render_command(figure), option, str(raw), "-q", "--json"])
        small_png(raw, FOLDER / f"{name}.png")
        drawn = run(program, [*draw_command(figure), option, str(FOLDER / f"{name}.svg"), "-q", "--json"])
    return {"primitives": run(program, ["info", f"scenes/{figure[2]}.vera", "-q", "--json"])["primitives"],
            "rays": rendered.get("rays"), "facets": drawn.get("facets"), "faces": drawn.get("visible_faces"),
            "grid": rendered.get("grid")}


def make_ladder(program):
    with tempfile.TemporaryDirectory() as folder:
        steps = pathlib.Path(folder) / "steps"
        report = run(program, ["ladder", *scene_arguments("ladder"), "-o", str(steps), "--width", "320", "-q", "--json"])
        for name in LADDER:
            small_png(steps / f"{name}.png", FOLDER / f"{name}.png")
    run(program, ["draw", *scene_arguments("ladder"), "--raster", "320x240", *LINES, "-q", "-o", str(FOLDER / "ladder.svg")])
    return report


def count(number):
    return f"{number:,}".replace(",", " ")


def kilobytes(path):
    return f"{max(1, round(path.stat().st_size / 1000))} kB"


def all_rays(rays):
    return sum(number for kind, number in rays.items() if kind != "extra_view_rays")


def figure_text(figure, cost):
    number, title, scene, raster, drawing, words = figure
    option = output_option(figure)
    commands = [["vera", *without_raster(render_command(figure)), option, f"{number}.png"],
                ["vera", *without_raster(draw_command(figure)), option, f"{number}.svg"]]
    if cost["rays"]:
        rays = cost["rays"]
        spent = (f"{count(cost['primitives'])} primitives; the picture: {count(all_rays(rays))} rays, of which {count(rays['shadow_rays'])} go to lights, "
                 f"{count(rays['mirrored_rays'])} are mirrored and {count(rays['refracted_rays'])} refracted; "
                 f"the drawing: {count(cost['faces'])} faces seen of {count(cost['facets'])} facets.")
    else:
        grid = cost["grid"]
        spent = (f"{count(grid['grids'])} grids of {count(grid['cells'])} cells, each subscene's counted once; "
                 f"{count(grid['references'])} entries in their lists.")
    sizes = f"{kilobytes(FOLDER / f'{number}.png')} and {kilobytes(FOLDER / f'{number}.svg')}"
    lines = [f"## {number}. {title}", "",
             f"| [scenes/{scene}.vera](../../scenes/{scene}.vera) | |", "| --- | --- |",
             f"| ![{title}, picture]({number}.png) | ![{title}, drawing]({number}.svg) |", "",
             words, "", f"At {raster.replace('x', ' x ')} pixels: {spent} Files of {sizes}.", "", "```sh", *(" ".join(command) for command in commands), "```", ""]
    return "\n".join(lines)


def ladder_text(report):
    steps = report["steps"]
    first = all_rays(steps[0]["rays"])
    rows = []
    for letter, name, step in zip(["1a", "1b", "1c", "1d", "1e"], LADDER, steps):
        rays = all_rays(step["rays"])
        times = "" if letter == "1a" else f", {rays / first:.3g} times as many as in 1a"
        rows.append(f"| {letter} | ![{step['title']}]({name}.png) | {step['title']}. {count(rays)} rays{times} |")
    rows.append("| | ![The same as a drawing](ladder.svg) | The same scene as a drawing in lines |")
    return "\n".join([
        "## 1a to 1e. One effect more each time", "",
        "The same chess still life, pieces in unusual positions: what makes a picture real? [The ladder](../ladder.md) does this with any scene, with "
        "the differences from step to step.", "", "| | | |", "| --- | --- | --- |", *rows, "",
        "```sh", "vera ladder scenes/ladder.vera -c scenes/ladder.ctl -o steps --width 48", "```", ""])


HEAD = """# Gallery

The figures of the VERA paper as this program makes them: on the left the ray traced picture, on the right the exact vector drawing of the same scene.
Drawings have light and shadows, and no mirrors or glass; those of figures with much of these are in lines. The costs are counted, and so the same on every
machine; the files are PNG of 8 bits and SVG. `./dev gallery` makes
this page and all that is on it, in the size that each figure names with `--raster`.
"""


def write_page(program):
    FOLDER.mkdir(exist_ok=True)
    texts = [HEAD, ladder_text(make_ladder(program))]
    for figure in shown():
        print(f"{figure[0]}. {figure[1]}", flush=True)
        texts.append(figure_text(figure, make(program, figure)))
    (FOLDER / "README.md").write_text("\n".join(texts).rstrip() + "\n", encoding="utf-8")


def write_figures(program, numbers):
    """Of a page that is there."""
    path = FOLDER / "README.md"
    for figure in [figure for figure in shown() if figure[0] in numbers]:
        page = path.read_text(encoding="utf-8")
        begin = page.index(f"## {figure[0]}. ")
        end = page.find("\n## ", begin)
        rest = "" if end < 0 else page[end:]
        path.write_text(page[:begin] + figure_text(figure, make(program, figure)).rstrip() + "\n" + rest, encoding="utf-8")


def check():
    """What is wrong with the page and its files, in lines."""
    page = (FOLDER / "README.md").read_text(encoding="utf-8")
    problems = []
    for figure in shown():
        if f"## {figure[0]}. {figure[1]}" not in page:
            problems.append(f"the page has no figure {figure[0]}: ./dev gallery")
    for path in sorted(FOLDER.iterdir()):
        if path.suffix not in LARGEST:
            continue
        if f"({path.name})" not in page:
            problems.append(f"{path.name} is on no page: remove it")
        if path.stat().st_size > LARGEST[path.suffix]:
            problems.append(f"{path.name} has {path.stat().st_size} bytes; {LARGEST[path.suffix]} are allowed: show less of it")
    return problems


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vera", default=str(ROOT / "build" / "bin" / "vera"), help="the program")
    parser.add_argument("--check", action="store_true", help="look whether the page is whole, and make nothing")
    parser.add_argument("figures", nargs="*", metavar="FIGURE", choices=[[], *(figure[0] for figure in shown())],
                        help="make only these anew, such as 2c")
    arguments = parser.parse_args()
    if arguments.figures:
        write_figures(arguments.vera, arguments.figures)
    elif not arguments.check:
        write_page(arguments.vera)
    problems = check()
    for problem in problems:
        print(f"gallery: {problem}", file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
