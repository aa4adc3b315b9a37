#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that a document shows of an example what stands there.

Blocks of the document that are fenced as cpp or cmake must be lines of one of the files, one after the other.

usage: check_excerpts.py DOCUMENT FILE...
"""

import pathlib
import re
import sys


def excerpts(text):
    """The line number and the text of each block of code."""
    for match in re.finditer(r"^```(?:cpp|cmake)\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
        yield text.count("\n", 0, match.start()) + 1, match.group(1)


def main():
    document = pathlib.Path(sys.argv[1])
    files = ["\n" + pathlib.Path(name).read_text(encoding="utf-8") for name in sys.argv[2:]]
    found = list(excerpts(document.read_text(encoding="utf-8")))
    strange = [number for number, excerpt in found if not any("\n" + excerpt in text for text in files)]
    for number in strange:
        print(f"{document}:{number}: this stands in none of {' '.join(sys.argv[2:])}")
    print(f"{document}: {len(found)} excerpts")
    return 1 if strange or not found else 0


if __name__ == "__main__":
    sys.exit(main())
