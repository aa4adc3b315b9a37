// SPDX-License-Identifier: Apache-2.0
#include "vera/math/vec3.h"

namespace vera::detail {

double scaled_length(Vec3 a, double largest) {
    if (!(largest > 0) || !(largest <= 1.7e308))
        return largest; // zero, infinite or not a number
    // Scaling by a power of two is exact, so that a scene and its scaled copy round alike.
    int exponent = 0;
    std::frexp(largest, &exponent);
    const Vec3 scaled = {
        std::ldexp(a.x, -exponent), std::ldexp(a.y, -exponent), std::ldexp(a.z, -exponent)};
    return std::ldexp(std::sqrt(dot(scaled, scaled)), exponent);
}

} // namespace vera::detail
