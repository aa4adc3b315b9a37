// SPDX-License-Identifier: Apache-2.0
#include "sample_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <utility>

namespace vera::testing {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float no_number = std::numeric_limits<float>::quiet_NaN();
constexpr float smallest = std::numeric_limits<float>::denorm_min();
constexpr float largest = std::numeric_limits<float>::max();

class Dice {
public:
    explicit Dice(std::uint64_t seed)
        : random_(seed) {}

    std::size_t below(std::size_t count) { return random_() % count; }

    bool one_in(std::size_t count) { return below(count) == 0; }

    template <typename Range>
    auto any_of(const Range& values) {
        return *(std::begin(values) + static_cast<std::ptrdiff_t>(below(std::size(values))));
    }

    float any_of(std::initializer_list<float> values) {
        return any_of<std::initializer_list<float>>(values);
    }

private:
    std::mt19937_64 random_;
};

MeshPoint operator+(const MeshPoint& a, const MeshPoint& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

MeshPoint operator-(const MeshPoint& a, const MeshPoint& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

MeshPoint operator*(float factor, const MeshPoint& a) {
    return {factor * a[0], factor * a[1], factor * a[2]};
}

float size(const MeshPoint& a) {
    return std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])});
}

float few_coordinates(Dice& dice) {
    return dice.any_of({-4, -2, -1, -0.5F, -0.0F, 0, 0.1F, 1, 2, 4});
}

/// A point on the line through a and b: often a corner or the middle.
MeshPoint on_line(Dice& dice, const MeshPoint& a, const MeshPoint& b) {
    return a + dice.any_of({0, 0, 0.5F, 0.25F, 0.3F, 1, -1, 2}) * (b - a);
}

/// A corner of the mesh, or a point in line, in plane or beside all with some of its corners.
MeshPoint place_by(Dice& dice, const SampleMesh& mesh) {
    if (mesh.triangles.empty())
        return {few_coordinates(dice), few_coordinates(dice), few_coordinates(dice)};
    const auto triangle = dice.any_of(mesh.triangles);
    const MeshPoint a = mesh.vertices[triangle[dice.below(3)]];
    const MeshPoint b = mesh.vertices[triangle[dice.below(3)]];
    const MeshPoint c =
        dice.one_in(2) ? mesh.vertices[triangle[dice.below(3)]] : dice.any_of(mesh.vertices);
    const MeshPoint on_ab = on_line(dice, a, b);
    const MeshPoint in_plane = on_line(dice, on_ab, c);
    return dice.any_of(
        std::array{a, on_ab, in_plane, on_line(dice, in_plane, dice.any_of(mesh.vertices))});
}

MeshPoint direction_by(Dice& dice, const SampleMesh& mesh, const MeshPoint& origin) {
    MeshPoint direction = place_by(dice, mesh) - origin;
    switch (dice.below(8)) {
    case 0:
        direction = place_by(dice, mesh) - place_by(dice, mesh);
        break;
    case 1:
        direction = {dice.any_of({-1, -0.0F, 0, 1}), dice.any_of({-1, 0}), dice.any_of({-1, 0, 1})};
        break;
    case 2:
        direction[dice.below(3)] = dice.any_of({-0.0F, 0, smallest, -smallest, 0x1p-130F});
        break;
    default:
        break;
    }
    if (dice.one_in(4) && size(direction) > 0)
        direction =
            dice.any_of({smallest, 1e-38F, 1e-20F, 1, 1e20F, 1e38F}) / size(direction) * direction;
    return direction;
}

void choose_range(Dice& dice, MeshRay& ray) {
    switch (dice.below(12)) {
    case 0:
        ray.t_min = -infinity;
        break;
    case 1:
        ray.t_min = dice.any_of({-4, -1, -0.5F, -smallest, -0.0F});
        break;
    case 2:
        ray.t_min = dice.any_of({smallest, 0.25F, 0.5F, 1, 2});
        break;
    case 3:
        ray.t_max = dice.any_of({smallest, 0.25F, 0.5F, 1, 2, largest});
        break;
    case 4:
        ray.t_min = ray.t_max = dice.any_of({-1, 0, 0.5F, 1, 2});
        break;
    case 5:
        ray.t_min = dice.any_of({-1, 0.5F, 1, infinity});
        ray.t_max = dice.any_of({-infinity, -0.0F, 0.5F, 1, infinity});
        break;
    default:
        break;
    }
}

/// Makes it a ray that is not followed, or one that only just is.
void spoil(Dice& dice, MeshRay& ray) {
    const float value = dice.any_of({no_number, infinity, -infinity, largest, -largest});
    switch (dice.below(5)) {
    case 0:
        ray.origin[dice.below(3)] = value;
        break;
    case 1:
        ray.direction[dice.below(3)] = value;
        break;
    case 2:
        ray.t_min = value;
        break;
    case 3:
        ray.t_max = value;
        break;
    default:
        ray.direction = {dice.any_of({-0.0F, 0}), -0.0F, 0};
        break;
    }
}

/// The triangles, each cut into four at the middles of its edges, which neighbours share.
SampleMesh cut_up(const SampleMesh& mesh) {
    SampleMesh result = {mesh.vertices, {}};
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto number = static_cast<std::uint32_t>(result.vertices.size());
        const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), number);
        if (is_new)
            result.vertices.push_back(0.5F * (mesh.vertices[a] + mesh.vertices[b]));
        return place->second;
    };
    for (const auto& [a, b, c] : mesh.triangles) {
        const std::uint32_t ab = middle(a, b);
        const std::uint32_t bc = middle(b, c);
        const std::uint32_t ca = middle(c, a);
        const std::array<std::uint32_t, 3> parts[] = {
            {a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}};
        result.triangles.insert(result.triangles.end(), std::begin(parts), std::end(parts));
    }
    return result;
}

} // namespace

void SampleMesh::add_triangle(const MeshPoint& a, const MeshPoint& b, const MeshPoint& c) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), {a, b, c});
    triangles.push_back({first, first + 1, first + 2});
}

SampleMesh random_mesh(std::uint64_t seed, std::size_t triangles) {
    Dice dice(seed);
    SampleMesh mesh;
    const bool in_few_planes = dice.one_in(3);
    for (std::size_t i = 0; i < 3 + triangles / 2; ++i)
        mesh.vertices.push_back(
            {few_coordinates(dice),
             few_coordinates(dice),
             in_few_planes ? dice.any_of({0, 1}) : few_coordinates(dice)});
    const auto corner = [&] {
        return static_cast<std::uint32_t>(dice.below(mesh.vertices.size()));
    };
    for (std::size_t i = 0; i < triangles; ++i) {
        std::array<std::uint32_t, 3> triangle = {corner(), corner(), corner()};
        if (dice.one_in(8)) { // a sliver
            MeshPoint beside_edge =
                on_line(dice, mesh.vertices[triangle[0]], mesh.vertices[triangle[1]]);
            beside_edge[dice.below(3)] += dice.any_of({0, 0x1p-20F, -0x1p-23F, 0x1p-60F});
            triangle[2] = static_cast<std::uint32_t>(mesh.vertices.size());
            mesh.vertices.push_back(beside_edge);
        } else if (i > 0 && dice.one_in(8)) { // one that was there before, from another corner
            triangle = mesh.triangles[dice.below(i)];
            std::rotate(triangle.begin(), triangle.begin() + 1, triangle.end());
        }
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

SampleMesh scaled_and_shifted(SampleMesh mesh, float factor, float offset) {
    for (MeshPoint& vertex : mesh.vertices)
        vertex = factor * vertex + MeshPoint{offset, offset, offset};
    return mesh;
}

SampleMesh close_layers(std::uint64_t seed, std::size_t layers) {
    Dice dice(seed);
    SampleMesh mesh;
    const float height = dice.any_of({0, 1, 1000});
    const float slope = dice.any_of({0, 0.25F, 3});
    for (std::size_t i = 0; i < layers; ++i) {
        const auto level = [&](float at) {
            // Near 0 single precision has numbers far nearer to each other than t is known.
            const auto step = static_cast<float>(dice.below(layers));
            return height == 0 ? 1e-12F * step + at : at + height * (1 + 0x1p-23F * step);
        };
        mesh.add_triangle(
            {-1, -1, level(0)}, {4, -1, level(slope)}, {-1, dice.any_of({3, 4}), level(-slope)});
    }
    return mesh;
}

SampleMesh mixed_sizes(std::uint64_t seed, std::size_t triangles) {
    Dice dice(seed);
    SampleMesh mesh = random_mesh(seed, triangles);
    const SampleMesh model = mesh;
    mesh.vertices.clear();
    for (auto& triangle : mesh.triangles) {
        const float factor = dice.any_of({smallest, 1e-38F, 1e-30F, 1e-6F, 1, 1e6F, 1e30F, 1e37F});
        for (std::uint32_t& corner : triangle) {
            mesh.vertices.push_back(factor * model.vertices[corner]);
            corner = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
        }
        // Some that reach from the smallest to the largest.
        if (dice.one_in(8))
            triangle[2] = static_cast<std::uint32_t>(dice.below(mesh.vertices.size()));
    }
    return mesh;
}

SampleMesh small_triangles_beside_large(std::uint64_t seed, std::size_t small) {
    Dice dice(seed);
    SampleMesh mesh = random_mesh(seed, small);
    const int smaller = 4 + static_cast<int>(dice.below(50));
    const std::size_t axis = dice.below(3);
    const float place = dice.any_of({0, 0, 0x1p-30F, 0x1p-12F, 1});
    for (MeshPoint& vertex : mesh.vertices) {
        for (float& coordinate : vertex)
            coordinate = std::ldexp(coordinate, -smaller);
        vertex[axis] += place;
    }
    const SampleMesh large = random_mesh(seed + 1, 1 + dice.below(6));
    for (const auto& [a, b, c] : large.triangles)
        mesh.add_triangle(large.vertices[a], large.vertices[b], large.vertices[c]);
    return mesh;
}

SampleMesh with_broken_vertices(SampleMesh mesh, std::uint64_t seed) {
    Dice dice(seed);
    for (MeshPoint& vertex : mesh.vertices)
        if (dice.one_in(16))
            vertex[dice.below(3)] = dice.any_of({no_number, infinity, -infinity});
    return mesh;
}

SampleMesh cube(std::size_t cuts) {
    SampleMesh mesh;
    for (std::size_t corner = 0; corner < 8; ++corner)
        mesh.vertices.push_back(
            {(corner & 1U) != 0 ? 1.0F : -1.0F,
             (corner & 2U) != 0 ? 1.0F : -1.0F,
             (corner & 4U) != 0 ? 1.0F : -1.0F});
    mesh.triangles = {
        {0, 2, 1},
        {1, 2, 3},
        {4, 5, 6},
        {5, 7, 6},
        {0, 1, 4},
        {1, 5, 4},
        {2, 6, 3},
        {3, 6, 7},
        {0, 4, 2},
        {2, 4, 6},
        {1, 3, 5},
        {3, 7, 5}};
    for (std::size_t i = 0; i < cuts; ++i)
        mesh = cut_up(mesh);
    return mesh;
}

SampleMesh sphere(std::size_t cuts) {
    SampleMesh mesh = {
        {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
        {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
    for (std::size_t i = 0; i < cuts; ++i)
        mesh = cut_up(mesh);
    for (MeshPoint& vertex : mesh.vertices)
        vertex = 1 / std::hypot(vertex[0], vertex[1], vertex[2]) * vertex;
    return mesh;
}

SampleMesh rough_sphere(std::size_t cuts, std::uint64_t seed) {
    Dice dice(seed);
    SampleMesh mesh = sphere(cuts);
    for (MeshPoint& vertex : mesh.vertices)
        vertex = (0.5F + 0.001F * static_cast<float>(dice.below(500))) * vertex;
    return mesh;
}

std::vector<MeshRay>
random_mesh_rays(std::uint64_t seed, const SampleMesh& mesh, std::size_t count) {
    Dice dice(seed);
    std::vector<MeshRay> rays(count);
    for (MeshRay& ray : rays) {
        ray.origin = place_by(dice, mesh);
        if (dice.one_in(8))
            ray.origin = dice.any_of({100, 1e6F, 1e30F}) * ray.origin;
        ray.direction = direction_by(dice, mesh, ray.origin);
        choose_range(dice, ray);
        if (dice.one_in(24))
            spoil(dice, ray);
    }
    return rays;
}

std::vector<MeshRay>
coherent_mesh_rays(std::uint64_t seed, const SampleMesh& mesh, std::size_t count) {
    Dice dice(seed);
    std::vector<MeshRay> rays;
    while (rays.size() < count) {
        MeshRay first;
        first.origin = place_by(dice, mesh);
        first.direction = direction_by(dice, mesh, first.origin);
        if (dice.one_in(4))
            choose_range(dice, first);
        const float spread = dice.any_of({0, 0x1p-20F, 0.001F, 0.1F, 1});
        const float shift = dice.any_of({0, 0, 0, 0x1p-20F, 0.01F, 1});
        const MeshPoint right = spread * direction_by(dice, mesh, first.origin);
        const MeshPoint down = spread * direction_by(dice, mesh, first.origin);
        const std::size_t mirrored_axis = dice.below(24); // most often none
        for (std::size_t i = 0; i < 16; ++i) {
            MeshRay ray = first;
            const MeshPoint aside =
                static_cast<float>(i % 4) * right + static_cast<float>(i / 4) * down;
            ray.direction = first.direction + aside;
            ray.origin = first.origin + shift * aside;
            if (mirrored_axis < 3 && i % 3 == 0)
                ray.direction[mirrored_axis] = -ray.direction[mirrored_axis];
            if (dice.one_in(60))
                choose_range(dice, ray);
            if (dice.one_in(120))
                spoil(dice, ray);
            rays.push_back(ray);
        }
    }
    return rays;
}

std::vector<MeshRay> rays_of_lights(std::uint64_t seed, const SampleMesh& mesh, std::size_t count) {
    constexpr std::size_t rays_of_light = 96;
    Dice dice(seed);
    std::vector<MeshRay> rays;
    while (rays.size() < count) {
        const MeshPoint light = dice.any_of({1, 1, 3, 1000}) * place_by(dice, mesh);
        const MeshPoint direction = direction_by(dice, mesh, light);
        const bool to_place = dice.one_in(2);
        const float spread = dice.any_of({0, 0, 0x1p-20F, 0.01F, 0.1F});
        const float t_max = dice.any_of({1, 1, 0.5F, 1e6F, 0x1p100F, infinity});
        // Those of one light from a few places, or from a square about each of a few.
        const bool from_squares = dice.one_in(2);
        const float patch = dice.any_of({0, 0x1p-20F, 0.001F, 0.01F});
        const bool are_cut = dice.one_in(2); // each as it comes
        MeshPoint corner = {};
        MeshPoint right = {};
        MeshPoint down = {};
        for (std::size_t i = 0; i < rays_of_light; ++i) {
            MeshRay ray;
            if (from_squares) {
                if (i % 16 == 0) {
                    corner = place_by(dice, mesh);
                    right = patch * direction_by(dice, mesh, corner);
                    down = patch * direction_by(dice, mesh, corner);
                }
                ray.origin = corner + static_cast<float>(i % 4) * right
                    + static_cast<float>(i / 4 % 4) * down;
            } else {
                ray.origin = place_by(dice, mesh);
            }
            ray.direction = (to_place ? light - ray.origin : direction)
                + spread * direction_by(dice, mesh, ray.origin);
            ray.t_max = t_max;
            if (are_cut) {
                ray.t_min = dice.any_of({0, 0, 0x1p-20F, 0.25F, 0.5F});
                ray.t_max = dice.any_of({t_max, 1, std::nextafter(1.0F, 0.0F), 0.75F});
            }
            rays.push_back(ray);
        }
    }
    return rays;
}

std::vector<MeshRay> rays_cut_at(const MeshRay& ray, float t) {
    const float before = std::nextafter(t, -infinity);
    const float behind = std::nextafter(t, infinity);
    std::vector<MeshRay> rays;
    for (const auto& [t_min, t_max] : std::initializer_list<std::pair<float, float>>{
             {ray.t_min, before},
             {ray.t_min, t},
             {ray.t_min, behind},
             {before, ray.t_max},
             {t, ray.t_max},
             {behind, ray.t_max},
             {t, t},
             {before, behind}}) {
        rays.push_back(ray);
        rays.back().t_min = t_min;
        rays.back().t_max = t_max;
    }
    return rays;
}

} // namespace vera::testing
