// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/inner_point_check.h"

#include "vera/formats/faces.h"

#include <array>
#include <cmath>
#include <optional>
#include <span>

namespace vera {

namespace {

/// The corners of a face; none of an item of another kind.
std::span<const Vec3> corners_of(const Geometry& geometry, const Item& item) {
    switch (item.kind) {
    case ItemKind::triangle:
        return geometry.triangles[item.index].corners;
    case ItemKind::patch:
        return geometry.patches[item.index].corners;
    case ItemKind::polygon: {
        const Polygon& polygon = geometry.polygons[item.index];
        return std::span(geometry.corners).subspan(polygon.first_corner, polygon.corner_count);
    }
    default:
        return {};
    }
}

std::optional<Vec3> normal_of(const Geometry& geometry, const Item& item) {
    const auto corners = corners_of(geometry, item);
    if (item.kind == ItemKind::polygon) {
        const Polygon& polygon = geometry.polygons[item.index];
        // The two halves of a quadrangle that is not plane are not judged.
        if (polygon.shape == Polygon::Shape::split_quadrangle)
            return std::nullopt;
        return polygon.normal;
    }
    if (corners.empty())
        return std::nullopt;
    return triangle_normal(corners.first<3>());
}

/// Looks through the corners of the other faces until one lies on the inner point's side of the
/// plane. Begins with the item that decided last, which often decides again.
class Comparison {
public:
    Comparison(const Geometry& geometry, std::size_t first, std::size_t last)
        : geometry_(geometry)
        , first_(first)
        , last_(last)
        , decisive_(first)
        , corners_left_(1'000'000 + 64 * (last - first)) {}

    bool exhausted() const { return corners_left_ == 0; }

    bool on_wrong_side(std::size_t face) {
        const Item& item = geometry_.items[face];
        if (item.outside == Outside::by_normal)
            return false;
        const auto normal = normal_of(geometry_, item);
        if (!normal)
            return false;
        const Vec3 origin = corners_of(geometry_, item)[0];
        const Vec3 inwards = item.outside == Outside::along_normal ? -*normal : *normal;
        bool any_beyond = false;
        const std::size_t count = last_ - first_;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t other = first_ + (decisive_ - first_ + i) % count;
            if (other == face)
                continue;
            for (const Vec3& corner : corners_of(geometry_, geometry_.items[other])) {
                if (corners_left_ == 0)
                    return false;
                --corners_left_;
                const Vec3 offset = corner - origin;
                const double distance = dot(inwards, offset);
                const double on_plane = 1e-9 * max_component(abs(offset));
                if (distance > on_plane) {
                    decisive_ = other;
                    return false;
                }
                any_beyond = any_beyond || distance < -on_plane;
            }
        }
        return any_beyond;
    }

private:
    const Geometry& geometry_;
    std::size_t first_;
    std::size_t last_;
    std::size_t decisive_;
    std::size_t corners_left_;
};

} // namespace

std::vector<std::size_t> faces_with_inner_point_on_wrong_side(
    const Geometry& geometry, std::size_t first, std::size_t last) {
    std::vector<std::size_t> wrong;
    Comparison comparison(geometry, first, last);
    for (std::size_t face = first; face < last && !comparison.exhausted(); ++face)
        if (comparison.on_wrong_side(face))
            wrong.push_back(face);
    return wrong;
}

} // namespace vera
