// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "base/scratch_folder.h"
#include <gtest/gtest.h>
#include <sys/wait.h>

namespace vera {

/// What a run of the program left.
struct ProgramRun {
    int exit_code = -1;
    std::string out;
    std::string err;
};

/// Runs the program with arguments, and variables of its environment, as a shell takes them, in the
/// folder.
inline ProgramRun run_vera(
    const ScratchFolder& folder,
    const std::string& arguments,
    const std::string& environment = "") {
    const ScratchFolder streams;
    const std::string command = "cd '" + folder.path().string() + "' && exec >'"
        + (streams.path() / "out").string() + "' 2>'" + (streams.path() / "err").string()
        + "' </dev/null; " + environment + " '" VERA_PROGRAM "' " + arguments;
    const int status = std::system(command.c_str());
    ProgramRun run;
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    run.out = streams.read("out");
    run.err = streams.read("err");
    return run;
}

/// A lit ball on a floor, small and quick to render.
inline const char* const small_scene = "PROJECTION 0 2 8  -2 0 0  2 0 0  -2 4 0\n"
                                       "LI 3 6 5  40 1 1 1\n"
                                       "CM grey\n"
                                       "P4 -9 0 9  9 0 9  9 0 -9  -9 0 -9\n"
                                       "SP 0 1.5 -1 1.5\n"
                                       "MA grey DRF 0.7 0.7 0.7\n";

} // namespace vera
