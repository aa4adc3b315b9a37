// SPDX-License-Identifier: Apache-2.0
// Proposition 1 on the boxes of scenes: view rays, shadow rays and mirrored rays of the examples,
// and which face of which primitive's box they meet first. Beside that, what the index that makes
// pictures visits for the same rays.
#include "vera/accel/wide_bvh.h"
#include "vera/formats/read_scene.h"
#include "vera/scene/camera.h"
#include "vera/scene/surface.h"
#include "vera/theory/box_faces.h"
#include "vera/theory/placed_primitives.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "accel/index_answers.h"
#include "accel/random_scene.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

/// The boxes of a scene's primitives in whole numbers of 2^-19 or so of its size, none smaller than
/// it is.
class WholeBoxes {
public:
    explicit WholeBoxes(const Scene& scene) {
        const PlacedPrimitives primitives(scene);
        Box3 all;
        for (std::size_t i = 0; i < primitives.size(); ++i)
            all = united(all, primitives.box(i));
        center_ = center(all);
        int exponent = 0;
        std::frexp(max_component(extent(all)), &exponent);
        scale_ = std::ldexp(1.0, 20 - exponent);
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            const Box3 box = primitives.box(i);
            WholeBox whole;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                whole.lower[axis] = static_cast<std::int32_t>(std::floor(placed(box.lower, axis)));
                whole.upper[axis] = static_cast<std::int32_t>(std::ceil(placed(box.upper, axis)));
            }
            boxes.push_back(whole);
        }
    }

    /// Nothing where it begins too far off.
    std::optional<WholeRay> ray(const Ray& ray) const {
        const double size = max_component(abs(ray.direction));
        WholeRay whole;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double origin = placed(ray.origin, axis);
            if (!(std::abs(origin) < largest_plane_coordinate))
                return {};
            whole.origin[axis] = static_cast<std::int32_t>(std::lround(origin));
            whole.direction[axis] =
                static_cast<std::int32_t>(std::lround(0x1p20 * (ray.direction[axis] / size)));
        }
        return whole;
    }

    std::vector<WholeBox> boxes;

private:
    double placed(Vec3 point, std::size_t axis) const {
        return scale_ * (point[axis] - center_[axis]);
    }

    Vec3 center_;
    double scale_ = 1;
};

struct Kind {
    const char* name;
    std::vector<QueryRay> rays;
};

/// From the viewer; from each light to what these meet; and from there as a mirror sends them on.
std::vector<Kind> rays_of(const Scene& scene, const std::vector<QueryRay>& view_rays) {
    std::vector<Kind> kinds = {{"view", view_rays}, {"shadow", {}}, {"mirrored", {}}};
    const auto index = make_wide_bvh(scene);
    std::vector<Hit> hits(view_rays.size());
    QueryCounts counts;
    index->nearest_hits(view_rays, hits, counts);
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].found())
            continue;
        const Ray& ray = view_rays[i].ray;
        const SurfacePoint at = surface_at(scene, ray, hits[i]);
        for (const PointLight& light : scene.lights) {
            QueryRay shadow;
            shadow.ray.origin = light.position;
            shadow.ray.direction = at.point - light.position;
            shadow.ray.t_max = 1 - 1e-6;
            kinds[1].rays.push_back(shadow);
        }
        QueryRay mirrored;
        mirrored.ray.origin = at.point;
        mirrored.ray.origin_error = at.point_error;
        mirrored.ray.direction =
            ray.direction - 2 * dot(ray.direction, at.geometric_normal) * at.geometric_normal;
        mirrored.start = at.face;
        kinds[2].rays.push_back(mirrored);
    }
    return kinds;
}

/// What the index of pictures visits for the first face that each ray meets.
std::uint64_t visits_of_index(const Scene& scene, const std::vector<QueryRay>& rays) {
    const auto index = make_wide_bvh(scene);
    QueryCounts counts;
    for (const QueryRay& ray : rays) {
        Hit hit;
        index->nearest_hits({&ray, 1}, {&hit, 1}, counts);
    }
    return counts.cells + counts.tests;
}

struct Compared {
    std::size_t rays = 0;
    std::size_t met = 0;
};

/// Compares all rays with looking at each face, and notes what it took.
Compared compare(const Scene& scene, const std::vector<QueryRay>& view_rays, bool notes) {
    Compared compared;
    const WholeBoxes whole(scene);
    const BoxFaces faces(whole.boxes);
    for (const Kind& kind : rays_of(scene, view_rays)) {
        StepCounts counts;
        std::size_t asked = 0;
        for (const QueryRay& query : kind.rays) {
            const auto ray = whole.ray(query.ray);
            if (!ray)
                continue;
            const auto found = faces.first_face(*ray, &counts);
            const auto expected = brute_force_first_face(whole.boxes, *ray);
            EXPECT_EQ(found, expected) << kind.name << " ray " << asked;
            if (found != expected)
                return compared;
            ++asked;
            compared.met += found ? 1 : 0;
        }
        compared.rays += asked;
        // From some hundred boxes on, they leave out most faces.
        if (whole.boxes.size() >= 100) {
            const std::size_t all_faces = 6 * whole.boxes.size() * asked;
            EXPECT_LT(counts.nodes + counts.points, all_faces / 2) << kind.name;
        }
        if (!notes || asked == 0)
            continue;
        const auto of_ray = [&](std::uint64_t steps) {
            return std::to_string(static_cast<double>(steps) / static_cast<double>(asked));
        };
        const std::string name = kind.name;
        ::testing::Test::RecordProperty(name + "_rays", std::to_string(asked));
        ::testing::Test::RecordProperty(name + "_nodes", of_ray(counts.nodes));
        ::testing::Test::RecordProperty(name + "_faces", of_ray(counts.points));
        ::testing::Test::RecordProperty(
            name + "_visits_of_index", of_ray(visits_of_index(scene, kind.rays)));
    }
    return compared;
}

class BoxesOf : public ::testing::TestWithParam<const char*> {};

TEST_P(BoxesOf, AreMetFirstAsLookingAtEachTells) {
    const Scene scene = read_scene(std::string(VERA_SOURCE_DIR "/scenes/") + GetParam()).scene;
    ASSERT_TRUE(scene.camera);
    const ViewRays view(*scene.camera);
    constexpr int width = 28;
    constexpr int height = 21;
    std::vector<QueryRay> rays;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            QueryRay query;
            query.ray =
                view.ray(view.place_across((x + 0.5) / width), view.place_up((y + 0.5) / height));
            rays.push_back(query);
        }
    const Compared compared = compare(scene, rays, true);
    EXPECT_GT(compared.rays, 1000U);
    EXPECT_GT(compared.met, 500U);
}

INSTANTIATE_TEST_SUITE_P(
    Examples,
    BoxesOf,
    ::testing::Values(
        "still_life.vera",
        "glass.vera",
        "mirror_room.vera",
        "chess.vera",
        "gambit.vera",
        "jewels.vera"),
    [](const auto& example) {
        const std::string name = example.param;
        return name.substr(0, name.find('.'));
    });

TEST(BoxesOfRandomScenes, AreMetFirstAsLookingAtEachTells) {
    Compared all;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        testing::RandomSceneSettings settings;
        settings.items = 2 * (seed + 1);
        Scene scene = testing::random_scene(seed, settings);
        std::vector<QueryRay> rays = testing::random_rays(seed, 300, 1);
        std::erase_if(rays, [](const QueryRay& query) { return query.ray.t_min < 0; });
        const Compared compared = compare(scene, rays, false);
        all.rays += compared.rays;
        all.met += compared.met;
    }
    EXPECT_GT(all.rays, 1500U);
    EXPECT_GT(all.met, 500U);
    EXPECT_GT(all.rays - all.met, 200U);
}

} // namespace
} // namespace vera
