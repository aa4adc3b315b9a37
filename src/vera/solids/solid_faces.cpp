// SPDX-License-Identifier: Apache-2.0
#include "vera/solids/solid_faces.h"

#include "vera/base/diagnostic.h"
#include "vera/scene/polygon_triangles.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace vera {

namespace {

/// Adds faces, each corner a point of its own at first.
class FaceCollector {
public:
    explicit FaceCollector(SolidFaces& faces)
        : faces_(faces) {}

    void add(std::uint32_t item, std::span<const Vec3> corners, bool is_split = false) {
        const auto first = static_cast<std::uint32_t>(faces_.points.size());
        if (faces_.points.size() + corners.size() > std::numeric_limits<std::uint32_t>::max())
            throw InputError({{.problem = "the scene has too many corners to be checked"}});
        const auto face = static_cast<std::uint32_t>(faces_.faces.size());
        faces_.faces.push_back({item, first, static_cast<std::uint32_t>(corners.size())});
        for (const Vec3 corner : corners)
            faces_.points.push_back(corner + Vec3{}); // -0 becomes 0
        triples_.clear();
        if (corners.size() == 3)
            triples_.push_back({0, 1, 2});
        else if (is_split)
            triples_ = {{0, 1, 2}, {0, 2, 3}};
        else
            split_polygon(corners, triples_);
        for (const CornerTriple& triple : triples_)
            faces_.triangles.push_back(
                {{first + triple[0], first + triple[1], first + triple[2]}, face});
    }

    /// Makes one point of those that are the same.
    void join_points() {
        std::vector<std::uint32_t> order(faces_.points.size());
        std::iota(order.begin(), order.end(), std::uint32_t{0});
        const auto key = [&](std::uint32_t i) {
            const Vec3& point = faces_.points[i];
            return std::tuple(point.x, point.y, point.z);
        };
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return key(a) < key(b);
        });
        std::vector<Vec3> points;
        faces_.corners.resize(order.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            if (i == 0 || key(order[i - 1]) != key(order[i]))
                points.push_back(faces_.points[order[i]]);
            faces_.corners[order[i]] = static_cast<std::uint32_t>(points.size() - 1);
        }
        for (SolidFaces::Triangle& triangle : faces_.triangles)
            for (std::uint32_t& point : triangle.points)
                point = faces_.corners[point];
        faces_.points = std::move(points);
    }

private:
    SolidFaces& faces_;
    std::vector<CornerTriple> triples_;
};

void add_mesh(FaceCollector& collector, std::uint32_t item, const Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
        std::array<Vec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = mesh.positions[mesh.position_indices[3 * i + k]];
        collector.add(item, corners);
    }
}

} // namespace

SolidFaces solid_faces(const Geometry& geometry) {
    SolidFaces faces;
    FaceCollector collector(faces);
    for (std::uint32_t i = 0; i < geometry.items.size(); ++i) {
        const Item& item = geometry.items[i];
        if (item.kind == ItemKind::triangle) {
            collector.add(i, geometry.triangles[item.index].corners);
        } else if (item.kind == ItemKind::patch) {
            collector.add(i, geometry.patches[item.index].corners);
        } else if (item.kind == ItemKind::polygon) {
            const Polygon& polygon = geometry.polygons[item.index];
            collector.add(
                i,
                std::span(geometry.corners).subspan(polygon.first_corner, polygon.corner_count),
                polygon.shape == Polygon::Shape::split_quadrangle);
        } else if (item.kind == ItemKind::mesh) {
            add_mesh(collector, i, geometry.meshes[item.index]);
        }
    }
    collector.join_points();
    return faces;
}

} // namespace vera
