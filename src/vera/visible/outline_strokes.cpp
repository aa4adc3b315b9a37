// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/outline_strokes.h"

#include "vera/math/vec3.h"
#include "vera/scene/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vera {

namespace {

enum class LineClass : std::uint8_t { none, silhouette, crease };

/// Faces that meet at less are one surface for the eye.
constexpr double smooth_cosine = 0.9;

Vec3 normal_of_face(const StrokeSources& sources, std::uint32_t face) {
    const Facets::Triangle& facet = sources.facets.triangles[sources.faces.first_facet[face]];
    const auto corner = [&](std::size_t i) { return sources.facets.corners[facet.corners[i]]; };
    return normalized(cross(corner(1) - corner(0), corner(2) - corner(0)));
}

bool are_of_one_item(const Scene& scene, std::uint64_t a, std::uint64_t b) {
    if (a == b)
        return true;
    const PrimitivePath path_a = path_to(scene, a);
    const PrimitivePath path_b = path_to(scene, b);
    return path_a.geometry == path_b.geometry && path_a.element.item == path_b.element.item
        && path_a.to_world == path_b.to_world;
}

/// Whether both triangles have the place on one of their sides, equally near.
bool meet_there(const StrokeSources& sources, const VisiblePiece& piece) {
    std::array<DepthPlane, 2> planes;
    for (std::size_t i = 0; i < 2; ++i)
        planes[i] = plane_of(
            sources.screen, sources.screen.triangles[i == 0 ? piece.left : piece.right]);
    for (const RationalPoint& point : {piece.from, piece.to}) {
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

/// Whether faces that meet do so at an angle that is to be seen. Facets of one curved piece do not,
/// however few there are of them.
bool is_crease(const StrokeSources& sources, std::uint32_t one, std::uint32_t other) {
    const Facets::Triangle& a = sources.facets.triangles[sources.faces.first_facet[one]];
    const Facets::Triangle& b = sources.facets.triangles[sources.faces.first_facet[other]];
    if (a.primitive == b.primitive && a.piece == b.piece)
        return false;
    const double cosine = dot(normal_of_face(sources, one), normal_of_face(sources, other));
    return std::abs(cosine) < smooth_cosine
        || !are_of_one_item(sources.scene, a.primitive, b.primitive);
}

/// Whether the frame cuts a surface there, which goes on beyond it.
bool is_on_frame(const VisiblePiece& piece) {
    const RationalPoint& a = piece.from;
    const RationalPoint& b = piece.to;
    const auto both_at = [](std::int32_t one, std::int32_t other) {
        return one == other && (one == 0 || one == screen_size);
    };
    return (both_at(a.whole.x, b.whole.x) && a.x_numerator == 0 && b.x_numerator == 0)
        || (both_at(a.whole.y, b.whole.y) && a.y_numerator == 0 && b.y_numerator == 0);
}

LineClass class_of(const StrokeSources& sources, const VisiblePiece& piece) {
    if (is_on_frame(piece))
        return LineClass::none;
    if (piece.left == no_triangle || piece.right == no_triangle || !meet_there(sources, piece))
        return LineClass::silhouette;
    const std::uint32_t left = sources.screen.triangles[piece.left].source;
    const std::uint32_t right = sources.screen.triangles[piece.right].source;
    return is_crease(sources, left, right) ? LineClass::crease : LineClass::none;
}

/// Joins pieces of one class end to end.
class Chains {
public:
    Chains(std::span<const std::array<std::uint32_t, 2>> ends, std::size_t vertex_count)
        : ends_(ends)
        , at_(vertex_count) {}

    void add(std::uint32_t piece) {
        pieces_.push_back(piece);
        for (const std::uint32_t vertex : ends_[piece])
            at_[vertex].push_back(piece);
    }

    /// Calls visit(vertices, closed) for each chain.
    template <typename Visit>
    void for_each(const Visit& visit) {
        done_.assign(ends_.size(), 0);
        // Open chains from their ends on, then what is left: closed ones.
        for (const bool from_ends : {true, false})
            for (const std::uint32_t piece : pieces_)
                for (const std::uint32_t begin : ends_[piece])
                    if (done_[piece] == 0 && (!from_ends || at_[begin].size() != 2))
                        follow(piece, begin, visit);
    }

private:
    template <typename Visit>
    void follow(std::uint32_t piece, std::uint32_t begin, const Visit& visit) {
        std::vector<std::uint32_t> vertices = {begin};
        std::uint32_t here = begin;
        while (true) {
            done_[piece] = 1;
            here = ends_[piece][0] == here ? ends_[piece][1] : ends_[piece][0];
            if (here == begin)
                return visit(vertices, true);
            vertices.push_back(here);
            if (at_[here].size() != 2)
                return visit(vertices, false);
            const std::uint32_t next = at_[here][0] == piece ? at_[here][1] : at_[here][0];
            if (done_[next] != 0)
                return visit(vertices, false);
            piece = next;
        }
    }

    std::span<const std::array<std::uint32_t, 2>> ends_;
    std::vector<std::vector<std::uint32_t>> at_; ///< the pieces at each vertex
    std::vector<std::uint32_t> pieces_;
    std::vector<std::uint8_t> done_;
};

} // namespace

void add_strokes(const StrokeSources& sources, const PictureSettings& picture, Drawing& drawing) {
    const std::size_t count = sources.pieces.pieces.size();
    std::vector<LineClass> classes(count);
    parallel_ranges(count, 1024, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            classes[i] = class_of(sources, sources.pieces.pieces[i]);
    });
    for (const auto& [line_class, name] :
         {std::pair{LineClass::crease, "crease"}, {LineClass::silhouette, "silhouette"}}) {
        Chains chains(sources.map.piece_ends, sources.map.vertices.size());
        for (std::uint32_t i = 0; i < count; ++i)
            if (classes[i] == line_class)
                chains.add(i);
        chains.for_each([&, name = name](const std::vector<std::uint32_t>& vertices, bool closed) {
            Stroke stroke;
            stroke.line_class = name;
            stroke.closed = closed;
            for (const std::uint32_t vertex : vertices) {
                const RationalPoint& point = sources.map.vertices[vertex];
                stroke.points.push_back(
                    {point.x() * picture.width / screen_size,
                     point.y() * picture.height / screen_size});
            }
            drawing.strokes.push_back(std::move(stroke));
        });
    }
}

} // namespace vera
