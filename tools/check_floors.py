#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the rules of the house that a compiler does not know, and names the line that breaks one.

A file of src/vera includes its own folder and lower floors: never a neighbour, never up; a folder's
CMakeLists.txt links in the same direction. Every file begins with its licence, every header with
#pragma once, and no folder has a name that says nothing.

usage: check_floors.py [ROOT]
"""

import pathlib
import re
import sys

# Folders of src/vera by floor, from the ground up. Apps, tests and the like may include any.
FLOORS = [
    ["base"],
    ["math"],
    ["exact", "image", "drawing"],
    ["scene"],
    ["generate", "accel", "shade", "solids"],
    ["formats", "render", "visible", "depth_buffer"],
    ["theory", "mpi"],
]
FLOOR_OF = {folder: number for number, folders in enumerate(FLOORS, 1) for folder in folders}

# Libraries that one file alone may include: the beginning of the header's name, and the file.
ONLY_IN = {
    "tbb/": "src/vera/base/parallel.cpp",
    "oneapi/tbb/": "src/vera/base/parallel.cpp",
}

NAMES_THAT_SAY_NOTHING = {"core", "common", "util", "utils", "misc", "helper", "helpers", "manager", "managers"}

LICENCE = "SPDX-License-Identifier: Apache-2.0"
LICENSED = {".h", ".cpp", ".py", ".cmake", ".sh", ".js", ".ts", ".css"}
LICENSED_NAMES = {"CMakeLists.txt", "dev", "run"}
SEARCHED = ["src", "apps", "tests", "bench", "examples", "tools", "cmake", "python", ".ci"]
ROOT_FILES = ["CMakeLists.txt", "dev"]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
LINK = re.compile(r"\bvera(?:::|_)([a-z_]+)")


def may_use(user, used):
    """Whether a file of one folder of src/vera may include a file of another."""
    return user == used or FLOOR_OF[used] < FLOOR_OF[user]


def direction(user, used):
    if FLOOR_OF[used] == FLOOR_OF[user]:
        return f"{used}/ is a neighbour of {user}/ on floor {FLOOR_OF[user]}"
    return f"{used}/ on floor {FLOOR_OF[used]} is above {user}/ on floor {FLOOR_OF[user]}"


def include_problems(path, folder, lines):
    """The includes of a file that it may not have; folder is that of src/vera, or None."""
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        bracket, name = match.groups()
        for beginning, only in ONLY_IN.items():
            if name.startswith(beginning) and not path.as_posix().endswith("/" + only):
                yield path, number, f"includes <{name}>: only {only} does"
        parts = name.split("/")
        if parts[0] in ("apps", "tests", "bench") or (bracket == '"' and ".." in parts):
            yield path, number, f'includes "{name}": what is no part of the library is included by none'
        if parts[0] != "vera" or len(parts) < 3:
            if folder and bracket == '"' and parts[0] != "hwy":
                yield path, number, f'includes "{name}": write the path from src on, as "vera/FOLDER/NAME.h"'
            continue
        of_a_user = "consumer" in path.parts or "examples" in path.parts
        if bracket == "<" and not of_a_user:
            yield path, number, f'includes <{name}>: files of our own stand in quotes'
        used = parts[1]
        if used not in FLOOR_OF:
            yield path, number, f'includes "{name}", but {used}/ is on no floor'
        elif folder and not may_use(folder, used):
            yield path, number, f'includes "{name}": {direction(folder, used)}'


def link_problems(path, folder, lines):
    """The targets that a folder's CMakeLists.txt links and may not."""
    for number, line in enumerate(lines, 1):
        for used in LINK.findall(line.split("#")[0]):
            if used in FLOOR_OF and not may_use(folder, used):
                yield path, number, f"links vera::{used}: {direction(folder, used)}"


def text_problems(path, lines):
    """What is wrong with a file wherever it stands."""
    first = next((i for i in range(min(2, len(lines))) if LICENCE in lines[i]), None)
    script = bool(lines) and lines[0].startswith("#!")
    if first is None or (first == 1 and not script):
        yield path, 1, f"must begin with {LICENCE}"
    if path.suffix == ".h":
        code = [line for line in lines if line.strip() and not line.lstrip().startswith("//")]
        foreach_target = any("HWY_TARGET_TOGGLE" in line for line in lines)
        if (not code or code[0].strip() != "#pragma once") and not foreach_target:
            yield path, 1, "a header begins with #pragma once"
    for number, line in enumerate(lines, 1):
        if re.search(r"\b(TODO|FIXME|XXX)\b", line) and path.name != "check_floors.py":
            yield path, number, "says what is still to be done: do it, or leave it out"


def folder_problems(root, path):
    """What is wrong with the names of the folders on the way to a file."""
    relative = path.relative_to(root)
    for name in relative.parts[:-1]:
        if name in NAMES_THAT_SAY_NOTHING:
            yield path, 0, f"stands in a folder called {name}/, which says nothing of what is in it"
    if relative.parts[:2] == ("src", "vera") and len(relative.parts) > 3 and relative.parts[2] not in FLOOR_OF:
        yield path, 0, f"{relative.parts[2]}/ is on no floor: give it one in tools/check_floors.py"


def test_problems(root, path):
    """A test of src/vera that tests no file there: it has been left behind, or has the wrong name."""
    relative = path.relative_to(root).parts
    if relative[0] == "src" and path.suffix == ".cpp" and path.name.endswith("_test.cpp"):
        yield path, 0, "tests stand in tests/, not beside what they test"


def problems(root):
    paths = [root / name for name in ROOT_FILES if (root / name).exists()]
    for folder in SEARCHED:
        paths += sorted(path for path in (root / folder).rglob("*") if path.is_file())
    for path in paths:
        if "__pycache__" in path.parts or "corpus" in path.parts or "node_modules" in path.parts:
            continue
        yield from folder_problems(root, path)
        if path.suffix not in LICENSED and path.name not in LICENSED_NAMES:
            continue
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
        yield from text_problems(path, lines)
        yield from test_problems(root, path)
        parts = path.relative_to(root).parts
        folder = parts[2] if parts[:2] == ("src", "vera") and len(parts) > 3 else None
        folder = folder if folder in FLOOR_OF else None
        if path.suffix in (".h", ".cpp"):
            yield from include_problems(path, folder, lines)
        elif path.name == "CMakeLists.txt" and folder:
            yield from link_problems(path, folder, lines)


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent).resolve()
    if not (root / "src" / "vera").is_dir():
        print(f"check_floors: {root} has no src/vera", file=sys.stderr)
        return 2
    count = 0
    for path, line, problem in problems(root):
        print(f"{path.relative_to(root)}:{line}: {problem}")
        count += 1
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
