// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/outline_strokes.h"

#include "vera/base/free_room.h"
#include "vera/base/long_loop.h"
#include "vera/base/parallel.h"
#include "vera/base/progress_part.h"
#include "vera/base/spent_pages.h"
#include "vera/drawing/elliptic_arc.h"
#include "vera/visible/curve_parts.h"
#include "vera/visible/hidden_intersections.h"
#include "vera/visible/hidden_parts.h"
#include "vera/visible/line_chains.h"
#include "vera/visible/line_rules.h"
#include "vera/visible/line_tracks.h"
#include "vera/visible/outline_curves.h"
#include "vera/visible/point_numbers.h"
#include "vera/visible/second_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace vera {

namespace {

/// The lines of a drawing in parts, and the points between them where these are not the map's
/// vertices alone.
struct LineParts {
    std::vector<LinePart> parts;
    std::vector<PackedPoint> points;
};

/// A straight way that joins others round what is seen of a face.
struct JoinedSide {
    LineEnds ends = {}; ///< the smaller one first
    std::uint32_t face = 0;

    friend auto operator<=>(const JoinedSide&, const JoinedSide&) = default;
};

std::vector<JoinedSide> joined_sides(const VisibleMap& map) {
    std::vector<JoinedSide> sides;
    for (const std::size_t place : map.joined_sides) {
        const auto after = std::upper_bound(
            map.rings.begin(),
            map.rings.end(),
            place,
            [](std::size_t at, const VisibleMap::Ring& ring) { return at < ring.first; });
        const VisibleMap::Ring& ring = *(after - 1);
        const std::size_t next = place + 1 == ring.first + ring.count ? ring.first : place + 1;
        const auto [smaller, larger] =
            std::minmax(map.ring_vertices[place], map.ring_vertices[next]);
        sides.push_back({{smaller, larger}, ring.source});
    }
    std::sort(sides.begin(), sides.end());
    return sides;
}

/// Where two faces that pass through each other do so within a step of an edge, no piece parts
/// them: the ways round what is seen of both are joined there by the same straight one.
void add_joined_parts(
    const StrokeSources& sources, const LineRules& rules, std::vector<LinePart>& parts) {
    const std::vector<JoinedSide> sides = joined_sides(sources.map);
    for (std::size_t i = 1; i < sides.size(); ++i) {
        const JoinedSide& one = sides[i - 1];
        const JoinedSide& other = sides[i];
        if (one.ends != other.ends || one.face == other.face)
            continue;
        const std::optional<LineClass> line_class =
            rules.class_of_meeting(one.ends, one.face, other.face);
        const RationalPoint begin = sources.map.vertices[one.ends[0]];
        const RationalPoint end = sources.map.vertices[one.ends[1]];
        // Within one step of the grid there is nothing to see, nor a direction.
        if (!line_class || begin.whole == end.whole)
            continue;
        LinePart& part = parts.emplace_back();
        part.ends = one.ends;
        part.step = step(begin.whole, end.whole);
        part.line_class = *line_class;
        part.faces = {one.face, other.face};
        ++i; // one line for all that are joined there
    }
}

/// Those of the classes that are drawn. Where no hidden lines are, nothing asks for the pieces
/// again.
std::vector<LinePart> visible_parts(
    StrokeSources& sources,
    const LineRules& rules,
    const ExtraLines& extra,
    const CancelFlag* cancel) {
    constexpr std::uint8_t no_class = 255;
    std::vector<VisiblePiece>& pieces = sources.pieces.pieces;
    std::vector<std::uint8_t> classes(pieces.size());
    parallel_ranges(pieces.size(), 1024, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        for (std::size_t i = first; i < last; ++i) {
            const std::optional<LineClass> found = rules.class_of(pieces[i]);
            const bool is_drawn = found && (extra.shadows || found != LineClass::shadow);
            classes[i] = is_drawn ? static_cast<std::uint8_t>(*found) : no_class;
        }
    });
    const auto face_of = [&](std::uint32_t triangle) {
        return triangle == no_triangle ? no_source : sources.screen.triangles[triangle].source;
    };
    std::vector<LinePart> parts;
    parts.reserve(
        classes.size()
        - static_cast<std::size_t>(std::count(classes.begin(), classes.end(), no_class))
        + sources.map.joined_sides.size() / 2);
    // A few at a time, as the parts may take the room of the pieces before.
    constexpr std::size_t at_a_time = 65536;
    for (std::size_t begin = 0; begin < pieces.size(); begin += at_a_time) {
        stop_if_raised(cancel);
        const std::size_t end = std::min(pieces.size(), begin + at_a_time);
        for (std::size_t i = begin; i < end; ++i) {
            if (classes[i] == no_class)
                continue;
            LinePart& part = parts.emplace_back();
            part.ends = {pieces[i].from, pieces[i].to};
            part.step = step(
                sources.screen.vertices[pieces[i].edge.begin].point,
                sources.screen.vertices[pieces[i].edge.end].point);
            part.line_class = static_cast<LineClass>(classes[i]);
            part.faces = {face_of(pieces[i].left), face_of(pieces[i].right)};
            part.is_between_neighbours = rules.is_between_neighbours(pieces[i]);
        }
        if (!extra.hidden)
            give_back_spent(pieces, begin, end);
    }
    add_joined_parts(sources, rules, parts);
    return parts;
}

/// Of different things, or of one that is not smooth there.
std::vector<HiddenIntersection>
intersections_of(const StrokeSources& sources, const CancelFlag* cancel) {
    const ScreenScene& uncut = sources.uncut;
    const auto facet_of = [&](std::uint32_t triangle) -> const Facets::Triangle& {
        const std::uint32_t face = uncut.triangles[triangle].source;
        return sources.facets.triangles[sources.faces.first_facet[face]];
    };
    const auto is_asked = [&](std::uint32_t one, std::uint32_t other) {
        const Facets::Triangle& a = facet_of(one);
        const Facets::Triangle& b = facet_of(other);
        return a.primitive != b.primitive || a.piece != b.piece;
    };
    return hidden_intersections(uncut, is_asked, cancel);
}

void add_hidden_parts(
    const StrokeSources& sources,
    const LineRules& rules,
    const Progress& progress,
    const CancelFlag* cancel,
    LineParts& lines) {
    const ScreenEdges& edges = rules.edges();
    const std::vector<HiddenIntersection> intersections = intersections_of(sources, cancel);
    const std::vector<HiddenPart> hidden = hidden_parts(
        sources.screen,
        edges,
        rules.drawn_edges(cancel),
        sources.pieces,
        intersections,
        progress,
        cancel);
    PointNumbers numbers(lines.points, lines.points.size() + 2 * hidden.size());
    const LongLoop loop(hidden.size(), {}, cancel);
    for (std::size_t i = 0; i < hidden.size(); ++i) {
        loop.turn(i);
        const HiddenPart& part = hidden[i];
        LinePart& line = lines.parts.emplace_back();
        line.ends = {numbers.number(part.from), numbers.number(part.to)};
        line.line_class = LineClass::hidden;
        if (part.edge >= edges.edges.size()) {
            const HiddenIntersection& intersection = intersections[part.edge - edges.edges.size()];
            line.step = step(intersection.begin, intersection.end);
            for (std::size_t j = 0; j < 2; ++j)
                line.faces[j] = sources.uncut.triangles[intersection.triangles[j]].source;
            continue;
        }
        const auto& [begin, end] = edges.edges[part.edge];
        const auto triangles = rules.edge_triangles().of(part.edge);
        line.step = step(sources.screen.vertices[begin].point, sources.screen.vertices[end].point);
        line.faces = {
            sources.screen.triangles[triangles.front()].source,
            sources.screen.triangles[triangles.back()].source};
    }
}

double tolerance(const StrokeSources& sources) {
    return curve_tolerance(sources.picture, sources.deviation);
}

OutlineCurves curves_of(const StrokeSources& sources, const std::vector<LinePart>& parts) {
    std::vector<std::uint8_t> has_lines(sources.faces.first_facet.size());
    for (const LinePart& part : parts)
        for (const std::uint32_t face : part.faces)
            if (face != no_source)
                has_lines[face] = 1;
    std::vector<std::uint64_t> primitives;
    for (std::size_t face = 0; face < has_lines.size(); ++face)
        if (has_lines[face] != 0)
            primitives.push_back(
                sources.facets.triangles[sources.faces.first_facet[face]].primitive);
    std::sort(primitives.begin(), primitives.end());
    primitives.erase(std::unique(primitives.begin(), primitives.end()), primitives.end());
    return {sources.scene, sources.camera_map, sources.picture, primitives};
}

/// Of facets along a silhouette, those that hide behind others may be farther off it.
double tolerance_of(const StrokeSources& sources, LineClass line_class) {
    return (line_class == LineClass::hidden ? 3 : 1) * tolerance(sources);
}

void find_curves(
    const StrokeSources& sources,
    const OutlineCurves& curves,
    const std::vector<DrawingPoint>& places,
    const CancelFlag* cancel,
    std::vector<LinePart>& parts) {
    parallel_ranges(parts.size(), 1024, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        for (std::size_t i = first; i < last; ++i)
            for (const std::uint32_t face : parts[i].faces)
                if (face != no_source && parts[i].curve == no_curve)
                    parts[i].curve = curves.curve_of(
                        sources.facets.triangles[sources.faces.first_facet[face]],
                        parts[i].line_class == LineClass::silhouette
                            || parts[i].line_class == LineClass::hidden,
                        {places[parts[i].ends[0]], places[parts[i].ends[1]]},
                        tolerance_of(sources, parts[i].line_class));
    });
}

/// What a point at which a line ends is to lie upon.
struct Constraint {
    std::uint32_t vertex = 0;
    std::uint32_t curve = no_curve; ///< or the straight line through the point along step
    ScreenStep step;

    bool is_same_as(const Constraint& other) const {
        return curve == other.curve && (curve != no_curve || cross(step, other.step) == 0);
    }
};

/// Of the points on curves, sorted by point, curves first.
std::vector<Constraint>
constraints_of(const std::vector<LinePart>& parts, std::size_t point_count) {
    std::vector<std::uint8_t> is_on_curve(point_count);
    for (const LinePart& part : parts)
        if (part.curve != no_curve)
            for (const std::uint32_t vertex : part.ends)
                is_on_curve[vertex] = 1;
    std::vector<Constraint> constraints;
    for (const LinePart& part : parts)
        for (const std::uint32_t vertex : part.ends)
            if (is_on_curve[vertex] != 0)
                constraints.push_back({vertex, part.curve, part.step});
    std::stable_sort(
        constraints.begin(), constraints.end(), [](const Constraint& a, const Constraint& b) {
            return std::tie(a.vertex, a.curve) < std::tie(b.vertex, b.curve);
        });
    return constraints;
}

/// Moves points of curves, which lie on facets, to these: those where two of them cross, or one and
/// a straight line, to where they do.
void move_to_curves(
    const StrokeSources& sources,
    const OutlineCurves& curves,
    const std::vector<LinePart>& parts,
    const CancelFlag* cancel,
    std::vector<DrawingPoint>& places) {
    const std::vector<Constraint> constraints = constraints_of(parts, places.size());
    const auto track = [&](const Constraint& to) {
        if (to.curve != no_curve)
            return LineTrack{&curves[to.curve], {}, {}};
        return LineTrack{
            nullptr,
            places[to.vertex],
            {static_cast<double>(to.step.x) * sources.picture.width,
             static_cast<double>(to.step.y) * sources.picture.height}};
    };
    for (std::size_t first = 0, last = 0; first < constraints.size(); first = last) {
        stop_if_raised(cancel);
        const Constraint& one = constraints[first];
        const Constraint* other = nullptr;
        for (; last < constraints.size() && constraints[last].vertex == one.vertex; ++last)
            if (other == nullptr && !constraints[last].is_same_as(one))
                other = &constraints[last];
        const DrawingPoint from = places[one.vertex];
        const DrawingPoint nearest = nearest_on(track(one), from);
        const DrawingPoint crossing =
            other != nullptr ? crossing_near(track(one), track(*other), from) : nearest;
        places[one.vertex] =
            distance(crossing, from) <= 4 * tolerance(sources) ? crossing : nearest;
    }
}

/// Makes strokes of chains.
class StrokeMaker {
public:
    StrokeMaker(
        const std::vector<LinePart>& parts,
        std::span<const CurveDegrees> degrees,
        const OutlineCurves& curves,
        const std::vector<DrawingPoint>& places)
        : parts_(parts)
        , degrees_(degrees)
        , curves_(curves)
        , places_(places) {}

    Stroke stroke(LineClass line_class, LineChain chain) const {
        begin_at_a_corner(chain);
        Stroke stroke;
        stroke.line_class = line_class;
        stroke.closed = chain.closed;
        stroke.points.reserve(point_count(chain));
        for (std::size_t i = 0; i < chain.parts.size(); ++i) {
            if (!has_point(chain, i))
                continue;
            if (const DrawingArc arc = arc_of(chain, i, stroke.points.size()); is_curved(arc))
                stroke.arcs.push_back(arc);
            stroke.points.push_back(places_[chain.vertices[i]]);
        }
        if (!chain.closed)
            stroke.points.push_back(places_[chain.vertices.back()]);
        return stroke;
    }

private:
    /// Whether its part number i does not go straight on from the one before.
    bool has_point(const LineChain& chain, std::size_t i) const {
        return i == 0 || !are_straight_on(chain.parts[i - 1], chain.parts[i]);
    }

    std::size_t point_count(const LineChain& chain) const {
        std::size_t count = chain.closed ? 0 : 1;
        for (std::size_t i = 0; i < chain.parts.size(); ++i)
            count += has_point(chain, i) ? 1 : 0;
        return count;
    }

    bool are_straight_on(std::uint32_t a, std::uint32_t b) const {
        return parts_[a].curve == no_curve && parts_[b].curve == no_curve
            && cross(parts_[a].step, parts_[b].step) == 0;
    }

    /// Where a closed chain has one.
    void begin_at_a_corner(LineChain& chain) const {
        for (std::size_t i = 0; chain.closed && i < chain.parts.size(); ++i)
            if (!are_straight_on(
                    chain.parts[i], chain.parts[i == 0 ? chain.parts.size() - 1 : i - 1])) {
                const auto by = static_cast<std::ptrdiff_t>(i);
                std::rotate(chain.parts.begin(), chain.parts.begin() + by, chain.parts.end());
                std::rotate(
                    chain.vertices.begin(), chain.vertices.begin() + by, chain.vertices.end());
                return;
            }
    }

    /// Of part number i of the chain, which may lead against the curve; of straight ones, none.
    DrawingArc arc_of(const LineChain& chain, std::size_t i, std::size_t segment) const {
        const LinePart& part = parts_[chain.parts[i]];
        if (part.curve == no_curve)
            return {};
        const bool forward = part.ends[0] == chain.vertices[i];
        const auto [begin, end] = degrees_[chain.parts[i] - (parts_.size() - degrees_.size())];
        return {segment, curves_[part.curve], forward ? begin : end, forward ? end : begin};
    }

    /// Whether it is to be told from a straight line.
    static bool is_curved(const DrawingArc& arc) {
        constexpr double flat = 1e-3; // pixels
        if (std::abs(arc.end_degrees - arc.begin_degrees) > 180)
            return true;
        const DrawingPoint a = point_at(arc.ellipse, arc.begin_degrees);
        const DrawingPoint b = point_at(arc.ellipse, arc.end_degrees);
        const DrawingPoint middle =
            point_at(arc.ellipse, (arc.begin_degrees + arc.end_degrees) / 2);
        return distance(middle, {(a.x + b.x) / 2, (a.y + b.y) / 2}) > flat;
    }

    const std::vector<LinePart>& parts_;
    std::span<const CurveDegrees> degrees_; ///< of the last of the parts, which are on curves
    const OutlineCurves& curves_;
    const std::vector<DrawingPoint>& places_;
};

/// Of the screen, which is forgotten with its pieces.
LineParts line_parts(
    StrokeSources& sources,
    const ExtraLines& extra,
    StageProgress& stages,
    const CancelFlag* cancel) {
    stages.next(2);
    LineParts lines;
    {
        const LineRules rules(
            sources.scene,
            sources.camera,
            sources.facets,
            sources.faces,
            sources.screen,
            sources.map.vertices);
        lines.parts = visible_parts(sources, rules, extra, cancel);
        stop_if_raised(cancel);
        const Progress of_hidden = stages.next(3);
        if (extra.hidden) {
            sources.pieces.points = sources.map.vertices;
            lines.points = sources.map.vertices;
            add_hidden_parts(sources, rules, of_hidden, cancel, lines);
        }
    }
    for (ScreenScene* screen : {&sources.screen, &sources.uncut}) {
        free_room(screen->triangles);
        free_room(screen->vertices);
    }
    free_room(sources.pieces.points);
    free_room(sources.pieces.pieces);
    return lines;
}

} // namespace

void add_strokes(
    StrokeSources sources,
    const ExtraLines& extra,
    const Progress& progress,
    const CancelFlag* cancel,
    Drawing& drawing) {
    StageProgress stages(progress, 10);
    const auto next_stage = [&](double weight) {
        stop_if_raised(cancel);
        return stages.next(weight);
    };
    LineParts lines = line_parts(sources, extra, stages, cancel);

    next_stage(1);
    const std::vector<PackedPoint>& points = extra.hidden ? lines.points : sources.map.vertices;
    std::vector<DrawingPoint> places;
    places.reserve(points.size());
    for (const PackedPoint& point : points)
        places.push_back(in_pixels(sources.picture, point));
    free_room(lines.points);
    leave_out_second_lines(
        sources.facets,
        sources.faces,
        places,
        tolerance_of(sources, LineClass::hidden),
        cancel,
        lines.parts);
    next_stage(2);
    const OutlineCurves curves = curves_of(sources, lines.parts);
    find_curves(sources, curves, places, cancel, lines.parts);
    move_to_curves(sources, curves, lines.parts, cancel, places);
    next_stage(1);
    const std::vector<CurveDegrees> degrees =
        unite_on_curves(curves, tolerance(sources), cancel, lines.parts, places);

    give_back_freed_memory(); // strokes are many small blocks, beside all that there is
    const StrokeMaker maker(lines.parts, degrees, curves, places);
    const Progress of_classes = next_stage(1);
    for (std::size_t i = 0; i < line_class_names.size(); ++i) {
        const auto line_class = static_cast<LineClass>(i);
        if (of_classes)
            of_classes(static_cast<double>(i) / static_cast<double>(line_class_names.size()));
        for_each_line_chain(
            lines.parts,
            line_class,
            places.size(),
            [&](LineChain chain) {
                stop_if_raised(cancel);
                drawing.strokes.push_back(maker.stroke(line_class, std::move(chain)));
            },
            [&](std::size_t count) { drawing.strokes.reserve(drawing.strokes.size() + count); });
    }
}

} // namespace vera
