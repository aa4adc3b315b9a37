// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "reference/faces.h"

namespace vera::reference {

/// Gives the roots of a t^2 + 2 b t + c. When the line starts on the surface, 0 is one root and is
/// left out; the other is then known without c.
template <typename Found>
void cross_quadric(Real a, Real b, Real c, bool starts_here, const Found& found) {
    if (a == 0) {
        if (!starts_here && b != 0)
            found(-c / (2 * b));
        return;
    }
    if (starts_here) {
        found(-2 * b / a);
        return;
    }
    const Real radicand = b * b - a * c;
    if (radicand < 0)
        return;
    // The larger sum first, so that nothing cancels; the roots' product is c / a.
    const Real sum = b < 0 ? -b + std::sqrt(radicand) : -b - std::sqrt(radicand);
    found(sum / a);
    if (sum != 0)
        found(c / sum);
}

/// RS, RK: one face for each piece of the contour, in order.
std::vector<std::unique_ptr<Face>>
contour_faces(const RotationalShape& shape, const Placement& placement);

} // namespace vera::reference
