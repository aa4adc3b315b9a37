// SPDX-License-Identifier: Apache-2.0
#include "missing_light.h"

#include "vera/render/generations.h"
#include "vera/render/raster.h"
#include "vera/scene/bounds.h"
#include "vera/scene/framing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "scene_index.h"

namespace vera {

namespace {

/// Rays across and down the picture.
constexpr std::size_t rays_a_side = 20;

/// What the viewer sees, and where light would come to it.
class LightSearch {
public:
    LightSearch(const PreparedScene& prepared, const RayIndex& index, const CancelFlag& cancel)
        : traced_(traced_scene(prepared.scene, index, prepared.settings, &cancel))
        , size_(length(extent(bounds(prepared.scene)))) {
        traced_.illumination = {default_lights(prepared.scene, prepared.camera), {}};
        traced_.firmament.reset();
        traced_.luminosity = false;
        traced_.shadows = true;
        const Raster raster = {ViewRays(prepared.camera), rays_a_side, rays_a_side};
        std::vector<QueryRay> rays;
        for (std::size_t y = 0; y < rays_a_side; ++y)
            for (std::size_t x = 0; x < rays_a_side; ++x)
                rays.push_back(raster.ray(static_cast<double>(x), static_cast<double>(y)));
        std::vector<Hit> hits(rays.size());
        QueryCounts counts;
        index.nearest_hits(rays, hits, counts);
        for (std::size_t i = 0; i < rays.size(); ++i)
            if (hits[i].found()) {
                rays_.push_back(rays[i]);
                seen_.push_back(rays[i].ray.origin + hits[i].t * rays[i].ray.direction);
            }
    }

    PointLight best() {
        std::vector<PointLight> lights = {rounded(traced_.illumination.lights.front())};
        for (const Vec3 place : free_places()) {
            lights.push_back(lights.front());
            lights.back().position = place;
            lights.back() = rounded(lights.back());
        }
        std::vector<std::size_t> lit;
        lit.reserve(lights.size());
        for (const PointLight& light : lights)
            lit.push_back(lit_by(light));
        // Those before show shapes better.
        const std::size_t most = *std::ranges::max_element(lit);
        const auto first =
            std::ranges::find_if(lit, [&](std::size_t count) { return 3 * count >= 2 * most; });
        return falling_off(lights[static_cast<std::size_t>(first - lit.begin())]);
    }

private:
    /// How many of the rays see something lit, directly or by mirrors and glass.
    std::size_t lit_by(const PointLight& light) {
        constexpr double black = 1.0 / 255;
        traced_.illumination.lights = {light};
        std::vector<Color> colors(rays_.size());
        GenerationTracer(traced_).trace(rays_, colors);
        return static_cast<std::size_t>(std::ranges::count_if(colors, [](const Color& color) {
            return std::max({color.r, color.g, color.b}) > black;
        }));
    }

    /// On the way of some of the rays to what they meet: high above it, below what is there; there
    /// itself; and at last where the viewer is.
    std::vector<Vec3> free_places() const {
        constexpr std::size_t most_rays = 16;
        const std::size_t step = std::max<std::size_t>(rays_.size() / most_rays, 1);
        const auto on_rays = [&](double part_to_viewer, std::vector<Vec3>& places) {
            for (std::size_t i = step / 2; i < rays_.size(); i += step) {
                const Ray& ray = rays_[i].ray;
                // A parallel view ray begins nowhere.
                const Vec3 to_viewer = std::isfinite(ray.t_min)
                    ? ray.origin - seen_[i]
                    : -size_ / length(ray.direction) * ray.direction;
                places.push_back(seen_[i] + part_to_viewer * to_viewer);
            }
        };
        std::vector<Vec3> on_way;
        for (const double part : {0.7, 0.4})
            on_rays(part, on_way);
        std::vector<Vec3> places = raised(on_way);
        places.insert(places.end(), on_way.begin(), on_way.end());
        on_rays(1, places);
        return places;
    }

    /// The places moved upwards, most of the way to what is above them.
    std::vector<Vec3> raised(std::vector<Vec3> places) const {
        std::vector<QueryRay> rays(places.size());
        for (std::size_t i = 0; i < places.size(); ++i) {
            rays[i].ray.origin = places[i];
            rays[i].ray.direction = {0, 1, 0};
        }
        std::vector<Hit> hits(rays.size());
        QueryCounts counts;
        traced_.index.nearest_hits(rays, hits, counts);
        for (std::size_t i = 0; i < places.size(); ++i)
            places[i].y += hits[i].found() ? 0.8 * hits[i].t : 0.3 * size_;
        return places;
    }

    /// To thousandths of the scene's size, as far as it has one.
    PointLight rounded(PointLight light) const {
        const double unit =
            size_ > 0 && std::isfinite(size_) ? std::pow(10, std::floor(std::log10(size_)) - 3) : 0;
        for (std::size_t axis = 0; axis < 3 && unit > 0; ++axis)
            light.position[axis] = unit * std::round(light.position[axis] / unit);
        return light;
    }

    PointLight falling_off(PointLight light) const {
        std::vector<double> squares;
        squares.reserve(seen_.size() + 1);
        for (const Vec3 point : seen_)
            squares.push_back(dot(point - light.position, point - light.position));
        if (squares.empty())
            squares.push_back(size_ * size_);
        const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
        std::nth_element(squares.begin(), middle, squares.end());
        light.intensity = *middle > 0 ? *middle : 1;
        light.falloff = Falloff::inverse_square;
        return light;
    }

    TracedScene traced_;
    double size_;
    std::vector<QueryRay> rays_; ///< that meet something
    std::vector<Vec3> seen_;     ///< where
};

} // namespace

PointLight missing_light(const PreparedScene& prepared, const CancelFlag& cancel) {
    const auto index = scene_index(prepared.scene, {}, {}, cancel);
    return LightSearch(prepared, *index, cancel).best();
}

} // namespace vera
