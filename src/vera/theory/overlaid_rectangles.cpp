// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/overlaid_rectangles.h"

#include "vera/exact/screen_point.h"
#include "vera/theory/whole_below.h"

#include <cmath>
#include <random>

namespace vera {

std::vector<IsoRectangle> scattered_squares(std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto side =
        static_cast<std::int32_t>(screen_size * std::sqrt(3.0 / static_cast<double>(count + 3)));
    std::vector<IsoRectangle> made;
    for (std::size_t i = 0; i < count; ++i) {
        const std::int32_t x = whole_below(screen_size - side, random);
        const std::int32_t y = whole_below(screen_size - side, random);
        made.push_back({static_cast<std::int32_t>(i), x, x + side, y, y + side});
    }
    return made;
}

std::vector<IsoRectangle> hand_of_cards(std::size_t count, std::uint64_t) {
    const auto step = static_cast<std::int32_t>(screen_size / 2 / count);
    std::vector<IsoRectangle> made;
    for (std::size_t i = 0; i < count; ++i) {
        const auto z = static_cast<std::int32_t>(i);
        const std::int32_t low = z * step;
        made.push_back({z, low, low + screen_size / 2, low, low + screen_size / 2});
    }
    return made;
}

std::vector<IsoRectangle> grate_of_bars(std::size_t count, std::uint64_t) {
    const auto each = static_cast<std::int32_t>(count / 2);
    const std::int32_t spacing = screen_size / each;
    std::vector<IsoRectangle> made;
    for (std::int32_t i = 0; i < each; ++i) {
        const std::int32_t begin = i * spacing + spacing / 4;
        const std::int32_t end = begin + spacing / 2;
        made.push_back({i, begin, end, 0, screen_size});
        made.push_back({each + i, 0, screen_size, begin, end});
    }
    return made;
}

std::vector<IsoRectangle> hidden_grate_of_bars(std::size_t count, std::uint64_t seed) {
    std::vector<IsoRectangle> made = grate_of_bars(count, seed);
    made.push_back({-1, 0, screen_size, 0, screen_size});
    return made;
}

const std::vector<OverlaidFamily>& overlaid_families() {
    static const std::vector<OverlaidFamily> all = {
        {"scattered",
         "squares anywhere, as many one behind the other at all sizes",
         scattered_squares},
        {"cards", "cards in a hand, which all cross each other", hand_of_cards},
        {"grate", "bars across bars, all seen", grate_of_bars},
        {"hidden-grate", "bars across bars, behind one square", hidden_grate_of_bars}};
    return all;
}

} // namespace vera
