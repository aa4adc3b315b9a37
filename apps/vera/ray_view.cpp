// SPDX-License-Identifier: Apache-2.0
#include "ray_view.h"

#include "vera/math/elementary.h"
#include "vera/scene/bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace vera {

namespace {

/// How far the places of the tree lie from each other: what a ray that leaves the scene, or a light
/// far away, is drawn at.
double reach_of(const RayTree& tree, const Scene& scene) {
    Box3 box;
    const Ray& view = tree.nodes.front().ray.ray;
    for (const RayNode& node : tree.nodes)
        if (node.hit.found())
            box = grown(box, node.surface.point);
    if (std::isfinite(view.t_min))
        box = grown(box, view.origin);
    const double size = length(extent(box));
    if (size > 0)
        return size;
    const double scene_size = length(extent(bounds(scene)));
    return scene_size > 0 && std::isfinite(scene_size) ? scene_size : 1;
}

RayLine::Kind kind_of(const LightAtPlace& light) {
    if (is_black(light.visibility))
        return RayLine::Kind::shadowed;
    return light.visibility == Color{1, 1, 1} ? RayLine::Kind::lit : RayLine::Kind::filtered;
}

RayLine line_to_light(
    const RayNode& node, std::size_t number, std::size_t light, Vec3 position, double reach) {
    const LightAtPlace& at = node.lights[light];
    RayLine line = {kind_of(at), node.surface.point, position, number, light, false};
    if (line.kind == RayLine::Kind::shadowed) {
        const auto blocks = std::find_if(
            at.crossings.begin(), at.crossings.end(), [](const ShadowCrossing& crossing) {
                return is_black(crossing.tab);
            });
        if (blocks != at.crossings.end())
            line.to = line.from + blocks->t * (position - line.from);
    }
    // Light far away must not make all else small.
    constexpr double longest = 0.7;
    if (length(line.to - line.from) > longest * reach) {
        line.to = line.from + longest * reach * at.to_light;
        line.goes_on = true;
    }
    return line;
}

RayLine line_of_ray(const RayNode& node, std::size_t number, double reach) {
    const Ray& ray = node.ray.ray;
    RayLine line;
    line.kind = node.kind == RayNode::Kind::view ? RayLine::Kind::view
        : node.kind == RayNode::Kind::refracted  ? RayLine::Kind::refracted
                                                 : RayLine::Kind::mirrored;
    line.node = number;
    line.goes_on = !node.hit.found();
    line.to = node.hit.found() ? node.surface.point : ray.origin + 0.5 * reach * ray.direction;
    // A parallel view ray has no beginning.
    line.from = std::isfinite(ray.t_min) ? ray.origin : line.to - reach * ray.direction;
    return line;
}

/// Upright: y is up in the world, and in the picture.
void turn_to(RayView& view, double around_degrees, double down_degrees) {
    const double flat = cos_degrees(down_degrees);
    const Vec3 direction = {
        -flat * sin_degrees(around_degrees),
        -sin_degrees(down_degrees),
        -flat * cos_degrees(around_degrees)};
    view.camera.projection = Camera::Projection::parallel;
    view.camera.direction = direction;
    view.right = normalized(cross(direction, {0, 1, 0}));
    view.up = cross(view.right, direction);
}

/// Whether each place of the tree is seen from very far against that direction.
double part_seen(const RayTree& tree, const RayIndex& index, Vec3 direction) {
    std::vector<QueryRay> queries;
    for (const RayNode& node : tree.nodes) {
        if (!node.hit.found())
            continue;
        QueryRay query;
        query.ray.origin = node.surface.point;
        query.ray.origin_error = node.surface.point_error;
        query.ray.direction = -direction;
        query.start = node.hit.face;
        queries.push_back(query);
    }
    if (queries.empty())
        return 1;
    std::vector<Hit> hits(queries.size());
    QueryCounts counts;
    index.nearest_hits(queries, hits, counts);
    const auto seen =
        std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return !hit.found(); });
    return static_cast<double>(seen) / static_cast<double>(queries.size());
}

/// How openly the surfaces that rays meet are seen, on the average: 0 edge-on, 1 from 30 degrees to
/// them on.
double part_open(const RayTree& tree, Vec3 direction) {
    double open = 0;
    std::size_t surfaces = 0;
    for (const RayNode& node : tree.nodes) {
        if (!node.hit.found())
            continue;
        open += std::min(2 * std::abs(dot(node.incidence.normal, direction)), 1.0);
        ++surfaces;
    }
    return surfaces > 0 ? open / static_cast<double>(surfaces) : 1;
}

/// How long the lines look by how long they are, on the average.
double part_of_length(const std::vector<RayLine>& lines, const RayView& view) {
    double seen = 0;
    double whole = 0;
    for (const RayLine& line : lines) {
        const Vec3 along = line.to - line.from;
        seen += length({dot(along, view.right), dot(along, view.up), 0});
        whole += length(along);
    }
    return whole > 0 ? seen / whole : 1;
}

/// Fits the lines into the picture, with a margin.
void frame(
    RayView& view, const std::vector<RayLine>& lines, std::uint32_t width, std::uint32_t height) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double margin = 0.12; // of the picture's size, on each side
    double left = infinity;
    double right = -infinity;
    double bottom = infinity;
    double top = -infinity;
    for (const RayLine& line : lines)
        for (const Vec3 point : {line.from, line.to}) {
            left = std::min(left, dot(point, view.right));
            right = std::max(right, dot(point, view.right));
            bottom = std::min(bottom, dot(point, view.up));
            top = std::max(top, dot(point, view.up));
        }
    const double inner = 1 - 2 * margin;
    const double unit =
        std::max((right - left) / (inner * width), (top - bottom) / (inner * height));
    view.scale = unit > 0 ? 1 / unit : 1;
    view.left = (left + right) / 2 - width / view.scale / 2;
    view.top = (bottom + top) / 2 + height / view.scale / 2;

    const Vec3 along = view.camera.direction;
    const Vec3 on_plane = dot(lines.front().to, along) * along;
    const Vec3 corner =
        on_plane + view.left * view.right + (view.top - height / view.scale) * view.up;
    view.camera.lower_left = corner;
    view.camera.lower_right = corner + width / view.scale * view.right;
    view.camera.upper_left = corner + height / view.scale * view.up;
}

} // namespace

std::vector<RayLine> ray_lines(const RayTree& tree, const Scene& scene) {
    const double reach = reach_of(tree, scene);
    std::vector<RayLine> lines;
    for (std::size_t number = 0; number < tree.nodes.size(); ++number) {
        const RayNode& node = tree.nodes[number];
        lines.push_back(line_of_ray(node, number, reach));
        for (std::size_t light = 0; light < node.lights.size(); ++light)
            if (node.lights[light].shadow_ray || !is_black(node.lights[light].terms))
                lines.push_back(
                    line_to_light(node, number, light, scene.lights[light].position, reach));
    }
    return lines;
}

RayView ray_view(
    const RayTree& tree,
    const std::vector<RayLine>& lines,
    const RayIndex& index,
    std::uint32_t width,
    std::uint32_t height) {
    constexpr int step = 15;
    std::optional<RayView> best;
    double best_score = -1;
    for (const int down : {20, 40})
        for (int around = 0; around < 360; around += step) {
            RayView view;
            turn_to(view, around, down);
            const double seen = part_seen(tree, index, view.camera.direction);
            const double score =
                2 * seen + part_of_length(lines, view) + part_open(tree, view.camera.direction);
            if (score <= best_score)
                continue;
            best_score = score;
            view.sees_all = seen == 1;
            best = view;
        }
    frame(*best, lines, width, height);
    return *best;
}

} // namespace vera
