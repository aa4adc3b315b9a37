// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/formula_shapes.h"

#include "vera/generate/scene_parts.h"
#include "vera/generate/surface.h"

#include <limits>
#include <numbers>

namespace vera {

namespace {

constexpr double turn = 2 * std::numbers::pi;

Mesh mesh_within(const Surface& surface, double deviation) {
    return tessellated(surface, {.allowed = deviation_of(deviation)});
}

} // namespace

Scene mesh_scene(Mesh mesh, const Affine3& placement) {
    Scene scene;
    if (placement == Affine3{}) {
        add(scene.geometry, std::move(mesh));
        return scene;
    }
    const SubsceneId part = add_subscene(scene, "surface-as-typed");
    add(geometry_of(scene, part), std::move(mesh));
    add_call(scene.geometry, part, placement);
    return scene;
}

Affine3 z_up_to_y_up() {
    Affine3 map;
    map.linear.rows = {Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, -1, 0}};
    return map;
}

Scene make_shell(const ParameterValues& values) {
    const FormulaNames names = {{"growth", values["growth"]}};
    const Surface surface = {
        .x = Formula("growth^(v/(2*pi)) * (0.1*cos(v) + 0.125*cos(v)*sin(u))", names),
        .y = Formula("growth^(v/(2*pi)) * (0.1*sin(v) + 0.125*sin(v)*sin(u))", names),
        .z = Formula("growth^(v/(2*pi)) * (0.6 + 0.25*cos(u))", names),
        .u_begin = 0,
        .u_end = turn,
        .v_begin = -turn * values["turns"],
        .v_end = 0};
    // The tip is at the origin and the shell grows along z: that way is down.
    Affine3 map = z_up_to_y_up();
    map.linear.rows[1] = -map.linear.rows[1];
    map.linear.rows[2] = -map.linear.rows[2];
    return mesh_scene(mesh_within(surface, values["deviation"]), map);
}

Scene make_knot(const ParameterValues& values) {
    // About the curve ((2 + cos qu) cos pu, (2 + cos qu) sin pu, sin qu) on the torus a circle lies
    // in the plane of the torus's normal and of what is across both that and the curve.
    const FormulaNames names = {{"p", values["p"]}, {"q", values["q"]}, {"w", values["thickness"]}};
    const std::string speed = "sqrt(p^2*(2 + cos(q*u))^2 + q^2)";
    const std::string radial =
        "(2 + cos(q*u) + w*cos(v)*cos(q*u) + w*sin(v)*p*(2 + cos(q*u))*sin(q*u)/" + speed + ")";
    const std::string along = "(w*sin(v)*q/" + speed + ")";
    const Surface surface = {
        .x = Formula(radial + "*cos(p*u) - " + along + "*sin(p*u)", names),
        .y = Formula(radial + "*sin(p*u) + " + along + "*cos(p*u)", names),
        .z = Formula(
            "sin(q*u) + w*cos(v)*sin(q*u) - w*sin(v)*p*(2 + cos(q*u))*cos(q*u)/" + speed, names),
        .u_begin = 0,
        .u_end = turn,
        .v_begin = 0,
        .v_end = turn};
    return mesh_scene(mesh_within(surface, values["deviation"]), z_up_to_y_up());
}

} // namespace vera
