// SPDX-License-Identifier: Apache-2.0
#include "vera/render/pixel_strata.h"

#include "vera/base/check.h"

#include <algorithm>
#include <cmath>

namespace vera {

void Stratum::add(Color color) {
    // Differences to one of them: of equal colours, all else is exactly 0.
    if (shaded == 0)
        first = color;
    ++shaded;
    const Color difference = color - first;
    sum += difference;
    squares += difference * difference;
}

Color Stratum::mean() const {
    VERA_CHECK(shaded > 0);
    return first + (1.0 / shaded) * sum;
}

std::size_t PixelStrata::begin(const Seen& center) {
    std::size_t stratum = free_;
    if (stratum == none) {
        stratum = strata_.size();
        strata_.emplace_back();
    } else {
        free_ = strata_[stratum].next;
        strata_[stratum] = {};
    }
    strata_[stratum].seen = center;
    return stratum;
}

void PixelStrata::end(std::size_t list) {
    std::size_t last = list;
    while (strata_[last].next != none)
        last = strata_[last].next;
    strata_[last].next = free_;
    free_ = list;
}

void PixelStrata::clear() {
    strata_.clear();
    free_ = none;
}

std::size_t PixelStrata::find_or_add(std::size_t list, const Seen& one) {
    std::size_t last = list;
    for (std::size_t i = list; i != none; i = strata_[i].next) {
        if (same_surface(strata_[i].seen, one))
            return i;
        last = i;
    }
    const std::size_t added = begin(one);
    strata_[last].next = added;
    return added;
}

double PixelStrata::covered(std::size_t list) const {
    double rays = 0;
    any(list, [&](const Stratum& stratum) {
        rays += stratum.covered;
        return false;
    });
    return rays;
}

Color PixelStrata::color(std::size_t list) const {
    const double rays = covered(list);
    Color color;
    any(list, [&](const Stratum& stratum) {
        if (stratum.covered > 0)
            color += (stratum.covered / rays) * stratum.mean();
        return false;
    });
    return color;
}

double PixelStrata::deviation(std::size_t list, const Color* center) const {
    const double rays = covered(list);
    const Color all = color(list);
    Color variance;
    any(list, [&](const Stratum& stratum) {
        if (stratum.covered == 0)
            return false;
        double count = stratum.shaded;
        Color sum = stratum.sum;
        Color squares = stratum.squares;
        if (center != nullptr && &stratum == &strata_[list]) {
            const Color difference = *center - stratum.first;
            ++count;
            sum += difference;
            squares += difference * difference;
        }
        const Color off = all - stratum.mean();
        const Color own =
            count > 1 ? (1 / (count - 1)) * (squares - (1 / count) * (sum * sum)) : off * off;
        variance += (stratum.covered / rays) * own;
        return false;
    });
    return std::sqrt(std::max({variance.r, variance.g, variance.b, 0.0}));
}

} // namespace vera
