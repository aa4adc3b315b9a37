// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/line_class.h"
#include "vera/scene/camera.h"
#include "vera/scene/facets.h"
#include "vera/scene/scene.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/edges.h"
#include "vera/visible/screen_scene.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vera {

/// Numbers of points.
using LineEnds = std::array<std::uint32_t, 2>;

/// Which edges are lines, and of which class.
class LineRules {
public:
    LineRules(
        const Scene& scene,
        const Camera& camera,
        const Facets& facets,
        const DrawnFaces& faces,
        const ScreenScene& screen,
        std::span<const PackedPoint> points);

    /// Of a piece that is seen, between two of the points; nothing where the frame cuts a surface,
    /// or one goes on smoothly.
    std::optional<LineClass> class_of(const VisiblePiece& piece) const;

    /// Of a line between two of the points, on whose sides two faces are seen, each on one; nothing
    /// where they do not meet along it.
    std::optional<LineClass>
    class_of_meeting(const LineEnds& ends, std::uint32_t face, std::uint32_t other_face) const;

    /// Whether the piece is where a facet of a curved surface covers one that has a corner in
    /// common with it: near its silhouette some do.
    bool is_between_neighbours(const VisiblePiece& piece) const;

    /// The edges at which a surface ends in the picture or makes a crease, seen or not, in
    /// ascending order: those of which hidden parts are drawn. Throws Cancelled.
    std::vector<std::uint32_t> drawn_edges(const CancelFlag* cancel = nullptr) const;

    const ScreenEdges& edges() const { return edges_; }

    const EdgeTriangles& edge_triangles() const { return triangles_; }

private:
    std::uint32_t face_of(std::uint32_t triangle) const;
    Vec3 normal_towards_viewer(std::uint32_t face) const;
    bool are_smooth(std::uint32_t one_face, std::uint32_t other_face) const;
    bool meet_there(const VisiblePiece& piece) const;
    bool meet_at(const LineEnds& ends, std::uint32_t triangle, std::uint32_t other) const;
    bool ends_there(const VisiblePiece& piece, std::uint32_t triangle, std::uint32_t other) const;
    bool goes_on_smoothly(std::uint32_t edge, std::uint32_t triangle) const;
    bool is_drawn(std::uint32_t edge) const;
    std::int64_t side_of(std::uint32_t edge, std::uint32_t triangle) const;

    const Scene& scene_;
    const Camera& camera_;
    const Facets& facets_;
    const DrawnFaces& faces_;
    const ScreenScene& screen_;
    std::span<const PackedPoint> points_;
    ScreenEdges edges_;
    EdgeTriangles triangles_;
    std::vector<std::uint32_t> triangle_of_face_; ///< one of them
};

} // namespace vera
