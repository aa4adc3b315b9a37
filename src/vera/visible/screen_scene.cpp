// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/screen_scene.h"

#include "vera/base/long_loop.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace vera {

namespace {

/// Lets a zero follow each of the lower 32 bits.
constexpr std::uint64_t spread(std::uint64_t bits) {
    bits = (bits | (bits << 16U)) & 0x0000ffff0000ffffU;
    bits = (bits | (bits << 8U)) & 0x00ff00ff00ff00ffU;
    bits = (bits | (bits << 4U)) & 0x0f0f0f0f0f0f0f0fU;
    bits = (bits | (bits << 2U)) & 0x3333333333333333U;
    return (bits | (bits << 1U)) & 0x5555555555555555U;
}

std::uint64_t morton_code(const std::array<ScreenVertex, 3>& corners) {
    std::uint64_t x = 0;
    std::uint64_t y = 0;
    for (const ScreenVertex& corner : corners) {
        x += static_cast<std::uint64_t>(corner.point.x);
        y += static_cast<std::uint64_t>(corner.point.y);
    }
    return spread(x) | (spread(y) << 1U);
}

std::array<std::uint32_t, 3> sorted(std::array<std::uint32_t, 3> vertices) {
    std::sort(vertices.begin(), vertices.end());
    return vertices;
}

/// Turns the corners to the left; false where they have no area.
bool turn_to_left(const ScreenScene& scene, std::array<std::uint32_t, 3>& vertices) {
    const auto point = [&](std::size_t i) { return scene.vertices[vertices[i]].point; };
    const std::int64_t area = orientation(point(0), point(1), point(2));
    if (area < 0)
        std::swap(vertices[1], vertices[2]);
    return area != 0;
}

} // namespace

void add_triangle(
    ScreenScene& scene,
    std::array<std::uint32_t, 3> vertices,
    std::uint32_t source,
    std::uint32_t light) {
    if (turn_to_left(scene, vertices))
        scene.triangles.push_back({vertices, source, light, vertices});
}

void add_part(
    ScreenScene& scene,
    std::array<std::uint32_t, 3> vertices,
    const ScreenTriangle& of,
    std::uint32_t light) {
    if (turn_to_left(scene, vertices))
        scene.triangles.push_back({vertices, of.source, light, of.plane});
}

void sort_by_place(ScreenScene& scene, const CancelFlag* cancel) {
    struct Placed {
        std::uint64_t code;
        std::uint32_t triangle;
    };

    std::vector<Placed> order(scene.triangles.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
        order[i] = {morton_code(corners_of(scene, scene.triangles[i])), i};
    stop_if_raised(cancel);
    const auto key = [&](const Placed& placed) {
        const ScreenTriangle& triangle = scene.triangles[placed.triangle];
        return std::tuple(
            placed.code,
            !triangle.is_shadow(),
            sorted(triangle.vertices),
            triangle.source,
            triangle.light,
            placed.triangle);
    };
    std::sort(order.begin(), order.end(), [&](const Placed& a, const Placed& b) {
        return a.code != b.code ? a.code < b.code : key(a) < key(b);
    });
    stop_if_raised(cancel);
    // Of surfaces between the same vertices the first of the text alone is seen.
    const auto duplicates =
        std::unique(order.begin(), order.end(), [&](const Placed& a, const Placed& b) {
            const ScreenTriangle& one = scene.triangles[a.triangle];
            const ScreenTriangle& other = scene.triangles[b.triangle];
            return sorted(one.vertices) == sorted(other.vertices) && one.light == other.light
                && (!one.is_shadow() || one.source == other.source);
        });
    order.erase(duplicates, order.end());

    constexpr std::uint32_t unused = ~std::uint32_t{0};
    std::vector<std::uint32_t> numbers(scene.vertices.size(), unused);
    std::vector<ScreenVertex> vertices;
    std::vector<ScreenTriangle> triangles;
    vertices.reserve(scene.vertices.size());
    triangles.reserve(scene.triangles.size());
    const LongLoop loop(order.size(), {}, cancel);
    for (std::size_t place = 0; place < order.size(); ++place) {
        loop.turn(place);
        ScreenTriangle triangle = scene.triangles[order[place].triangle];
        for (std::array<std::uint32_t, 3>* corners : {&triangle.vertices, &triangle.plane})
            for (std::uint32_t& vertex : *corners) {
                if (numbers[vertex] == unused) {
                    numbers[vertex] = static_cast<std::uint32_t>(vertices.size());
                    vertices.push_back(scene.vertices[vertex]);
                }
                vertex = numbers[vertex];
            }
        triangles.push_back(triangle);
    }
    scene.vertices = std::move(vertices);
    scene.triangles = std::move(triangles);
}

} // namespace vera
