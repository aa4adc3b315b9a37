// SPDX-License-Identifier: Apache-2.0
#include "random_scene.h"

#include "vera/math/transform.h"
#include "vera/scene/crossings.h"

#include <array>
#include <limits>

namespace vera::testing {

namespace {

class SceneMaker {
public:
    SceneMaker(std::uint64_t seed, const RandomSceneSettings& settings)
        : random_(seed)
        , settings_(settings) {}

    Scene scene() {
        Scene scene;
        for (int i = 0; i < 3; ++i) {
            Material material;
            if (settings_.glass && i > 0)
                material.tab = i == 1 ? Color{0.5, 0.25, 1} : Color{0.3, 0.7, 0};
            scene.materials.push_back(material);
        }
        // Subscene i calls only those before it.
        for (std::size_t i = 0; i < settings_.subscenes; ++i)
            scene.subscenes.push_back(geometry(settings_.items / 4 + 1, i));
        scene.geometry = geometry(settings_.items, settings_.subscenes);
        number_primitives(scene);
        return scene;
    }

private:
    std::size_t below(std::size_t count) { return random_() % count; }

    double coordinate() {
        constexpr std::array<double, 9> values = {-4, -2, -1, -0.5, 0, 0.1, 1, 2, 4};
        return settings_.scale * values[below(values.size())];
    }

    Vec3 point() { return {coordinate(), coordinate(), coordinate()}; }

    double radius() {
        constexpr std::array<double, 4> values = {0.1, 0.5, 1, 2};
        return settings_.scale * values[below(values.size())];
    }

    std::array<Vec3, 3> corners() {
        while (true) {
            const std::array<Vec3, 3> result = {point(), point(), point()};
            if (length(cross(result[1] - result[0], result[2] - result[0])) > 0)
                return result;
        }
    }

    /// Makes it a polygon of many corners within the parallelogram of the corner and two sides.
    static Polygon comb(Geometry& geometry, Polygon polygon, const std::array<Vec3, 3>& within) {
        const auto& [p, e, f] = within;
        polygon.shape = Polygon::Shape::simple;
        geometry.corners.push_back(p);
        for (int tooth = 0; tooth < 4; ++tooth) {
            geometry.corners.push_back(p + 0.25 * tooth * e + f);
            geometry.corners.push_back(p + (0.25 * tooth + 0.125) * e + f);
            geometry.corners.push_back(p + (0.25 * tooth + 0.125) * e + 0.5 * f);
            geometry.corners.push_back(p + 0.25 * (tooth + 1) * e + (tooth < 3 ? 0.5 : 0) * f);
        }
        polygon.corner_count =
            static_cast<std::uint32_t>(geometry.corners.size()) - polygon.first_corner;
        return polygon;
    }

    /// A rectangle, perhaps with one corner moved in its plane or out of it, or a comb.
    Polygon polygon(Geometry& geometry) {
        const auto three = corners();
        const Vec3 p = three[0];
        const Vec3 e = three[1] - p;
        const Vec3 f = three[2] - p;
        Polygon result;
        result.first_corner = static_cast<std::uint32_t>(geometry.corners.size());
        result.corner_count = 4;
        result.normal = normalized(cross(e, f));
        const std::size_t shape = below(5);
        if (shape == 4)
            return comb(geometry, result, {p, e, f});
        Vec3 last = p + f;
        Vec3 third = p + e + f;
        if (shape == 1) {
            result.shape = Polygon::Shape::simple;
            third = p + 0.25 * e + 0.25 * f;
        } else if (shape == 2) {
            result.shape = Polygon::Shape::split_quadrangle;
            last = last + length(e) * result.normal;
        } else if (shape == 3) {
            third = p + 0.5 * e + 1.5 * f;
        }
        for (const Vec3& corner : {p, p + e, third, last})
            geometry.corners.push_back(corner);
        return result;
    }

    RotationalShape rotational_shape() {
        RotationalShape shape;
        shape.base = point();
        constexpr std::array<Vec3, 4> axes = {
            Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{1, 1, 1}};
        shape.axis = normalized(axes[below(axes.size())]);
        shape.start = {below(2) == 0 ? 0 : radius(), 0};
        const std::size_t pieces = 1 + below(3);
        for (std::size_t i = 0; i < pieces; ++i) {
            ContourPiece piece;
            piece.end = {below(3) == 0 ? 0 : radius(), coordinate()};
            if (below(4) == 0) {
                piece.kind = ContourPiece::Kind::conic;
                piece.control[0] = {radius(), coordinate()};
                piece.weight = 0.5;
            }
            shape.contour.push_back(piece);
        }
        return shape;
    }

    Mesh mesh() {
        Mesh mesh;
        for (int i = 0; i < 6; ++i)
            mesh.positions.push_back(point());
        const std::size_t triangles = below(8);
        while (mesh.triangle_count() < triangles) {
            const std::array<std::uint32_t, 3> indices = {
                static_cast<std::uint32_t>(below(6)),
                static_cast<std::uint32_t>(below(6)),
                static_cast<std::uint32_t>(below(6))};
            mesh.position_indices.insert(
                mesh.position_indices.end(), indices.begin(), indices.end());
        }
        return mesh;
    }

    SubsceneCall call(std::size_t callable) {
        SubsceneCall call;
        call.subscene = SubsceneId{static_cast<std::uint32_t>(below(callable))};
        Affine3 map = scaling(below(2) == 0 ? 0.5 : -1);
        if (below(2) == 0)
            map = composed(rotation({90, 0, static_cast<double>(30 * below(3))}), map);
        if (below(3) == 0)
            map.linear.rows[0] = 2 * map.linear.rows[0];
        call.to_parent = composed(translation(point()), map);
        call.from_parent = *inverse(call.to_parent);
        return call;
    }

    Geometry geometry(std::size_t items, std::size_t callable) {
        Geometry geometry;
        for (std::size_t i = 0; i < items; ++i) {
            Item item;
            item.material = below(3) == 0 ? inherited_material
                                          : MaterialId{static_cast<std::uint32_t>(below(3))};
            auto kind = static_cast<ItemKind>(below(callable > 0 ? 7 : 6));
            if (!settings_.curved
                && (kind == ItemKind::sphere || kind == ItemKind::rotational_shape))
                kind = ItemKind::polygon;
            add(geometry, item, kind, callable);
        }
        return geometry;
    }

    void add(Geometry& geometry, Item item, ItemKind kind, std::size_t callable) {
        const auto push = [&](auto& vector, auto&& value) {
            item.kind = kind;
            item.index = static_cast<std::uint32_t>(vector.size());
            vector.push_back(value);
            geometry.items.push_back(item);
        };
        switch (kind) {
        case ItemKind::sphere:
            return push(geometry.spheres, Sphere{point(), radius()});
        case ItemKind::triangle:
            return push(geometry.triangles, Triangle{corners()});
        case ItemKind::polygon:
            return push(geometry.polygons, polygon(geometry));
        case ItemKind::patch:
            return push(geometry.patches, Patch{corners(), {Vec3{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}});
        case ItemKind::rotational_shape:
            return push(geometry.rotational_shapes, rotational_shape());
        case ItemKind::mesh:
            return push(geometry.meshes, mesh());
        case ItemKind::subscene_call:
            return push(geometry.calls, call(callable));
        }
    }

    std::mt19937_64 random_;
    RandomSceneSettings settings_;
};

double pick(std::mt19937_64& random) {
    constexpr std::array<double, 9> values = {-4, -2, -1, -0.5, 0, 0.1, 1, 2, 4};
    return values[random() % values.size()];
}

Vec3 pick_point(std::mt19937_64& random, double scale) {
    const double x = scale * pick(random);
    const double y = scale * pick(random);
    return {x, y, scale * pick(random)};
}

} // namespace

Scene random_scene(std::uint64_t seed, const RandomSceneSettings& settings) {
    return SceneMaker(seed, settings).scene();
}

std::vector<QueryRay> random_rays(std::uint64_t seed, std::size_t count, double scale) {
    std::mt19937_64 random(seed);
    std::vector<QueryRay> rays(count);
    for (QueryRay& query : rays) {
        query.ray.origin = pick_point(random, scale * (random() % 8 == 0 ? 1000 : 1));
        while (query.ray.direction == Vec3{})
            query.ray.direction = pick_point(random, 1);
        if (random() % 4 != 0)
            query.ray.direction = normalized(query.ray.direction);
        switch (random() % 5) {
        case 0:
            query.ray.t_min = -std::numeric_limits<double>::infinity();
            break;
        case 4:
            query.ray.t_min = scale * std::array{0.25, 0.5, 1.0, 3.0}[random() % 4];
            break;
        case 1:
            query.ray.t_max = scale * 2;
            break;
        default:
            break;
        }
        if (random() % 5 == 0)
            query.ray.origin_error = 0x1p-45 * scale;
    }
    return rays;
}

std::vector<QueryRay> coherent_rays(std::uint64_t seed, std::size_t count, double scale) {
    std::mt19937_64 random(seed);
    std::vector<QueryRay> rays;
    while (rays.size() < count) {
        const Vec3 origin = pick_point(random, 3 * scale);
        const Vec3 target = pick_point(random, scale);
        const double spread = random() % 2 == 0 ? 0.01 : 0.3;
        for (int i = 0; i < 16; ++i) {
            QueryRay query;
            query.ray.origin = origin;
            const int column = i % 4;
            const int row = i / 4;
            const Vec3 aside = {spread * column, spread * row, 0};
            query.ray.direction = normalized(target + scale * aside - origin);
            if (query.ray.direction == Vec3{})
                query.ray.direction = {0, 0, 1};
            rays.push_back(query);
        }
    }
    return rays;
}

std::vector<QueryRay> rays_from_hits(
    std::uint64_t seed, const std::vector<QueryRay>& rays, const std::vector<Hit>& hits) {
    std::mt19937_64 random(seed);
    std::vector<QueryRay> result;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].found())
            continue;
        QueryRay query;
        query.ray.origin = point_at(rays[i].ray, hits[i].t);
        query.ray.origin_error = 0x1p-48
            * (max_component(abs(rays[i].ray.origin))
               + std::abs(hits[i].t) * max_component(abs(rays[i].ray.direction)));
        query.start = hits[i].face;
        while (query.ray.direction == Vec3{})
            query.ray.direction = pick_point(random, 1);
        if (random() % 2 == 0)
            query.ray.t_max = 1;
        result.push_back(query);
    }
    return result;
}

} // namespace vera::testing
