// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/unfilled_vector.h"
#include "vera/visible/line_step.h"
#include "vera/visible/visible_map.h"

#include <cstddef>
#include <cstdint>

namespace vera {

constexpr std::uint32_t no_way = ~std::uint32_t{0};

/// The two ways along each piece: 2 i with, 2 i + 1 against its edge. All that a map is made of
/// beside the points, and smaller than pieces and scene, which are not asked any more.
class Ways {
public:
    struct Ends {
        std::uint32_t from = 0;
        std::uint32_t to = 0;
    };

    /// Of no piece, but with room for so many.
    explicit Ways(std::size_t most) {
        ends.reserve(most);
        steps.reserve(most);
        region.reserve(2 * most);
    }

    /// Those that it adds are to be filled in.
    void resize(std::size_t count) {
        ends.resize(count);
        steps.resize(count);
        region.resize(2 * count);
    }

    std::size_t count() const { return region.size(); }

    /// Where the way begins.
    std::uint32_t from(std::uint32_t way) const {
        const Ends& piece = ends[way / 2];
        return way % 2 == 0 ? piece.from : piece.to;
    }

    std::uint32_t to(std::uint32_t way) const { return from(way ^ 1U); }

    /// Along the whole edge.
    ScreenStep direction(std::uint32_t way) const {
        const ScreenStep step = steps[way / 2];
        return way % 2 == 0 ? step : ScreenStep{-step.x, -step.y};
    }

    UnfilledVector<Ends> ends;            ///< of the pieces
    UnfilledVector<LineStep> steps;       ///< along their whole edges
    UnfilledVector<std::uint32_t> region; ///< seen on the left of each way
};

} // namespace vera
