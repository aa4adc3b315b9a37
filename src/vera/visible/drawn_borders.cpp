// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/drawn_borders.h"

#include "vera/base/long_loop.h"
#include "vera/base/parallel.h"
#include "vera/base/progress_part.h"
#include "vera/drawing/elliptic_arc.h"
#include "vera/visible/line_tracks.h"
#include "vera/visible/outline_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

namespace vera {

namespace {

/// A side of a ring: the way from one vertex of the map to another.
struct Side {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::uint32_t region = 0;
    std::uint32_t across = no_region;

    friend auto operator<=>(const Side&, const Side&) = default;
};

/// Those of all rings, by the number of their first vertex among ring_vertices.
std::vector<Side> sides_of(const VisibleMap& map) {
    std::vector<Side> sides(map.ring_vertices.size());
    for (const VisibleMap::Ring& ring : map.rings)
        for (std::size_t i = 0; i < ring.count; ++i)
            sides[ring.first + i] = {
                map.ring_vertices[ring.first + i],
                map.ring_vertices[ring.first + (i + 1 == ring.count ? 0 : i + 1)],
                ring.region,
                map.ring_across[ring.first + i]};
    return sides;
}

OutlineCurves curves_of(const MapSources& sources) {
    std::vector<std::uint64_t> primitives;
    for (const VisibleMap::Region& region : sources.map.regions) {
        const std::uint32_t facet = sources.faces.first_facet[region.source];
        const std::uint64_t primitive = sources.facets.triangles[facet].primitive;
        if (primitives.empty() || primitives.back() != primitive)
            primitives.push_back(primitive);
    }
    return {sources.scene, sources.camera_map, sources.picture, primitives};
}

bool is_at_rim(std::int32_t whole, std::int64_t numerator) {
    return numerator == 0 && (whole == 0 || whole == screen_size);
}

class BorderMaker {
public:
    BorderMaker(const MapSources& sources, const CancelFlag* cancel)
        : sources_(sources)
        , cancel_(cancel)
        , tolerance_(curve_tolerance(sources.picture, sources.deviation))
        , curves_(curves_of(sources))
        , borders_(straight_borders(sources.map, sources.picture)) {
        borders_.curves = BorderCurves(curves_.all());
    }

    DrawnBorders take(const Progress& progress) {
        StageProgress stages(progress, 4);
        if (curves_.all().empty())
            return std::move(borders_);
        sides_ = sides_of(sources_.map);
        stages.next(2);
        find_curves();
        stages.next(1);
        place_vertices();
        stages.next(1);
        leave_out_what_does_not_fit();
        return std::move(borders_);
    }

private:
    const Facets::Triangle& facet_of(std::uint32_t region) const {
        const std::uint32_t source = sources_.map.regions[region].source;
        return sources_.facets.triangles[sources_.faces.first_facet[source]];
    }

    /// Whether no surface goes on smoothly from one region to the other.
    bool is_outline(const Side& side) const {
        if (side.across == no_region)
            return true;
        const Facets::Triangle& a = facet_of(side.region);
        const Facets::Triangle& b = facet_of(side.across);
        return a.primitive != b.primitive
            || shows_outside(sources_.facets, a, sources_.camera)
            != shows_outside(sources_.facets, b, sources_.camera);
    }

    bool are_of_one_piece(const Side& side) const {
        if (side.across == no_region)
            return false;
        const Facets::Triangle& a = facet_of(side.region);
        const Facets::Triangle& b = facet_of(side.across);
        return a.primitive == b.primitive && a.piece == b.piece;
    }

    /// The same for both regions beside it.
    std::uint32_t curve_of(const Side& side) const {
        const bool outline = is_outline(side);
        std::array<std::uint32_t, 2> regions = {side.region, side.across};
        if (regions[1] < regions[0])
            std::swap(regions[0], regions[1]);
        if (!outline && are_of_one_piece(side))
            return no_curve;
        for (const std::uint32_t region : regions) {
            if (region == no_region)
                continue;
            const std::uint32_t curve = curves_.curve_of(
                facet_of(region),
                outline,
                {borders_.places[side.from], borders_.places[side.to]},
                tolerance_);
            if (curve != no_curve)
                return curve;
        }
        return no_curve;
    }

    void find_curves() {
        borders_.side_curves.assign(sides_.size(), no_curve);
        parallel_ranges(sides_.size(), 1024, [&](std::size_t first, std::size_t last) {
            stop_if_raised(cancel_);
            for (std::size_t i = first; i < last; ++i)
                borders_.side_curves[i] = curve_of(sides_[i]);
        });
        for (const std::size_t side : sources_.map.joined_sides)
            borders_.side_curves[side] = no_curve;
    }

    /// What a vertex is to lie upon: its sides.
    struct Constraint {
        std::uint32_t vertex = 0;
        std::uint32_t curve = no_curve; ///< curves come first
        std::uint32_t other_end = 0;    ///< of a straight side
    };

    /// Which vertices lie on curves and may be moved.
    std::vector<std::uint8_t> moving_vertices() const {
        std::vector<std::uint8_t> is_moving(borders_.places.size());
        for (std::size_t i = 0; i < sides_.size(); ++i)
            if (borders_.side_curves[i] != no_curve)
                is_moving[sides_[i].from] = is_moving[sides_[i].to] = 1;
        keep_where_regions_touch(is_moving);
        // Nothing tells what is beyond these.
        for (const std::size_t side : sources_.map.joined_sides)
            is_moving[sides_[side].from] = is_moving[sides_[side].to] = 0;
        return is_moving;
    }

    /// Of all vertices that move, those of one after the other.
    std::vector<Constraint> constraints() const {
        const std::vector<std::uint8_t> is_moving = moving_vertices();
        std::vector<Constraint> all;
        const LongLoop loop(sides_.size(), {}, cancel_);
        for (std::size_t i = 0; i < sides_.size(); ++i) {
            loop.turn(i);
            // Where facets of one piece meet there is no line: it may turn.
            if (borders_.side_curves[i] == no_curve && are_of_one_piece(sides_[i]))
                continue;
            for (const auto& [vertex, other] :
                 {std::pair(sides_[i].from, sides_[i].to), std::pair(sides_[i].to, sides_[i].from)})
                if (is_moving[vertex] != 0)
                    all.push_back({vertex, borders_.side_curves[i], other});
        }
        std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
            return std::tie(a.vertex, a.curve, a.other_end)
                < std::tie(b.vertex, b.curve, b.other_end);
        });
        return all;
    }

    void place_vertices() {
        const std::vector<Constraint> all = constraints();
        std::vector<std::size_t> starts; // of each vertex
        for (std::size_t i = 0; i < all.size(); ++i)
            if (i == 0 || all[i].vertex != all[i - 1].vertex)
                starts.push_back(i);
        const std::size_t count = starts.size();
        starts.push_back(all.size());
        // All by where the others were.
        std::vector<DrawingPoint> places(count);
        parallel_ranges(count, 256, [&](std::size_t first, std::size_t last) {
            stop_if_raised(cancel_);
            for (std::size_t i = first; i < last; ++i)
                places[i] = place_on(std::span(all).subspan(starts[i], starts[i + 1] - starts[i]));
        });
        for (std::size_t i = 0; i < count; ++i)
            borders_.places[all[starts[i]].vertex] = places[i];
    }

    /// Where a region touches another's border in a point alone, that border has no vertex there,
    /// and must stay where it is.
    void keep_where_regions_touch(std::vector<std::uint8_t>& is_moving) const {
        std::vector<Side> moving;
        for (const Side& side : sides_)
            if (side.across != no_region && (is_moving[side.from] != 0 || is_moving[side.to] != 0))
                moving.push_back(side);
        std::sort(moving.begin(), moving.end());
        std::vector<std::uint32_t> kept;
        for (const Side& side : moving)
            if (const Side back = {side.to, side.from, side.across, side.region};
                !std::binary_search(moving.begin(), moving.end(), back))
                kept.insert(kept.end(), {side.from, side.to});
        for (const std::uint32_t vertex : kept)
            is_moving[vertex] = 0;
    }

    /// The different lines that the constraints of one vertex ask for.
    std::vector<LineTrack> tracks_of(std::span<const Constraint> constraints) const {
        const auto is_parallel = [](DrawingPoint a, DrawingPoint b) {
            constexpr double hardly = 1e-6; // radians
            return std::abs(a.x * b.y - a.y * b.x) <= hardly * distance(a, {}) * distance(b, {});
        };
        const DrawingPoint place = borders_.places[constraints.front().vertex];
        std::vector<LineTrack> tracks;
        for (const Constraint& constraint : constraints) {
            LineTrack track;
            if (constraint.curve != no_curve) {
                track.ellipse = &curves_[constraint.curve];
            } else {
                const DrawingPoint to = borders_.places[constraint.other_end];
                track = {nullptr, place, {to.x - place.x, to.y - place.y}};
                if (to == place)
                    continue;
            }
            const bool is_new = std::none_of(tracks.begin(), tracks.end(), [&](const auto& other) {
                return track.ellipse == other.ellipse
                    && (track.ellipse != nullptr || is_parallel(track.direction, other.direction));
            });
            if (is_new)
                tracks.push_back(track);
        }
        return tracks;
    }

    /// The side of the frame on which the vertex lies; of a corner, none.
    std::optional<LineTrack> frame_at(std::uint32_t vertex, bool& is_corner) const {
        const RationalPoint& point = sources_.map.vertices[vertex];
        const bool at_x = is_at_rim(point.whole.x, point.x_numerator);
        const bool at_y = is_at_rim(point.whole.y, point.y_numerator);
        is_corner = at_x && at_y;
        if (at_x == at_y)
            return std::nullopt;
        return LineTrack{
            nullptr, borders_.places[vertex], at_x ? DrawingPoint{0, 1} : DrawingPoint{1, 0}};
    }

    DrawingPoint place_on(std::span<const Constraint> constraints) const {
        constexpr double far = 4; // times the tolerance, along lines that cross at a slant
        const std::uint32_t vertex = constraints.front().vertex;
        const DrawingPoint from = borders_.places[vertex];
        const std::vector<LineTrack> tracks = tracks_of(constraints);
        if (tracks.empty() || tracks.front().ellipse == nullptr)
            return from;
        bool is_corner = false;
        if (const auto frame = frame_at(vertex, is_corner); frame || is_corner) {
            const DrawingPoint crossing =
                frame ? crossing_near(*frame, tracks.front(), from) : from;
            return distance(crossing, from) <= far * tolerance_ ? crossing : from;
        }
        const DrawingPoint nearest = nearest_on(tracks.front(), from);
        if (tracks.size() == 1)
            return nearest;
        const bool are_two = tracks.size() == 2;
        if (!are_two && tracks[1].ellipse == nullptr)
            return nearest;
        // Other lines through the vertex turn with it.
        const DrawingPoint crossing = crossing_near(tracks[0], tracks[1], from);
        return distance(crossing, from) <= (are_two ? far : 1) * tolerance_ ? crossing : nearest;
    }

    /// Whether the ends of the side are on the curve, and the arc between them is near its chord.
    bool fits(const Side& side, std::uint32_t curve) const {
        constexpr double hardly = 1e-7; // pixels
        const DrawingEllipse& ellipse = curves_[curve];
        const DrawingPoint a = borders_.places[std::min(side.from, side.to)];
        const DrawingPoint b = borders_.places[std::max(side.from, side.to)];
        const double begin = nearest_degrees(ellipse, a);
        const double sweep = turned(begin, nearest_degrees(ellipse, b));
        if (distance(a, point_at(ellipse, begin)) > hardly
            || distance(b, point_at(ellipse, begin + sweep)) > hardly)
            return false;
        const DrawingPoint chord = {b.x - a.x, b.y - a.y};
        const double squared = chord.x * chord.x + chord.y * chord.y;
        for (const double part : {0.25, 0.5, 0.75}) {
            const DrawingPoint on = point_at(ellipse, begin + part * sweep);
            const double along =
                squared > 0 ? ((on.x - a.x) * chord.x + (on.y - a.y) * chord.y) / squared : 0;
            const double at = std::clamp(along, 0.0, 1.0);
            if (distance(on, {a.x + at * chord.x, a.y + at * chord.y}) > 2 * tolerance_)
                return false;
        }
        return true;
    }

    void leave_out_what_does_not_fit() {
        parallel_ranges(sides_.size(), 1024, [&](std::size_t first, std::size_t last) {
            stop_if_raised(cancel_);
            for (std::size_t i = first; i < last; ++i)
                if (std::uint32_t& curve = borders_.side_curves[i];
                    curve != no_curve && !fits(sides_[i], curve))
                    curve = no_curve;
        });
    }

    const MapSources& sources_;
    const CancelFlag* cancel_;
    double tolerance_;
    OutlineCurves curves_;
    DrawnBorders borders_;
    std::vector<Side> sides_;
};

} // namespace

BorderRing DrawnBorders::ring(const VisibleMap& map, const VisibleMap::Ring& ring) const {
    BorderRing points;
    points.reserve(ring.count);
    for (std::size_t i = ring.first; i < ring.first + ring.count; ++i) {
        const std::size_t before = (i == ring.first ? i + ring.count : i) - 1;
        points.push_back(point(map, i));
        points.back().is_node = map.ring_across[i] != map.ring_across[before];
    }
    return points;
}

DrawnBorders straight_borders(const VisibleMap& map, const PictureSettings& picture) {
    DrawnBorders borders;
    borders.places.reserve(map.vertices.size());
    for (const PackedPoint& vertex : map.vertices)
        borders.places.push_back(in_pixels(picture, vertex));
    return borders;
}

DrawnBorders
curved_borders(const MapSources& sources, const Progress& progress, const CancelFlag* cancel) {
    return BorderMaker(sources, cancel).take(progress);
}

} // namespace vera
