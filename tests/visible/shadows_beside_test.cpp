// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/seen_beside.h"
#include "vera/visible/shadows_beside.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

struct Cover {
    ScreenTriangle triangle;
    std::uint8_t sides = 0;
};

/// Of all that is here, one by one.
LightSet lights_of_all(const std::vector<Cover>& here, std::uint32_t source, std::uint8_t side) {
    LightSet lights = 0;
    for (const auto& [triangle, sides] : here)
        if (triangle.is_shadow() && triangle.source == source && (sides & side) != 0)
            lights |= LightSet{1} << triangle.light;
    return lights;
}

bool is_any_parted_of_all(const std::vector<Cover>& here) {
    return std::any_of(here.begin(), here.end(), [&](const Cover& one) {
        return !one.triangle.is_shadow()
            && lights_of_all(here, one.triangle.source, left_side)
            != lights_of_all(here, one.triangle.source, right_side);
    });
}

/// Of few sources and lights; three of four are shadows.
Cover any_cover(std::mt19937& random) {
    const auto source = static_cast<std::uint32_t>(random() % 3);
    const auto light = static_cast<std::uint32_t>(random() % 4);
    const auto sides = static_cast<std::uint8_t>(1 + random() % 3);
    Cover cover;
    cover.triangle.source = source;
    cover.triangle.light = light == 3 ? no_light : light * 15;
    cover.sides = sides;
    return cover;
}

TEST(ShadowsBeside, TellWhatLookingAtEachOfThemTells) {
    std::mt19937 random(1988);
    ShadowsBeside shadows;
    for (int edge = 0; edge < 2000; ++edge) {
        std::vector<Cover> coming(random() % 12);
        shadows.clear();
        for (Cover& cover : coming) {
            cover = any_cover(random);
            if (cover.triangle.is_shadow())
                shadows.expect(cover.triangle);
        }
        shadows.start();
        std::vector<Cover> here;
        while (!coming.empty() || !here.empty()) {
            const bool begins = !coming.empty() && (here.empty() || random() % 2 == 0);
            std::vector<Cover>& from = begins ? coming : here;
            const auto place = from.begin() + static_cast<std::ptrdiff_t>(random() % from.size());
            const Cover cover = *place;
            from.erase(place);
            if (begins)
                here.push_back(cover);
            shadows.change(cover.triangle, cover.sides, begins ? 1 : -1);
            ASSERT_EQ(shadows.is_any_parted(), is_any_parted_of_all(here)) << "edge " << edge;
            for (std::uint32_t source = 0; source < 3; ++source)
                for (const std::uint8_t side : {left_side, right_side})
                    ASSERT_EQ(shadows.lights(source, side), lights_of_all(here, source, side))
                        << "edge " << edge;
        }
    }
}

TEST(ShadowsBeside, TakeNoMoreStepsWhereManyLieOnEachOther) {
    std::array<std::uint64_t, 2> steps = {};
    for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t count = i == 0 ? 100 : 10'000;
        ScreenTriangle shadow;
        shadow.light = 0;
        ShadowsBeside shadows;
        for (std::size_t j = 0; j < count; ++j)
            shadows.expect(shadow);
        shadows.start();
        for (const std::int32_t more : {1, -1})
            for (std::size_t j = 0; j < count; ++j)
                shadows.change(shadow, left_side, more);
        steps[i] = shadows.steps() / count;
    }
    EXPECT_EQ(steps[0], steps[1]);
    EXPECT_LE(steps[1], 4U);
}

} // namespace
} // namespace vera
