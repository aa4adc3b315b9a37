// SPDX-License-Identifier: Apache-2.0
// Asks which triangles of a mesh and which spheres rays meet, in each of the ways there are, and
// prints a picture of the mesh.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include <vera/accel/mesh_index.h>
#include <vera/accel/sphere_index.h>
#include <vera/base/parallel.h>
#include <vera/math/vec3.h>

using vera::Vec3;

struct Mesh {
    std::vector<std::array<float, 3>> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

std::array<float, 3> in_single(Vec3 point) {
    return {static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z)};
}

Vec3 in_double(const std::array<float, 3>& point) {
    return {double{point[0]}, double{point[1]}, double{point[2]}};
}

/// A ring around the z axis, and a square floor below it.
Mesh ring_above_a_floor() {
    constexpr std::uint32_t around = 96;
    constexpr std::uint32_t across = 32;
    constexpr double full_turn = 6.283185307179586;
    Mesh mesh;
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t j = 0; j < across; ++j) {
            const double a = full_turn * i / around;
            const double b = full_turn * j / across;
            const double radius = 2 + 0.8 * std::cos(b);
            mesh.vertices.push_back(
                in_single({radius * std::cos(a), radius * std::sin(a), 0.8 * std::sin(b)}));
            const std::uint32_t here = i * across;
            const std::uint32_t next = (i + 1) % around * across;
            const std::uint32_t k = (j + 1) % across;
            mesh.triangles.push_back({here + j, next + j, next + k});
            mesh.triangles.push_back({here + j, next + k, here + k});
        }
    const auto floor = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{-6, -6, -1}, {6, -6, -1}, {6, 6, -1}, {-6, 6, -1}});
    mesh.triangles.push_back({floor, floor + 1, floor + 2});
    mesh.triangles.push_back({floor, floor + 2, floor + 3});
    return mesh;
}

Vec3 normal(const Mesh& mesh, std::uint32_t triangle) {
    const auto [a, b, c] = mesh.triangles[triangle];
    const Vec3 corner = in_double(mesh.vertices[a]);
    return normalized(
        cross(in_double(mesh.vertices[b]) - corner, in_double(mesh.vertices[c]) - corner));
}

void tell_what_is_below(const vera::MeshIndex& index) {
    const vera::MeshRay down = {.origin = {1.9F, 0.3F, 5}, .direction = {0, 0, -1}};

    const vera::MeshHit nearest = index.nearest_hit(down);
    if (nearest.found())
        std::cout << "First the ray meets triangle " << nearest.triangle << ".\n";

    for (const vera::MeshHit& hit : index.all_hits(down))
        std::cout << "It meets triangle " << hit.triangle << " at t = " << hit.t
                  << ", u = " << hit.u << ", v = " << hit.v << ".\n";
}

/// A row of pearls along the x axis: x, y and z of the center, and the radius.
std::vector<std::array<float, 4>> row_of_pearls() {
    std::vector<std::array<float, 4>> pearls;
    for (int i = 0; i < 10; ++i)
        pearls.push_back({static_cast<float>(i), 0, 0, 0.5F});
    return pearls;
}

void tell_which_pearls_are_met() {
    const std::vector<std::array<float, 4>> pearls = row_of_pearls();
    const vera::SphereIndex index(pearls);

    const vera::MeshRay across = {.origin = {3.25F, -2, 0}, .direction = {0, 1, 0}};
    const vera::SphereHit nearest = index.nearest_hit(across);
    if (nearest.found())
        std::cout << "First the ray meets pearl " << nearest.sphere << ".\n";

    for (const vera::SphereHit& hit : index.all_hits(across))
        std::cout << "It enters or leaves pearl " << hit.sphere << " at t = " << hit.t << ".\n";
}

constexpr int width = 64;
constexpr int height = 24;

struct Pixel {
    int x = 0;
    int y = 0;
};

/// All pixels, square after square of 4 x 4: the rays of each go through the index together.
std::vector<Pixel> pixels_by_squares() {
    std::vector<Pixel> pixels;
    for (int y = 0; y < height; y += 4)
        for (int x = 0; x < width; x += 4)
            for (int i = 0; i < 16; ++i)
                pixels.push_back({x + i % 4, y + i / 4});
    return pixels;
}

/// Characters are twice as high as they are wide.
vera::MeshRay view_ray(Pixel pixel) {
    const Vec3 forward = {0, 0.8, -0.6};
    const Vec3 up = {0, 0.6, 0.8};
    const double right = 0.014 * (pixel.x - width / 2 + 0.5);
    const Vec3 direction = forward + Vec3{right, 0, 0} + 0.028 * (height / 2 - pixel.y - 0.5) * up;
    return {.origin = {0, -8, 6}, .direction = in_single(direction)};
}

std::vector<vera::MeshHit>
nearest_hits(const vera::MeshIndex& index, const std::vector<vera::MeshRay>& rays) {
    std::vector<vera::MeshHit> hits(rays.size());
    constexpr std::size_t rays_at_once = 512;
    vera::parallel_ranges(rays.size(), rays_at_once, [&](std::size_t first, std::size_t last) {
        index.nearest_hits(
            std::span(rays).subspan(first, last - first),
            std::span(hits).subspan(first, last - first));
    });
    return hits;
}

/// From where the view ray meets the mesh, to the light. A ray from nowhere meets nothing.
vera::MeshRay shadow_ray(const vera::MeshRay& view, const vera::MeshHit& hit, Vec3 to_light) {
    const Vec3 place = in_double(view.origin) + double{hit.t} * in_double(view.direction);
    return {.origin = in_single(place), .t_min = 0.001F, .direction = in_single(to_light)};
}

int main() {
    const Mesh mesh = ring_above_a_floor();
    const vera::MeshIndex index({mesh.vertices, mesh.triangles});
    tell_what_is_below(index);
    tell_which_pearls_are_met();

    const std::vector<Pixel> pixels = pixels_by_squares();
    std::vector<vera::MeshRay> rays(pixels.size());
    std::transform(pixels.begin(), pixels.end(), rays.begin(), view_ray);
    const std::vector<vera::MeshHit> hits = nearest_hits(index, rays);

    const Vec3 to_light = {0.48, -0.6, 0.64};
    std::vector<vera::MeshRay> shadow_rays(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i)
        shadow_rays[i] = shadow_ray(rays[i], hits[i], to_light);
    std::vector<std::uint8_t> in_shadow(rays.size());
    index.meet_any(shadow_rays, in_shadow);

    std::vector<std::string> picture(height, std::string(width, ' '));
    for (std::size_t i = 0; i < pixels.size(); ++i)
        if (hits[i].found()) {
            const double light = std::max(0.0, dot(normal(mesh, hits[i].triangle), to_light));
            const char shade = in_shadow[i] != 0 ? '.' : ":-=+*#%@"[static_cast<int>(7.99 * light)];
            picture[pixels[i].y][pixels[i].x] = shade;
        }
    for (const std::string& line : picture)
        std::cout << line << '\n';
}
