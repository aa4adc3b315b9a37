// SPDX-License-Identifier: Apache-2.0
#include "reference/faces.h"

#include "reference/contour.h"
#include "reference/plane_faces.h"

namespace vera::reference {
namespace {

/// A sphere, perhaps pulled into an ellipsoid: the line is carried back to where it is a sphere.
struct Ball final : Face {
    Placement placement;
    Vector center;
    Real radius = 1;

    void
    cross(const Line& line, bool starts_here, std::vector<Crossing>& crossings) const override {
        const Vector o = placed_back(placement, line.origin) - center;
        const Vector d = turned_back(placement, line.direction);
        cross_quadric(
            inner(d, d), inner(o, d), inner(o, o) - radius * radius, starts_here, [&](Real t) {
                crossings.push_back({t, 0, this});
            });
    }

    // "Spheres are solid by themselves": outside is away from the centre.
    Surface surface(Vector point, const Crossing&) const override {
        const Vector away = placed_back(placement, point) - center;
        const Vector normal = unit(carried_normal(placement, away));
        return {normal, normal};
    }
};

class Builder {
public:
    explicit Builder(const Scene& scene)
        : scene_(scene) {}

    // "A subscene starts ... with the material that was current at the call; its own CM overrides
    // that."
    Group build(const Geometry& geometry, const Placement& placement, MaterialId current) {
        Group group;
        for (const Item& item : geometry.items) {
            const MaterialId material =
                item.material == inherited_material ? current : item.material;
            if (item.kind == ItemKind::subscene_call) {
                const SubsceneCall& call = geometry.calls[item.index];
                group.groups.push_back(build(
                    scene_.subscenes[static_cast<std::size_t>(call.subscene)],
                    chained(placement, placement_of(call.to_parent)),
                    material));
                continue;
            }
            const std::size_t first = group.faces.size();
            add(group, geometry, item, placement);
            for (std::size_t i = first; i < group.faces.size(); ++i) {
                group.faces[i]->order = next_order_++;
                group.faces[i]->material = material;
            }
        }
        put_ball_round(group);
        return group;
    }

private:
    static void
    add(Group& group, const Geometry& geometry, const Item& item, const Placement& placement) {
        const auto corner = [&](Vec3 point) { return placed(placement, vector_of(point)); };
        const PlaneSides sides = {item.outside, volume(placement) < 0};
        switch (item.kind) {
        case ItemKind::sphere: {
            const Sphere& sphere = geometry.spheres[item.index];
            auto ball = std::make_unique<Ball>();
            ball->placement = placement;
            ball->center = vector_of(sphere.center);
            ball->radius = sphere.radius;
            ball->ball_center = corner(sphere.center);
            ball->ball_radius = ball->radius * stretch(placement);
            group.faces.push_back(std::move(ball));
            break;
        }
        case ItemKind::triangle: {
            const auto& [a, b, c] = geometry.triangles[item.index].corners;
            group.faces.push_back(polygon_face({corner(a), corner(b), corner(c)}, sides));
            break;
        }
        case ItemKind::polygon: {
            const Polygon& polygon = geometry.polygons[item.index];
            std::vector<Vector> corners;
            for (std::size_t i = 0; i < polygon.corner_count; ++i)
                corners.push_back(corner(geometry.corners[polygon.first_corner + i]));
            if (polygon.shape == Polygon::Shape::split_quadrangle) {
                group.faces.push_back(polygon_face({corners[0], corners[1], corners[2]}, sides));
                group.faces.push_back(polygon_face({corners[0], corners[2], corners[3]}, sides));
            } else {
                group.faces.push_back(polygon_face(corners, sides));
            }
            break;
        }
        case ItemKind::patch: {
            const Patch& patch = geometry.patches[item.index];
            const auto& [a, b, c] = patch.corners;
            std::array<Vector, 3> normals;
            for (std::size_t i = 0; i < 3; ++i)
                normals[i] = carried_normal(placement, vector_of(patch.normals[i]));
            group.faces.push_back(patch_face({corner(a), corner(b), corner(c)}, normals, sides));
            break;
        }
        case ItemKind::rotational_shape:
            for (auto& piece : contour_faces(geometry.rotational_shapes[item.index], placement))
                group.faces.push_back(std::move(piece));
            break;
        case ItemKind::mesh:
            add_mesh(group, geometry.meshes[item.index], placement, sides);
            break;
        case ItemKind::subscene_call:
            break;
        }
    }

    static void
    add_mesh(Group& group, const Mesh& mesh, const Placement& placement, const PlaneSides& sides) {
        const auto& normal_indices =
            mesh.normal_indices.empty() ? mesh.position_indices : mesh.normal_indices;
        for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
            std::vector<Vector> corners;
            std::array<Vector, 3> normals;
            for (std::size_t c = 0; c < 3; ++c) {
                corners.push_back(
                    placed(placement, vector_of(mesh.positions[mesh.position_indices[3 * i + c]])));
                if (!mesh.normals.empty())
                    normals[c] = carried_normal(
                        placement, vector_of(mesh.normals[normal_indices[3 * i + c]]));
            }
            group.faces.push_back(
                mesh.normals.empty() ? polygon_face(corners, sides)
                                     : patch_face(corners, normals, sides));
        }
    }

    static void put_ball_round(Group& group) {
        std::vector<std::pair<Vector, Real>> balls;
        for (const auto& face : group.faces)
            balls.emplace_back(face->ball_center, face->ball_radius);
        for (const Group& inner_group : group.groups)
            balls.emplace_back(inner_group.ball_center, inner_group.ball_radius);
        for (const auto& [center, radius] : balls)
            group.ball_center = group.ball_center + (1 / static_cast<Real>(balls.size())) * center;
        for (const auto& [center, radius] : balls)
            group.ball_radius =
                std::fmax(group.ball_radius, norm(center - group.ball_center) + radius);
    }

    const Scene& scene_;
    std::uint64_t next_order_ = 0;
};

bool misses_ball(const Line& line, Vector center, Real radius) {
    const Vector to_center = center - line.origin;
    const Vector across = to_center - inner(to_center, line.direction) * line.direction;
    // A little room: balls are found with rounding errors too.
    return norm(across) > radius * (1 + 1e-9L) + 1e-12L * size(line.origin);
}

void collect(
    const Group& group, const Line& line, const Face* start, std::vector<Crossing>& crossings) {
    if (misses_ball(line, group.ball_center, group.ball_radius))
        return;
    for (const auto& face : group.faces)
        if (face.get() == start || !misses_ball(line, face->ball_center, face->ball_radius))
            face->cross(line, face.get() == start, crossings);
    for (const Group& inner_group : group.groups)
        collect(inner_group, line, start, crossings);
}

} // namespace

Group faces_of(const Scene& scene) {
    return Builder(scene).build(scene.geometry, {}, inherited_material);
}

std::vector<Crossing> crossings(const Group& group, const Line& line, const Face* start) {
    std::vector<Crossing> found;
    collect(group, line, start, found);
    return found;
}

} // namespace vera::reference
