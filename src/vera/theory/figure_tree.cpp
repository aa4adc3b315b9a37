// SPDX-License-Identifier: Apache-2.0
// Figure 3b: the conjugation tree, and a query half-plane.
#include "vera/theory/conjugation_tree.h"
#include "vera/theory/diagram.h"
#include "vera/theory/figures.h"
#include "vera/theory/plane_hull.h"
#include "vera/theory/plane_points.h"

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <utility>

#include <fmt/format.h>

namespace vera {

namespace {

constexpr std::size_t point_count = 64;
constexpr std::size_t leaf_size = 2;
constexpr std::int32_t reach = 1'000'000; ///< of scattered_points()

/// How a search ended at a node, if it came to it.
enum class Ending { not_reached, goes_on, inside, outside, looked_at };

struct EndingStyle {
    const char* fill;
    DiagramPen pen;
};

EndingStyle style_of(Ending ending) {
    switch (ending) {
    case Ending::goes_on:
        return {"#ffffff", {diagram_colors::orange, 1.6}};
    case Ending::inside:
        return {"#ffffff", {diagram_colors::blue, 2}};
    case Ending::outside:
        return {diagram_colors::ink, {diagram_colors::ink, 1}};
    case Ending::looked_at:
        return {diagram_colors::gold, {diagram_colors::orange, 1.2}};
    case Ending::not_reached:
        break;
    }
    return {"#d5dbe1", {"none"}};
}

/// A search, node by node.
class SearchedTree {
public:
    SearchedTree(const ConjugationTree& tree, const PlaneStrip& strip)
        : tree_(tree)
        , strip_(strip)
        , endings_(tree.nodes().size(), Ending::not_reached) {
        look_at(0);
    }

    Ending ending(std::uint32_t node) const { return endings_[node]; }

    std::size_t count(Ending ending) const {
        return static_cast<std::size_t>(std::count(endings_.begin(), endings_.end(), ending));
    }

private:
    void look_at(std::uint32_t number) {
        const ConjugationNode& node = tree_.nodes()[number];
        switch (tree_.inclusion(node, strip_, counts_)) {
        case Inclusion::all:
            endings_[number] = Ending::inside;
            return;
        case Inclusion::none:
            endings_[number] = Ending::outside;
            return;
        case Inclusion::some:
            break;
        }
        endings_[number] = node.is_leaf() ? Ending::looked_at : Ending::goes_on;
        if (node.is_leaf())
            return;
        look_at(number + 1);
        look_at(node.children);
    }

    const ConjugationTree& tree_;
    PlaneStrip strip_;
    StepCounts counts_;
    std::vector<Ending> endings_;
};

/// What of a square lies in the half-plane: the corners of that.
std::vector<DrawingPoint> clipped_square(const PlaneStrip& half_plane, double half_side) {
    const std::array<DrawingPoint, 4> corners = {
        DrawingPoint{-half_side, -half_side},
        DrawingPoint{half_side, -half_side},
        DrawingPoint{half_side, half_side},
        DrawingPoint{-half_side, half_side}};
    const auto height = [&](DrawingPoint point) {
        return static_cast<double>(half_plane.highest)
            - (static_cast<double>(half_plane.normal.x) * point.x
               + static_cast<double>(half_plane.normal.y) * point.y);
    };
    std::vector<DrawingPoint> kept;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const DrawingPoint a = corners.at(i);
        const DrawingPoint b = corners.at((i + 1) % corners.size());
        if (height(a) >= 0)
            kept.push_back(a);
        if ((height(a) >= 0) != (height(b) >= 0)) {
            const double part = height(a) / (height(a) - height(b));
            kept.push_back({a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)});
        }
    }
    return kept;
}

/// The points, the hulls of nodes at which the search ended, and the half-plane.
class PlaneOfTree {
public:
    PlaneOfTree(
        Diagram& diagram,
        const DiagramPlane& plane,
        const PlanePoints& points,
        const ConjugationTree& tree,
        const SearchedTree& searched)
        : diagram_(diagram)
        , plane_(plane)
        , points_(points)
        , tree_(tree)
        , searched_(searched) {}

    void draw(const PlaneStrip& half_plane) {
        constexpr double half_side = 1.08 * reach;
        std::vector<DrawingPoint> area = clipped_square(half_plane, half_side);
        for (DrawingPoint& point : area)
            point = plane_.place(point.x, point.y);
        diagram_.polygon(area, "#e4f0fa", {diagram_colors::blue, 1.4});
        const std::array<DrawingPoint, 4> frame = {
            plane_.place(-half_side, -half_side),
            plane_.place(half_side, -half_side),
            plane_.place(half_side, half_side),
            plane_.place(-half_side, half_side)};
        diagram_.polygon(frame, "none", {diagram_colors::faint, 1});
        for (std::uint32_t i = 0; i < tree_.nodes().size(); ++i)
            draw_hull(i);
        for (const PlanePoint point : points_)
            diagram_.circle(plane_.place(point.x, point.y), 2.1, diagram_colors::ink);
    }

private:
    void draw_hull(std::uint32_t number) {
        const Ending ending = searched_.ending(number);
        if (ending == Ending::not_reached || ending == Ending::goes_on)
            return;
        const PlaneHull hull = hull_of(points_, tree_.numbers_of(tree_.nodes()[number]));
        std::vector<DrawingPoint> corners;
        for (const std::uint32_t vertex : hull.below)
            corners.push_back(plane_.place(points_[vertex].x, points_[vertex].y));
        for (std::size_t i = hull.above.size(); i-- > 0;)
            corners.push_back(plane_.place(points_[hull.above[i]].x, points_[hull.above[i]].y));
        const bool is_inside = ending == Ending::inside;
        const bool is_outside = ending == Ending::outside;
        diagram_.polygon(
            corners,
            is_inside        ? "#b9d9f0"
                : is_outside ? "#d8dce1"
                             : "#f8dfae",
            {is_inside        ? diagram_colors::blue
                 : is_outside ? "#5d6d7e"
                              : diagram_colors::gold,
             1.6});
    }

    Diagram& diagram_;
    DiagramPlane plane_;
    const PlanePoints& points_;
    const ConjugationTree& tree_;
    const SearchedTree& searched_;
};

/// The tree from the top down, leaves side by side.
class TreeOfNodes {
public:
    TreeOfNodes(
        Diagram& diagram,
        DrawingPoint corner,
        double width,
        double level_height,
        const ConjugationTree& tree,
        const SearchedTree& searched)
        : diagram_(diagram)
        , corner_(corner)
        , level_height_(level_height)
        , tree_(tree)
        , searched_(searched) {
        const auto leaves = std::count_if(
            tree.nodes().begin(), tree.nodes().end(), [](const ConjugationNode& node) {
                return node.is_leaf();
            });
        leaf_width_ = width / static_cast<double>(leaves);
    }

    void draw() {
        place(0, 0);
        for (const auto& [from, to] : lines_)
            diagram_.line(from, to, {"#aeb6bf", 1});
        for (const auto& [node, at] : nodes_) {
            const Ending ending = searched_.ending(node);
            const EndingStyle style = style_of(ending);
            diagram_.circle(at, ending == Ending::not_reached ? 2 : 5, style.fill, style.pen);
        }
    }

private:
    DrawingPoint place(std::uint32_t number, int level) {
        const ConjugationNode& node = tree_.nodes()[number];
        DrawingPoint at = {0, corner_.y + level * level_height_};
        if (node.is_leaf()) {
            at.x = corner_.x + (next_leaf_ + 0.5) * leaf_width_;
            next_leaf_ += 1;
        } else {
            const DrawingPoint first = place(number + 1, level + 1);
            const DrawingPoint second = place(node.children, level + 1);
            at.x = (first.x + second.x) / 2;
            lines_.push_back({at, first});
            lines_.push_back({at, second});
        }
        nodes_.push_back({number, at});
        return at;
    }

    Diagram& diagram_;
    DrawingPoint corner_;
    double level_height_;
    double leaf_width_ = 0;
    double next_leaf_ = 0;
    const ConjugationTree& tree_;
    const SearchedTree& searched_;
    std::vector<std::pair<DrawingPoint, DrawingPoint>> lines_;
    std::vector<std::pair<std::uint32_t, DrawingPoint>> nodes_;
};

} // namespace

DrawnFigure figure_of_conjugation_tree() {
    std::mt19937_64 random(1988);
    const PlanePoints points = scattered_points(point_count, random);
    const ConjugationTree tree(points, leaf_size);
    const PlaneStrip half_plane = {
        {3, 5}, std::numeric_limits<std::int64_t>::min(), -std::int64_t{reach} / 2};
    const SearchedTree searched(tree, half_plane);

    DrawnFigure figure;
    figure.counts = {
        {"points", points.size()},
        {"nodes", tree.nodes().size()},
        {"inside", searched.count(Ending::inside)},
        {"outside", searched.count(Ending::outside)},
        {"looked at", searched.count(Ending::looked_at)},
        {"going on", searched.count(Ending::goes_on)},
        {"in the half-plane", tree.count(half_plane)}};
    const std::size_t reached = tree.nodes().size() - searched.count(Ending::not_reached);

    Diagram diagram(1100, 640, "Figure 3b: the conjugation tree, and a query half-plane");
    const DiagramText heading = {15, diagram_colors::ink, "start", true};
    diagram.text({30, 30}, "The points, and the hulls at which the search ends", heading);
    diagram.text({570, 30}, "The tree", heading);
    const DiagramPlane plane = {{275, 292}, 232e-6, 232e-6};
    PlaneOfTree(diagram, plane, points, tree, searched).draw(half_plane);
    TreeOfNodes(diagram, {560, 70}, 520, 66, tree, searched).draw();

    DrawingPoint key = {580, 460};
    for (const auto& [ending, text] :
         {std::pair(Ending::goes_on, "crossed by the border: both children are looked at"),
          std::pair(Ending::inside, "inside: all its points are found"),
          std::pair(Ending::outside, "outside: none is"),
          std::pair(Ending::looked_at, "a leaf that is crossed: its points are looked at"),
          std::pair(Ending::not_reached, "not reached")}) {
        const EndingStyle style = style_of(ending);
        diagram.circle(
            {key.x, key.y - 4}, ending == Ending::not_reached ? 2 : 5, style.fill, style.pen);
        diagram.text({key.x + 14, key.y}, text);
        key.y += 19;
    }
    const std::vector<std::string> caption = {
        fmt::format(
            "{} points in {} nodes, leaves of {}. The search looks at {}: it ends inside {} and",
            points.size(),
            tree.nodes().size(),
            leaf_size,
            reached,
            searched.count(Ending::inside)),
        fmt::format(
            "outside {}, and at {} leaves. {} points are in the half-plane.",
            searched.count(Ending::outside),
            searched.count(Ending::looked_at),
            tree.count(half_plane))};
    diagram.lines({30, 585}, caption);
    figure.svg = diagram.svg();
    return figure;
}

} // namespace vera
