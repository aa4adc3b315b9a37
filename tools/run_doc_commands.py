#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of the documents, and checks that their links lead somewhere.

In blocks fenced as sh, the lines that begin with "vera" or "./dev help" are run, in order, file by file, each
file in a new folder that holds scenes/ and dev. Pictures and drawings that say no size are made with a small
raster. A line that ends in "# exit N" must exit with N, others with 0. Other lines are not run. Blocks fenced
as vera are whole scenes, in which "vera check" must find no error.

usage: run_doc_commands.py PROGRAM [DOCUMENT...]
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
RUN = re.compile(r"^(\./dev help|vera)\b")
EXIT = re.compile(r"\s+#\s*exit (\d+)\s*$")
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
SMALL = " --raster 32x32"
SECONDS = 120


def documents():
    return sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])


def commands(text):
    """The line number, the command and the exit code expected of each command that is to be run."""
    fence = None
    pending = ""
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            fence = None if fence is not None else line[3:].strip()
            continue
        if fence != "sh":
            continue
        line = pending + line.strip()
        if line.endswith("\\"):
            pending = line[:-1] + " "
            continue
        pending = ""
        match = EXIT.search(line)
        expected = int(match.group(1)) if match else 0
        line = EXIT.sub("", line)
        if RUN.match(line):
            yield number, line, expected


def scenes(text):
    """The line number and the text of each scene that is shown as a whole."""
    for match in re.finditer(r"^```vera\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
        yield text.count("\n", 0, match.start()) + 1, match.group(1)


def check_scenes(path, program):
    failures = 0
    for number, scene in scenes(path.read_text(encoding="utf-8")):
        done = subprocess.run(
            [program, "check", "-", "--scene-format", "vera"], input=scene.encode(), capture_output=True,
            timeout=SECONDS)
        print(f"{path.relative_to(ROOT)}:{number}: a scene")
        if done.returncode != 0:
            print(done.stderr.decode(errors="replace"))
            failures += 1
    return failures


def small(command):
    """The command with a small picture, where it says no size itself."""
    if re.match(r"vera (render|draw)\b", command) and not re.search(r"--raster|--help", command):
        first, *rest = re.split(r"(\s[|>&;])", command, maxsplit=1)
        return first + SMALL + "".join(rest)
    return command


def run_document(path, program):
    failures = 0
    found = list(commands(path.read_text(encoding="utf-8")))
    if not found:
        return 0
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "bin").mkdir()
        (folder / "bin" / "vera").symlink_to(pathlib.Path(program).resolve())
        (folder / "scenes").symlink_to(ROOT / "scenes")
        (folder / "dev").symlink_to(ROOT / "dev")
        environment = dict(os.environ, PATH=f"{folder}/bin:{os.environ['PATH']}")
        for number, command, expected in found:
            try:
                done = subprocess.run(
                    ["bash", "-o", "pipefail", "-c", small(command)], cwd=folder, env=environment,
                    stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=SECONDS)
                code, said = done.returncode, done.stderr.decode(errors="replace")
            except subprocess.TimeoutExpired:
                code, said = "none", f"did not end within {SECONDS} s"
            print(f"{path.relative_to(ROOT)}:{number}: {command}")
            if code != expected:
                print(f"    exit code {code}, expected {expected}\n{said}")
                failures += 1
    return failures


def check_links(path):
    """The links of a document to files that are not there."""
    failures = 0
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        for target in LINK.findall(re.sub(r"`[^`]*`", "", line)):
            if re.match(r"[a-z]+:", target) or target.startswith("#"):
                continue
            if not (path.parent / target.split("#")[0]).exists():
                print(f"{path.relative_to(ROOT)}:{number}: there is no {target}")
                failures += 1
    return failures


def main():
    if len(sys.argv) < 2:
        print(__doc__.split("usage: ")[1], file=sys.stderr)
        return 2
    chosen = [pathlib.Path(name).resolve() for name in sys.argv[2:]] or documents()
    failures = sum(
        run_document(path, sys.argv[1]) + check_scenes(path, sys.argv[1]) + check_links(path) for path in chosen)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
