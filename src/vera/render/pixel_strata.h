// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/color.h"
#include "vera/render/seen.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace vera {

/// What the rays of a pixel tell of one of the surfaces that it shows.
struct Stratum {
    Seen seen;                 ///< by the first ray that met it
    std::uint32_t covered = 0; ///< rays that met it
    std::uint32_t shaded = 0;  ///< those that have a colour
    /// Which of the pixel's samples got a colour ahead of others, as the surface had none.
    std::uint32_t shaded_ahead = std::numeric_limits<std::uint32_t>::max();
    Color first;   ///< one of the colours
    Color sum;     ///< of all colours' differences to it
    Color squares; ///< sum of the squares of these, channel by channel
    std::size_t next = std::numeric_limits<std::size_t>::max(); ///< PixelStrata::none

    void add(Color color);
    Color mean() const; ///< shaded must not be 0
};

/// The surfaces that pixels show, and how much of these: samples of which the strata are known
/// afterwards (post-stratification: Cochran, Sampling Techniques, 1977, 5A.9). A pixel's strata are
/// a list, which begins with that of its centre, met by a sample or not.
class PixelStrata {
public:
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

    /// A list for another pixel.
    std::size_t begin(const Seen& center);

    /// The list is needed no more: others take its room.
    void end(std::size_t list);

    /// The stratum in the list that shows the same surface, which is added where there is none.
    std::size_t find_or_add(std::size_t list, const Seen& one);

    /// The sum of the surfaces' mean colours, each by its part of all rays that met any.
    Color color(std::size_t list) const;

    /// The standard deviation of colours from their surface's mean, in the channel where it is the
    /// largest. Of a surface with one colour nothing is known; how far that is off the pixel's
    /// mean stands in. The centre's colour, if there is one, counts for this alone: what covers a
    /// pixel must not prefer a place in it.
    double deviation(std::size_t list, const Color* center) const;

    bool shows_several(std::size_t list) const { return strata_[list].next != none; }

    /// Calls visit(stratum) for each, until it returns true; returns whether it did.
    template <typename Visit>
    bool any(std::size_t list, const Visit& visit) const {
        for (std::size_t i = list; i != none; i = strata_[i].next)
            if (visit(strata_[i]))
                return true;
        return false;
    }

    Stratum& operator[](std::size_t stratum) { return strata_[stratum]; }

    void clear();

    /// How many surfaces there has been room for at a time.
    std::size_t room() const { return strata_.size(); }

private:
    double covered(std::size_t list) const;

    std::vector<Stratum> strata_;
    std::size_t free_ = none; ///< a list
};

} // namespace vera
