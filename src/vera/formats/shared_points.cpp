// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/shared_points.h"

#include <bit>

namespace vera {

SharedPoints::SharedPoints(std::vector<Vec3>& points)
    : points_(points)
    , slots_(1024, empty) {}

std::size_t SharedPoints::slot_of(Vec3 point) const {
    // Adding 0 makes a 0 of -0. The multipliers are odd and have no pattern: digits of the golden
    // ratio and of its square root.
    const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value + 0.0); };
    std::uint64_t hash = bits(point.x) * 0x9e3779b97f4a7c15U;
    hash = (hash ^ (hash >> 32U) ^ bits(point.y)) * 0xc2b2ae3d27d4eb4fU;
    hash = (hash ^ (hash >> 32U) ^ bits(point.z)) * 0x9e3779b97f4a7c15U;
    hash ^= hash >> 32U;
    return static_cast<std::size_t>(hash) & (slots_.size() - 1);
}

std::uint32_t SharedPoints::number_of(Vec3 point) {
    std::size_t slot = slot_of(point);
    for (; slots_[slot] != empty; slot = (slot + 1) & (slots_.size() - 1))
        if (points_[slots_[slot]] == point)
            return slots_[slot];
    const auto number = static_cast<std::uint32_t>(points_.size());
    slots_[slot] = number;
    points_.push_back(point);
    if (points_.size() * 8 > slots_.size() * 5)
        grow();
    return number;
}

void SharedPoints::grow() {
    const std::size_t size = 2 * slots_.size();
    slots_ = {};
    slots_.assign(size, empty);
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
        std::size_t slot = slot_of(points_[i]);
        while (slots_[slot] != empty)
            slot = (slot + 1) & (slots_.size() - 1);
        slots_[slot] = i;
    }
}

} // namespace vera
