// SPDX-License-Identifier: Apache-2.0
// Rays a second and tests per ray of the grid and of brute force, on one thread.
//
// grid_bench               scenes of 1e2 to 1e6 spheres and triangles
// grid_bench FILE.nff ...  scenes from files, the grid alone
//
// view: 512 x 512 view rays; shadow: from what they hit to the first light; diffuse: from there in
// random directions.

#include "vera/accel/brute_force.h"
#include "vera/accel/grid_tree.h"
#include "vera/formats/nff.h"
#include "vera/scene/bounds.h"
#include "vera/scene/surface.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace vera;

constexpr std::size_t picture_size = 512;

/// Of this thread, so that what else the machine does matters less.
double cpu_seconds() {
    timespec time = {};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

struct Measurement {
    double million_rays = 0; ///< a second
    double tests = 0;        ///< per ray
    double cells = 0;        ///< per ray
};

Measurement measurement(std::size_t rays, double seconds, const QueryCounts& counts) {
    const auto n = static_cast<double>(rays);
    return {
        n / seconds * 1e-6,
        static_cast<double>(counts.tests) / n,
        static_cast<double>(counts.cells) / n};
}

template <typename Answer, typename Query>
Measurement measured(const std::vector<QueryRay>& rays, std::vector<Answer>& answers, Query query) {
    answers.resize(rays.size());
    if (rays.empty())
        return {};
    constexpr std::size_t tile = 1024;
    double best = 0;
    QueryCounts counts;
    for (int round = 0; round < 3; ++round) {
        counts = {};
        const double start = cpu_seconds();
        for (std::size_t first = 0; first < rays.size(); first += tile) {
            const std::size_t size = std::min(tile, rays.size() - first);
            query(
                std::span(rays).subspan(first, size),
                std::span(answers).subspan(first, size),
                counts);
        }
        const double seconds = cpu_seconds() - start;
        best = round == 0 ? seconds : std::min(best, seconds);
        if (best > 2)
            break;
    }
    return measurement(rays.size(), best, counts);
}

Measurement
measured_hits(const RayIndex& index, const std::vector<QueryRay>& rays, std::vector<Hit>& hits) {
    return measured(rays, hits, [&](auto some, auto found, QueryCounts& counts) {
        index.nearest_hits(some, found, counts);
    });
}

Measurement measured_shadows(const RayIndex& index, const std::vector<QueryRay>& rays) {
    std::vector<Color> transmitted;
    return measured(rays, transmitted, [&](auto some, auto found, QueryCounts& counts) {
        index.transmittances(some, found, counts);
    });
}

/// In tiles of 32 x 32, within them in squares of 4 x 4, as the renderer does.
std::vector<QueryRay> view_rays(const Camera& camera, std::size_t size) {
    constexpr std::size_t side = 32;
    constexpr std::size_t square = 4;
    const auto n = static_cast<double>(size);
    std::vector<QueryRay> rays(size * size);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::size_t tile = i / (side * side);
        const std::size_t in_tile = i % (side * side);
        const std::size_t block = in_tile / (square * square);
        const std::size_t in_block = in_tile % (square * square);
        const std::size_t x =
            tile % (size / side) * side + block % (side / square) * square + in_block % square;
        const std::size_t y =
            tile / (size / side) * side + block / (side / square) * square + in_block / square;
        rays[i].ray = view_ray(
            camera, (static_cast<double>(x) + 0.5) / n, (static_cast<double>(y) + 0.5) / n);
    }
    return rays;
}

struct NextRays {
    std::vector<QueryRay> shadow;
    std::vector<QueryRay> diffuse;
};

NextRays
next_rays(const Scene& scene, const std::vector<QueryRay>& rays, const std::vector<Hit>& hits) {
    NextRays next;
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].found())
            continue;
        const SurfacePoint surface = surface_at(scene, rays[i].ray, hits[i]);
        QueryRay query;
        query.ray.origin = surface.point;
        query.ray.origin_error = surface.point_error;
        query.start = surface.face;
        const Vec3 direction = normalized({normal(random), normal(random), normal(random)});
        const double side = dot(surface.geometric_normal, rays[i].ray.direction) < 0 ? 1 : -1;
        query.ray.direction = normalized(direction + (1.01 * side) * surface.geometric_normal);
        next.diffuse.push_back(query);
        if (scene.lights.empty())
            continue;
        query.ray.direction = scene.lights.front().position - surface.point;
        query.ray.t_max = 1;
        if (side * dot(query.ray.direction, surface.geometric_normal) > 0)
            next.shadow.push_back(query);
    }
    return next;
}

void print(const char* name, const Measurement& m) {
    std::printf(
        "  %s %7.3f Mray/s %6.2f tests %6.2f cells", name, m.million_rays, m.tests, m.cells);
}

void bench_scene(const std::string& name, const Scene& scene, const GridSettings& settings) {
    const double start = cpu_seconds();
    const auto grid = make_grid_tree(scene, settings);
    const double build = cpu_seconds() - start;
    const auto rays = view_rays(*scene.camera, picture_size);
    std::vector<Hit> hits;
    const auto view = measured_hits(*grid, rays, hits);
    const NextRays next = next_rays(scene, rays, hits);
    const auto shadow = measured_shadows(*grid, next.shadow);
    std::vector<Hit> diffuse_hits;
    const auto diffuse = measured_hits(*grid, next.diffuse, diffuse_hits);
    const GridTreeStatistics statistics = grid->statistics();
    std::printf(
        "%-12s %7zu elements, %5.2f references each, %zu levels, %5zu grids, %8zu cells, longest "
        "list %5zu, build %.3f s\n",
        name.c_str(),
        statistics.elements,
        static_cast<double>(statistics.references)
            / static_cast<double>(std::max<std::size_t>(statistics.elements, 1)),
        statistics.levels,
        statistics.grids,
        statistics.cells,
        statistics.longest_list,
        build);
    print("view", view);
    print("shadow", shadow);
    print("diffuse", diffuse);
    std::printf("\n");
}

/// Primitives of a size that lets about the same part of the rays through, whatever their number.
Scene cloud(std::size_t count, bool spheres) {
    Scene scene;
    std::mt19937_64 random(count);
    std::uniform_real_distribution<double> place(-1, 1);
    const double size = 1 / std::sqrt(static_cast<double>(count));
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 center = {place(random), place(random), place(random)};
        Item item;
        item.index = static_cast<std::uint32_t>(i);
        const auto near = [&] {
            return center + size * Vec3{place(random), place(random), place(random)};
        };
        if (spheres) {
            item.kind = ItemKind::sphere;
            scene.geometry.spheres.push_back({center, 0.6 * size});
        } else {
            item.kind = ItemKind::triangle;
            const Vec3 a = near();
            const Vec3 b = near();
            scene.geometry.triangles.push_back({{a, b, near()}});
        }
        scene.geometry.items.push_back(item);
    }
    number_primitives(scene);
    scene.camera = Camera{};
    scene.camera->viewpoint = {1, 2, 4};
    scene.camera->lower_left = {-1.5, -1.5, 0};
    scene.camera->lower_right = {1.5, -1.5, 0};
    scene.camera->upper_left = {-1.5, 1.5, 0};
    scene.lights.push_back({{5, 5, 5}, 1, {1, 1, 1}, Falloff::none});
    return scene;
}

void bench_cloud(std::size_t count, bool spheres) {
    const Scene scene = cloud(count, spheres);
    const auto grid = make_grid_tree(scene);
    const auto brute = make_brute_force(scene);
    const auto rays = view_rays(*scene.camera, picture_size);
    // As many as brute force manages in about a second.
    const std::size_t few = std::clamp<std::size_t>(50'000'000 / count, 16, rays.size());
    std::vector<QueryRay> some;
    for (std::size_t i = 0; i < few; ++i)
        some.push_back(rays[i * (rays.size() / few)]);
    std::vector<Hit> hits;
    const Measurement slow = measured_hits(*brute, some, hits);
    const Measurement fast = measured_hits(*grid, rays, hits);
    std::printf(
        "%-10s %8zu  %12.6f %12.1f  %12.6f %10.2f  %10.1f %12.1f\n",
        spheres ? "spheres" : "triangles",
        count,
        slow.million_rays,
        slow.tests,
        fast.million_rays,
        fast.tests,
        fast.million_rays / slow.million_rays,
        slow.tests / fast.tests);
}

GridSettings settings_of_environment() {
    GridSettings settings;
    const auto read = [](const char* name, auto& value) {
        if (const char* text = std::getenv(name))
            value = static_cast<std::remove_reference_t<decltype(value)>>(std::atof(text));
    };
    read("GRID_DENSITY", settings.density);
    read("GRID_CROWD", settings.crowd);
    read("GRID_CROWD_DENSITY", settings.crowd_density);
    read("GRID_REFERENCES", settings.references);
    read("GRID_LEVELS", settings.levels);
    return settings;
}

} // namespace

int main(int count, char** arguments) {
    if (count > 1) {
        for (int i = 1; i < count; ++i) {
            const std::string path = arguments[i];
            const std::size_t slash = path.rfind('/');
            const SceneFile file = read_nff(SourceText(path));
            bench_scene(
                path.substr(slash == std::string::npos ? 0 : slash + 1),
                file.scene,
                settings_of_environment());
        }
        return 0;
    }
    std::printf(
        "%-10s %8s  %12s %12s  %12s %10s  %10s %12s\n",
        "",
        "number",
        "brute Mray/s",
        "tests/ray",
        "grid Mray/s",
        "tests/ray",
        "faster",
        "fewer tests");
    for (const bool spheres : {true, false})
        for (std::size_t size = 100; size <= 1'000'000; size *= 10)
            bench_cloud(size, spheres);
    return 0;
}
