// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/image_file.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "door/program.h"

namespace vera {

/// The bytes of the pixels that `vera render` makes of the scene.
inline std::vector<std::uint8_t>
picture(const ScratchFolder& folder, const std::string& scene, const std::string& options) {
    const ProgramRun run =
        run_vera(folder, "render " + scene + " -q --format ppm -o a.ppm " + options);
    EXPECT_EQ(run.exit_code, 0) << options << '\n' << run.err;
    return std::get<std::vector<std::uint8_t>>(read_image(folder.path() / "a.ppm").samples);
}

inline std::size_t
different_pixels(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); i += 3)
        count += a[i] == b[i] && a[i + 1] == b[i + 1] && a[i + 2] == b[i + 2] ? 0 : 1;
    return count;
}

} // namespace vera
