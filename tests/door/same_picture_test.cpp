// SPDX-License-Identifier: Apache-2.0
// Whole pictures, by the program as users run it: neither the instruction set, nor the CPU's fused
// multiply-add, nor the index, nor the number of threads changes a pixel.
#include "vera/accel/simd_level.h"

#include <string>
#include <vector>

#include "door/program.h"

namespace vera {
namespace {

/// The indexes that --index knows, taken from the program's help so that none is forgotten.
std::vector<std::string> indexes(const ScratchFolder& folder) {
    const std::string help = run_vera(folder, "render --help").out;
    const std::string option = "--index ";
    const std::size_t begin = help.find(option) + option.size();
    std::string names = help.substr(begin, help.find_first_of(" :=\n", begin) - begin);
    std::vector<std::string> list;
    for (std::size_t bar = 0; bar != std::string::npos;) {
        bar = names.find('|');
        if (const std::string name = names.substr(0, bar); name != "auto") // is one of the others
            list.push_back(name);
        names.erase(0, bar + 1);
    }
    return list;
}

/// What is set in the environment of a run: each instruction set of this machine, and a C library
/// that takes the CPU for one without fused multiply-add (other machines do not know the name).
std::vector<std::string> environments() {
    std::vector<std::string> list;
    for (const std::string& level : simd_levels())
        list.push_back("VERA_SIMD=" + level);
    list.emplace_back("GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2");
    return list;
}

class SamePicture : public testing::TestWithParam<const char*> {
protected:
    std::string picture(const std::string& environment, const std::string& options) const {
        const std::string scene = std::string(VERA_SOURCE_DIR "/scenes/") + GetParam();
        const ProgramRun run = run_vera(
            folder,
            "render " + scene + ".vera -c " + scene + ".ctl --raster 16x12 -q --format ppm -o - "
                + options,
            environment);
        EXPECT_EQ(run.exit_code, 0) << environment << ' ' << options << '\n' << run.err;
        return run.out;
    }

    const ScratchFolder folder;
};

TEST_P(SamePicture, IsMadeByEveryInstructionSetIndexAndNumberOfThreads) {
    const std::vector<std::string> all_indexes = indexes(folder);
    ASSERT_GE(all_indexes.size(), 2U);
    const std::string expected = picture("", "");
    ASSERT_GT(expected.size(), 16U * 12 * 3);
    for (const std::string& environment : environments())
        for (const std::string& index : all_indexes)
            for (const char* threads : {"1", "2", "7"}) {
                const std::string options = "--index " + index + " --threads " + threads;
                // Not EXPECT_EQ, which would print the bytes.
                EXPECT_TRUE(picture(environment, options) == expected)
                    << environment << ' ' << options;
            }
}

INSTANTIATE_TEST_SUITE_P(
    Examples, SamePicture, testing::Values("instances", "goblet"), [](const auto& test) {
        return std::string(test.param);
    });

} // namespace
} // namespace vera
