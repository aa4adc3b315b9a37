// SPDX-License-Identifier: Apache-2.0
// Shadows against the construct of VERA 3.4, which makes them of one union of the faces and of what
// is seen of them.
#include "vera/exact/front_order.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/shadows.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <optional>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "visible/cameras.h"
#include "visible/drawn_shadows.h"
#include "visible/map_turns.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::drawn_shadows;
using testing::DrawnShadows;
using testing::region_at;
using testing::scene_of_planes;

/// Calls visit(corners) for trapezoids that together are the region, cut at each of its corners.
template <typename Visit>
void for_each_trapezoid(const VisibleMap& map, std::uint32_t region, const Visit& visit) {
    struct Side {
        NearnessPlace from;
        NearnessPlace to;

        double height(double x) const {
            return from.y + (x - from.x) / (to.x - from.x) * (to.y - from.y);
        }
    };

    std::vector<Side> sides;
    std::set<double> columns;
    for (const VisibleMap::Ring& ring : map.rings) {
        const auto vertices = map.vertices_of(ring);
        for (std::size_t i = 0; i < vertices.size() && ring.region == region; ++i) {
            const RationalPoint& a = map.vertices[vertices[i]];
            const RationalPoint& b = map.vertices[vertices[(i + 1) % vertices.size()]];
            columns.insert(a.x());
            if (a.x() < b.x())
                sides.push_back({{a.x(), a.y()}, {b.x(), b.y()}});
            else if (b.x() < a.x())
                sides.push_back({{b.x(), b.y()}, {a.x(), a.y()}});
        }
    }
    for (auto left = columns.begin(); std::next(left) != columns.end(); ++left) {
        const double right = *std::next(left);
        const double middle = 0.5 * (*left + right);
        std::vector<Side> here;
        for (const Side& side : sides)
            if (side.from.x < middle && side.to.x > middle)
                here.push_back(side);
        std::sort(here.begin(), here.end(), [&](const Side& a, const Side& b) {
            return a.height(middle) < b.height(middle);
        });
        for (std::size_t i = 0; i + 1 < here.size(); i += 2)
            visit(std::array<NearnessPlace, 4>{
                {{*left, here[i].height(*left)},
                 {right, here[i].height(right)},
                 {right, here[i + 1].height(right)},
                 {*left, here[i + 1].height(*left)}}});
    }
}

/// The construct of 3.4: what is seen of each face becomes a part of its own in front of the face.
/// Of what the light then sees, these parts are lit.
class ShadowsByUnion {
public:
    ShadowsByUnion(const Camera& camera, const DrawnShadows& drawn)
        : camera_(camera)
        , drawn_(drawn) {
        const VisibleMap& map = drawn.without;
        for (std::uint32_t region = 0; region < map.regions.size(); ++region)
            for_each_trapezoid(map, region, [&](const std::array<NearnessPlace, 4>& corners) {
                const std::uint32_t face = map.regions[region].source;
                const auto first = static_cast<std::uint32_t>(all_.corners.size());
                for (const NearnessPlace& corner : corners)
                    all_.corners.push_back(on_face(face, corner));
                for (const std::uint32_t i : {1U, 2U}) {
                    all_.triangles.push_back({{first, first + i, first + i + 1}});
                    sources_.push_back(face);
                }
            });
        // The parts come before the faces that they are parts of.
        const auto faces = static_cast<std::uint32_t>(drawn.faces.first_facet.size());
        const auto corners = static_cast<std::uint32_t>(all_.corners.size());
        for (std::size_t i = 0; i < drawn.facets.triangles.size(); ++i) {
            const auto& [a, b, c] = drawn.facets.triangles[i].corners;
            all_.triangles.push_back({{corners + a, corners + b, corners + c}});
            sources_.push_back(faces + drawn.faces.of_facet[i]);
        }
        for (std::size_t i = 0; i < drawn.facets.corners.size(); ++i)
            all_.corners.push_back(drawn.facets.corners[i]);
    }

    /// Whether the light reaches the place of the face; nothing where its view does not show it.
    class View {
    public:
        View(const ShadowsByUnion& shadows, Vec3 light)
            : shadows_(shadows)
            , map_(camera_at(light)) {
            ScreenScene screen = screen_scene(shadows.all_, map_, shadows.sources_);
            sort_by_place(screen);
            const WholePieces whole = whole_pieces(screen);
            seen_ = visible_map(screen, whole.pieces);
        }

        std::optional<bool> is_lit(std::uint32_t face, NearnessPlace place) const {
            const ImagePoint at = map_.image_point(shadows_.on_face(face, place));
            if (!(at.w > 0 && at.x > 0 && at.x < at.w && at.y > 0 && at.y < at.w))
                return std::nullopt;
            const auto turns = testing::turns_about(
                seen_, at.x / at.w * screen_size, (1 - at.y / at.w) * screen_size);
            if (turns.size() != 1)
                return std::nullopt;
            const std::uint32_t source = seen_.regions[turns.begin()->first].source;
            const auto faces = static_cast<std::uint32_t>(shadows_.drawn_.faces.first_facet.size());
            return source % faces == face;
        }

    private:
        static Camera camera_at(Vec3 light) {
            const Vec3 forward = normalized(-light);
            const Vec3 across = 3 * normalized(cross(forward, {0.1, 0.2, 1}));
            const Vec3 up = 3 * normalized(cross(across, forward));
            Camera camera;
            camera.viewpoint = light;
            camera.lower_left = light + forward - across - up;
            camera.lower_right = light + forward + across - up;
            camera.upper_left = light + forward - across + up;
            return camera;
        }

        const ShadowsByUnion& shadows_;
        CameraMap map_;
        VisibleMap seen_;
    };

    /// Whether the light is on the viewer's side of the face.
    bool faces(std::uint32_t face, NearnessPlace place, Vec3 light) const {
        const auto [corner, normal] = plane(face);
        const Ray ray = ray_through(place);
        return dot(normal, light - corner) * dot(normal, ray.direction) < 0;
    }

private:
    std::pair<Vec3, Vec3> plane(std::uint32_t face) const {
        const auto& corners = drawn_.facets.triangles[drawn_.faces.first_facet[face]].corners;
        const auto corner = [&](std::size_t i) { return drawn_.facets.corners[corners[i]]; };
        return {corner(0), normalized(cross(corner(1) - corner(0), corner(2) - corner(0)))};
    }

    Ray ray_through(NearnessPlace place) const {
        return view_ray(camera_, place.x / screen_size, place.y / screen_size);
    }

    Vec3 on_face(std::uint32_t face, NearnessPlace place) const {
        const auto [corner, normal] = plane(face);
        const Ray ray = ray_through(place);
        return point_at(ray, dot(normal, corner - ray.origin) / dot(normal, ray.direction));
    }

    const Camera& camera_;
    const DrawnShadows& drawn_;
    Facets all_;
    std::vector<std::uint32_t> sources_;
};

/// Whether the view's light reaches the face there, if it is the same some steps around.
std::optional<bool>
is_lit_around(const ShadowsByUnion::View& view, std::uint32_t source, const NearnessPlace& place) {
    std::set<std::optional<bool>> found;
    constexpr double off = 40;
    for (const auto& [x, y] :
         {std::pair{0.0, 0.0}, {off, off}, {-off, off}, {off, -off}, {-off, -off}})
        found.insert(view.is_lit(source, {place.x + x, place.y + y}));
    return found.size() == 1 ? *found.begin() : std::nullopt;
}

TEST(Shadows, AreThoseOfTheConstructOfTheText) {
    int compared = 0;
    int unlit = 0;
    for (std::uint64_t seed = 0; seed < 8 && !HasFailure(); ++seed) {
        const Scene scene = scene_of_planes(seed);
        const Camera camera = testing::camera_number(static_cast<int>(seed));
        const DrawnShadows drawn = drawn_shadows(scene, camera);
        if (drawn.screen.cut_nearness > 0 || drawn.counts.cut_nearness > 0)
            continue;
        const ShadowsByUnion by_union(camera, drawn);
        for (std::size_t light = 0; light < scene.lights.size(); ++light) {
            const Vec3 position = scene.lights[light].position;
            const ShadowsByUnion::View view(by_union, position);
            std::mt19937_64 random(seed);
            for (int i = 0; i < 60; ++i) {
                const NearnessPlace place = {
                    std::uniform_real_distribution(0.0, 1.0 * screen_size)(random),
                    std::uniform_real_distribution(0.0, 1.0 * screen_size)(random)};
                const auto region = region_at(drawn.map, place.x, place.y);
                if (!region)
                    continue;
                const auto is_lit = is_lit_around(view, region->source, place);
                if (!is_lit || !by_union.faces(region->source, place, position))
                    continue;
                ++compared;
                const bool is_unlit = contains(region->unlit, light);
                unlit += is_unlit ? 1 : 0;
                EXPECT_EQ(!is_unlit, *is_lit) << "scene " << seed << " light " << light << " at "
                                              << place.x << " " << place.y;
            }
        }
    }
    EXPECT_GT(compared, 300);
    EXPECT_GT(unlit, 60);
}

} // namespace
} // namespace vera
