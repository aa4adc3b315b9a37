// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/theory/profile.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/edges.h"
#include "vera/visible/screen_scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// Puts together the pieces of edges that are seen from what is seen of each triangle: an edge
/// is seen where on its two sides different sources are, or one and the background.
class SeenSides {
public:
    /// All must outlive this.
    SeenSides(
        const ScreenScene& scene,
        const ScreenEdges& edges,
        const SweepSegments& segments,
        Upward upward);

    /// Of a triangle is seen what lies between the two profiles where `floor` is; the roof, its
    /// upper sides, is higher there.
    void
    add(std::uint32_t triangle, const Profile& roof, const Profile& floor, ProfileMerge& merge);

    /// By their edges; the points each once. To be asked once all triangles are added.
    VisiblePieces pieces();

private:
    /// A part of a segment on one side of which a triangle is seen, in the direction of the
    /// segment.
    struct Side {
        std::uint32_t segment = no_segment;
        bool is_left = false;
        RationalPoint from;
        RationalPoint to;
        std::uint32_t triangle = no_triangle;
    };

    /// What is seen of the triangle between two segments from one x to another.
    struct Slab {
        SweepPoint from;
        SweepPoint to;
        std::uint32_t roof = no_segment;
        std::uint32_t floor = no_segment;
        bool goes_on = false; ///< from the slab before, in more than one point
    };

    /// Where what is seen of the triangle begins or ends along a column.
    struct Vertical {
        std::uint32_t triangle = no_triangle;
        bool is_left = false;
        RationalPoint from;
        RationalPoint to;
    };

    /// A part of an edge with what is seen on its sides.
    struct Part {
        std::uint32_t edge = 0;
        RationalPoint from; ///< in the direction of the edge
        RationalPoint to;
        std::uint32_t left = no_triangle;
        std::uint32_t right = no_triangle;
    };

    RationalPoint point(std::uint32_t segment, const SweepPoint& at, std::uint32_t crossed) const;
    bool does_go_on(const Slab& before, const Slab& after) const;
    void add_roofs(std::uint32_t triangle, std::span<const Slab> slabs);
    void add_floors(std::uint32_t triangle, std::span<const Slab> slabs);
    void add_verticals(std::uint32_t triangle, std::span<const Slab> slabs);
    void add_vertical(
        std::uint32_t triangle, const RationalPoint& one, const RationalPoint& other, bool is_left);
    void add_sides_of(const Vertical& vertical);
    void add_parts(std::span<const Side> sides);
    void add_part(
        const Side* left, const Side* right, const RationalPoint& from, const RationalPoint& to);

    const ScreenScene& scene_;
    const ScreenEdges& edges_;
    const SweepSegments& segments_;
    bool is_left_above_ = true; ///< the left of what goes from left to right is the higher side
    std::vector<std::uint32_t> vertical_; ///< segments, by their beginnings
    std::vector<Side> sides_;
    std::vector<Vertical> verticals_;
    std::vector<Part> parts_;
};

} // namespace vera
