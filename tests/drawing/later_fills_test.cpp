// SPDX-License-Identifier: Apache-2.0
// Outlines that are made while they are written, beside the same ones that were there before; and
// what numbers their gradients, beside a search through all of them.
#include "vera/base/output_file.h"
#include "vera/drawing/drawing_file.h"
#include "vera/drawing/gradient_numbers.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "drawing/sample_drawing.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

/// Few values each, so that much is equal, vanishes when it is rounded, or shares its seams'
/// points.
class RandomFills {
public:
    explicit RandomFills(std::uint32_t seed)
        : numbers_(seed)
        , has_gradients_(seed % 3 != 0) {}

    std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(numbers_() % end); }

    Gradient gradient() {
        Gradient made;
        made.shape = below(2) == 0 ? Gradient::Shape::linear : Gradient::Shape::radial;
        made.start = point();
        made.axis.x = 1 + below(2);
        made.axis.y = below(2) == 0 ? 0.0 : -0.0;
        if (below(2) == 0)
            made.other_axis.y = 1 + below(2);
        for (std::uint32_t stops = 1 + below(3); stops > 0; --stops)
            made.stops.push_back({0.5, {static_cast<std::uint8_t>(below(2)), 0, 0}});
        return made;
    }

    FilledOutline outline() {
        FilledOutline made;
        made.id = below(3) == 0 ? "" : "face-" + std::to_string(below(4));
        made.name = below(4) == 0 ? "a face" : "";
        if (below(3) > 0)
            made.group = group_named("group " + std::to_string(below(2)));
        made.color.r = static_cast<std::uint8_t>(below(3));
        if (has_gradients_ && below(3) == 0)
            made.gradient = gradient();
        for (std::uint32_t rings = below(3); rings > 0; --rings)
            made.rings.push_back(points(3 + below(3)));
        for (std::uint32_t seams = below(4) == 0 ? 1 + below(2) : 0; seams > 0; --seams)
            made.seams.push_back(points(2 + below(3)));
        return made;
    }

private:
    DrawingPoint point() {
        const double x = below(5);
        const double y = below(5);
        return {0.7 * x, 0.7 * y};
    }

    std::vector<DrawingPoint> points(std::uint32_t count) {
        std::vector<DrawingPoint> made;
        for (; count > 0; --count)
            made.push_back(point());
        return made;
    }

    std::mt19937 numbers_;
    bool has_gradients_;
};

/// The drawing with the outlines from that number on made later, in blocks of so many.
Drawing with_later_fills(Drawing drawing, std::size_t first, std::size_t block) {
    const auto begin = drawing.fills.begin() + static_cast<std::ptrdiff_t>(first);
    const std::vector<FilledOutline> later(begin, drawing.fills.end());
    drawing.fills.erase(begin, drawing.fills.end());
    const auto of_block = [later, block](std::size_t number, const CancelFlag*) {
        const std::size_t from = number * block;
        const std::size_t to = std::min(later.size(), from + block);
        std::vector<FilledOutline> made;
        for (std::size_t i = from; i < to; ++i)
            made.push_back(later[i]);
        return made;
    };
    drawing.later_fills = {
        (later.size() + block - 1) / block,
        std::ranges::any_of(later, [](const auto& fill) { return fill.gradient.has_value(); }),
        of_block,
        [of_block](std::size_t number, const CancelFlag* cancel) {
            std::vector<FilledOutline> made = of_block(number, cancel);
            std::erase_if(made, [](const FilledOutline& fill) { return fill.seams.empty(); });
            return made;
        }};
    return drawing;
}

std::string bytes_of_file(const Drawing& drawing, const DrawingSettings& settings) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / "vera_later_fills_test.svg";
    write_drawing(drawing, path, DrawingFormat::svg, settings);
    std::ifstream file(path, std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    std::filesystem::remove(path);
    return bytes;
}

TEST(LaterFills, AreWrittenLikeThoseThatAreThere) {
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        RandomFills random(seed);
        Drawing drawing = seed % 2 == 0 ? Drawing() : sample_drawing();
        drawing.width = drawing.height = 5;
        const std::size_t given = drawing.fills.size();
        for (std::uint32_t count = random.below(20); count > 0; --count)
            drawing.fills.push_back(random.outline());
        const Drawing later =
            with_later_fills(drawing, random.below(2) == 0 ? 0 : given, 1 + random.below(4));
        DrawingSettings settings;
        settings.precision = random.below(2) == 0 ? 1 : 0.01;
        settings.cover_seams = random.below(4) != 0;
        for (const Writer writer : {Writer{write_svg}, Writer{write_pdf}, Writer{write_eps}})
            EXPECT_TRUE(written(writer, later, settings) == written(writer, drawing, settings))
                << "seed " << seed;
        if (seed % 20 < 2) {
            EXPECT_TRUE(bytes_of_file(later, settings) == written(write_svg, drawing, settings))
                << "seed " << seed;
        }
    }
}

TEST(GradientNumbers, AreThoseOfASearchThroughAll) {
    RandomFills random(1);
    detail::GradientNumbers numbers;
    std::vector<Gradient> all;
    for (int i = 0; i < 2000; ++i) {
        const Gradient gradient = random.gradient();
        const auto [number, is_new] = numbers.of(gradient);
        const auto found = std::find(all.begin(), all.end(), gradient);
        EXPECT_EQ(is_new, found == all.end());
        EXPECT_EQ(number, static_cast<std::size_t>(found - all.begin()));
        if (is_new)
            all.push_back(gradient);
    }
    EXPECT_EQ(numbers.count(), all.size());
    EXPECT_GT(all.size(), 100U);
}

} // namespace
} // namespace vera
