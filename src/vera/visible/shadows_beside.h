// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/screen_scene.h"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// Which lights' shadows cover what is on the two sides of an edge, place by place along it. Counts
/// what begins and ends, so that a place takes no longer where many shadows lie on each other.
class ShadowsBeside {
public:
    /// Of another edge.
    void clear() { keys_.clear(); }

    /// A shadow that covers a part of one side or both. All are expected before start().
    void expect(const ScreenTriangle& shadow) { keys_.push_back({shadow.source, shadow.light}); }

    /// Before the first place: nothing covers anything.
    void start();

    /// So many more, or fewer, such triangles cover these sides, as bits: surfaces or shadows.
    void change(const ScreenTriangle& triangle, std::uint8_t sides, std::int32_t more);

    /// Whether a light's shadows on a source that is here cover but one of the sides.
    bool is_any_parted() const { return parted_ > 0; }

    /// The lights of the shadows on the source on that side.
    LightSet lights(std::uint32_t source, std::uint8_t side) const;

    /// Triangles, lights and sources that were looked at, in all.
    std::uint64_t steps() const { return steps_; }

private:
    struct Key {
        std::uint32_t source = 0;
        std::uint32_t light = 0;

        friend auto operator<=>(const Key&, const Key&) = default;
    };

    struct Source {
        std::uint32_t source = 0;
        std::uint32_t first = 0;   ///< of its keys
        std::int32_t surfaces = 0; ///< of it, that are here
        std::int32_t parted = 0;   ///< lights whose shadows cover but one side

        bool is_parted() const { return surfaces > 0 && parted > 0; }
    };

    std::size_t place_of(std::uint32_t source) const;

    std::vector<Key> keys_;
    std::vector<std::array<std::int32_t, 2>> covering_; ///< of the keys, shadows on each side
    std::vector<Source> sources_;                       ///< in ascending order, and an end
    std::int32_t parted_ = 0;                           ///< sources
    mutable std::uint64_t steps_ = 0;
};

} // namespace vera
