// SPDX-License-Identifier: Apache-2.0
#include "visible/screen_scenes.h"

#include "vera/math/vec3.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vera::testing {

namespace {

std::uint32_t add_vertex(ScreenScene& scene, ScreenPoint point, std::int64_t nearness) {
    scene.vertices.push_back({point, nearness});
    return static_cast<std::uint32_t>(scene.vertices.size() - 1);
}

} // namespace

ScreenScene layers(std::uint64_t seed, std::size_t count, std::int32_t crossings_per_side) {
    std::mt19937_64 random(seed);
    const auto below = [&](std::int64_t end) {
        return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(end));
    };
    ScreenScene scene;
    const std::int64_t thickness = depth_size / static_cast<std::int64_t>(count + 1);
    const std::int32_t spacing = screen_size / crossings_per_side;
    while (scene.triangles.size() < count) {
        const std::size_t layer = scene.triangles.size();
        const bool slants = below(2) == 0;
        std::array<std::uint32_t, 3> vertices;
        for (std::uint32_t& vertex : vertices) {
            const ScreenPoint point = {
                static_cast<std::int32_t>(below(crossings_per_side + 1)) * spacing,
                static_cast<std::int32_t>(below(crossings_per_side + 1)) * spacing};
            const std::int64_t within = slants ? below(thickness) : 0;
            vertex =
                add_vertex(scene, point, static_cast<std::int64_t>(layer) * thickness + within);
        }
        // Numbers that do not go with the order in depth.
        const auto source = static_cast<std::uint32_t>(layer * 7919 % 1009);
        add_triangle(scene, vertices, source);
        if (scene.triangles.size() > layer && below(4) == 0)
            add_triangle(scene, vertices, source + 1009);
    }
    return scene;
}

ScreenScene scattered(std::uint64_t seed, std::size_t count, std::int32_t size) {
    std::mt19937_64 random(seed);
    const auto below = [&](std::int64_t end) {
        return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(end));
    };
    ScreenScene scene;
    const std::int64_t thickness = depth_size / static_cast<std::int64_t>(count + 1);
    for (std::size_t i = 0; i < count; ++i) {
        const std::int64_t x = below(screen_size);
        const std::int64_t y = below(screen_size);
        std::array<std::uint32_t, 3> vertices;
        for (std::uint32_t& vertex : vertices) {
            const ScreenPoint point = {
                static_cast<std::int32_t>(
                    std::clamp<std::int64_t>(x + below(size) - size / 2, 0, screen_size)),
                static_cast<std::int32_t>(
                    std::clamp<std::int64_t>(y + below(size) - size / 2, 0, screen_size))};
            vertex = add_vertex(
                scene, point, static_cast<std::int64_t>(i) * thickness + below(thickness));
        }
        add_triangle(scene, vertices, static_cast<std::uint32_t>(i * 7919 % count));
    }
    return scene;
}

ScreenScene terrain(std::uint64_t seed, std::int32_t columns) {
    std::mt19937_64 random(seed);
    const auto below = [&](std::int64_t end) {
        return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(end));
    };
    ScreenScene scene;
    // Seen at a grazing angle: a row is hidden by what rises before it.
    const std::int32_t width = screen_size / columns;
    for (std::int32_t row = 0; row <= columns; ++row)
        for (std::int32_t column = 0; column <= columns; ++column) {
            const std::int64_t y = std::int64_t{row} * width / 4 + below(3) * width;
            add_vertex(
                scene,
                {column * width, static_cast<std::int32_t>(std::min<std::int64_t>(y, screen_size))},
                depth_size - std::int64_t{row} * (depth_size / (columns + 1)));
        }
    const auto vertex = [&](std::int32_t column, std::int32_t row) {
        return static_cast<std::uint32_t>(row * (columns + 1) + column);
    };
    std::uint32_t source = 0;
    for (std::int32_t row = 0; row < columns; ++row)
        for (std::int32_t column = 0; column < columns; ++column) {
            add_triangle(
                scene,
                {vertex(column, row), vertex(column + 1, row), vertex(column, row + 1)},
                source++);
            add_triangle(
                scene,
                {vertex(column + 1, row), vertex(column + 1, row + 1), vertex(column, row + 1)},
                source++);
        }
    return scene;
}

ScreenScene balls(std::uint64_t seed, std::size_t count, std::int32_t segments) {
    std::mt19937_64 random(seed);
    const auto below = [&](std::int64_t end) {
        return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(end));
    };
    ScreenScene scene;
    const std::int64_t thickness = depth_size / static_cast<std::int64_t>(count);
    std::uint32_t source = 0;
    for (std::size_t ball = 0; ball < count; ++ball) {
        const auto radius = static_cast<double>(screen_size / 8 + below(screen_size / 8));
        const auto x = static_cast<double>(screen_size / 4 + below(screen_size / 2));
        const auto y = static_cast<double>(screen_size / 4 + below(screen_size / 2));
        const double nearness = (static_cast<double>(ball) + 0.5) * static_cast<double>(thickness);
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        // Rings from pole to pole, the axis slanting; segments + 1 of segments corners each.
        for (std::int32_t ring = 0; ring <= segments; ++ring)
            for (std::int32_t i = 0; i < segments; ++i) {
                const double polar = std::numbers::pi * ring / segments;
                const double around = 2 * std::numbers::pi * i / segments;
                const Vec3 at = {
                    std::sin(polar) * std::cos(around),
                    0.8 * std::cos(polar) + 0.6 * std::sin(polar) * std::sin(around),
                    0.6 * std::cos(polar) - 0.8 * std::sin(polar) * std::sin(around)};
                add_vertex(
                    scene,
                    {static_cast<std::int32_t>(std::lround(x + radius * at.x)),
                     static_cast<std::int32_t>(std::lround(y + radius * at.y))},
                    std::llround(nearness + 0.4 * static_cast<double>(thickness) * at.z));
            }
        const auto corner = [&](std::int32_t ring, std::int32_t i) {
            return first + static_cast<std::uint32_t>(ring * segments + i % segments);
        };
        for (std::int32_t ring = 0; ring < segments; ++ring)
            for (std::int32_t i = 0; i < segments; ++i) {
                add_triangle(
                    scene, {corner(ring, i), corner(ring, i + 1), corner(ring + 1, i)}, source++);
                add_triangle(
                    scene,
                    {corner(ring, i + 1), corner(ring + 1, i + 1), corner(ring + 1, i)},
                    source++);
            }
    }
    return scene;
}

ScreenScene tangle(std::uint64_t seed, std::size_t count, std::int32_t crossings_per_side) {
    std::mt19937_64 random(seed);
    const std::int64_t size = screen_size;
    const std::int64_t step = crossings_per_side == 0 ? 1 : size / crossings_per_side;
    const auto coordinate = [&] {
        const auto any = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(size + 1));
        return static_cast<std::int32_t>(any / step * step);
    };
    ScreenScene scene;
    for (std::uint32_t i = 0; i < count; ++i) {
        std::array<std::uint32_t, 3> vertices;
        for (std::uint32_t& vertex : vertices) {
            const ScreenPoint point = {coordinate(), coordinate()};
            vertex = add_vertex(scene, point, std::int64_t{coordinate()} * (depth_size / size));
        }
        add_triangle(scene, vertices, i);
    }
    return scene;
}

ScreenScene star(std::int32_t count) {
    ScreenScene scene;
    const ScreenPoint middle = {screen_size / 2, screen_size / 2};
    const std::int32_t width = screen_size / count;
    for (std::int32_t i = 0; i < count; ++i) {
        const std::int32_t y = i % 2 == 0 ? 0 : screen_size;
        const std::uint32_t tip = add_vertex(scene, middle, i);
        const std::uint32_t first = add_vertex(scene, {i * width, y}, i);
        const std::uint32_t last = add_vertex(scene, {i * width + width * 2 / 3, y}, i);
        add_triangle(scene, {tip, first, last}, static_cast<std::uint32_t>(i));
    }
    return scene;
}

ScreenScene slivers(std::uint64_t seed, std::size_t count) {
    std::mt19937_64 random(seed);
    const auto below = [&](std::uint64_t end) { return static_cast<std::int32_t>(random() % end); };
    ScreenScene scene;
    const std::int64_t thickness = depth_size / static_cast<std::int64_t>(count + 1);
    constexpr std::int32_t middle = screen_size / 2;
    while (scene.triangles.size() < count) {
        const auto layer = static_cast<std::int64_t>(scene.triangles.size());
        const bool is_long = below(2) == 0;
        const std::int32_t reach = is_long ? screen_size / 2 : 2;
        const std::int32_t x = below(2) == 0 ? middle - reach : middle + below(4);
        std::array<std::uint32_t, 3> vertices = {
            add_vertex(scene, {x, middle + below(4)}, layer * thickness),
            add_vertex(scene, {x, middle + below(4)}, layer * thickness),
            add_vertex(
                scene, {middle + below(3) * reach / 2, middle + below(4)}, layer * thickness)};
        add_triangle(scene, vertices, static_cast<std::uint32_t>(layer * 7919 % 1009));
    }
    return scene;
}

ScreenScene nested_holes(std::int32_t count) {
    ScreenScene scene;
    for (std::int32_t i = 0; i < count; ++i) {
        // Each frame lies within the hole of the one before, and one in three shares its border.
        const std::int32_t unit = screen_size / (4 * count);
        const std::int32_t outer = 2 * i * unit - (i % 3 == 2 ? unit : 0);
        const std::int32_t inner = (2 * i + 1) * unit;
        std::array<std::uint32_t, 8> corners;
        for (std::size_t j = 0; j < 8; ++j) {
            const std::int32_t from = j < 4 ? outer : inner;
            const std::int32_t to = screen_size - from;
            corners[j] = add_vertex(
                scene, {j % 4 == 0 || j % 4 == 3 ? from : to, j % 4 < 2 ? from : to}, 1000 * i);
        }
        for (std::size_t j = 0; j < 4; ++j) {
            const std::size_t next = (j + 1) % 4;
            const auto source = static_cast<std::uint32_t>(count - i);
            add_triangle(scene, {corners[j], corners[next], corners[j + 4]}, source);
            add_triangle(scene, {corners[next], corners[next + 4], corners[j + 4]}, source);
        }
    }
    return scene;
}

} // namespace vera::testing
