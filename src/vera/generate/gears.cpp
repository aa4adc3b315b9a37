// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/gears.h"

#include "vera/generate/formula_functions.h"
#include "vera/generate/scene_parts.h"
#include "vera/math/elementary.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vera {

namespace {

constexpr double degrees_per_radian = 180 / std::numbers::pi;

double pitch_radius(std::size_t teeth) {
    return 0.5 * static_cast<double>(teeth);
}

/// The angle in degrees by which an involute has turned from its beginning on the base circle when
/// it has come to the radius: tan a - a, with a the pressure angle there.
double involute_degrees(double base, double radius) {
    const double tangent = std::sqrt(std::max(0.0, (radius / base) * (radius / base) - 1));
    return (tangent - arc_tangent(tangent)) * degrees_per_radian;
}

Vec3 polar(double radius, double angle_degrees) {
    return {radius * cos_degrees(angle_degrees), radius * sin_degrees(angle_degrees), 0};
}

/// The outline of a gear's tooth turned about the axis to its place.
std::vector<Vec3> turned(const std::vector<Vec3>& outline, double angle_degrees) {
    const Affine3 map = rotation({0, 0, angle_degrees});
    std::vector<Vec3> points;
    points.reserve(outline.size());
    for (const Vec3 point : outline)
        points.push_back(short_decimals(transformed_point(map, point)));
    return points;
}

Vec3 raised(Vec3 point, double z) {
    return {point.x, point.y, z};
}

/// A polygon that need not be convex.
void add_simple_polygon(Geometry& geometry, const std::vector<Vec3>& corners, double side) {
    add_convex_polygon(geometry, corners);
    geometry.polygons.back().shape = Polygon::Shape::simple;
    geometry.polygons.back().normal = {0, 0, side};
}

/// The faces of a piece of the gear with one tooth, from bore to tip.
void add_tooth(
    Geometry& geometry, const GearForm& form, const std::vector<Vec3>& outer, double angle) {
    const double half = 180.0 / static_cast<double>(form.teeth);
    std::vector<Vec3> bore;
    for (const double part : {-1.0, 0.0, 1.0})
        bore.push_back(short_decimals(polar(form.bore_radius, angle + part * half)));
    const double z = short_decimals(Vec3{0, 0, 0.5 * form.width}).z;
    std::vector<Vec3> face;
    face.reserve(outer.size() + bore.size());
    for (const Vec3 point : outer)
        face.push_back(raised(point, z));
    for (std::size_t i = bore.size(); i-- > 0;)
        face.push_back(raised(bore[i], z));
    add_simple_polygon(geometry, face, 1);
    std::reverse(face.begin(), face.end());
    for (Vec3& point : face)
        point.z = -z;
    add_simple_polygon(geometry, face, -1);
    const auto add_wall = [&](Vec3 a, Vec3 b) {
        add_convex_polygon(geometry, {raised(a, -z), raised(b, -z), raised(b, z), raised(a, z)});
    };
    for (std::size_t i = 0; i + 1 < outer.size(); ++i)
        add_wall(outer[i], outer[i + 1]);
    for (std::size_t i = bore.size() - 1; i > 0; --i)
        add_wall(bore[i], bore[i - 1]);
}

void add_gear(Geometry& geometry, const GearForm& form) {
    const std::vector<Vec3> outline = tooth_outline(form);
    for (std::size_t i = 0; i < form.teeth; ++i) {
        const double angle = 360.0 * static_cast<double>(i) / static_cast<double>(form.teeth);
        std::vector<Vec3> outer = turned(outline, angle);
        // The corner shared with the next tooth is rounded once.
        const double next =
            360.0 * static_cast<double>((i + 1) % form.teeth) / static_cast<double>(form.teeth);
        outer.back() = turned({outline.front()}, next).front();
        add_tooth(geometry, form, outer, angle);
    }
}

} // namespace

std::vector<Vec3> tooth_outline(const GearForm& form) {
    constexpr double addendum = 1;
    constexpr double dedendum = 1.25;
    constexpr int flank_steps = 8;
    const double pitch = pitch_radius(form.teeth);
    const double base = pitch * cos_degrees(form.pressure_degrees);
    const double root = pitch - dedendum;
    const double tip = pitch + addendum;
    const double part = 360.0 / static_cast<double>(form.teeth);
    // Half the tooth's angle is a quarter of its part on the pitch circle, and less farther out.
    const double at_base = part / 4 + involute_degrees(base, pitch);
    const double start = std::max(base, root);
    std::vector<Vec3> flank;
    if (root < base)
        flank.push_back(polar(root, -at_base));
    for (int i = 0; i <= flank_steps; ++i) {
        const double radius = start + (tip - start) * i / flank_steps;
        const double half = at_base - involute_degrees(base, radius);
        // Teeth of few or steep gears end in a point.
        if (half <= 0.02 * part)
            break;
        flank.push_back(polar(radius, -half));
    }
    std::vector<Vec3> outline = {polar(root, -part / 2)};
    outline.insert(outline.end(), flank.begin(), flank.end());
    for (std::size_t i = flank.size(); i-- > 0;)
        outline.push_back({flank[i].x, -flank[i].y, 0});
    outline.push_back(polar(root, part / 2));
    return outline;
}

Scene make_gear(const ParameterValues& values) {
    GearForm form;
    form.teeth = values.whole("teeth");
    form.pressure_degrees = values["pressure"];
    form.width = values["width"];
    // Some of the body is left below the teeth.
    const double pitch = pitch_radius(form.teeth);
    form.bore_radius = std::min(values["bore"] * pitch, 0.8 * (pitch - 1.25));
    Scene scene;
    add_gear(scene.geometry, form);
    return scene;
}

Scene make_gears(const ParameterValues& values) {
    const std::array<std::size_t, 3> teeth = {
        values.whole("first"), values.whole("second"), values.whole("third")};
    const std::array<Color, 3> colors = {
        {{0.62, 0.47, 0.20}, {0.50, 0.52, 0.55}, {0.58, 0.34, 0.20}}};
    constexpr std::array<const char*, 3> names = {"gears-brass", "gears-steel", "gears-copper"};
    constexpr double width = 4;
    Scene scene;
    const MaterialId steel = add_material(scene, "gears-axle", {0.30, 0.31, 0.33});
    scene.materials.back().rab = {0.25, 0.25, 0.26};
    scene.materials.back().spc = 0.95;
    // Where the centre of each lies, seen from that of the one before it.
    constexpr std::array<double, 3> bearing = {0, 20, -50};
    Vec3 center;
    double turn = 0; // degrees, of a tooth from the x axis
    for (std::size_t i = 0; i < teeth.size(); ++i) {
        if (i > 0) {
            const double distance = pitch_radius(teeth[i - 1]) + pitch_radius(teeth[i]);
            center = center + distance * polar(1, bearing[i]);
            // Where the pitch circles touch, a tooth of one meets a gap of the other: what the one
            // before has turned past the line of centres, this one turns back by the same arc.
            const double past = (bearing[i] - turn) * static_cast<double>(teeth[i - 1]);
            turn = bearing[i] + 180 + (past + 180) / static_cast<double>(teeth[i]);
        }
        const MaterialId metal = add_material(scene, names[i], 0.6 * colors[i]);
        scene.materials.back().rab = 0.45 * colors[i];
        scene.materials.back().spc = 0.93;
        const SubsceneId gear = add_subscene(scene, std::string(names[i]).substr(6) + "-gear");
        const double bore = 0.3 * (pitch_radius(teeth[i]) - 1.25);
        add_gear(geometry_of(scene, gear), {teeth[i], 20, width, bore});
        add_call(
            scene.geometry,
            gear,
            short_decimals(
                in_turn(rotation({0, 0, turn}), translation(center), rotation({-90, 0, 0}))),
            metal);
        const Vec3 foot = transformed_point(rotation({-90, 0, 0}), center);
        RotationalShape axle;
        axle.base = {foot.x, -width / 2 - 0.6, foot.z};
        axle.axis = {0, 1, 0};
        axle.start = {bore + 0.8, 0};
        for (const ContourPiece::Point point :
             {ContourPiece::Point{bore + 0.8, 0.6},
              {bore, 0.6},
              {bore, width + 1.2},
              {0.9 * bore, width + 1.4},
              {0, width + 1.4}})
            axle.contour.push_back({.end = point});
        add(scene.geometry, axle, steel);
    }
    return scene;
}

} // namespace vera
