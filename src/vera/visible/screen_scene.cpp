// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/screen_scene.h"

#include "vera/base/free_room.h"
#include "vera/base/long_loop.h"

#include <algorithm>
#include <numeric>
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

struct Placed {
    std::uint64_t code = 0;
    std::uint32_t triangle = 0;
};

constexpr std::size_t code_parts = 4096;

/// Which of the parts, in their order, the code is in.
std::size_t code_part(std::uint64_t code) {
    // The sums of three coordinates have 24 bits.
    return static_cast<std::size_t>(code * code_parts >> 48U);
}

struct PartedByCode {
    std::vector<Placed> triangles;
    std::vector<std::size_t> starts; ///< of the parts, and the end
};

PartedByCode parted_by_code(const ScreenScene& scene) {
    std::vector<Placed> placed(scene.triangles.size());
    parallel_ranges(placed.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            placed[i] = {
                morton_code(corners_of(scene, scene.triangles[i])), static_cast<std::uint32_t>(i)};
    });
    PartedByCode parted = {std::vector<Placed>(placed.size()), {}};
    parted.starts.resize(code_parts + 2);
    for (const Placed& one : placed)
        ++parted.starts[code_part(one.code) + 2];
    std::partial_sum(parted.starts.begin(), parted.starts.end(), parted.starts.begin());
    // Each part grows from where the one before it ends, until it ends where the next begins.
    for (const Placed& one : placed)
        parted.triangles[parted.starts[code_part(one.code) + 1]++] = one;
    return parted;
}

} // namespace

void turn_to_left(ScreenScene& scene) {
    for (ScreenTriangle& triangle : scene.triangles) {
        if (!turn_to_left(scene, triangle.vertices))
            triangle.source = no_source;
        triangle.plane = triangle.vertices;
    }
    std::erase_if(scene.triangles, [](const ScreenTriangle& triangle) {
        return triangle.source == no_source;
    });
}

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
    PartedByCode parted = parted_by_code(scene);
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
    std::vector<Placed>& order = parted.triangles;
    parallel_ranges(code_parts, code_parts / 64, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        const auto place = [&](std::size_t part) {
            return order.begin() + static_cast<std::ptrdiff_t>(parted.starts[part]);
        };
        std::sort(place(first), place(last), [&](const Placed& a, const Placed& b) {
            return a.code != b.code ? a.code < b.code : key(a) < key(b);
        });
    });
    stop_if_raised(cancel);
    // Of surfaces between the same vertices the first of the text alone is seen.
    const auto duplicates =
        std::unique(order.begin(), order.end(), [&](const Placed& a, const Placed& b) {
            const ScreenTriangle& one = scene.triangles[a.triangle];
            const ScreenTriangle& other = scene.triangles[b.triangle];
            return a.code == b.code && sorted(one.vertices) == sorted(other.vertices)
                && one.light == other.light && (!one.is_shadow() || one.source == other.source);
        });
    order.erase(duplicates, order.end());

    std::vector<ScreenTriangle> triangles(order.size());
    parallel_ranges(order.size(), 4096, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        for (std::size_t place = first; place < last; ++place)
            triangles[place] = scene.triangles[order[place].triangle];
    });
    scene.triangles = std::move(triangles);
    free_room(order);
    constexpr std::uint32_t unused = ~std::uint32_t{0};
    std::vector<std::uint32_t> numbers(scene.vertices.size(), unused);
    std::vector<std::uint32_t> used;
    used.reserve(scene.vertices.size());
    const LongLoop loop(scene.triangles.size(), {}, cancel);
    for (std::size_t place = 0; place < scene.triangles.size(); ++place) {
        loop.turn(place);
        ScreenTriangle& triangle = scene.triangles[place];
        for (auto* corners : {&triangle.vertices, &triangle.plane})
            for (std::uint32_t& vertex : *corners) {
                if (numbers[vertex] == unused) {
                    numbers[vertex] = static_cast<std::uint32_t>(used.size());
                    used.push_back(vertex);
                }
                vertex = numbers[vertex];
            }
    }
    std::vector<ScreenVertex> vertices(used.size());
    parallel_ranges(used.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            vertices[i] = scene.vertices[used[i]];
    });
    scene.vertices = std::move(vertices);
}

} // namespace vera
