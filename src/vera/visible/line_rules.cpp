// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/line_rules.h"

#include "vera/base/long_loop.h"
#include "vera/math/vec3.h"
#include "vera/scene/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace vera {

namespace {

/// Faces that meet at less are one surface for the eye.
constexpr double smooth_cosine = 0.9;

/// Whether they have the same normals at two corners of both: parts of one curved surface.
bool join_smoothly(const Patch& a, const Patch& b) {
    std::size_t same = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            same += a.corners[i] == b.corners[k] && a.normals[i] == b.normals[k] ? 1 : 0;
    return same >= 2;
}

/// Of one mesh, as it were: triangles of one, or patches that join.
bool are_of_one_surface(const Scene& scene, std::uint64_t a, std::uint64_t b) {
    if (a == b)
        return true;
    const PrimitivePath path_a = path_to(scene, a);
    const PrimitivePath path_b = path_to(scene, b);
    if (path_a.geometry != path_b.geometry || path_a.to_world != path_b.to_world)
        return false;
    if (path_a.element.item == path_b.element.item)
        return true;
    const Geometry& geometry = *path_a.geometry;
    const Item& item_a = geometry.items[path_a.element.item];
    const Item& item_b = geometry.items[path_b.element.item];
    return item_a.kind == ItemKind::patch && item_b.kind == ItemKind::patch
        && join_smoothly(geometry.patches[item_a.index], geometry.patches[item_b.index]);
}

/// Whether both lie on one side of the frame, which cuts a surface there that goes on beyond it.
bool are_on_frame(const RationalPoint& a, const RationalPoint& b) {
    const auto both_at = [](std::int32_t one, std::int32_t other) {
        return one == other && (one == 0 || one == screen_size);
    };
    return (both_at(a.whole.x, b.whole.x) && a.x_numerator == 0 && b.x_numerator == 0)
        || (both_at(a.whole.y, b.whole.y) && a.y_numerator == 0 && b.y_numerator == 0);
}

} // namespace

LineRules::LineRules(
    const Scene& scene,
    const Camera& camera,
    const Facets& facets,
    const DrawnFaces& faces,
    const ScreenScene& screen,
    std::span<const PackedPoint> points)
    : scene_(scene)
    , camera_(camera)
    , facets_(facets)
    , faces_(faces)
    , screen_(screen)
    , points_(points)
    , edges_(screen_edges(screen))
    , triangles_(vera::edge_triangles(screen, edges_))
    , triangle_of_face_(faces.first_facet.size(), no_triangle) {
    for (std::uint32_t i = 0; i < screen.triangles.size(); ++i)
        triangle_of_face_[face_of(i)] = i;
}

std::uint32_t LineRules::face_of(std::uint32_t triangle) const {
    return screen_.triangles[triangle].source;
}

/// So that where a surface goes on beyond an edge, the angle is that by which it turns there, and
/// of a thin blade seen on its edge not the small one between its sides.
Vec3 LineRules::normal_towards_viewer(std::uint32_t face) const {
    const Facets::Triangle& facet = facets_.triangles[faces_.first_facet[face]];
    const auto corner = [&](std::size_t i) { return facets_.corners[facet.corners[i]]; };
    const Vec3 normal = normalized(cross(corner(1) - corner(0), corner(2) - corner(0)));
    const Vec3 view = camera_.projection == Camera::Projection::parallel
        ? camera_.direction
        : corner(0) - camera_.viewpoint;
    return dot(normal, view) > 0 ? -normal : normal;
}

/// Whether faces beside each other are one surface for the eye. Facets of one curved piece are,
/// however few there are of them; different things never, but for patches with the same normals.
bool LineRules::are_smooth(std::uint32_t one_face, std::uint32_t other_face) const {
    if (one_face == other_face)
        return true;
    const Facets::Triangle& a = facets_.triangles[faces_.first_facet[one_face]];
    const Facets::Triangle& b = facets_.triangles[faces_.first_facet[other_face]];
    if (a.primitive == b.primitive && a.piece == b.piece)
        return true;
    return dot(normal_towards_viewer(one_face), normal_towards_viewer(other_face)) >= smooth_cosine
        && are_of_one_surface(scene_, a.primitive, b.primitive);
}

bool LineRules::is_between_neighbours(const VisiblePiece& piece) const {
    if (piece.left == no_triangle || piece.right == no_triangle || meet_there(piece))
        return false;
    const Facets::Triangle& a = facets_.triangles[faces_.first_facet[face_of(piece.left)]];
    const Facets::Triangle& b = facets_.triangles[faces_.first_facet[face_of(piece.right)]];
    return a.primitive == b.primitive && a.piece == b.piece
        && std::find_first_of(
               a.corners.begin(), a.corners.end(), b.corners.begin(), b.corners.end())
        != a.corners.end();
}

bool LineRules::meet_there(const VisiblePiece& piece) const {
    return meet_at({piece.from, piece.to}, piece.left, piece.right);
}

/// Whether the planes of both triangles are equally near at both ends.
bool LineRules::meet_at(const LineEnds& ends, std::uint32_t triangle, std::uint32_t other) const {
    const std::array<DepthPlane, 2> planes = {
        plane_of(screen_, screen_.triangles[triangle]),
        plane_of(screen_, screen_.triangles[other])};
    for (const std::uint32_t end : ends) {
        const RationalPoint& point = points_[end];
        const double apart =
            std::abs(planes[0].value(point.x(), point.y()) - planes[1].value(point.x(), point.y()));
        double slope = 0;
        for (const DepthPlane& plane : planes)
            slope += (std::abs(static_cast<double>(plane.along_x))
                      + std::abs(static_cast<double>(plane.along_y)))
                / static_cast<double>(plane.area);
        if (!(apart <= 2 * slope + 4))
            return false;
    }
    return true;
}

/// Whether the triangle has a side along the piece, beyond which there is nothing of the scene's
/// surfaces but the other one.
bool LineRules::ends_there(
    const VisiblePiece& piece, std::uint32_t triangle, std::uint32_t other) const {
    const auto point = [&](std::uint32_t vertex) { return screen_.vertices[vertex].point; };
    const auto is_on_line = [&](std::size_t corner) {
        const std::uint32_t vertex = screen_.triangles[triangle].vertices[corner % 3];
        return orientation(point(piece.edge.begin), point(piece.edge.end), point(vertex)) == 0;
    };
    for (std::size_t side = 0; side < 3; ++side)
        if (is_on_line(side) && is_on_line(side + 1)) {
            const std::uint32_t edge = edges_.of_triangle[triangle][side];
            const auto all = triangles_.of(edge);
            return std::none_of(all.begin(), all.end(), [&](std::uint32_t beyond) {
                return beyond != other
                    && (side_of(edge, beyond) > 0) != (side_of(edge, triangle) > 0);
            });
        }
    return false;
}

std::optional<LineClass> LineRules::class_of(const VisiblePiece& piece) const {
    if (are_on_frame(points_[piece.from], points_[piece.to]))
        return std::nullopt;
    if (piece.left == no_triangle || piece.right == no_triangle)
        return LineClass::silhouette;
    if (face_of(piece.left) == face_of(piece.right))
        return LineClass::shadow;
    if (!meet_there(piece))
        return LineClass::silhouette;
    if (are_smooth(face_of(piece.left), face_of(piece.right)))
        return std::nullopt;
    return ends_there(piece, piece.left, piece.right) && ends_there(piece, piece.right, piece.left)
        ? LineClass::crease
        : LineClass::intersection;
}

std::optional<LineClass> LineRules::class_of_meeting(
    const LineEnds& ends, std::uint32_t face, std::uint32_t other_face) const {
    if (are_on_frame(points_[ends[0]], points_[ends[1]]) || are_smooth(face, other_face)
        || !meet_at(ends, triangle_of_face_[face], triangle_of_face_[other_face]))
        return std::nullopt;
    return LineClass::intersection;
}

/// Positive where the triangle, of which it is a side, lies to the left of the edge.
std::int64_t LineRules::side_of(std::uint32_t edge, std::uint32_t triangle) const {
    const auto& [begin, end] = edges_.edges[edge];
    const ScreenPoint a = screen_.vertices[begin].point;
    const ScreenPoint b = screen_.vertices[end].point;
    std::int64_t side = 0;
    for (const ScreenVertex& corner : corners_of(screen_, screen_.triangles[triangle]))
        if (const std::int64_t of_corner = orientation(a, b, corner.point); of_corner != 0)
            side = of_corner;
    return side;
}

bool LineRules::goes_on_smoothly(std::uint32_t edge, std::uint32_t triangle) const {
    const std::int64_t side = side_of(edge, triangle);
    const auto all = triangles_.of(edge);
    return std::any_of(all.begin(), all.end(), [&](std::uint32_t other) {
        // What is plane does not turn back, whatever the grid made of slivers cut from it.
        if (other != triangle && face_of(other) == face_of(triangle))
            return true;
        return (side_of(edge, other) > 0) != (side > 0)
            && are_smooth(face_of(triangle), face_of(other));
    });
}

bool LineRules::is_drawn(std::uint32_t edge) const {
    const auto& [begin, end] = edges_.edges[edge];
    const ScreenPoint a = screen_.vertices[begin].point;
    const ScreenPoint b = screen_.vertices[end].point;
    if (a == b || are_on_frame({a}, {b}))
        return false;
    const auto all = triangles_.of(edge);
    return !std::all_of(all.begin(), all.end(), [&](std::uint32_t triangle) {
        return goes_on_smoothly(edge, triangle);
    });
}

std::vector<std::uint32_t> LineRules::drawn_edges(const CancelFlag* cancel) const {
    std::vector<std::uint8_t> drawn(edges_.edges.size());
    parallel_ranges(drawn.size(), 4096, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        for (std::size_t i = first; i < last; ++i)
            drawn[i] = is_drawn(static_cast<std::uint32_t>(i)) ? 1 : 0;
    });
    std::vector<std::uint32_t> result;
    for (std::uint32_t i = 0; i < drawn.size(); ++i)
        if (drawn[i] != 0)
            result.push_back(i);
    return result;
}

} // namespace vera
