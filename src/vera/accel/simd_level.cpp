// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/simd_level.h"

#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <utility>

#include <hwy/highway.h>
#include <hwy/targets.h>

namespace vera {

namespace {

struct Level {
    const char* name;
    std::int64_t target;
};

// From the best to the plainest, as Highway prefers them.
constexpr Level known_levels[] = {
    {"avx512", HWY_AVX3_DL},
    {"avx512f", HWY_AVX3},
    {"avx2", HWY_AVX2},
    {"sse4", HWY_SSE4},
    {"ssse3", HWY_SSSE3},
    {"neon", HWY_NEON},
    {"scalar", HWY_EMU128},
    {"scalar", HWY_SCALAR},
};

/// The levels of this build and machine, from the best to the plainest.
std::vector<Level> usable_levels() {
    hwy::SetSupportedTargetsForTest(0);
    const std::int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;
    std::vector<Level> result;
    for (const Level& level : known_levels)
        if ((usable & level.target) != 0)
            result.push_back(level);
    return result;
}

} // namespace

std::vector<std::string> simd_levels() {
    std::vector<std::string> names;
    for (const Level& level : usable_levels())
        names.insert(names.begin(), level.name);
    return names;
}

bool limit_simd(std::string_view name) {
    const std::vector<Level> usable = usable_levels();
    if (name.empty())
        return true;
    std::int64_t allowed = 0;
    bool found = false;
    for (const Level& level : usable) {
        found = found || name == level.name;
        if (found)
            allowed |= level.target;
    }
    if (found)
        hwy::SetSupportedTargetsForTest(allowed);
    return found;
}

void honour_simd_environment() {
    static std::once_flag once;
    std::call_once(once, [] {
        const char* level = std::getenv("VERA_SIMD");
        if (level == nullptr || limit_simd(level))
            return;
        std::string names;
        for (const std::string& name : simd_levels())
            names += " " + name;
        throw std::runtime_error(
            std::string("VERA_SIMD names no instruction set of this machine: '") + level
            + "'; there are:" + names);
    });
}

} // namespace vera
