// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/orientation.h"

#include "vera/exact/big_integer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace vera {

namespace {

constexpr double half_ulp = std::numeric_limits<double>::epsilon() / 2;

/// Less, and products may have lost what matters to underflow.
constexpr double smallest_sure = 1e-250;

int sign_of(double value) {
    return value > 0 ? 1 : value < 0 ? -1 : 0;
}

/// Coordinates as whole numbers of one unit, a power of two.
class WholeCoordinates {
public:
    explicit WholeCoordinates(std::span<const Vec3> points) {
        for (const Vec3 point : points)
            for (std::size_t i = 0; i < 3; ++i)
                if (point[i] != 0)
                    lowest_ = std::min(lowest_, std::ilogb(point[i]) - 52);
    }

    BigInteger difference(double a, double b) const { return whole(a) - whole(b); }

private:
    BigInteger whole(double value) const {
        if (value == 0)
            return {};
        // 53 bits before the point, whatever the exponent.
        const int exponent = std::ilogb(value) - 52;
        return BigInteger(
            static_cast<std::int64_t>(std::scalbn(value, -exponent)),
            static_cast<unsigned>(exponent - lowest_));
    }

    int lowest_ = std::numeric_limits<int>::max();
};

int exact_orientation(const std::array<Vec3, 4>& points) {
    const WholeCoordinates whole(points);
    std::array<std::array<BigInteger, 3>, 3> rows;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            rows[i][axis] = whole.difference(points[i + 1][axis], points[0][axis]);
    const auto& [b, c, d] = rows;
    const BigInteger x = b[1] * c[2] - b[2] * c[1];
    const BigInteger y = b[2] * c[0] - b[0] * c[2];
    const BigInteger z = b[0] * c[1] - b[1] * c[0];
    return (d[0] * x + d[1] * y + d[2] * z).sign();
}

bool are_all_zero(double a, double b, double c) {
    return a == 0 && b == 0 && c == 0;
}

} // namespace

int orientation(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const Vec3 ad = d - a;
    // In a plane across an axis, as faces of buildings are. Differences are 0 only where they are.
    if (are_all_zero(ab.x, ac.x, ad.x) || are_all_zero(ab.y, ac.y, ad.y)
        || are_all_zero(ab.z, ac.z, ad.z))
        return 0;
    const double determinant = dot(ad, cross(ab, ac));
    const Vec3 size_b = abs(ab);
    const Vec3 size_c = abs(ac);
    const Vec3 size_d = abs(ad);
    const double permanent = size_d.x * (size_b.y * size_c.z + size_b.z * size_c.y)
        + size_d.y * (size_b.z * size_c.x + size_b.x * size_c.z)
        + size_d.z * (size_b.x * size_c.y + size_b.y * size_c.x);
    // The bound A of Shewchuk 1997, section 4.1; twice that, as the sums run in another order.
    const double bound = 2 * (7 + 56 * half_ulp) * half_ulp * permanent;
    if (permanent > smallest_sure && std::abs(determinant) > bound)
        return sign_of(determinant);
    return exact_orientation({a, b, c, d});
}

int orientation_along(std::size_t axis, Vec3 a, Vec3 b, Vec3 c) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    const double left = (b[u] - a[u]) * (c[v] - a[v]);
    const double right = (b[v] - a[v]) * (c[u] - a[u]);
    const double size = std::abs(left) + std::abs(right);
    const double determinant = left - right;
    if (size > smallest_sure && std::abs(determinant) > 2 * (3 + 16 * half_ulp) * half_ulp * size)
        return sign_of(determinant);
    const std::array<Vec3, 3> points = {a, b, c};
    const WholeCoordinates whole(points);
    return (whole.difference(b[u], a[u]) * whole.difference(c[v], a[v])
            - whole.difference(b[v], a[v]) * whole.difference(c[u], a[u]))
        .sign();
}

} // namespace vera
