// SPDX-License-Identifier: Apache-2.0
#include "reference/plane_faces.h"

namespace vera::reference {
namespace {

struct PlaneFace : Face {
    std::vector<Vector> corners;
    Vector own_normal; ///< unit: the area vector's direction in the subscene, carried into place
    bool outside_against_own_normal = false;

    void
    cross(const Line& line, bool starts_here, std::vector<Crossing>& crossings) const override {
        // "A ray never meets again the face that it starts from."
        if (starts_here)
            return;
        const Real towards = inner(own_normal, line.direction);
        if (towards == 0)
            return;
        const Real t = inner(own_normal, corners[0] - line.origin) / towards;
        if (holds(line.origin + t * line.direction))
            crossings.push_back({t, 0, this});
    }

    Surface surface(Vector, const Crossing&) const override {
        const Vector outside = outside_against_own_normal ? -1 * own_normal : own_normal;
        return {outside, outside};
    }

    void set_up(std::vector<Vector> points, PlaneSides sides) {
        corners = std::move(points);
        // "its normal is its area vector (sum of cross products, right-hand rule)", in the
        // subscene's coordinates: a mirrored one comes out reversed in place.
        Vector area;
        Vector middle;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Vector& next = corners[(i + 1) % corners.size()];
            area = area + outer(corners[i] - corners[0], next - corners[0]);
            middle = middle + (1 / static_cast<Real>(corners.size())) * corners[i];
        }
        own_normal = unit(sides.mirrored ? -1 * area : area);
        outside_against_own_normal = sides.outside == Outside::against_normal;
        ball_center = middle;
        for (const Vector& corner : corners)
            ball_radius = std::fmax(ball_radius, norm(corner - middle));
    }

private:
    /// Whether a point of the plane lies within the corners: seen along the axis that the plane
    /// faces most, a half line from the point crosses the sides an odd number of times.
    bool holds(Vector point) const {
        const auto seen = [this](Vector a) -> std::array<Real, 2> {
            const Real x = std::fabs(own_normal.x);
            const Real y = std::fabs(own_normal.y);
            const Real z = std::fabs(own_normal.z);
            if (x >= y && x >= z)
                return {a.y, a.z};
            return y >= z ? std::array{a.z, a.x} : std::array{a.x, a.y};
        };
        const auto [u, v] = seen(point);
        bool odd = false;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const auto [u1, v1] = seen(corners[i]);
            const auto [u2, v2] = seen(corners[(i + 1) % corners.size()]);
            if ((v1 > v) != (v2 > v) && u < u1 + (v - v1) / (v2 - v1) * (u2 - u1))
                odd = !odd;
        }
        return odd;
    }
};

struct PatchFace final : PlaneFace {
    std::array<Vector, 3> normals;
    bool outside_by_interpolated_normal = false;

    Surface surface(Vector point, const Crossing&) const override {
        // Each normal counts by the part of the area that lies opposite its corner.
        const auto part = [&](const Vector& p, const Vector& q) {
            return inner(own_normal, outer(p - point, q - point));
        };
        const Real a = part(corners[1], corners[2]);
        const Real b = part(corners[2], corners[0]);
        const Real c = part(corners[0], corners[1]);
        const Vector sum = a * normals[0] + b * normals[1] + c * normals[2];

        // "the normals are interpolated as given, then made unit; a zero result becomes the face's
        // own normal"; all areas have the sign of the mirroring, and so has the sum.
        const Vector given = a + b + c < 0 ? -1 * sum : sum;
        const Real largest =
            std::fmax(size(normals[0]), std::fmax(size(normals[1]), size(normals[2])));
        const bool is_zero = size(given) <= 1e-15L * largest * std::fabs(a + b + c);
        const Vector normal = is_zero ? own_normal : unit(given);

        // "Without IP the side that the (... for PA the interpolated) normal points to is the
        // outside."
        const bool against = outside_by_interpolated_normal ? inner(normal, own_normal) < 0
                                                            : outside_against_own_normal;
        return {against ? -1 * own_normal : own_normal, normal};
    }
};

} // namespace

std::unique_ptr<Face> polygon_face(std::vector<Vector> corners, PlaneSides sides) {
    auto face = std::make_unique<PlaneFace>();
    face->set_up(std::move(corners), sides);
    return face;
}

std::unique_ptr<Face>
patch_face(std::vector<Vector> corners, std::array<Vector, 3> normals, PlaneSides sides) {
    auto face = std::make_unique<PatchFace>();
    face->set_up(std::move(corners), sides);
    face->normals = normals;
    face->outside_by_interpolated_normal = sides.outside == Outside::by_normal;
    return face;
}

} // namespace vera::reference
