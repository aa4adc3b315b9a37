// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace vera {

/// A folder of a test's own, gone at its end.
class ScratchFolder {
public:
    ScratchFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "vera-test-XXXXXX").string();
        path_ = mkdtemp(name.data());
    }

    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name, std::ios::binary) << text;
        return path_ / name;
    }

    std::string read(const std::string& name) const {
        std::ifstream file(path_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }

    std::size_t file_count() const {
        return static_cast<std::size_t>(std::distance(
            std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator()));
    }

private:
    std::filesystem::path path_;
};

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
