// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/terrain.h"

#include "vera/generate/chance.h"
#include "vera/generate/scene_parts.h"

#include <algorithm>
#include <cmath>

namespace vera {

namespace {

/// Heights over the corners of a grid of squares, by the diamond-square scheme (Miller 1986).
class HeightField {
public:
    HeightField(std::size_t halvings, double roughness, std::uint64_t seed, double peak)
        : side_(std::size_t{1} << halvings)
        , heights_((side_ + 1) * (side_ + 1), 0.0) {
        double range = 0.5;
        for (std::size_t step = side_; step > 1; step /= 2) {
            for (std::size_t z = step / 2; z < side_; z += step)
                for (std::size_t x = step / 2; x < side_; x += step)
                    at(x, z) = average_of_corners(x, z, step / 2) + displacement(seed, x, z, range)
                        + (step == side_ ? peak : 0);
            for (std::size_t z = 0; z <= side_; z += step / 2)
                for (std::size_t x = (z / (step / 2)) % 2 == 0 ? step / 2 : 0; x <= side_;
                     x += step)
                    at(x, z) =
                        average_of_sides(x, z, step / 2) + displacement(seed, x, z, 0.7 * range);
            range *= roughness;
        }
    }

    std::size_t side() const { return side_; }

    double& at(std::size_t x, std::size_t z) { return heights_[z * (side_ + 1) + x]; }

    double height(std::size_t x, std::size_t z) const { return heights_[z * (side_ + 1) + x]; }

    double lowest() const { return *std::min_element(heights_.begin(), heights_.end()); }

    double highest() const { return *std::max_element(heights_.begin(), heights_.end()); }

    /// From -1/2 to 1/2 in x and z.
    Vec3 place(std::size_t x, std::size_t z) const {
        const auto across = static_cast<double>(side_);
        return short_decimals(Vec3{
            static_cast<double>(x) / across - 0.5,
            height(x, z),
            static_cast<double>(z) / across - 0.5});
    }

private:
    static double displacement(std::uint64_t seed, std::size_t x, std::size_t z, double range) {
        return Chance(seed, (std::uint64_t{x} << 32U) | z).between(-range, range);
    }

    double average_of_corners(std::size_t x, std::size_t z, std::size_t half) const {
        return (height(x - half, z - half) + height(x + half, z - half) + height(x - half, z + half)
                + height(x + half, z + half))
            / 4;
    }

    /// Along the border there are three.
    double average_of_sides(std::size_t x, std::size_t z, std::size_t half) const {
        double sum = 0;
        double count = 0;
        const auto take = [&](std::size_t at_x, std::size_t at_z) {
            sum += height(at_x, at_z);
            ++count;
        };
        if (x >= half)
            take(x - half, z);
        if (x + half <= side_)
            take(x + half, z);
        if (z >= half)
            take(x, z - half);
        if (z + half <= side_)
            take(x, z + half);
        return sum / count;
    }

    std::size_t side_;
    std::vector<double> heights_;
};

/// The triangles of the ground, normals upwards; visit(a, b, c) of the places of their corners.
template <typename Visitor>
void for_each_triangle(const HeightField& field, const Visitor& visit) {
    for (std::size_t z = 0; z < field.side(); ++z)
        for (std::size_t x = 0; x < field.side(); ++x) {
            const Vec3 a = field.place(x, z);
            const Vec3 b = field.place(x + 1, z);
            const Vec3 c = field.place(x, z + 1);
            const Vec3 d = field.place(x + 1, z + 1);
            // Diagonals change their way, or all ridges would lie along them.
            if ((x + z) % 2 == 0) {
                visit(a, c, d);
                visit(a, d, b);
            } else {
                visit(a, c, b);
                visit(b, c, d);
            }
        }
}

struct Land {
    MaterialId sand;
    MaterialId grass;
    MaterialId rock;
    MaterialId snow;
    double water; ///< height
    double highest;

    MaterialId of(Vec3 a, Vec3 b, Vec3 c) const {
        const double height = (a.y + b.y + c.y) / 3;
        const double part = (height - water) / (highest - water);
        const Vec3 normal = normalized(cross(b - a, c - a));
        if (part < 0.03)
            return sand;
        if (part > 0.62 && normal.y > 0.62)
            return snow;
        return normal.y < 0.72 || part > 0.45 ? rock : grass;
    }
};

/// The four cut sides, from the ground down to the bottom.
void add_sides(Geometry& geometry, const HeightField& field, double bottom, MaterialId material) {
    const std::size_t side = field.side();
    const auto wall = [&](Vec3 a, Vec3 b) {
        const Vec3 under_a = {a.x, bottom, a.z};
        const Vec3 under_b = {b.x, bottom, b.z};
        add(geometry, Triangle{{a, under_a, under_b}}, material);
        add(geometry, Triangle{{a, under_b, b}}, material);
    };
    for (std::size_t i = 0; i < side; ++i) {
        wall(field.place(i, side), field.place(i + 1, side));
        wall(field.place(i + 1, 0), field.place(i, 0));
        wall(field.place(0, i), field.place(0, i + 1));
        wall(field.place(side, i + 1), field.place(side, i));
    }
    add_convex_polygon(
        geometry,
        {{-0.5, bottom, -0.5}, {0.5, bottom, -0.5}, {0.5, bottom, 0.5}, {-0.5, bottom, 0.5}},
        material);
}

/// A slab of water, a little within the sides of the land.
void add_water(Geometry& geometry, double bottom, double surface, MaterialId material) {
    constexpr double w = 0.4995;
    const auto corner = [&](double x, double y, double z) { return Vec3{x * w, y, z * w}; };
    add_convex_polygon(
        geometry,
        {corner(-1, surface, 1),
         corner(1, surface, 1),
         corner(1, surface, -1),
         corner(-1, surface, -1)},
        material);
    for (const auto& [a, b] :
         {std::pair(corner(-1, 0, 1), corner(1, 0, 1)),
          std::pair(corner(1, 0, 1), corner(1, 0, -1)),
          std::pair(corner(1, 0, -1), corner(-1, 0, -1)),
          std::pair(corner(-1, 0, -1), corner(-1, 0, 1))})
        add_convex_polygon(
            geometry,
            {{a.x, bottom, a.z}, {b.x, bottom, b.z}, {b.x, surface, b.z}, {a.x, surface, a.z}},
            material);
}

} // namespace

Scene make_terrain(const ParameterValues& values) {
    const HeightField field(
        values.whole("detail"), values["roughness"], values.whole("seed"), 0.35);
    // The field's heights are of its width; land is flatter.
    constexpr double flat = 0.55;
    const double lowest = field.lowest();
    HeightField land_field = field;
    for (std::size_t z = 0; z <= field.side(); ++z)
        for (std::size_t x = 0; x <= field.side(); ++x)
            land_field.at(x, z) = flat * (field.height(x, z) - lowest);
    const double highest = land_field.highest();
    Scene scene;
    Land land = {};
    land.sand = add_material(scene, "terrain-sand", {0.62, 0.54, 0.36});
    land.grass = add_material(scene, "terrain-grass", {0.24, 0.37, 0.12});
    land.rock = add_material(scene, "terrain-rock", {0.42, 0.37, 0.32});
    land.snow = add_material(scene, "terrain-snow", {0.88, 0.90, 0.94});
    const MaterialId earth = add_material(scene, "terrain-earth", {0.30, 0.21, 0.14});
    const MaterialId water = add_material(scene, "terrain-water", {0.05, 0.16, 0.24});
    scene.materials.back().rab = {0.22, 0.25, 0.28};
    scene.materials.back().tab = {0.25, 0.36, 0.40};
    scene.materials.back().spc = 0.99;
    land.water = values["water"] * highest;
    land.highest = highest;
    for_each_triangle(land_field, [&](Vec3 a, Vec3 b, Vec3 c) {
        add(scene.geometry, Triangle{{a, b, c}}, land.of(a, b, c));
    });
    const double bottom = -0.08;
    add_sides(scene.geometry, land_field, bottom, earth);
    if (land.water > 0)
        add_water(scene.geometry, 0.5 * bottom, land.water, water);
    return scene;
}

Scene make_mountain(const ParameterValues& values) {
    const HeightField field(values.whole("size"), values["roughness"], values.whole("seed"), 0.55);
    Scene scene;
    const MaterialId rock = add_material(scene, "mountain-rock", {0.52, 0.46, 0.37});
    for_each_triangle(field, [&](Vec3 a, Vec3 b, Vec3 c) {
        add(scene.geometry, Triangle{{a, b, c}}, rock);
    });
    const MaterialId ball = add_material(scene, "mountain-ball", {0.10, 0.11, 0.13});
    scene.materials.back().rab = {0.62, 0.65, 0.70};
    scene.materials.back().spc = 0.99;
    const double top = field.highest();
    constexpr double radius = 0.09;
    add(scene.geometry, Sphere{{0, top + 0.30, 0}, radius}, ball);
    for (int i = 0; i < 3; ++i) {
        const Vec3 aside = transformed_vector(rotation({0, 120.0 * i + 20, 0}), {0, 0, 0.2});
        add(scene.geometry, Sphere{Vec3{0, top + 0.14, 0} + aside, radius}, ball);
    }
    return scene;
}

} // namespace vera
