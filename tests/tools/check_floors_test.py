#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""check_floors.py finds each violation in a house made for it, and names its line."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "check_floors.py"
LICENCE = "// SPDX-License-Identifier: Apache-2.0\n"
HEADER = LICENCE + "#pragma once\n\n"


class CheckFloors(unittest.TestCase):
    def check(self, files):
        """The exit code and the lines said of a house that holds just these files."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "src" / "vera").mkdir(parents=True)
            for name, text in files.items():
                path = root / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            done = subprocess.run([sys.executable, TOOL, root], capture_output=True, text=True)
            return done.returncode, done.stdout.splitlines()

    def expect_problem(self, files, *parts):
        code, lines = self.check(files)
        self.assertEqual(code, 1)
        self.assertEqual(len(lines), 1, lines)
        for part in parts:
            self.assertIn(part, lines[0])

    def test_lower_floors_and_the_own_folder_may_be_included(self):
        files = {
            "src/vera/scene/a.h": HEADER + '#include "vera/math/vec3.h"\n#include "vera/scene/b.h"\n',
            "src/vera/scene/CMakeLists.txt": "# " + LICENCE[3:] + "vera_folder(scene LINKS vera::math)\n",
            "apps/vera/main.cpp": LICENCE + '#include "vera/theory/a.h"\n#include "command.h"\n',
        }
        self.assertEqual(self.check(files), (0, []))

    def test_a_higher_floor_may_not_be_included(self):
        self.expect_problem(
            {"src/vera/math/a.h": HEADER + '#include "vera/scene/scene.h"\n'},
            "src/vera/math/a.h:4:", "scene/ on floor 4 is above math/ on floor 2")

    def test_a_neighbour_may_not_be_included(self):
        self.expect_problem(
            {"src/vera/accel/a.cpp": LICENCE + '\n  #  include "vera/shade/b.h"\n'},
            "src/vera/accel/a.cpp:3:", "shade/ is a neighbour of accel/ on floor 5")

    def test_a_neighbour_may_not_be_linked(self):
        self.expect_problem(
            {"src/vera/accel/CMakeLists.txt": "# " + LICENCE[3:] + "vera_folder(accel\n    LINKS vera::shade)\n"},
            "src/vera/accel/CMakeLists.txt:3:", "links vera::shade")

    def test_a_folder_without_a_floor_is_named(self):
        self.expect_problem({"src/vera/clouds/a.cpp": LICENCE}, "clouds/ is on no floor")

    def test_a_folder_that_says_nothing_is_named(self):
        self.expect_problem({"apps/vera/utils/a.cpp": LICENCE}, "utils/, which says nothing")

    def test_a_file_without_its_licence_is_named(self):
        self.expect_problem({"src/vera/math/a.cpp": "\n" + LICENCE}, "a.cpp:1:", "must begin with SPDX")

    def test_a_header_without_pragma_once_is_named(self):
        self.expect_problem({"src/vera/math/a.h": LICENCE + "#include <cmath>\n"}, "#pragma once")

    def test_a_door_is_included_by_none(self):
        self.expect_problem(
            {"tests/math/a_test.cpp": LICENCE + '#include "apps/vera/command.h"\n'}, "a_test.cpp:2:")

    def test_a_library_that_one_file_may_include_is_left_to_it(self):
        self.expect_problem(
            {"src/vera/accel/a.cpp": LICENCE + "#include <tbb/parallel_for.h>\n",
             "src/vera/base/parallel.cpp": LICENCE + "#include <oneapi/tbb/parallel_for.h>\n"},
            "src/vera/accel/a.cpp:2:", "only src/vera/base/parallel.cpp")

    def test_work_left_undone_is_named(self):
        self.expect_problem({"src/vera/math/a.cpp": LICENCE + "// TO" + "DO\n"}, "a.cpp:2:")


if __name__ == "__main__":
    unittest.main()
