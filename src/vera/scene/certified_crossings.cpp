// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/certified_crossings.h"

#include "vera/math/bracketed_zero.h"
#include "vera/scene/contour.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vera {

namespace {

using Point = ContourPiece::Point;

/// A branch of the ray in the half plane of r and h.
///
/// A steep ray is a graph over h: its radius is R(h), convex, and changes no faster than h. A flat
/// ray is two graphs over r >= its smallest radius, one for each half of it: its height is
/// height +- rise w(r), with w = sqrt((r^2 - c) / a) concave. Either way a contour point has a
/// signed distance from the branch, whose sign tells on which side it lies.
struct Branch {
    const AxialRay& axial;
    double side = 1; ///< flat: 1 or -1, the half of the ray after or before s = 0
};

/// A point of the contour and its place beside the branch.
struct Node {
    double v = 0;
    Point point;
    Point direction;
    double graph = 0;    ///< steep: R(h); flat: w(r)
    double distance = 0; ///< r - R(h), or h - height -+ rise w(r)
};

double graph_at(const AxialRay& axial, Point point) {
    if (axial.flat) {
        const double beyond = point.r * point.r - axial.c;
        return beyond > 0 ? std::sqrt(beyond / axial.a) : 0;
    }
    return std::sqrt(axial.radius_squared_at((point.h - axial.height) / axial.rise));
}

/// 0 where rounding could have given it the other sign, so that contact makes no random crossings.
double distance_from(const Branch& branch, Point point, double graph) {
    const AxialRay& axial = branch.axial;
    const double distance =
        axial.flat ? (point.h - axial.height) - branch.side * axial.rise * graph : point.r - graph;
    // Some ten roundings of these, of up to 2^-53 each.
    const double size = point.r + std::abs(point.h) + std::abs(axial.height) + graph;
    double rounding = 0x1p-49 * size;
    if (axial.flat) {
        // w is a root, which near 0 magnifies what rounding does to its square.
        const double of_square = 0x1p-50 * point.r * point.r / axial.a;
        rounding += std::abs(axial.rise) * of_square / std::max(graph, std::sqrt(of_square));
    }
    return std::abs(distance) <= rounding ? 0 : distance;
}

/// A point on the branch counts as before it, so that a contour that ends on the axis, where no
/// distance from a steep ray is positive, ends before every ray.
bool is_beyond(const Node& node) {
    return node.distance > 0;
}

/// A search along one piece. Its arcs are monotone in r and in h and turn to one side only, so that
/// the directions at an arc's ends bound those between.
class Search {
public:
    Search(const AxialRay& axial, const ContourPiece& piece, Point start)
        : branch_{axial}
        , piece_(piece)
        , start_(start)
        , hodograph_(hodograph(piece, start)) {
        for (const Point p : {start, piece.end, piece.control[0], piece.control[1]})
            size_ = std::max(size_, std::max(std::abs(p.r), std::abs(p.h)));
    }

    PieceCrossings run();

private:
    Node node_at(double v) const;
    void search_arc(double first, double last);
    void search(const Node& first, const Node& last, int depth);
    std::array<double, 4> derivatives(const Node& first, const Node& last) const;
    bool out_of_reach(
        const Node& first, const Node& last, const std::array<double, 4>& derivatives) const;
    double root_between(const Node& low, const Node& high) const;
    double parameter_at_radius(double radius, const Node& first, const Node& last) const;
    void report(double v);

    Branch branch_;
    const ContourPiece& piece_;
    Point start_;
    Hodograph hodograph_;
    double size_ = 0;
    /// Ends the search where contour and ray run along one another for a while.
    int steps_left_ = 4000;
    PieceCrossings found_;
};

Node Search::node_at(double v) const {
    Node node;
    node.v = v;
    node.point = vera::point_at(piece_, start_, v);
    node.direction = direction_at(hodograph_, v);
    node.graph = graph_at(branch_.axial, node.point);
    node.distance = distance_from(branch_, node.point, node.graph);
    return node;
}

/// The derivative of the distance along the contour, times the graph of the branch, for the four
/// pairs of a direction of the contour and a slope of the graph at either node. It is linear in
/// both, and both change in one sense between the nodes, so that these are its extremes.
std::array<double, 4> Search::derivatives(const Node& first, const Node& last) const {
    const AxialRay& axial = branch_.axial;
    std::array<double, 4> result = {};
    std::size_t i = 0;
    for (const Node* at : {&first, &last})
        for (const Point d : {first.direction, last.direction}) {
            if (axial.flat) {
                result[i++] =
                    d.h * axial.a * at->graph - branch_.side * axial.rise * at->point.r * d.r;
            } else {
                const double s = (at->point.h - axial.height) / axial.rise;
                result[i++] = d.r * at->graph - (axial.a * s + axial.b) / axial.rise * d.h;
            }
        }
    return result;
}

bool all_of_one_sign(const std::array<double, 4>& values) {
    return std::all_of(values.begin(), values.end(), [](double value) { return value >= 0; })
        || std::all_of(values.begin(), values.end(), [](double value) { return value <= 0; });
}

/// Whether the arc cannot reach the ray from its ends, which lie on the same side: by how far the
/// distance can change over a coordinate that it passes, r or h, with slopes no steeper than the
/// extremes.
bool Search::out_of_reach(
    const Node& first, const Node& last, const std::array<double, 4>& derivatives) const {
    const auto sum = [](double a, double b) { return std::abs(a) + std::abs(b); };
    const bool over_h =
        sum(first.direction.h, last.direction.h) > sum(first.direction.r, last.direction.r);
    const double way =
        std::abs(over_h ? last.point.h - first.point.h : last.point.r - first.point.r);
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (std::size_t i = 0; i < 4; ++i) {
        const Node& slope_of = i < 2 ? first : last;
        const Node& direction_of = i % 2 == 0 ? first : last;
        const double pace = std::abs(over_h ? direction_of.direction.h : direction_of.direction.r)
            * slope_of.graph * (branch_.axial.flat ? branch_.axial.a : 1);
        const double slope = derivatives[i] / pace;
        if (!std::isfinite(slope))
            return false;
        least = std::min(least, slope);
        most = std::max(most, slope);
    }
    // As if the distance were positive.
    double from = first.distance;
    double to = last.distance;
    if (from < 0 || to < 0) {
        from = -from;
        to = -to;
        std::swap(least, most);
        least = -least;
        most = -most;
    }
    // The lowest point of the two lines that bound it: from the first node down with the least
    // slope, and up to the last with the most.
    const double x = std::clamp((from - to + most * way) / (most - least), 0.0, way);
    return from + least * x > 0x1p-46 * size_ && to - most * (way - x) > 0x1p-46 * size_;
}

void Search::search(const Node& first, const Node& last, int depth) {
    // Not a number, or infinitely far: nothing to be found.
    if (!std::isfinite(first.distance) || !std::isfinite(last.distance))
        return;
    const bool crosses = is_beyond(first) != is_beyond(last);
    const std::array<double, 4> slopes = derivatives(first, last);
    if (all_of_one_sign(slopes)) {
        if (crosses)
            report(root_between(first, last));
        return;
    }
    if (!crosses && out_of_reach(first, last, slopes))
        return;
    const bool within_rounding = depth > 8 && first.distance == 0 && last.distance == 0;
    if (within_rounding || depth > 44 || steps_left_ <= 0) {
        if (crosses)
            report(0.5 * (first.v + last.v));
        return;
    }
    --steps_left_;
    const Node middle = node_at(0.5 * (first.v + last.v));
    search(first, middle, depth + 1);
    search(middle, last, depth + 1);
}

double Search::root_between(const Node& low, const Node& high) const {
    // A node on the branch counts as before it, and is the zero.
    if (low.distance == 0 || high.distance == 0)
        return low.distance == 0 ? low.v : high.v;
    return bracketed_zero(low.v, low.distance, high.v, high.distance, [&](double v) {
        const Point point = vera::point_at(piece_, start_, v);
        return distance_from(branch_, point, graph_at(branch_.axial, point));
    });
}

double Search::parameter_at_radius(double radius, const Node& first, const Node& last) const {
    return bracketed_zero(
        first.v, first.point.r - radius, last.v, last.point.r - radius, [&](double v) {
            const double beyond = vera::point_at(piece_, start_, v).r - radius;
            return std::abs(beyond) <= 0x1p-51 * radius ? 0 : beyond;
        });
}

void Search::report(double v) {
    if (found_.count == found_.t.size())
        return;
    const AxialRay& axial = branch_.axial;
    const Point point = vera::point_at(piece_, start_, v);
    double s = (point.h - axial.height) / axial.rise;
    if (axial.flat) {
        // From the radius or from the height, whichever rounding disturbs less.
        const double w = graph_at(axial, point);
        const double error_by_radius = point.r * point.r / (axial.a * w);
        const double error_by_height =
            (std::abs(point.h) + std::abs(axial.height)) / std::abs(axial.rise);
        const bool ring = piece_.kind == ContourPiece::Kind::line && start_.h == piece_.end.h;
        if (!ring && !(error_by_height < error_by_radius))
            s = branch_.side * w;
    }
    found_.t[found_.count++] = axial.t_reference + s;
}

void Search::search_arc(double first, double last) {
    Node from = node_at(first);
    Node to = node_at(last);
    if (!branch_.axial.flat) {
        search(from, to, 0);
        return;
    }
    // Only points as far from the axis as the ray's nearest can lie on it.
    const double nearest = std::sqrt(branch_.axial.c);
    if (from.point.r <= nearest && to.point.r <= nearest)
        return;
    const bool starts_within = from.point.r < nearest;
    const bool ends_within = to.point.r < nearest;
    if (starts_within || ends_within) {
        Node at_nearest = node_at(parameter_at_radius(nearest, from, to));
        // Both halves of the ray meet there, and must find the same distance.
        at_nearest.graph = 0;
        at_nearest.distance = distance_from(branch_, at_nearest.point, 0);
        (starts_within ? from : to) = at_nearest;
    }
    for (const double side : {1.0, -1.0}) {
        branch_.side = side;
        from.distance = distance_from(branch_, from.point, from.graph);
        to.distance = distance_from(branch_, to.point, to.graph);
        search(from, to, 0);
    }
}

PieceCrossings Search::run() {
    std::array<double, 8> splits = {0, 1};
    std::size_t count = 2;
    const auto insert = [&](const QuadraticRoots& roots) {
        for (std::size_t i = 0; i < roots.count; ++i) {
            std::size_t place = count++;
            for (; splits[place - 1] > roots.v[i]; --place)
                splits[place] = splits[place - 1];
            splits[place] = roots.v[i];
        }
    };
    if (piece_.kind != ContourPiece::Kind::line) {
        insert(extremes(hodograph_, {1, 0}));
        insert(extremes(hodograph_, {0, 1}));
        insert(inflections(hodograph_));
    }
    for (std::size_t i = 0; i + 1 < count; ++i)
        if (splits[i] < splits[i + 1])
            search_arc(splits[i], splits[i + 1]);
    return found_;
}

} // namespace

PieceCrossings certified_crossings(const AxialRay& axial, const ContourPiece& piece, Point start) {
    if (!(axial.a > 0) && axial.rise == 0)
        return {};
    return Search(axial, piece, start).run();
}

PieceCrossings crossings_beyond_start(
    const PreparedRay& prepared,
    const AxialRay& axial,
    const RotationalShape& shape,
    std::size_t piece,
    bool starts_here) {
    const ContourPiece& contour = shape.contour[piece];
    const Point start = piece == 0 ? shape.start : shape.contour[piece - 1].end;
    PieceCrossings found = certified_crossings(axial, contour, start);
    if (found.count == 0 || !(starts_here || prepared.starts_at_origin()))
        return found;

    // Where the ray leaves almost along the surface, the crossing there and a second one nearby
    // move apart or together by the square root of what rounding moves the origin; their middle
    // stays, and so the start is the one nearer to the origin.
    double& nearest = *std::min_element(
        found.t.begin(),
        found.t.begin() + static_cast<std::ptrdiff_t>(found.count),
        [](double a, double b) { return std::abs(a) < std::abs(b); });
    double reach = 0;
    for (const Point p : {start, contour.end, contour.control[0], contour.control[1]})
        reach = std::max(reach, std::max(std::abs(p.r), std::abs(p.h)));
    const double bound = start_distance(prepared, shape, reach);
    const double way = std::abs(nearest) * max_component(abs(prepared.ray.direction));
    if (!(way <= 8 * std::sqrt(bound * (bound + reach))))
        return found;
    if (!starts_here) {
        const Vec3 from_base = prepared.ray.origin - shape.base;
        const double h = dot(from_base, shape.axis);
        const double r = length(from_base - h * shape.axis);
        const Point on_curve =
            vera::point_at(contour, start, nearest_parameter(contour, start, {r, h}));
        if (!(std::abs(on_curve.r - r) <= bound && std::abs(on_curve.h - h) <= bound))
            return found;
    }
    nearest = found.t[--found.count];
    return found;
}

double start_distance(const PreparedRay& prepared, const RotationalShape& shape, double reach) {
    // sqrt(3) times the error along each axis; the axis' direction has an error, too.
    return 1.75 * prepared.start_distance(max_component(abs(shape.base)) + reach);
}

} // namespace vera
