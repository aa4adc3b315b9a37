// SPDX-License-Identifier: Apache-2.0
// Compares the colours of a drawing in style shaded with the lighting formula, at random points
// amid what is seen. bench/drawings/gradients runs it and tells what its numbers mean.
#include "vera/accel/wide_bvh.h"
#include "vera/base/random.h"
#include "vera/drawing/drawing_file.h"
#include "vera/drawing/elliptic_arc.h"
#include "vera/drawing/gradient.h"
#include "vera/formats/control_file.h"
#include "vera/formats/read_scene.h"
#include "vera/render/exposure.h"
#include "vera/scene/crossings.h"
#include "vera/scene/framing.h"
#include "vera/scene/surface.h"
#include "vera/shade/firmament.h"
#include "vera/shade/lighting.h"
#include "vera/visible/draw_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace vera {

namespace {

constexpr double deviation = 0.1; // pixels, as of vera draw
constexpr double tolerance = 1.0 / 255;
constexpr double margin = 1.5; // pixels, from all borders

/// From 0 to 1: a number of that point, along that axis.
double random_part(std::size_t point, std::uint64_t axis) {
    return static_cast<double>(random(1988, point, axis) >> 11U) * 0x1p-53;
}

double difference(Color a, Color b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

/// A point at that way from another one, in pixels.
DrawingPoint beside(DrawingPoint point, double way, int eighth) {
    const double angle = eighth * std::numbers::pi / 4;
    return {point.x + way * std::cos(angle), point.y + way * std::sin(angle)};
}

/// What a ray through a point of the picture sees.
struct Sight {
    FaceId face;
    std::uint64_t lights = 0;    ///< that light it, by number
    bool is_filtered = false;    ///< whether one of them shines through something
    std::vector<Color> switched; ///< what the colour were with one light more or less
    Color color;                 ///< without mirrors and glass

    bool is_like(const Sight& other) const { return face == other.face && lights == other.lights; }
};

class Rays {
public:
    Rays(const Scene& scene, const Camera& camera, const PictureSettings& picture)
        : scene_(scene)
        , camera_(camera)
        , picture_(picture)
        , index_(make_wide_bvh(scene)) {}

    const RayIndex& index() const { return *index_; }

    Sight sight(DrawingPoint point) const {
        QueryRay query;
        query.ray = view_ray(camera_, point.x / picture_.width, point.y / picture_.height);
        Hit hit;
        QueryCounts counts;
        index_->nearest_hits({&query, 1}, {&hit, 1}, counts);
        Sight seen;
        if (!hit.found()) {
            seen.color = clamped(firmament_color(picture_.firmament, query.ray.direction));
            return seen;
        }
        seen.face = hit.face;
        const SurfacePoint surface = surface_at(scene_, query.ray, hit);
        const Incidence at = incidence(surface, query.ray.direction);
        const Material& material = material_of(scene_, surface.material);
        LocalTerms terms = unlit(at, material, picture_.ambient);
        std::vector<std::pair<double, LightTerms>> others; // that are on or off by shadows alone
        for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
            const LightTerms light = unshadowed(at, material, scene_.lights[i]);
            const Color passed = is_black(light) ? Color{} : reaching(surface, hit, i);
            seen.lights |= is_black(passed) ? 0 : std::uint64_t{1} << (i % 64);
            seen.is_filtered = seen.is_filtered || !(is_black(passed) || passed == Color{1, 1, 1});
            terms += passed * light;
            if (!is_black(light))
                others.emplace_back(is_black(passed) ? 1 : -1, light);
        }
        for (const auto& [sign, light] : others) {
            LocalTerms with = terms;
            with += Color{sign, sign, sign} * light;
            seen.switched.push_back(clamped(sum(with)));
        }
        seen.color = clamped(sum(terms));
        return seen;
    }

private:
    /// The part of the light's that reaches the place.
    Color reaching(const SurfacePoint& surface, const Hit& hit, std::size_t light) const {
        if (!picture_.shadows)
            return {1, 1, 1};
        QueryRay query;
        query.ray.origin = surface.point;
        query.ray.direction = scene_.lights[light].position - surface.point;
        query.ray.origin_error = surface.point_error;
        query.start = hit.face;
        query.ray.t_max = 1 - coincidence_tolerance(query.ray, 1);
        Color passed = {1, 1, 1};
        QueryCounts counts;
        index_->transmittances({&query, 1}, {&passed, 1}, counts);
        return passed;
    }

    const Scene& scene_;
    const Camera& camera_;
    const PictureSettings& picture_;
    std::unique_ptr<RayIndex> index_;
};

/// The outlines of a drawing, found by rows of pixels.
class Fills {
public:
    explicit Fills(const Drawing& drawing)
        : drawing_(drawing)
        , sides_(static_cast<std::size_t>(drawing.height) + 1) {
        for (std::uint32_t i = 0; i < drawing.fills.size(); ++i)
            add(i);
    }

    /// The colour of the last outline that covers the point; see Gradient for how it is meant.
    Color color(DrawingPoint point) const {
        const FilledOutline* last = last_at(point);
        return last != nullptr ? color_of(*last, point)
                               : as_color(drawing_.background.value_or(DrawingColor{}));
    }

    /// The id of that outline; empty where the background is seen.
    std::string name(DrawingPoint point) const {
        const FilledOutline* last = last_at(point);
        return last != nullptr ? last->id : std::string();
    }

private:
    struct Side {
        DrawingPoint from;
        DrawingPoint to;
        std::uint32_t outline = 0;
    };

    /// The last outline that covers the point.
    const FilledOutline* last_at(DrawingPoint point) const {
        std::vector<std::pair<std::uint32_t, int>> turns;
        for (const Side& side : sides_[row_of(point.y)]) {
            const bool down = side.from.y <= point.y && point.y < side.to.y;
            const bool up = side.to.y <= point.y && point.y < side.from.y;
            if (!down && !up)
                continue;
            const double part = (point.y - side.from.y) / (side.to.y - side.from.y);
            if (side.from.x + part * (side.to.x - side.from.x) > point.x)
                turns.emplace_back(side.outline, down ? 1 : -1);
        }
        std::sort(turns.begin(), turns.end());
        while (!turns.empty()) {
            const std::uint32_t last = turns.back().first;
            int sum = 0;
            for (; !turns.empty() && turns.back().first == last; turns.pop_back())
                sum += turns.back().second;
            if (sum != 0)
                return &drawing_.fills[last];
        }
        return nullptr;
    }

    static Color as_color(DrawingColor color) {
        return {color.r / 255.0, color.g / 255.0, color.b / 255.0};
    }

    static Color color_of(const FilledOutline& outline, DrawingPoint point) {
        return outline.gradient ? color_at(*outline.gradient, point) : as_color(outline.color);
    }

    std::size_t row_of(double y) const {
        return static_cast<std::size_t>(std::clamp(y, 0.0, static_cast<double>(sides_.size() - 1)));
    }

    void add(std::uint32_t number) {
        const FilledOutline& outline = drawing_.fills[number];
        for (std::size_t i = 0; i < outline.rings.size(); ++i) {
            const std::vector<DrawingPoint>& ring = outline.rings[i];
            const std::vector<DrawingArc> none;
            const auto& arcs = i < outline.arcs.size() ? outline.arcs[i] : none;
            auto arc = arcs.begin();
            for (std::size_t j = 0; j < ring.size(); ++j) {
                DrawingPoint from = ring[j];
                if (arc != arcs.end() && arc->segment == j) {
                    const double sweep = arc->end_degrees - arc->begin_degrees;
                    const double parts = std::ceil(std::abs(sweep));
                    for (double part = 1; part < parts; ++part) {
                        const DrawingPoint to =
                            point_at(arc->ellipse, arc->begin_degrees + part / parts * sweep);
                        add_side({from, to, number});
                        from = to;
                    }
                    ++arc;
                }
                add_side({from, ring[j + 1 == ring.size() ? 0 : j + 1], number});
            }
        }
    }

    void add_side(const Side& side) {
        const auto [top, bottom] = std::minmax(side.from.y, side.to.y);
        for (std::size_t row = row_of(top); row <= row_of(bottom); ++row)
            sides_[row].push_back(side);
    }

    const Drawing& drawing_;
    std::vector<std::vector<Side>> sides_; ///< of each row
};

/// What is off, of the points compared.
struct Comparison {
    std::size_t compared = 0;
    std::size_t off = 0;     ///< by more than the tolerance
    std::size_t shadow = 0;  ///< of them those of the colour that one light more or less makes
    std::size_t far_off = 0; ///< by more than twice that
    std::size_t beyond = 0;  ///< from all that the light is within the deviation
    double most = 0;         ///< of 255
    double most_beyond = 0;  ///< likewise
    nlohmann::ordered_json worst;
    nlohmann::ordered_json places = nlohmann::ordered_json::array(); ///< that are off
};

Comparison compared(const Rays& rays, const Drawing& drawing, std::size_t points) {
    const Fills fills(drawing);
    Comparison result;
    for (std::size_t i = 0; i < points; ++i) {
        const DrawingPoint at = {
            margin + random_part(i, 0) * (drawing.width - 2 * margin),
            margin + random_part(i, 1) * (drawing.height - 2 * margin)};
        const Sight seen = rays.sight(at);
        bool is_inner = !seen.is_filtered;
        double slack = 0;
        for (int eighth = 0; is_inner && eighth < 8; ++eighth) {
            is_inner = rays.sight(beside(at, margin, eighth)).is_like(seen);
            const Sight near = rays.sight(beside(at, deviation, eighth));
            is_inner = is_inner && near.is_like(seen);
            slack = std::max(slack, difference(near.color, seen.color));
        }
        if (!is_inner)
            continue;
        constexpr double rounding = 1.001;
        ++result.compared;
        const Color shown = fills.color(at);
        const double error = difference(shown, seen.color);
        const auto is_shown = [&](Color color) {
            return difference(shown, color) <= rounding * tolerance;
        };
        const bool is_off = !is_shown(seen.color);
        result.off += is_off ? 1 : 0;
        const bool is_shadow = is_off && std::ranges::any_of(seen.switched, is_shown);
        result.shadow += is_shadow ? 1 : 0;
        if (is_off)
            result.places.push_back(
                {{"x", at.x},
                 {"y", at.y},
                 {"primitive", seen.face.primitive},
                 {"path", fills.name(at)},
                 {"off", 255 * error},
                 {"beyond", 255 * (error - slack)},
                 {"shadow", is_shadow}});
        result.far_off += error > 2 * tolerance ? 1 : 0;
        result.most = std::max(result.most, 255 * error);
        result.beyond += error - slack > rounding * tolerance ? 1 : 0;
        if (255 * (error - slack) <= result.most_beyond)
            continue;
        result.most_beyond = 255 * (error - slack);
        result.worst = {
            {"x", at.x},
            {"y", at.y},
            {"primitive", seen.face.primitive},
            {"shown", {255 * shown.r, 255 * shown.g, 255 * shown.b}},
            {"is", {255 * seen.color.r, 255 * seen.color.g, 255 * seen.color.b}}};
    }
    return result;
}

void measure(const std::string& path, const std::string& control, std::size_t points) {
    SceneFile file = read_scene(path, {});
    PictureSettings picture = file.scene.defaults;
    if (!control.empty())
        picture = read_control_file(control, file.scene.defaults, file.warnings);
    Scene& scene = file.scene;
    const FrameSettings frame = {
        .width = picture.width,
        .height = picture.height,
        .margin = picture.frame_margin.value_or(FrameSettings().margin),
        .pixel_aspect = picture.pixel_aspect};
    const Camera camera = !scene.camera ? framed_camera(scene, frame)
        : picture.frame_margin          ? reframed_camera(scene, *scene.camera, frame)
                                        : *scene.camera;
    const Rays rays(scene, camera, picture);
    if (picture.exposure.value_or(0) > 0) {
        TracedScene traced = traced_scene(scene, rays.index(), picture, nullptr);
        RenderStatistics statistics;
        expose(traced, camera, *picture.exposure, statistics);
        scene.lights = traced.illumination.lights;
        picture.ambient = traced.illumination.ambient;
    }
    DrawSettings settings;
    settings.style = DrawingStyle::shaded;
    settings.deviation = deviation;
    const DrawnScene drawn = draw_scene(scene, camera, picture, settings);
    std::string svg;
    write_svg(drawn.drawing, {}, svg);
    std::size_t stops = 0;
    for (const FilledOutline& fill : drawn.drawing.fills)
        stops += fill.gradient ? fill.gradient->stops.size() : 0;
    const Comparison found = compared(rays, drawn.drawing, points);
    const nlohmann::ordered_json json = {
        {"compared", found.compared},
        {"off", found.off},
        {"shadow", found.shadow},
        {"far_off", found.far_off},
        {"most", found.most},
        {"beyond", found.beyond},
        {"most_beyond", found.most_beyond},
        {"worst", found.worst},
        {"places", found.places},
        {"paths", drawn.drawing.fills.size()},
        {"stops", stops},
        {"bytes", svg.size()}};
    std::printf("%s\n", json.dump().c_str());
}

} // namespace

} // namespace vera

int main(int count, char** words) {
    if (count != 4) {
        std::fprintf(stderr, "usage: gradients_check SCENE CONTROL|- POINTS\n");
        return 2;
    }
    try {
        vera::measure(
            words[1],
            words[2] == std::string("-") ? "" : words[2],
            static_cast<std::size_t>(std::atoll(words[3])));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "gradients_check: %s\n", error.what());
        return 3;
    }
    return 0;
}
