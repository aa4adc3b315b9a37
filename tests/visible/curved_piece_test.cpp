// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/contour.h"
#include "vera/scene/surface.h"
#include "vera/visible/convex_piece.h"
#include "vera/visible/curved_piece.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>

#include <gtest/gtest.h>

namespace vera {
namespace {

using Point = ContourPiece::Point;

/// Numbers drawn from few, so that rays along the axis and through corners are common.
class FewNumbers {
public:
    double operator()() {
        constexpr std::array numbers = {-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0};
        return numbers[random_() % numbers.size()];
    }

    Vec3 vector() {
        Vec3 v;
        v.x = (*this)();
        v.y = (*this)();
        v.z = (*this)();
        return v;
    }

    std::size_t below(std::size_t count) { return random_() % count; }

private:
    std::mt19937 random_{1958};
};

ContourPiece line(Point end) {
    ContourPiece piece;
    piece.end = end;
    return piece;
}

ContourPiece conic(Point control, double weight, Point end) {
    ContourPiece piece;
    piece.kind = ContourPiece::Kind::conic;
    piece.control[0] = control;
    piece.weight = weight;
    piece.end = end;
    return piece;
}

ContourPiece cubic(Point first, Point second, Point end) {
    ContourPiece piece;
    piece.kind = ContourPiece::Kind::cubic;
    piece.control = {first, second};
    piece.end = end;
    return piece;
}

/// Cylinders, cones, barrels, domes with a pole, cups seen from inside, and a wave that is none.
Scene scene_of_shapes() {
    Scene scene;
    const auto add = [&](Vec3 axis, Point start, const ContourPiece& piece) {
        RotationalShape shape;
        shape.base = {0.25, -0.5, 0};
        shape.axis = normalized(axis);
        shape.start = start;
        shape.contour = {piece};
        Item item;
        item.kind = ItemKind::rotational_shape;
        item.index = static_cast<std::uint32_t>(scene.geometry.rotational_shapes.size());
        scene.geometry.rotational_shapes.push_back(shape);
        scene.geometry.items.push_back(item);
    };
    for (const Vec3 axis : {Vec3{0, 0, 1}, Vec3{1, 2, -1}}) {
        add(axis, {1, -1}, line({1, 1}));
        add(axis, {1.5, -1}, line({0, 1}));
        add(axis, {0.5, 1}, line({1, -1}));
        add(axis, {1, -1}, conic({2, 0}, 0.7, {1, 1}));
        add(axis, {1, 0}, conic({1, 1}, std::sqrt(0.5), {0, 1}));
        add(axis, {0, 1}, conic({1, 1}, std::sqrt(0.5), {1, 0}));
        add(axis, {1, -1}, cubic({1.5, -0.5}, {1.5, 0.5}, {0.5, 1}));
        add(axis, {0.5, 1}, cubic({1, 0.8}, {1.2, 0}, {0.8, -1}));
        add(axis, {1, -1}, cubic({2, -0.5}, {0.5, 0.5}, {1, 1}));
    }
    Item item;
    item.kind = ItemKind::sphere;
    scene.geometry.spheres.push_back({{0.25, -0.5, 0}, 1});
    scene.geometry.items.push_back(item);
    return scene;
}

PrimitivePath path_of(const Scene& scene, std::size_t item) {
    PrimitivePath path;
    path.geometry = &scene.geometry;
    path.element = {static_cast<std::uint32_t>(item), 0};
    return path;
}

TEST(CurvedPiece, IsMetWherePlanesThatTouchItLeadTo) {
    const Scene scene = scene_of_shapes();
    FewNumbers few;
    int met = 0;
    int found = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::size_t item = few.below(scene.geometry.items.size());
        const PrimitivePath path = path_of(scene, item);
        const Convexity convex = convexity(path, 0);
        if (convex == Convexity::none)
            continue;
        Ray ray;
        ray.origin = 4.0 * few.vector();
        const Vec3 to = few.vector() + Vec3{0.01, 0.02, -0.03};
        if (to == ray.origin)
            continue;
        ray.direction = normalized(to - ray.origin);
        const double middle = length(to - ray.origin);
        const Passage passage = {middle - 5, middle + 5, few.below(2) == 0};
        const SurfacePoint there = meeting_by_planes(path, 0, ray, passage);
        const double t = dot(there.point - ray.origin, ray.direction);
        const double off = length(there.point - point_at(ray, t));
        const double square = std::abs(dot(there.geometric_normal, ray.direction));
        if (off > 1e-7 || square < 0.05 || t <= passage.from || t >= passage.to)
            continue; // it misses, or all but does
        ++met;
        const auto place = CurvedPiece(path, 0).meeting(ray, passage);
        if (!place)
            continue;
        ++found;
        EXPECT_NEAR(place->t, t, 1e-5) << "item " << item;
        EXPECT_LT(length(place->normal - there.geometric_normal), 1e-5) << "item " << item;
    }
    EXPECT_GT(met, 3000);
    EXPECT_GT(found, met - met / 50);
}

/// Where it misses, the place is one of the silhouette: the normal is square to the ray.
TEST(CurvedPiece, IsNearestToARayThatMissesIt) {
    const Scene scene = scene_of_shapes();
    const std::size_t sphere = scene.geometry.items.size() - 1;
    for (const std::size_t item : {std::size_t{0}, std::size_t{9}, sphere}) {
        const PrimitivePath path = path_of(scene, item);
        for (const double away : {1.001, 1.5, 3.0}) {
            Ray ray;
            const Vec3 axis =
                item == sphere ? Vec3{0, 0, 1} : scene.geometry.rotational_shapes[item].axis;
            const Vec3 aside = normalized(cross(axis, {0.3, 0.5, 0.1}));
            ray.direction = cross(axis, aside);
            ray.origin = Vec3{0.25, -0.5, 0} + away * aside - 5.0 * ray.direction;
            const auto place = CurvedPiece(path, 0).meeting(ray, {0, 10, true});
            ASSERT_TRUE(place);
            EXPECT_NEAR(place->t, 5, 1e-9);
            EXPECT_LT(length(place->normal - aside), 1e-9);
        }
    }
}

/// From a place beside the surface by little, as facets are, with a parameter beside that, and by a
/// ray from anywhere: the place is on the surface, and has the normal that it has there, but where
/// the ray goes along the surface.
TEST(CurvedPiece, IsMetNearAPlaceThatIsAllButOnIt) {
    const Scene scene = scene_of_shapes();
    FewNumbers few;
    int compared = 0;
    int along = 0;
    constexpr int rounds = 4000;
    for (int i = 0; i < rounds; ++i) {
        const std::size_t item = few.below(scene.geometry.rotational_shapes.size());
        const PrimitivePath path = path_of(scene, item);
        const RotationalShape& shape = scene.geometry.rotational_shapes[item];
        const double v = 0.125 * static_cast<double>(few.below(8));
        const Point on = point_at(shape.contour.front(), shape.start, v);
        const Vec3 aside = normalized(cross(shape.axis, few.vector() + Vec3{0.1, 0.2, 0.15}));
        const Vec3 beside = 0.002 * few.vector();
        const Vec3 point = shape.base + on.r * aside + on.h * shape.axis + beside;
        const CurvedPiece piece(path, 0);
        const double nearest = piece.parameter_near(point);
        if (on.r < 0.2 || nearest < 0.01 || nearest > 0.99)
            continue; // at the tip of a cone, or beyond an end
        double parameter = std::clamp(nearest + 0.05 * few(), 0.0, 1.0);
        Ray ray;
        ray.direction = normalized(few.vector() + Vec3{0.03, 0.02, 0.01});
        ray.origin = point - 5.0 * ray.direction;
        const auto place = piece.meeting_near(ray, 5, parameter);
        ASSERT_TRUE(place) << "item " << item;
        const Vec3 met = point_at(ray, place->t);
        const SurfacePoint there = surface_within(path, 0, met);
        const double off = length(there.point - met);
        const double before = length(surface_within(path, 0, point).point - point);
        EXPECT_LE(std::abs(place->t - 5), 11 * before + 1e-9) << "item " << item;
        EXPECT_LE(off, 1.01 * before + 1e-9) << "item " << item;
        if (std::abs(dot(there.geometric_normal, ray.direction)) < 0.5) {
            ++along;
            continue;
        }
        ++compared;
        EXPECT_LT(off, 0.01 * before + 1e-9) << "item " << item;
        EXPECT_LT(length(place->normal - there.geometric_normal), 2e-3) << "item " << item;
    }
    EXPECT_GT(compared, 1000);
    EXPECT_GT(along, 500);
}

} // namespace
} // namespace vera
