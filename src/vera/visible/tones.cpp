// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/tones.h"

#include <algorithm>

namespace vera {

namespace {

double brightest(Color color) {
    return std::max({color.r, color.g, color.b});
}

} // namespace

Color toned(Color light, const Material& material) {
    Color own = material.drf + material.arf + material.sdi + material.san;
    if (is_black(own)) // mirrors and glass
        own = material.rab + material.tab;
    const double most = brightest(own);
    if (!(most > 0))
        return {};
    if (most > 1)
        own = (1 / most) * own;
    const double part = brightest(light) / brightest(own);
    constexpr double dark = 0.35;
    constexpr double middle = 0.65;
    return (part < 1.0 / 3 ? dark : part < 2.0 / 3 ? middle : 1.0) * own;
}

} // namespace vera
