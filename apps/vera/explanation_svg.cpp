// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/elliptic_arc.h"
#include "vera/image/develop.h"
#include "vera/math/elementary.h"
#include "vera/visible/draw_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "explanation.h"
#include "ray_view.h"
#include "scene_objects.h"
#include <fmt/format.h>

namespace vera {

namespace {

constexpr std::uint32_t picture_width = 900;
constexpr std::uint32_t picture_height = 640;
constexpr double panel_width = 400; ///< right of the picture
constexpr double node_radius = 9;
constexpr const char* box_color = "#cc79a7"; ///< of the same set of colours as those of the rays

struct RayStyle {
    const char* color;
    const char* dashes; ///< empty: none
    double width;
    const char* meaning;
};

/// Colours that the colour-blind tell apart (Okabe and Ito 2008).
const RayStyle& style_of(RayLine::Kind kind) {
    static constexpr std::array<RayStyle, 6> styles = {{
        {"#000000", "", 2.6, "view ray"},
        {"#0072b2", "", 2.2, "mirrored ray"},
        {"#009e73", "", 2.2, "refracted ray"},
        {"#e69f00", "", 1.4, "to a light that is seen"},
        {"#e69f00", "2 3", 1.8, "to a light, filtered by glass"},
        {"#d55e00", "6 4", 1.4, "to a light, up to what shadows it"},
    }};
    return styles[static_cast<std::size_t>(kind)];
}

std::string escaped(std::string_view text) {
    std::string result;
    for (const char letter : text)
        if (letter == '<')
            result += "&lt;";
        else if (letter == '&')
            result += "&amp;";
        else if (letter == '"')
            result += "&quot;";
        else if (static_cast<unsigned char>(letter) < ' ')
            result += '?';
        else
            result += letter;
    return result;
}

std::string css(Color color) {
    return fmt::format(
        "#{:02x}{:02x}{:02x}",
        developed_byte(color.r),
        developed_byte(color.g),
        developed_byte(color.b));
}

/// The points of a stroke, its arcs as short pieces.
std::vector<DrawingPoint> points_of(const Stroke& stroke) {
    constexpr double degrees_a_piece = 2;
    std::vector<DrawingPoint> points;
    auto arc = stroke.arcs.begin();
    for (std::size_t i = 0; i < stroke.points.size(); ++i) {
        points.push_back(stroke.points[i]);
        if (arc == stroke.arcs.end() || arc->segment != i)
            continue;
        const double turn = arc->end_degrees - arc->begin_degrees;
        const int pieces = static_cast<int>(std::abs(turn) / degrees_a_piece) + 1;
        for (int piece = 1; piece < pieces; ++piece)
            points.push_back(point_at(arc->ellipse, arc->begin_degrees + turn * piece / pieces));
        ++arc;
    }
    if (stroke.closed && !points.empty())
        points.push_back(points.front());
    return points;
}

/// Puts the drawing together, part by part.
class RayDrawing {
public:
    explicit RayDrawing(const Explanation& explanation)
        : of_(explanation)
        , objects_(explanation.prepared.scene)
        , lines_(ray_lines(explanation.tree, explanation.prepared.scene))
        , view_(ray_view(
              explanation.tree, lines_, explanation.traced.index, picture_width, picture_height)) {}

    std::string svg(const Progress& progress, const CancelFlag& cancel) {
        add_head();
        add_scene(progress, cancel);
        if (!of_.visits.empty())
            add_boxes(of_.visits.front().walk);
        add_rays();
        add_lights();
        add_eye();
        add_numbers();
        text_ += "</g>\n";
        add_panel();
        text_ += "</svg>\n";
        return std::move(text_);
    }

private:
    template <typename... Parts>
    void put(fmt::format_string<Parts...> format, Parts&&... parts) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Parts>(parts)...);
        text_ += '\n';
    }

    void add_head();
    void add_scene(const Progress& progress, const CancelFlag& cancel);
    void add_boxes(const RayWalk& walk);
    void add_rays();
    void add_ray(const RayLine& line);
    void add_lights();
    void add_eye();
    void add_numbers();
    void add_panel();
    double add_legend(double x, double y);
    double add_ray_list(double x, double y);
    DrawingPoint free_place(DrawingPoint wanted);

    const Explanation& of_;
    SceneObjects objects_;
    std::vector<RayLine> lines_;
    RayView view_;
    std::vector<DrawingPoint> taken_; ///< where numbers and names stand already
    std::string text_;
};

void RayDrawing::add_head() {
    const double width = picture_width + panel_width;
    put(R"(<?xml version="1.0" encoding="UTF-8"?>)");
    put(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0:g}" height="{1}" )"
        R"(viewBox="0 0 {0:g} {1}" font-family="Helvetica, Arial, sans-serif" )"
        R"(font-size="13">)",
        width,
        picture_height);
    put("<title>The rays of pixel {} {}</title>", of_.x, of_.y);
    put(R"(<rect width="{:g}" height="{}" fill="#ffffff"/>)", width, picture_height);
    put(R"(<clipPath id="picture"><rect width="{}" height="{}"/></clipPath>)",
        picture_width,
        picture_height);
    put(R"svg(<g clip-path="url(#picture)" stroke-linecap="round" stroke-linejoin="round">)svg");
}

void RayDrawing::add_scene(const Progress& progress, const CancelFlag& cancel) {
    PictureSettings picture = of_.prepared.settings;
    picture.width = picture_width;
    picture.height = picture_height;
    picture.shadows = false;
    DrawSettings settings;
    // Where something stands before the rays, what is behind it is to be seen all the same.
    settings.style = view_.sees_all ? DrawingStyle::lines : DrawingStyle::hidden_lines;
    const DrawnScene drawn =
        draw_scene(of_.prepared.scene, view_.camera, picture, settings, progress, &cancel);
    for (const LineClass line_class :
         {LineClass::hidden, LineClass::intersection, LineClass::crease, LineClass::silhouette}) {
        const bool hidden = line_class == LineClass::hidden;
        put(R"(<g id="{}" fill="none" stroke="{}" stroke-width="{}"{}>)",
            name_of(line_class),
            hidden ? "#c4c4c4" : "#8a8a8a",
            line_class == LineClass::silhouette ? 1.1 : 0.7,
            hidden ? R"( stroke-dasharray="3 3")" : "");
        for (const Stroke& stroke : drawn.drawing.strokes) {
            if (stroke.line_class != line_class)
                continue;
            text_ += R"(<polyline points=")";
            for (const DrawingPoint point : points_of(stroke))
                fmt::format_to(std::back_inserter(text_), "{:.1f},{:.1f} ", point.x, point.y);
            text_.back() = '"';
            text_ += "/>\n";
        }
        put("</g>");
    }
}

/// The cells that the ray goes through and the leaves that it comes to, as far as something stands
/// in them.
void RayDrawing::add_boxes(const RayWalk& walk) {
    put(R"(<g id="visited" stroke="{}" stroke-width="0.8">)", box_color);
    for (const WalkStep& step : walk.steps) {
        if (step.listed == 0)
            continue;
        const auto corner = [&](std::size_t number) {
            Vec3 point = step.box.lower;
            for (std::size_t axis = 0; axis < 3; ++axis)
                if ((number >> axis & 1U) != 0)
                    point[axis] = step.box.upper[axis];
            return view_.on_picture(transformed_point(walk.places[step.place].to_scene, point));
        };
        for (std::size_t number = 0; number < 8; ++number)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::size_t other = number | std::size_t{1} << axis;
                if (other == number)
                    continue;
                const DrawingPoint from = corner(number);
                const DrawingPoint to = corner(other);
                put(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)",
                    from.x,
                    from.y,
                    to.x,
                    to.y);
            }
    }
    put("</g>");
}

void RayDrawing::add_rays() {
    // View rays on top of what they send, these on top of the ways to lights.
    std::vector<RayLine> order = lines_;
    std::stable_sort(order.begin(), order.end(), [](const RayLine& a, const RayLine& b) {
        return a.kind > b.kind;
    });
    put(R"(<g id="rays" fill="none">)");
    for (const RayLine& line : order)
        add_ray(line);
    put("</g>");
}

void RayDrawing::add_ray(const RayLine& line) {
    const RayStyle& style = style_of(line.kind);
    const DrawingPoint from = view_.on_picture(line.from);
    const DrawingPoint to = view_.on_picture(line.to);
    const std::string dashes = *style.dashes == '\0'
        ? std::string()
        : fmt::format(R"( stroke-dasharray="{}")", style.dashes);
    put(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="{}" )"
        R"(stroke-width="{}"{}/>)",
        from.x,
        from.y,
        to.x,
        to.y,
        style.color,
        style.width,
        dashes);
    const double length = distance(from, to);
    if (line.kind == RayLine::Kind::shadowed && !line.goes_on) {
        constexpr double arm = 4;
        put(R"(<path d="M{:.1f} {:.1f}l{} {}m0 {}l{} {}" stroke="{}" stroke-width="2"/>)",
            to.x - arm,
            to.y - arm,
            2 * arm,
            2 * arm,
            -2 * arm,
            -2 * arm,
            2 * arm,
            style.color);
        return;
    }
    constexpr double head = 11;
    if (length < 3 * head)
        return;
    // The arrow shows the way that the ray runs, in its middle, or at its end where that is open.
    const double at = line.goes_on ? 1 : 0.5 + head / 2 / length;
    const DrawingPoint along = {(to.x - from.x) / length, (to.y - from.y) / length};
    const DrawingPoint tip = {from.x + at * length * along.x, from.y + at * length * along.y};
    const DrawingPoint back = {tip.x - head * along.x, tip.y - head * along.y};
    put(R"(<path d="M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z" fill="{}"/>)",
        tip.x,
        tip.y,
        back.x - 0.36 * head * along.y,
        back.y + 0.36 * head * along.x,
        back.x + 0.36 * head * along.y,
        back.y - 0.36 * head * along.x,
        style.color);
}

/// The place, or one beside it, that is away from all others.
DrawingPoint RayDrawing::free_place(DrawingPoint wanted) {
    constexpr double apart = 2 * node_radius + 2;
    DrawingPoint best = wanted;
    for (int step = 0; step < 40; ++step) {
        const double away = apart * std::floor(step / 8.0);
        const double turn = step % 8 * 45.0;
        best = {wanted.x + away * cos_degrees(turn), wanted.y + away * sin_degrees(turn)};
        const bool is_free =
            std::none_of(taken_.begin(), taken_.end(), [&](const DrawingPoint& other) {
                return distance(best, other) < apart;
            });
        if (is_free)
            break;
    }
    taken_.push_back(best);
    return best;
}

void RayDrawing::add_lights() {
    std::vector<bool> shown(of_.prepared.scene.lights.size(), false);
    for (const RayLine& line : lines_) {
        const bool to_light =
            line.kind == RayLine::Kind::lit || line.kind == RayLine::Kind::filtered;
        if (!to_light || shown[line.light])
            continue;
        shown[line.light] = true;
        const DrawingPoint at = view_.on_picture(line.to);
        if (!line.goes_on) {
            put(R"(<g stroke="#e69f00" stroke-width="2">)");
            for (int degrees = 0; degrees < 360; degrees += 45)
                put(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)",
                    at.x + 9 * cos_degrees(degrees),
                    at.y + 9 * sin_degrees(degrees),
                    at.x + 14 * cos_degrees(degrees),
                    at.y + 14 * sin_degrees(degrees));
            put(R"(<circle cx="{:.1f}" cy="{:.1f}" r="6" fill="#ffe9b0"/>)", at.x, at.y);
            put("</g>");
        }
        taken_.push_back(at);
        put(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle" fill="#8a5f00">{}light )"
            "{}</text>",
            std::clamp(at.x, 60.0, picture_width - 60.0),
            std::max(at.y - 19, 14.0),
            line.goes_on ? "to " : "",
            line.light + 1);
    }
}

void RayDrawing::add_eye() {
    const DrawingPoint at = view_.on_picture(lines_.front().from);
    const bool has_point = std::isfinite(of_.tree.nodes.front().ray.ray.t_min);
    if (has_point) {
        put(R"(<path d="M{:.1f} {:.1f}q12 -13 24 0q-12 13 -24 0z" fill="#ffffff" )"
            R"(stroke="#000000" stroke-width="1.5"/>)",
            at.x - 12,
            at.y);
        put(R"(<circle cx="{:.1f}" cy="{:.1f}" r="3.5"/>)", at.x, at.y);
    }
    taken_.push_back(at);
    put(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)",
        std::clamp(at.x, 60.0, picture_width - 60.0),
        view_.on_picture(lines_.front().to).y > at.y + 40 ? at.y - 16 : at.y + 24,
        has_point ? "view point" : "from the viewer");
}

void RayDrawing::add_numbers() {
    for (const RayLine& line : lines_) {
        if (line.kind > RayLine::Kind::refracted)
            continue;
        DrawingPoint end = view_.on_picture(line.to);
        if (line.goes_on) {
            // Beyond the arrow.
            const DrawingPoint from = view_.on_picture(line.from);
            const double length = std::max(distance(from, end), 1.0);
            end.x += (node_radius + 3) / length * (end.x - from.x);
            end.y += (node_radius + 3) / length * (end.y - from.y);
        }
        const DrawingPoint at = free_place(end);
        if (distance(at, end) > 0)
            put(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="#888888" )"
                R"(stroke-width="0.7"/>)",
                at.x,
                at.y,
                end.x,
                end.y);
        put(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{}" fill="#ffffff" stroke="{}" )"
            R"(stroke-width="1.6"/>)",
            at.x,
            at.y,
            node_radius,
            style_of(line.kind).color);
        put(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle" font-size="11">{}</text>)",
            at.x,
            at.y + 4,
            line.node + 1);
    }
}

void RayDrawing::add_panel() {
    const double x = picture_width + 20;
    put(R"(<line x1="{0}" y1="0" x2="{0}" y2="{1}" stroke="#c4c4c4"/>)",
        picture_width,
        picture_height);
    const auto bytes = picture_bytes(of_);
    put(R"(<rect x="{:g}" y="20" width="52" height="52" fill="{}" stroke="#888888"/>)",
        x,
        css(of_.tree.nodes.front().color));
    put(R"(<text x="{:g}" y="40" font-size="17" font-weight="bold">Pixel {} {}</text>)",
        x + 66,
        of_.x,
        of_.y);
    put(R"(<text x="{:g}" y="63">bytes {} {} {}</text>)", x + 66, bytes[0], bytes[1], bytes[2]);
    add_ray_list(x, add_legend(x, 104));
}

double RayDrawing::add_legend(double x, double y) {
    for (std::size_t i = 0; i < 6; ++i) {
        const auto kind = static_cast<RayLine::Kind>(i);
        if (std::none_of(lines_.begin(), lines_.end(), [&](const RayLine& line) {
                return line.kind == kind;
            }))
            continue;
        const RayStyle& style = style_of(kind);
        put(R"(<line x1="{:g}" y1="{:g}" x2="{:g}" y2="{:g}" stroke="{}" )"
            R"(stroke-width="{}" stroke-dasharray="{}"/>)",
            x,
            y,
            x + 52,
            y,
            style.color,
            style.width,
            *style.dashes == '\0' ? "none" : style.dashes);
        put(R"(<text x="{:g}" y="{:g}">{}</text>)", x + 66, y + 4, style.meaning);
        y += 22;
    }
    if (!of_.visits.empty()) {
        put(R"(<rect x="{:g}" y="{:g}" width="52" height="12" fill="none" stroke="{}"/>)",
            x,
            y - 6,
            box_color);
        put(R"(<text x="{:g}" y="{:g}">{} whose objects the view ray is tested against</text>)",
            x + 66,
            y + 4,
            of_.index == "grid" ? "cells" : "boxes");
        y += 22;
    }
    return y + 14;
}

/// What each ray meets, and the colour that it brings.
double RayDrawing::add_ray_list(double x, double y) {
    constexpr std::size_t most_letters = 46;
    constexpr double row = 38;
    put(R"(<text x="{:g}" y="{:g}" font-weight="bold">What the rays meet</text>)", x, y);
    y += 16;
    for (std::size_t i = 0; i < of_.tree.nodes.size(); ++i) {
        const RayNode& node = of_.tree.nodes[i];
        if (y + row > picture_height - 12) {
            put(R"(<text x="{:g}" y="{:g}">and {} more rays</text>)",
                x,
                y + 14,
                of_.tree.nodes.size() - i);
            break;
        }
        std::string what = "leaves the scene";
        std::string where = of_.traced.firmament ? "sees the firmament" : "sees black";
        if (node.hit.found()) {
            const SceneObject object = objects_.object(node.hit.face);
            what = fmt::format(
                "{} {}, {}",
                object.kind,
                object.number,
                material_name(of_.prepared.scene, node.surface.material));
            where = to_text(object.place);
            // The end of a place says more than its beginning.
            if (where.size() > most_letters)
                where = "..." + where.substr(where.size() - most_letters);
        }
        put(R"(<rect x="{:g}" y="{:g}" width="26" height="26" fill="{}" )"
            R"(stroke="#888888"/>)",
            x,
            y,
            css(node.color));
        put(R"(<text x="{:g}" y="{:g}"><tspan font-weight="bold">{}</tspan>  {}</text>)",
            x + 36,
            y + 11,
            i + 1,
            escaped(what.substr(0, most_letters)));
        put(R"(<text x="{:g}" y="{:g}" font-size="11" fill="#555555">{}</text>)",
            x + 36,
            y + 25,
            escaped(where));
        y += row;
    }
    return y;
}

} // namespace

std::string explanation_svg(
    const Explanation& explanation, const Progress& progress, const CancelFlag& cancel) {
    return RayDrawing(explanation).svg(progress, cancel);
}

} // namespace vera
