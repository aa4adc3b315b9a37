// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/curve_parts.h"

#include "vera/base/long_loop.h"
#include "vera/drawing/elliptic_arc.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>

namespace vera {

namespace {

constexpr std::uint32_t no_vertex = ~std::uint32_t{0};
constexpr double whole_turn = 360;

/// A part of a curve in degrees, from 0 to 360: what leads beyond is two parts, which have no
/// vertex at their common end.
struct Interval {
    double begin = 0;
    double end = 0;
    std::uint32_t begin_vertex = no_vertex;
    std::uint32_t end_vertex = no_vertex;
};

struct OnCurve {
    std::uint32_t curve = 0;
    LineClass line_class = LineClass::silhouette;
    Interval interval;
};

bool is_before(const OnCurve& a, const OnCurve& b) {
    const auto key = [](const OnCurve& on) {
        return std::tuple(
            on.curve,
            -static_cast<int>(on.line_class), // the foremost first
            on.interval.begin,
            on.interval.end,
            on.interval.begin_vertex,
            on.interval.end_vertex);
    };
    return key(a) < key(b);
}

void add_part(
    const OutlineCurves& curves,
    const LinePart& part,
    const std::vector<DrawingPoint>& places,
    std::vector<OnCurve>& found) {
    const DrawingEllipse& ellipse = curves[part.curve];
    auto [from, to] = part.ends;
    double begin = nearest_degrees(ellipse, places[from]);
    double by = turned(begin, nearest_degrees(ellipse, places[to]));
    if (by < 0) {
        begin += by;
        by = -by;
        std::swap(from, to);
    }
    begin -= whole_turn * std::floor(begin / whole_turn);
    if (begin + by <= whole_turn) {
        found.push_back({part.curve, part.line_class, {begin, begin + by, from, to}});
        return;
    }
    found.push_back({part.curve, part.line_class, {begin, whole_turn, from, no_vertex}});
    found.push_back({part.curve, part.line_class, {0, begin + by - whole_turn, no_vertex, to}});
}

/// Of intervals by their beginnings, those that overlap, or all but touch, as one.
std::vector<Interval> united(std::span<const Interval> intervals, double gap) {
    std::vector<Interval> result;
    for (const Interval& next : intervals)
        if (result.empty() || next.begin > result.back().end + gap) {
            result.push_back(next);
        } else if (next.end > result.back().end) {
            result.back().end = next.end;
            result.back().end_vertex = next.end_vertex;
        }
    return result;
}

/// What of the intervals is left without others. Both are in order, and none overlap.
std::vector<Interval>
difference(std::span<const Interval> intervals, std::span<const Interval> others) {
    std::vector<Interval> result;
    for (Interval rest : intervals) {
        for (const Interval& other : others) {
            if (other.end <= rest.begin || other.begin >= rest.end)
                continue;
            if (other.begin > rest.begin)
                result.push_back({rest.begin, other.begin, rest.begin_vertex, other.begin_vertex});
            rest.begin = std::min(other.end, rest.end);
            rest.begin_vertex = other.end_vertex;
        }
        if (rest.begin < rest.end)
            result.push_back(rest);
    }
    return result;
}

/// Lets what was parted at the whole turn be one again.
void join_ends(std::vector<Interval>& intervals) {
    if (intervals.size() < 2 || intervals.front().begin > 0 || intervals.back().end < whole_turn)
        return;
    intervals.back().end = whole_turn + intervals.front().end;
    intervals.back().end_vertex = intervals.front().end_vertex;
    intervals.erase(intervals.begin());
}

/// Makes line parts of intervals.
class PartMaker {
public:
    PartMaker(
        const OutlineCurves& curves,
        std::vector<LinePart>& parts,
        std::vector<DrawingPoint>& places)
        : curves_(curves)
        , parts_(parts)
        , places_(places) {}

    void add(std::uint32_t curve, LineClass line_class, Interval interval) {
        constexpr double shortest = 1e-2; // pixels
        const DrawingEllipse& ellipse = curves_[curve];
        const DrawingPoint a = point_at(ellipse, interval.begin);
        const DrawingPoint b = point_at(ellipse, interval.end);
        if (distance(a, b) < shortest && interval.end - interval.begin < whole_turn / 2)
            return;
        const bool is_whole = interval.end - interval.begin >= whole_turn;
        if (is_whole)
            interval.begin_vertex = no_vertex; // no other line begins there
        if (interval.begin_vertex == no_vertex)
            interval.begin_vertex = new_point(a);
        if (is_whole)
            interval.end_vertex = interval.begin_vertex;
        if (interval.end_vertex == no_vertex)
            interval.end_vertex = new_point(b);
        LinePart part;
        part.ends = {interval.begin_vertex, interval.end_vertex};
        part.line_class = line_class;
        part.curve = curve;
        parts_.push_back(part);
        degrees_.push_back({interval.begin, interval.end});
    }

    std::vector<CurveDegrees> take_degrees() { return std::move(degrees_); }

private:
    std::uint32_t new_point(DrawingPoint place) {
        places_.push_back(place);
        return static_cast<std::uint32_t>(places_.size() - 1);
    }

    const OutlineCurves& curves_;
    std::vector<LinePart>& parts_;
    std::vector<DrawingPoint>& places_;
    std::vector<CurveDegrees> degrees_; ///< of the parts that were added
};

} // namespace

std::vector<CurveDegrees> unite_on_curves(
    const OutlineCurves& curves,
    double tolerance,
    const CancelFlag* cancel,
    std::vector<LinePart>& parts,
    std::vector<DrawingPoint>& places) {
    std::vector<OnCurve> all;
    for (const LinePart& part : parts)
        if (part.curve != no_curve)
            add_part(curves, part, places, all);
    std::sort(all.begin(), all.end(), is_before);
    std::erase_if(parts, [](const LinePart& part) { return part.curve != no_curve; });

    PartMaker maker(curves, parts, places);
    std::vector<Interval> covered;
    for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
        stop_if_raised(cancel);
        const auto [curve, line_class, none] = all[first];
        std::vector<Interval> intervals;
        for (; last < all.size() && all[last].curve == curve && all[last].line_class == line_class;
             ++last)
            intervals.push_back(all[last].interval);
        if (first == 0 || all[first - 1].curve != curve)
            covered.clear();
        // An angle of the ellipse is farthest across at the ends of the minor axis.
        const double degrees_per_pixel = 57.3 / distance(curves[curve].major, {});
        intervals = difference(united(intervals, tolerance * degrees_per_pixel), covered);
        covered.insert(covered.end(), intervals.begin(), intervals.end());
        std::sort(covered.begin(), covered.end(), [](const Interval& a, const Interval& b) {
            return a.begin < b.begin;
        });
        join_ends(intervals);
        for (const Interval& interval : intervals)
            maker.add(curve, line_class, interval);
    }
    return maker.take_degrees();
}

} // namespace vera
