// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/second_lines.h"

#include "vera/base/long_loop.h"
#include "vera/drawing/elliptic_arc.h"
#include "vera/visible/screen_scene.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace vera {

namespace {

/// What is seen of the silhouettes of a primitive.
struct SeenPart {
    std::uint64_t primitive = 0;
    std::array<DrawingPoint, 2> ends;
};

double distance_to_segment(DrawingPoint point, const std::array<DrawingPoint, 2>& ends) {
    const DrawingPoint along = {ends[1].x - ends[0].x, ends[1].y - ends[0].y};
    const double size = along.x * along.x + along.y * along.y;
    const double on = size > 0
        ? std::clamp(
            ((point.x - ends[0].x) * along.x + (point.y - ends[0].y) * along.y) / size, 0.0, 1.0)
        : 0;
    return distance(point, {ends[0].x + on * along.x, ends[0].y + on * along.y});
}

class SeenSilhouettes {
public:
    SeenSilhouettes(
        const Facets& facets,
        const DrawnFaces& faces,
        std::span<const DrawingPoint> places,
        std::span<const LinePart> parts)
        : facets_(facets)
        , faces_(faces)
        , places_(places) {
        for (const LinePart& part : parts)
            for (const std::uint32_t face : part.faces)
                if (part.line_class == LineClass::silhouette && face != no_source)
                    seen_.push_back({facet(face).primitive, ends(part)});
        std::stable_sort(seen_.begin(), seen_.end(), [](const SeenPart& a, const SeenPart& b) {
            return a.primitive < b.primitive;
        });
    }

    /// Whether it is a hidden part, between two facets of one curved surface, along one of these.
    bool are_along(const LinePart& part, double tolerance) const {
        const auto [one, other] = part.faces;
        if (part.line_class != LineClass::hidden || one == other || one == no_source
            || other == no_source || facet(one).primitive != facet(other).primitive)
            return false;
        const auto [a, b] = ends(part);
        const std::uint64_t primitive = facet(one).primitive;
        return is_near(primitive, a, tolerance) && is_near(primitive, b, tolerance)
            && is_near(primitive, {(a.x + b.x) / 2, (a.y + b.y) / 2}, tolerance);
    }

private:
    const Facets::Triangle& facet(std::uint32_t face) const {
        return facets_.triangles[faces_.first_facet[face]];
    }

    std::array<DrawingPoint, 2> ends(const LinePart& part) const {
        return {places_[part.ends[0]], places_[part.ends[1]]};
    }

    bool is_near(std::uint64_t primitive, DrawingPoint point, double tolerance) const {
        auto seen = std::lower_bound(
            seen_.begin(), seen_.end(), primitive, [](const SeenPart& a, std::uint64_t number) {
                return a.primitive < number;
            });
        for (; seen != seen_.end() && seen->primitive == primitive; ++seen)
            if (distance_to_segment(point, seen->ends) <= tolerance)
                return true;
        return false;
    }

    const Facets& facets_;
    const DrawnFaces& faces_;
    std::span<const DrawingPoint> places_;
    std::vector<SeenPart> seen_; ///< by primitive
};

/// Leaves out, once, what of the lines that are seen is to go wherever nothing goes on at one of
/// its ends. Returns whether there was any.
template <typename IsToGo>
bool leave_out_loose_parts(
    std::size_t point_count, std::vector<LinePart>& parts, const IsToGo& is_to_go) {
    std::vector<std::uint32_t> count(point_count);
    for (const LinePart& part : parts)
        if (part.line_class != LineClass::hidden)
            for (const std::uint32_t vertex : part.ends)
                ++count[vertex];
    return std::erase_if(
               parts,
               [&](const LinePart& part) {
                   return part.line_class != LineClass::hidden && is_to_go(part)
                       && (count[part.ends[0]] == 1 || count[part.ends[1]] == 1);
               })
        > 0;
}

} // namespace

void leave_out_second_lines(
    const Facets& facets,
    const DrawnFaces& faces,
    std::span<const DrawingPoint> places,
    double tolerance,
    const CancelFlag* cancel,
    std::vector<LinePart>& parts) {
    const auto is_between_neighbours = [](const LinePart& part) {
        return part.is_between_neighbours;
    };
    while (leave_out_loose_parts(places.size(), parts, is_between_neighbours))
        stop_if_raised(cancel);
    // Shorter than facets may be off the surface.
    leave_out_loose_parts(places.size(), parts, [&](const LinePart& part) {
        const auto [one, other] = part.faces;
        return one != no_source && other != no_source
            && facets.triangles[faces.first_facet[one]].primitive
            == facets.triangles[faces.first_facet[other]].primitive
            && distance(places[part.ends[0]], places[part.ends[1]]) <= tolerance;
    });
    const auto is_hidden = [](const LinePart& part) {
        return part.line_class == LineClass::hidden;
    };
    if (std::ranges::none_of(parts, is_hidden))
        return;
    const SeenSilhouettes seen(facets, faces, places, parts);
    std::erase_if(parts, [&](const LinePart& part) {
        stop_if_raised(cancel);
        return seen.are_along(part, tolerance);
    });
}

} // namespace vera
