// SPDX-License-Identifier: Apache-2.0
#include "vera/image/develop.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "explanation.h"
#include "scene_objects.h"
#include <fmt/format.h>

namespace vera {

namespace {

/// The report, line by line.
class Report {
public:
    explicit Report(const Explanation& explanation)
        : of_(explanation)
        , objects_(explanation.prepared.scene) {}

    std::string text() {
        add_head();
        for (std::size_t i = 0; i < of_.tree.nodes.size(); ++i)
            add_ray(i);
        add_sum();
        return std::move(text_);
    }

private:
    void line(const std::string& words = {}) {
        text_ += words;
        text_ += '\n';
    }

    /// Without -0.
    static std::string three(double a, double b, double c) {
        return fmt::format("{:.6g} {:.6g} {:.6g}", a + 0.0, b + 0.0, c + 0.0);
    }

    static std::string vector(Vec3 a) { return three(a.x, a.y, a.z); }

    static std::string color(Color a) { return three(a.r, a.g, a.b); }

    /// What the rows of a ray are called stands in so many columns.
    static constexpr int label_width = 14;

    void row(const char* label, const std::string& words) {
        line(fmt::format("  {:<{}}{}", label, label_width, words));
    }

    void term(const std::string& label, Color value, const std::string& words) {
        line(fmt::format(
            "  {:<{}}{} {} {}   {}",
            label,
            label_width,
            column(value.r),
            column(value.g),
            column(value.b),
            words));
    }

    /// With its point below those above it, as long as it is not huge.
    static std::string column(double value) {
        return std::abs(value) < 10'000 ? fmt::format("{:>11.6f}", value)
                                        : fmt::format("{:>11.4g}", value);
    }

    void add_head();
    void add_ray(std::size_t number);
    void add_hit(const RayNode& node);
    void add_visits(const char* label, const RayWalk& walk, double direction_length);
    void add_light(std::size_t ray, std::size_t number);
    void add_light_terms(const LightAtPlace& light, std::size_t number);
    void add_terms(const RayNode& node);
    void add_sent(const RayNode& node);
    void add_sum();
    std::string visibility(const LightAtPlace& light);

    const Explanation& of_;
    SceneObjects objects_;
    std::string text_;
};

void Report::add_head() {
    const PictureSettings& settings = of_.prepared.settings;
    const Color value = of_.tree.nodes.front().color;
    const auto bytes = picture_bytes(of_);
    line(fmt::format(
        "Pixel {} {} of {} x {}, counted from the top left, seen through its centre.",
        of_.x,
        of_.y,
        settings.width,
        settings.height));
    line(fmt::format(
        "Its colour is {} in red, green and blue, 1 being full: bytes {} {} {}.",
        color(value),
        bytes[0],
        bytes[1],
        bytes[2]));
    line(fmt::format(
        "Ray tree: {} {} in at most {} {}. Shadows are {}. Index: {}.",
        of_.tree.nodes.size(),
        of_.tree.nodes.size() == 1 ? "ray" : "rays",
        settings.depth,
        settings.depth == 1 ? "level" : "levels",
        settings.shadows ? "on" : "off",
        of_.index));
    if (of_.exposure && of_.exposure->target > 0)
        line(fmt::format(
            "EXPMES has multiplied the light sources and AMBIENT by {:.6g}.",
            of_.exposure->factor));
    line("Lengths are in units of the scene, cosines and colours are plain numbers.");
}

void Report::add_ray(std::size_t number) {
    const RayNode& node = of_.tree.nodes[number];
    line();
    if (node.kind == RayNode::Kind::view)
        line("Ray 1, the view ray");
    else
        line(fmt::format(
            "Ray {}, {} by ray {}, level {}",
            number + 1,
            node.kind == RayNode::Kind::totally_reflected ? "totally reflected"
                : node.kind == RayNode::Kind::mirrored    ? "mirrored"
                                                          : "refracted",
            node.parent + 1,
            node.level));
    row("starts at",
        fmt::format(
            "{}, runs along {}", vector(node.ray.ray.origin), vector(node.ray.ray.direction)));
    if (number > 0)
        row("weight", color(node.weight) + ": so much of its colour reaches the picture");
    row("counted",
        fmt::format(
            "{} cells or nodes visited, {} objects tested", node.counts.cells, node.counts.tests));
    if (!of_.visits.empty())
        add_visits("visits", of_.visits[number].walk, 1);
    if (!node.hit.found()) {
        row("meets", "nothing: it leaves the scene");
        line(fmt::format("  {:<{}}{:>11} {:>11} {:>11}", "", label_width, "red", "green", "blue"));
        term(
            "firmament",
            node.color,
            of_.traced.firmament ? node.ray.ray.direction.y < 0
                    ? "EARTH, since the ray runs downwards"
                    : fmt::format(
                        "HORIZON + (SKY - HORIZON) times {:.6g}, how far it runs upwards",
                        node.ray.ray.direction.y)
                                 : "black: there is no SKY");
        return;
    }
    add_hit(node);
    for (std::size_t i = 0; i < node.lights.size(); ++i)
        add_light(number, i);
    add_terms(node);
}

void Report::add_hit(const RayNode& node) {
    const SceneObject object = objects_.object(node.hit.face);
    std::string what = fmt::format("{} {}", object.kind, object.number);
    if (object.triangle > 0)
        what += fmt::format(", its triangle {}", object.triangle);
    row("meets", what + ", from the " + (node.incidence.from_outside ? "outside" : "inside"));
    row("written at", to_text(object.place));
    if (!object.parts.empty())
        row("is part of", fmt::format("{}", fmt::join(object.parts, ", within it ")));
    for (const SceneObject::Call& call : object.calls)
        row("in subscene", fmt::format("{}, called at {}", call.subscene, to_text(call.place)));
    row("material", material_name(of_.prepared.scene, node.surface.material));
    row("point", fmt::format("{}, at distance {:.6g}", vector(node.surface.point), node.hit.t));
    row("normal N",
        fmt::format(
            "{}, towards the viewer; R.N = {:.6g}",
            vector(node.incidence.normal),
            node.incidence.cos_viewer));
}

std::string Report::visibility(const LightAtPlace& light) {
    if (light.behind)
        return "behind the surface: it gives nothing";
    if (!light.shadow_ray)
        return of_.traced.shadows ? "visibility not asked: its terms are 0"
                                  : "visibility 1: SHADOWS is off";
    std::string text = fmt::format("visibility {}", color(light.visibility));
    if (!light.crossings_known)
        return text + "; the scene is too large to list what stands between";
    if (light.crossings.empty())
        text += ", nothing stands between";
    return text;
}

void Report::add_visits(const char* label, const RayWalk& walk, double direction_length) {
    for (const std::string& words : visit_lines(walk, direction_length, objects_)) {
        row(label, words);
        label = "";
    }
}

void Report::add_light(std::size_t ray, std::size_t number) {
    const LightAtPlace& light = of_.tree.nodes[ray].lights[number];
    row(fmt::format("light {}", number + 1).c_str(),
        fmt::format(
            "at distance {:.6g}, intensity there {}; L.N = {:.6g}, L.R = {:.6g}, L.S = {:.6g}",
            light.distance,
            color(light.intensity),
            light.cos_normal,
            light.cos_viewer,
            light.cos_mirrored));
    row("", visibility(light));
    constexpr std::size_t most_shown = 8;
    for (std::size_t i = 0; i < std::min(light.crossings.size(), most_shown); ++i) {
        const ShadowCrossing& crossing = light.crossings[i];
        const std::string name = short_name(objects_.object(crossing.face));
        const double distance = crossing.t * light.distance;
        row("",
            is_black(crossing.tab)
                ? fmt::format("shadowed by {} at distance {:.6g}", name, distance)
                : fmt::format(
                    "filtered by {} at distance {:.6g}, TAB {}",
                    name,
                    distance,
                    color(crossing.tab)));
    }
    if (light.crossings.size() > most_shown)
        row("", fmt::format("and {} more surfaces", light.crossings.size() - most_shown));
    if (light.shadow_ray)
        row("",
            fmt::format(
                "its shadow ray: {} cells or nodes visited, {} objects tested",
                light.counts.cells,
                light.counts.tests));
    if (!of_.visits.empty() && of_.visits[ray].shadow_walks[number])
        add_visits("", *of_.visits[ray].shadow_walks[number], light.distance);
}

void Report::add_light_terms(const LightAtPlace& light, std::size_t number) {
    const std::string of = fmt::format(" light {}", number + 1);
    if (light.behind) {
        term("Dif" + of, {}, "the surface is turned away from it");
        return;
    }
    term(
        "Dif" + of,
        light.terms.diffuse,
        fmt::format(
            "visibility times (DRF's {} + ARF's {})",
            color(light.diffuse_drf),
            color(light.diffuse_arf)));
    term(
        "Spk" + of,
        light.terms.highlight,
        light.highlight == 0
            ? std::string("L.S does not reach SPC")
            : fmt::format(
                "f(L.S) = {:.6g}, squared, times intensity and visibility", light.highlight));
}

void Report::add_terms(const RayNode& node) {
    line(fmt::format("  {:<{}}{:>11} {:>11} {:>11}", "", label_width, "red", "green", "blue"));
    const Material& material = *node.material;
    term(
        "Amb",
        node.local.ambient,
        fmt::format(
            "(R.N DRF + ARF) AMBIENT: DRF {}, ARF {}, AMBIENT {}",
            color(material.drf),
            color(material.arf),
            color(of_.traced.illumination.ambient)));
    for (std::size_t i = 0; i < node.lights.size(); ++i)
        add_light_terms(node.lights[i], i);
    term(
        "Slm",
        node.local.luminosity,
        fmt::format(
            "self-luminosity: R.N SAN {} + SDI {}",
            color(node.luminosity_san),
            color(material.sdi)));
    add_sent(node);
    term("sum", node.color, "the colour that this ray brings");
}

void Report::add_sent(const RayNode& node) {
    const Material& material = *node.material;
    const auto sent = [&](const char* name,
                          const char* factor,
                          Color part,
                          Color value,
                          const std::optional<std::size_t>& ray) {
        if (ray)
            term(
                name,
                value,
                fmt::format("{} {} times the colour of ray {}", factor, color(part), *ray + 1));
        else if (!is_black(part))
            term(
                name,
                {},
                fmt::format("{} {}: not followed, RTDEPTH ends here", factor, color(part)));
        else
            term(name, {}, fmt::format("{} is black", factor));
    };
    sent("Rfl", "RAB", material.rab, node.mirrored, node.mirrored_ray);
    sent("Rfr", "TAB", material.tab, node.refracted, node.refracted_ray);
}

void Report::add_sum() {
    line();
    line("The same as a sum of layers, weights multiplied down the tree, in floats of 32 bits as");
    line("'vera render --layers' writes them. It ends in the picture's bytes exactly.");
    std::size_t width = 0;
    for (const PictureLayer& layer : of_.layers)
        width = std::max(width, layer.name.size());
    line(fmt::format(
        "  {:<{}}{:>15}{:>15}{:>15}   {:>15}{:>15}{:>15}",
        "layer",
        width,
        "red",
        "green",
        "blue",
        "sum: red",
        "green",
        "blue"));
    std::size_t left_out = 0;
    LayerSample sum = {};
    for (std::size_t i = 0; i < of_.samples.size(); ++i) {
        const LayerSample& sample = of_.samples[i];
        const bool is_rounding = i == of_.layers.size();
        sum = layer_sum(std::array{sum, sample});
        if (!is_rounding && sample == LayerSample{}) {
            ++left_out;
            continue;
        }
        line(fmt::format(
            "  {:<{}}{:>15}{:>15}{:>15}   {:>15}{:>15}{:>15}",
            is_rounding ? PictureLayer::rounding : of_.layers[i].name,
            width,
            sample[0],
            sample[1],
            sample[2],
            sum[0],
            sum[1],
            sum[2]));
    }
    const auto bytes = picture_bytes(of_);
    line(fmt::format(
        "  {:<{}}{:>48}{:>15}{:>15}{:>15}",
        "255 times that, limited and rounded",
        width > 35 ? width : 35,
        "",
        bytes[0],
        bytes[1],
        bytes[2]));
    if (left_out > 0)
        line(fmt::format("  {} layers that are black here were left out.", left_out));
}

} // namespace

std::array<std::uint8_t, 3> picture_bytes(const Explanation& explanation) {
    const Color color = explanation.tree.nodes.front().color;
    return {developed_byte(color.r), developed_byte(color.g), developed_byte(color.b)};
}

const char* name_of(RayNode::Kind kind) {
    switch (kind) {
    case RayNode::Kind::view:
        return "view";
    case RayNode::Kind::mirrored:
        return "mirrored";
    case RayNode::Kind::refracted:
        return "refracted";
    case RayNode::Kind::totally_reflected:
        return "totally_reflected";
    }
    return "";
}

std::string explanation_text(const Explanation& explanation) {
    return Report(explanation).text();
}

} // namespace vera
