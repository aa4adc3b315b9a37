// SPDX-License-Identifier: Apache-2.0
#include "theory/rectangle_scenes.h"

#include "vera/theory/whole_below.h"

#include <algorithm>

namespace vera::testing {

namespace {

/// With the corners on multiples of the step, each at one of so many depths; some have no area.
Rectangles
anywhere(std::int32_t count, std::int32_t step, std::int32_t depths, std::mt19937_64& random) {
    Rectangles made;
    const std::int32_t places = scene_side / step + 1;
    for (std::int32_t i = 0; i < count; ++i) {
        const std::int32_t z = whole_below(depths, random);
        std::int32_t corners[4] = {};
        for (std::int32_t& value : corners)
            value = step * whole_below(places, random);
        const auto& [a, b, c, d] = corners;
        made.push_back({z, std::min(a, b), std::max(a, b), std::min(c, d), std::max(c, d)});
    }
    return made;
}

Rectangles scattered(std::mt19937_64& random) {
    const std::int32_t count = 1 + whole_below(24, random);
    return anywhere(count, 1, 5, random);
}

Rectangles on_few_lines(std::mt19937_64& random) {
    const std::int32_t count = 1 + whole_below(30, random);
    return anywhere(count, 3, 3, random);
}

Rectangles all_in_one_plane(std::mt19937_64& random) {
    const std::int32_t count = 1 + whole_below(12, random);
    return anywhere(count, 2, 1, random);
}

Rectangles repeated(std::mt19937_64& random) {
    const Rectangles few = anywhere(4, 2, 4, random);
    Rectangles made;
    for (int i = 0; i < 16; ++i) {
        made.push_back(few[random() % few.size()]);
        made.back().z = whole_below(4, random);
    }
    return made;
}

/// Squares beside each other, or over each other by 1, or with a gap of 1.
Rectangles lattice(std::mt19937_64& random) {
    Rectangles made;
    const std::int32_t step = 2 + whole_below(3, random);
    const std::int32_t size = step - 1 + whole_below(3, random);
    const std::int32_t depths = 1 + whole_below(4, random);
    for (std::int32_t x = 0; x + size <= scene_side; x += step)
        for (std::int32_t y = 0; y + size <= scene_side; y += step)
            if (whole_below(8, random) > 0)
                made.push_back({whole_below(depths, random), x, x + size, y, y + size});
    return made;
}

/// Four bars each, one frame within the other; what lies behind is seen in their holes.
Rectangles frames(std::mt19937_64& random) {
    Rectangles made;
    const std::int32_t step = 1 + whole_below(2, random);
    for (std::int32_t low = 0; low + 1 < scene_side - low; low += step) {
        const std::int32_t high = scene_side - low;
        const std::int32_t z = whole_below(6, random);
        made.push_back({z, low, high, low, low + 1});
        made.push_back({z, low, high, high - 1, high});
        made.push_back({whole_below(6, random), low, low + 1, low, high});
        made.push_back({z, high - 1, high, low, high});
    }
    const Rectangles more = anywhere(3, 1, 6, random);
    made.insert(made.end(), more.begin(), more.end());
    return made;
}

/// Bars across bars, of any order, sometimes behind a cover.
Rectangles grate(std::mt19937_64& random) {
    Rectangles made;
    const std::int32_t depths = 1 + whole_below(6, random);
    const std::int32_t width = 1 + whole_below(2, random);
    for (std::int32_t i = 0; i + width <= scene_side; i += 2) {
        made.push_back({whole_below(depths, random), i, i + width, 0, scene_side});
        made.push_back({whole_below(depths, random), 0, scene_side, i, i + width});
    }
    if (whole_below(3, random) == 0)
        made.push_back({whole_below(depths, random) - 1, 0, scene_side, 0, scene_side});
    return made;
}

/// Large ones over each other, each moved by a step.
Rectangles cards(std::mt19937_64& random) {
    Rectangles made;
    const std::int32_t right = whole_below(2, random);
    const std::int32_t up = whole_below(3, random) - 1;
    for (std::int32_t i = 0; i < 5; ++i) {
        const std::int32_t x = right * i;
        const std::int32_t y = 5 + up * i;
        made.push_back(
            {whole_below(2, random) + i, x, x + 6, std::max(y, 0), std::min(y + 7, scene_side)});
    }
    std::shuffle(made.begin(), made.end(), random);
    return made;
}

/// One within the other, in any order: so that some hide all others, and some leave rings.
Rectangles nested(std::mt19937_64& random) {
    Rectangles made;
    IsoRectangle one = {0, 0, scene_side, 0, scene_side};
    while (one.lower_x < one.upper_x && one.lower_y < one.upper_y) {
        one.z = whole_below(8, random);
        made.push_back(one);
        one.lower_x += whole_below(2, random);
        one.upper_x -= whole_below(2, random);
        one.lower_y += whole_below(2, random);
        one.upper_y -= whole_below(2, random) == 0 ? 0 : 1;
        if (made.size() == 12)
            break;
    }
    return made;
}

} // namespace

const std::vector<RectangleScene>& rectangle_scenes() {
    static const std::vector<RectangleScene> all = {
        {"scattered", scattered},
        {"on few lines", on_few_lines},
        {"all in one plane", all_in_one_plane},
        {"repeated", repeated},
        {"lattice", lattice},
        {"frames", frames},
        {"grate", grate},
        {"cards", cards},
        {"nested", nested}};
    return all;
}

} // namespace vera::testing
