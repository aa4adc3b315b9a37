// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/theory/side_projection.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vera {

/// The point location of DualPairs with bits in place of pairs: each end has, for each place of a
/// slope about it, a bit for each rectangle, which tells whether the line passes its side. A ray is
/// at one place seen along y and at one seen along x, and meets the rectangles that have both bits,
/// which stand in the order of z. O(log n + n/64) steps a ray, and about 2 n^3 bytes.
class DualBits {
public:
    /// Takes O(n^3). Throws std::invalid_argument as RectanglesByZ does, std::runtime_error where
    /// the memory that is available does not suffice, and Cancelled.
    explicit DualBits(
        std::span<const IsoRectangle> rectangles,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr);

    /// As brute_force_first_rectangle(), and throws likewise. May be asked from many threads.
    std::optional<std::uint32_t>
    first_rectangle(const WholeRay& ray, DualCounts* counts = nullptr) const;

    std::size_t bytes() const;

    /// At most so much, in bytes; without what the allocator takes for itself.
    static double bytes_forecast(std::size_t rectangles);

private:
    using Word = std::uint64_t;

    /// The bits of every end of a side view, place by place.
    struct Passed {
        std::vector<std::size_t> starts; ///< of each end, in words
        std::vector<Word> words;
    };

    Passed passed(const SideProjection& side, const CancelFlag* cancel) const;
    std::span<const Word> bits(const Passed& passed, SideProjection::Pivot pivot) const;

    RectanglesByZ order_;
    SideProjection along_y_;
    SideProjection along_x_;
    std::size_t words_ = 0; ///< of a place
    Passed passed_x_;
    Passed passed_y_;
};

} // namespace vera
