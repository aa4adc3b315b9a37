// SPDX-License-Identifier: Apache-2.0
// Figure 3d: rays cut at their crossings in a segment tree over z, with their order in each node.
#include "vera/theory/diagram.h"
#include "vera/theory/figures.h"
#include "vera/theory/slope.h"
#include "vera/theory/stabbing_tree.h"

#include <algorithm>
#include <array>
#include <bit>

#include <fmt/format.h>

namespace vera {

namespace {

/// x = slope z + offset.
struct FigureRay {
    std::int32_t slope = 0;
    std::int32_t offset = 0;
};

constexpr std::array<FigureRay, 4> rays = {{{4, 2}, {-3, 44}, {1, 8}, {-1, 22}}};
constexpr double last_z = 12;
/// A rectangle, seen along the y axis.
constexpr double query_z = 5;
constexpr double query_lower = 10;
constexpr double query_upper = 24;

constexpr std::array<const char*, rays.size()> ray_colors = {
    diagram_colors::blue, diagram_colors::orange, diagram_colors::green, diagram_colors::purple};

double value(Slope z) {
    return static_cast<double>(z.rise) / static_cast<double>(z.run);
}

double x_of(std::size_t ray, double z) {
    return rays.at(ray).slope * z + rays.at(ray).offset;
}

/// Where two rays cross, as a fraction.
Slope crossing(std::size_t a, std::size_t b) {
    return Slope::of(rays.at(b).offset - rays.at(a).offset, rays.at(a).slope - rays.at(b).slope);
}

/// The z of all crossings, ascending.
std::vector<Slope> crossings() {
    std::vector<Slope> found;
    for (std::size_t a = 0; a < rays.size(); ++a)
        for (std::size_t b = a + 1; b < rays.size(); ++b)
            found.push_back(crossing(a, b));
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

/// The rays of each node of a segment tree over the intervals between crossings. A ray is cut at
/// its own crossings, and each piece goes to the nodes that together are its intervals.
struct SegmentTree {
    std::size_t leaves = 1;
    std::vector<std::vector<std::size_t>> rays_of; ///< of each node, from the lowest at its z
    std::size_t pieces = 0;
    std::size_t entries = 0;
};

SegmentTree segment_tree(const std::vector<Slope>& events) {
    SegmentTree tree;
    tree.leaves = std::bit_ceil(events.size() + 1);
    tree.rays_of.resize(2 * tree.leaves);
    for (std::size_t ray = 0; ray < rays.size(); ++ray) {
        std::size_t first = 0;
        const auto add_piece = [&](std::size_t last) {
            ++tree.pieces;
            for_each_canonical_node(tree.leaves, first, last, [&](std::size_t node) {
                tree.rays_of[node].push_back(ray);
                ++tree.entries;
            });
            first = last + 1;
        };
        for (std::size_t i = 0; i < events.size(); ++i)
            for (std::size_t other = 0; other < rays.size(); ++other)
                if (other != ray && crossing(ray, other) == events[i])
                    add_piece(i);
        add_piece(events.size());
    }
    // Within a node none crosses another: any z of its own tells the order.
    const auto some_z = [&](std::size_t node) {
        while (node < tree.leaves)
            node *= 2;
        const std::size_t interval = node - tree.leaves;
        const double begin = interval == 0 ? 0 : value(events[interval - 1]);
        return interval < events.size() ? (begin + value(events[interval])) / 2
                                        : (begin + last_z) / 2;
    };
    for (std::size_t node = 1; node < tree.rays_of.size(); ++node)
        std::sort(
            tree.rays_of[node].begin(),
            tree.rays_of[node].end(),
            [&](std::size_t a, std::size_t b) {
                return x_of(a, some_z(node)) < x_of(b, some_z(node));
            });
    return tree;
}

/// The interval that the query's z lies in.
std::size_t interval_of_query(const std::vector<Slope>& events) {
    const auto behind =
        std::find_if(events.begin(), events.end(), [](Slope z) { return value(z) > query_z; });
    return static_cast<std::size_t>(behind - events.begin());
}

void draw_rays(Diagram& diagram, const DiagramPlane& plane, const std::vector<Slope>& events) {
    constexpr double most_x = 56;
    for (const Slope z : events)
        diagram.line(
            plane.place(value(z), 0), plane.place(value(z), most_x), {"#aeb6bf", 1, "3 3"});
    diagram.line(plane.place(0, 0), plane.place(last_z, 0), {diagram_colors::faint});
    diagram.line(plane.place(0, 0), plane.place(0, most_x), {diagram_colors::faint});
    const DrawingPoint top = plane.place(0, most_x);
    diagram.text({top.x - 18, top.y + 8}, "x", {14});
    for (std::size_t ray = 0; ray < rays.size(); ++ray) {
        diagram.line(
            plane.place(0, x_of(ray, 0)),
            plane.place(last_z, x_of(ray, last_z)),
            {ray_colors.at(ray), 2.2});
        const DrawingPoint end = plane.place(0, x_of(ray, 0));
        diagram.text(
            {end.x - 16, end.y + 4},
            std::to_string(ray + 1),
            {14, ray_colors.at(ray), "start", true});
    }
    for (std::size_t ray = 0; ray < rays.size(); ++ray)
        for (std::size_t other = ray + 1; other < rays.size(); ++other) {
            const double z = value(crossing(ray, other));
            diagram.circle(plane.place(z, x_of(ray, z)), 4, "#ffffff", {diagram_colors::ink, 1.3});
        }
    diagram.line(
        plane.place(query_z, query_lower),
        plane.place(query_z, query_upper),
        {diagram_colors::ink, 4});
}

/// The nodes below the rays, each as wide as its intervals.
class NodesOverZ {
public:
    NodesOverZ(
        Diagram& diagram,
        const DiagramPlane& plane,
        double top,
        const std::vector<Slope>& events,
        const SegmentTree& tree)
        : diagram_(diagram)
        , plane_(plane)
        , top_(top)
        , events_(events)
        , tree_(tree) {}

    void draw(std::size_t interval_of_query) {
        for (std::size_t node = 1; node < 2 * tree_.leaves; ++node) {
            bool on_path = false;
            for (std::size_t at = interval_of_query + tree_.leaves; at > 0; at /= 2)
                on_path = on_path || at == node;
            draw_node(node, on_path);
        }
    }

private:
    double border(std::size_t interval) const {
        if (interval == 0)
            return 0;
        return interval <= events_.size() ? value(events_[interval - 1]) : last_z;
    }

    void draw_node(std::size_t node, bool on_path) {
        const auto level = static_cast<std::size_t>(std::bit_width(node) - 1);
        const std::size_t wide = tree_.leaves >> level;
        const std::size_t first = node * wide - tree_.leaves;
        if (first > events_.size())
            return; // beyond the last interval
        const double left = plane_.place(border(first), 0).x;
        const double right = plane_.place(border(std::min(first + wide, events_.size() + 1)), 0).x;
        const double y = top_ + 38 * static_cast<double>(level);
        const std::array<DrawingPoint, 4> box = {
            DrawingPoint{left + 1, y},
            DrawingPoint{right - 1, y},
            DrawingPoint{right - 1, y + 28},
            DrawingPoint{left + 1, y + 28}};
        diagram_.polygon(
            box,
            on_path ? "#fdeccb" : "#f4f6f8",
            {on_path ? diagram_colors::gold : "#c5ccd4", on_path ? 1.8 : 1});
        const std::vector<std::size_t>& held = tree_.rays_of[node];
        for (std::size_t i = 0; i < held.size(); ++i)
            diagram_.text(
                {(left + right) / 2
                     + (static_cast<double>(i) - 0.5 * static_cast<double>(held.size() - 1)) * 13,
                 y + 19},
                std::to_string(held[i] + 1),
                {14, ray_colors.at(held[i]), "middle", true});
    }

    Diagram& diagram_;
    DiagramPlane plane_;
    double top_;
    const std::vector<Slope>& events_;
    const SegmentTree& tree_;
};

} // namespace

DrawnFigure figure_of_segment_tree() {
    const std::vector<Slope> events = crossings();
    const SegmentTree tree = segment_tree(events);
    const std::size_t interval = interval_of_query(events);
    std::size_t on_path = 0;
    std::size_t met = 0;
    for (std::size_t node = interval + tree.leaves; node > 0; node /= 2)
        for (const std::size_t ray : tree.rays_of[node]) {
            ++on_path;
            const double x = x_of(ray, query_z);
            met += query_lower <= x && x <= query_upper ? 1 : 0;
        }

    Diagram diagram(1000, 720, "Figure 3d: the segment tree over z, and its range trees");
    diagram.text(
        {40, 30},
        "Rays, cut where they cross, in a segment tree over z",
        {15, diagram_colors::ink, "start", true});
    const DiagramPlane plane = {{60, 420}, 74, 6.4};
    draw_rays(diagram, plane, events);
    NodesOverZ(diagram, plane, 440, events, tree).draw(interval);
    diagram.text({plane.place(last_z, 0).x + 12, 424}, "z", {14});

    DrawnFigure figure;
    figure.counts = {
        {"rays", rays.size()},
        {"crossings", events.size()},
        {"pieces", tree.pieces},
        {"entries", tree.entries},
        {"on the path", on_path},
        {"met", met}};
    const std::vector<std::string> caption = {
        fmt::format(
            "{} rays with {} crossings are cut into {} pieces. Each is held by the nodes (boxes) "
            "that together cover its z: {} entries.",
            rays.size(),
            events.size(),
            tree.pieces,
            tree.entries),
        "A node has its rays from the lowest to the highest, which do not change their order "
        "there: the first level of a range tree.",
        fmt::format(
            "A rectangle (thick) asks the nodes above its z (yellow), which hold each of the {} "
            "rays "
            "once, and finds the {} that meet it.",
            on_path,
            met)};
    diagram.lines({40, 630}, caption);
    figure.svg = diagram.svg();
    return figure;
}

} // namespace vera
