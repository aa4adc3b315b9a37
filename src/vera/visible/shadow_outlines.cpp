// SPDX-License-Identifier: Apache-2.0
// Where the shadows lie that facets throw on faces, in the picture (VERA 3.4): the other half of
// ThrownShadows.
#include "vera/base/long_loop.h"
#include "vera/exact/front_order.h"
#include "vera/visible/cut_polygon.h"
#include "vera/visible/shadows.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace vera {

/// A face with what is asked of it for each shadow of a light.
struct ThrownShadows::Ground {
    std::uint32_t face = 0;
    FacePlane plane;
    double light_height = 0;
    double flat = 0;
    ImagePoint light;
    ScreenTriangle on; ///< whose plane its shadows have
    NearnessSlope slope;
};

/// A convex polygon in the picture; without points where there is nothing to see.
struct ThrownShadows::Outline {
    std::array<ScreenPoint, CutPolygon::most> points;
    std::size_t count = 0;
};

namespace {

/// Numbers the vertices that are added to a screen: those of shadows on one face by their points,
/// which tell how near they are.
class ShadowVertices {
public:
    /// Of about so many.
    ShadowVertices(ScreenScene& screen, std::size_t expected)
        : screen_(screen)
        , first_(screen.vertices.size())
        , places_(std::bit_ceil(std::max<std::size_t>(512, 2 * expected)), none) {}

    std::uint32_t number(ScreenPoint point, std::uint32_t face, const NearnessSlope& slope) {
        if (2 * faces_.size() >= places_.size())
            grow();
        const std::size_t place = place_of(point, face);
        if (places_[place] == none) {
            places_[place] = static_cast<std::uint32_t>(screen_.vertices.size());
            faces_.push_back(face);
            const double nearness = std::clamp(
                std::ceil(slope.at({static_cast<double>(point.x), static_cast<double>(point.y)})),
                0.0,
                static_cast<double>(depth_size));
            screen_.vertices.push_back({point, static_cast<std::int64_t>(nearness)});
        }
        return places_[place];
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    std::size_t place_of(ScreenPoint point, std::uint32_t face) const {
        std::uint64_t hash =
            static_cast<std::uint64_t>(point.x) << 32U | static_cast<std::uint32_t>(point.y);
        hash = (hash ^ hash >> 29U) * 0x9e3779b97f4a7c15U;
        hash = (hash ^ face) * 0xbf58476d1ce4e5b9U;
        std::size_t place = (hash ^ hash >> 32U) & (places_.size() - 1);
        while (places_[place] != none
               && (faces_[places_[place] - first_] != face
                   || screen_.vertices[places_[place]].point != point))
            place = (place + 1) & (places_.size() - 1);
        return place;
    }

    void grow() {
        places_.assign(2 * places_.size(), none);
        for (std::size_t i = 0; i < faces_.size(); ++i)
            places_[place_of(screen_.vertices[first_ + i].point, faces_[i])] =
                static_cast<std::uint32_t>(first_ + i);
    }

    ScreenScene& screen_;
    std::size_t first_;
    std::vector<std::uint32_t> faces_; ///< of the vertices
    std::vector<std::uint32_t> places_;
};

} // namespace

ThrownShadows::Ground
ThrownShadows::ground(std::size_t light, const Lit& lit, const ScreenScene& screen) const {
    const Vec3 position = shadowed_.scene.lights[light].position;
    Ground ground;
    ground.face = lit.face;
    ground.plane = plane_towards(shadowed_, lit.face, position);
    ground.light_height = ground.plane.height(position);
    ground.flat = lit.flat;
    ground.light = shadowed_.map.image_point(position);
    ground.on = screen.triangles[receivers_[lit.face].largest];
    ground.slope = nearness_slope(plane_of(screen, ground.on));
    return ground;
}

/// Where the facet's shadow lies on the face's plane, as the camera sees it, in the receiver's part
/// of the picture.
ThrownShadows::Outline ThrownShadows::outline(const Ground& on, std::uint32_t facet) const {
    const Facets::Triangle& throwing = shadowed_.facets.triangles[facet];
    // Heights, by the light's, are kept in the points' depths.
    std::array<ImagePoint, 3> corners;
    bool stands_up = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 corner = shadowed_.facets.corners[throwing.corners[i]];
        const double height = on.plane.height(corner);
        corners[i] = shadowed_.map.image_point(corner);
        corners[i].depth = std::abs(height) <= on.flat ? 0 : height / on.light_height;
        stands_up = stands_up || corners[i].depth > 0;
    }
    if (!stands_up)
        return {};
    CutPolygon polygon(corners);
    polygon.cut([](const ImagePoint& p) { return p.depth; }, [](ImagePoint& p) { p.depth = 0; });
    // What is as high as the light has its shadow infinitely far away.
    constexpr double highest = 1 - 0x1p-24;
    polygon.cut(
        [](const ImagePoint& p) { return highest - p.depth; },
        [](ImagePoint& p) { p.depth = highest; });
    // In homogeneous coordinates the projection from the light to the plane is p - height light.
    const ImagePoint& light = on.light;
    for (ImagePoint& p : polygon.points())
        p = {p.x - p.depth * light.x, p.y - p.depth * light.y, p.w - p.depth * light.w, 0};
    const ShadowReceiver& receiver = receivers_[on.face];
    const double left = static_cast<double>(receiver.low.x) / screen_size;
    const double right = static_cast<double>(receiver.high.x) / screen_size;
    const double low = 1 - static_cast<double>(receiver.high.y) / screen_size;
    const double high = 1 - static_cast<double>(receiver.low.y) / screen_size;
    polygon.cut(
        [&](const ImagePoint& p) { return p.x - left * p.w; },
        [&](ImagePoint& p) { p.x = left * p.w; });
    polygon.cut(
        [&](const ImagePoint& p) { return right * p.w - p.x; },
        [&](ImagePoint& p) { p.x = right * p.w; });
    polygon.cut(
        [&](const ImagePoint& p) { return p.y - low * p.w; },
        [&](ImagePoint& p) { p.y = low * p.w; });
    polygon.cut(
        [&](const ImagePoint& p) { return high * p.w - p.y; },
        [&](ImagePoint& p) { p.y = high * p.w; });
    Outline outline;
    const auto rounded = [](double value) {
        return static_cast<std::int32_t>(
            std::clamp(std::floor(value + 0.5), 0.0, 1.0 * screen_size));
    };
    for (const ImagePoint& p : std::as_const(polygon).points()) {
        if (!(p.w > 0))
            return {};
        outline.points[outline.count++] = {
            rounded(p.x / p.w * screen_size), rounded((1 - p.y / p.w) * screen_size)};
    }
    return outline;
}

std::vector<std::uint32_t> ThrownShadows::add_on(
    std::span<const std::uint32_t> faces, ScreenScene& screen, const CancelFlag* cancel) const {
    struct Thrown {
        std::uint32_t ground = 0;
        std::uint32_t facet = 0;
    };

    constexpr std::size_t batch = 4096; // so that not all outlines are there at a time
    std::size_t count = 0;
    for (const std::uint32_t face : faces)
        count += count_on_[face];
    ShadowVertices vertices(screen, 4 * count);
    std::vector<Outline> outlines(std::min(batch, count));
    std::vector<std::uint32_t> starts;
    std::vector<std::uint32_t> corners;
    for (std::size_t light = 0; light < lights_.size(); ++light) {
        starts.push_back(static_cast<std::uint32_t>(screen.vertices.size()));
        const auto& [lit, throwing] = lights_[light];
        std::vector<Ground> grounds;
        std::vector<Thrown> all;
        auto next = lit.begin();
        for (const std::uint32_t face : faces) {
            next = std::lower_bound(
                next, lit.end(), face, [](const Lit& a, std::uint32_t b) { return a.face < b; });
            if (next->face != face)
                continue;
            for (std::uint32_t i = next->first; i < (next + 1)->first; ++i)
                all.push_back({static_cast<std::uint32_t>(grounds.size()), throwing[i]});
            grounds.push_back(ground(light, *next, screen));
        }
        for (std::size_t first = 0; first < all.size(); first += batch) {
            stop_if_raised(cancel);
            const std::size_t here = std::min(batch, all.size() - first);
            parallel_ranges(here, 256, [&](std::size_t from, std::size_t to) {
                for (std::size_t i = from; i < to; ++i)
                    outlines[i] = outline(grounds[all[first + i].ground], all[first + i].facet);
            });
            for (std::size_t i = 0; i < here; ++i) {
                const Ground& on = grounds[all[first + i].ground];
                corners.clear();
                for (std::size_t j = 0; j < outlines[i].count; ++j)
                    corners.push_back(vertices.number(outlines[i].points[j], on.face, on.slope));
                for (std::size_t j = 2; j < corners.size(); ++j)
                    add_part(
                        screen,
                        {corners[0], corners[j - 1], corners[j]},
                        on.on,
                        static_cast<std::uint32_t>(light));
            }
        }
    }
    starts.push_back(static_cast<std::uint32_t>(screen.vertices.size()));
    return starts;
}

} // namespace vera
