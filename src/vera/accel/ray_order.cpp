// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/ray_order.h"

#include "vera/base/check.h"

#include <cmath>
#include <limits>

namespace vera::detail {

namespace {

constexpr unsigned cell_bits = 3; // along each axis
constexpr std::size_t key_count = std::size_t{1} << (3 * cell_bits + 3);

/// The least and the largest coordinates along an axis. Those that are no numbers do not count.
struct Extent {
    float least = std::numeric_limits<float>::infinity();
    float most = -least;

    void add(float coordinate) {
        least = std::min(least, coordinate);
        most = std::max(most, coordinate);
    }
};

/// The bits of a cell's number along an axis, each at its place on the Z curve.
constexpr std::array<std::uint32_t, 1U << cell_bits> on_curve = [] {
    std::array<std::uint32_t, 1U << cell_bits> spread = {};
    for (std::uint32_t cell = 0; cell < spread.size(); ++cell)
        for (unsigned bit = 0; bit < cell_bits; ++bit)
            spread[cell] |= (cell >> bit & 1U) << (3 * bit);
    return spread;
}();

} // namespace

bool start_apart(std::span<const IndexRay> rays) {
    constexpr std::size_t most_asked = 32;
    constexpr float far = 0x1p-4F; // of the extent of those that are asked
    if (rays.size() < 2)
        return false;
    const std::size_t asked = std::min(most_asked, rays.size() - 1);
    const auto number = [&](std::size_t i) { return i * (rays.size() - 1) / asked; };
    std::array<Extent, 3> extents;
    for (std::size_t i = 0; i < asked; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            extents[axis].add(rays[number(i)].origin[axis]);
    float size = 0;
    for (const Extent& extent : extents)
        size = std::max(size, extent.most - extent.least);
    std::size_t apart = 0;
    for (std::size_t i = 0; i < asked; ++i) {
        const auto& origin = rays[number(i)].origin;
        const auto& next = rays[number(i) + 1].origin;
        float way = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            way = std::max(way, std::abs(next[axis] - origin[axis]));
        apart += way > far * size ? 1U : 0U;
    }
    return 2 * apart > asked;
}

void order_rays(std::span<const IndexRay> rays, std::vector<std::uint32_t>& numbers) {
    VERA_CHECK(rays.size() <= most_ordered);
    std::array<Extent, 3> extents;
    for (const IndexRay& ray : rays)
        for (std::size_t axis = 0; axis < 3; ++axis)
            extents[axis].add(ray.origin[axis]);
    constexpr float cells = 1U << cell_bits;
    std::array<float, 3> per_cell;
    for (std::size_t axis = 0; axis < 3; ++axis)
        per_cell[axis] = cells / (extents[axis].most - extents[axis].least);
    // By counting: how many have each key, then where those of each begin.
    std::array<std::uint16_t, most_ordered> keys;
    std::array<std::uint32_t, key_count> places = {};
    for (std::size_t i = 0; i < rays.size(); ++i) {
        std::uint32_t key = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float cell = (rays[i].origin[axis] - extents[axis].least) * per_cell[axis];
            // In this order, 0 comes of what is no number.
            const float within = std::min(cells - 1, std::max(0.0F, cell));
            key |= on_curve[static_cast<std::size_t>(within)] << axis;
            key |= (rays[i].direction[axis] < 0 ? 1U : 0U) << (3 * cell_bits + axis);
        }
        keys[i] = static_cast<std::uint16_t>(key);
        ++places[key];
    }
    std::uint32_t before = 0;
    for (std::uint32_t& place : places) {
        const std::uint32_t count = place;
        place = before;
        before += count;
    }
    numbers.resize(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        numbers[places[keys[i]]++] = static_cast<std::uint32_t>(i);
}

} // namespace vera::detail
