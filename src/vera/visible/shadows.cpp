// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/shadows.h"

#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/base/spent_pages.h"
#include "vera/math/box3.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/cells.h"
#include "vera/visible/closed_bodies.h"
#include "vera/visible/drawing_memory.h"
#include "vera/visible/light_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>
#include <numeric>
#include <span>
#include <vector>

namespace vera {

namespace {

/// By the largest of the facets.
FacePlane plane_of(const ShadowedScene& shadowed, std::uint32_t facet, std::uint32_t end_facet) {
    FacePlane plane;
    double largest = 0;
    for (std::uint32_t i = facet; i < end_facet; ++i) {
        const auto corner = [&](std::size_t j) {
            return shadowed.facets.corners[shadowed.facets.triangles[i].corners[j]];
        };
        const Vec3 normal = cross(corner(1) - corner(0), corner(2) - corner(0));
        const double area = length(normal);
        if (area > largest) {
            largest = area;
            plane = {corner(0), normal / area};
        }
    }
    return plane;
}

/// Behind the facets of a plane face, which follow each other.
std::uint32_t end_facet(const ShadowedScene& shadowed, std::uint32_t face) {
    const auto& first = shadowed.faces.first_facet;
    return face + 1 < first.size() ? first[face + 1]
                                   : static_cast<std::uint32_t>(shadowed.facets.triangles.size());
}

/// Of each face.
std::vector<ShadowReceiver>
receivers_of(const ScreenScene& screen, const VisiblePieces& seen, std::size_t faces) {
    // Beyond its sides, so that no crumb of the face is left lit between them and the shadow.
    constexpr std::int32_t around = 8;
    std::vector<ShadowReceiver> receivers(faces);
    std::vector<std::int64_t> areas(faces);
    for (std::uint32_t i = 0; i < screen.triangles.size(); ++i) {
        const std::uint32_t face = screen.triangles[i].source;
        ShadowReceiver& receiver = receivers[face];
        const auto corners = corners_of(screen, screen.triangles[i]);
        for (const ScreenVertex& corner : corners) {
            const ScreenPoint p = corner.point;
            receiver.low = {
                std::max(std::min(receiver.low.x, p.x - around), 0),
                std::max(std::min(receiver.low.y, p.y - around), 0)};
            receiver.high = {
                std::min(std::max(receiver.high.x, p.x + around), screen_size),
                std::min(std::max(receiver.high.y, p.y + around), screen_size)};
        }
        const std::int64_t area = orientation(corners[0].point, corners[1].point, corners[2].point);
        if (area > areas[face]) {
            areas[face] = area;
            receiver.largest = i;
        }
    }
    for (const VisiblePiece& piece : seen.pieces)
        for (const std::uint32_t triangle : {piece.left, piece.right})
            if (triangle != no_triangle)
                receivers[screen.triangles[triangle].source].is_seen = true;
    return receivers;
}

/// How high over the plane the viewer is: of parallel rays only the sign tells.
double viewer_height(const Camera& camera, const FacePlane& plane) {
    return camera.projection == Camera::Projection::parallel ? -dot(plane.normal, camera.direction)
                                                             : plane.height(camera.viewpoint);
}

/// Calls visit(segment) for the borders of what is seen, each on the planes beside it, within the
/// box of all.
void for_each_seen(
    const ShadowedScene& shadowed,
    const ScreenScene& screen,
    const Box3& all,
    const CancelFlag* cancel,
    const std::function<void(const SeenSegment&)>& visit) {
    const LongLoop loop(shadowed.seen.pieces.size(), {}, cancel);
    for (std::size_t number = 0; number < shadowed.seen.pieces.size(); ++number) {
        loop.turn(number);
        const VisiblePiece& piece = shadowed.seen.pieces[number];
        for (const std::uint32_t triangle : {piece.left, piece.right}) {
            if (triangle == no_triangle)
                continue;
            const std::uint32_t face = screen.triangles[triangle].source;
            const std::uint32_t facet = shadowed.faces.first_facet[face];
            const FacePlane plane = plane_of(shadowed, facet, facet + 1);
            SeenSegment segment;
            for (std::size_t i = 0; i < 2; ++i) {
                const RationalPoint& end = shadowed.seen.points[i == 0 ? piece.from : piece.to];
                const Ray ray =
                    view_ray(shadowed.camera, end.x() / screen_size, end.y() / screen_size);
                const Vec3 at =
                    point_at(ray, -plane.height(ray.origin) / dot(plane.normal, ray.direction));
                // Of a plane seen edge-on it may be anywhere; what is not finite leaves the box.
                segment.ends[i] = min(max(at, all.lower), all.upper);
                segment.pixels[i] =
                    shadowed.map.size_of_pixel(shadowed.width, shadowed.height, segment.ends[i]);
            }
            visit(segment);
        }
    }
}

/// Where the lights look, each in its frames.
std::vector<std::vector<LightFrame>> frames_of_lights(
    const ShadowedScene& shadowed,
    const ScreenScene& screen,
    std::span<const Vec3> positions,
    const CancelFlag* cancel) {
    Box3 all;
    for (std::size_t i = 0; i < shadowed.facets.corners.size(); ++i)
        all = grown(all, shadowed.facets.corners[i]);
    Box3 box;
    for_each_seen(shadowed, screen, all, cancel, [&](const SeenSegment& segment) {
        for (const Vec3& end : segment.ends)
            box = grown(box, end);
    });
    const bool is_finite = std::isfinite(length(box.upper - box.lower));
    if (box.empty() || !is_finite)
        box = all;
    return light_frames(positions, box, [&](const auto& visit) {
        for_each_seen(shadowed, screen, all, cancel, visit);
    });
}

/// A face that a light may reach a part of.
struct Receiving {
    std::uint32_t face = 0;
    double flat = 0; ///< as in ThrownShadows::Lit
};

/// A facet that throws a shadow on a face, by their numbers.
struct Throw {
    std::uint32_t partly_lit = 0;
    std::uint32_t facet = 0;

    friend auto operator<=>(const Throw&, const Throw&) = default;
};

/// Whether the triangles have more than a side or corner in common, by the axes that could part
/// them.
bool overlap(const std::array<ScreenVertex, 3>& a, const std::array<ScreenVertex, 3>& b) {
    const auto is_parted_by_sides_of = [](const auto& one, const auto& other) {
        for (std::size_t i = 0; i < 3; ++i) {
            const ScreenPoint from = one[i].point;
            const ScreenPoint to = one[(i + 1) % 3].point;
            if (orientation(from, to, other[0].point) <= 0
                && orientation(from, to, other[1].point) <= 0
                && orientation(from, to, other[2].point) <= 0)
                return true;
        }
        return false;
    };
    return !is_parted_by_sides_of(a, b) && !is_parted_by_sides_of(b, a);
}

/// Adds the facets that the light sees where a triangle of its view lies, and that overlap it.
void add_throws(
    const LightView& view,
    const LitFacets& lit,
    std::uint32_t facet,
    const std::array<ScreenVertex, 3>& corners,
    std::uint32_t partly_lit,
    std::vector<Throw>& throws) {
    const std::size_t first = throws.size();
    for_each_cell_of(view.cells, corners, [&](std::size_t cell) {
        for (const std::uint32_t i : view.cells.triangles_of(cell)) {
            const ScreenTriangle& other = view.screen.triangles[i];
            if (other.source != facet && lit.is_seen(other.source)
                && overlap(corners, corners_of(view.screen, other)))
                throws.push_back({partly_lit, other.source});
        }
    });
    const auto begin = throws.begin() + static_cast<std::ptrdiff_t>(first);
    std::sort(begin, throws.end());
    throws.erase(std::unique(begin, throws.end()), throws.end());
}

} // namespace

FacePlane plane_of_face(const ShadowedScene& shadowed, std::uint32_t face) {
    return plane_of(shadowed, shadowed.faces.first_facet[face], end_facet(shadowed, face));
}

FacePlane plane_towards(const ShadowedScene& shadowed, std::uint32_t face, Vec3 position) {
    FacePlane plane = plane_of_face(shadowed, face);
    if (plane.height(position) < 0)
        plane.normal = -plane.normal;
    return plane;
}

/// What is thrown in the light of one lamp.
class ThrownShadows::OneLight {
public:
    OneLight(
        const ShadowedScene& shadowed,
        std::span<const ShadowReceiver> receivers,
        std::uint32_t light,
        ScreenScene& screen,
        const CancelFlag* cancel)
        : shadowed_(shadowed)
        , receivers_(receivers)
        , light_(light)
        , position_(shadowed.scene.lights[light].position)
        , screen_(screen)
        , cancel_(cancel) {}

    Light find(
        const ClosedBodies& bodies,
        std::span<const LightFrame> frames,
        const Progress& progress,
        ShadowCounts& counts);

private:
    void find_turned();
    std::vector<std::uint32_t> facets_to_look_at(const ClosedBodies& bodies) const;
    void keep_partly_lit(const LitFacets& lit);
    std::vector<Throw> throws(const LightViews& views) const;

    /// How high the point is over the outer side of the facet, in some unit.
    double outer_height(std::uint32_t facet, Vec3 point) const {
        const auto& corners = shadowed_.facets.triangles[facet].corners;
        const auto corner = [&](std::size_t i) { return shadowed_.facets.corners[corners[i]]; };
        return dot(cross(corner(1) - corner(0), corner(2) - corner(0)), point - corner(0));
    }

    const ShadowedScene& shadowed_;
    std::span<const ShadowReceiver> receivers_;
    std::uint32_t light_;
    Vec3 position_;
    ScreenScene& screen_;
    const CancelFlag* cancel_;
    std::vector<Receiving> turned_; ///< to the light; then those that it reaches a part of
};

/// Finds the faces of which the viewer sees the side that is turned to the light: the lighting
/// formula gives nothing to the others.
void ThrownShadows::OneLight::find_turned() {
    const LongLoop loop(receivers_.size(), {}, cancel_);
    for (std::uint32_t face = 0; face < receivers_.size(); ++face) {
        loop.turn(face);
        if (!receivers_[face].is_seen)
            continue;
        const FacePlane plane = plane_towards(shadowed_, face, position_);
        if (plane.height(position_) > 0 && viewer_height(shadowed_.camera, plane) > 0)
            turned_.push_back({face, 0});
    }
}

/// The facets that the light's views are made of. From outside a closed body, what is seen behind a
/// facet that faces away from the light is behind one that faces it as well: between the light and
/// a place outside, a way goes out as often as it goes in.
std::vector<std::uint32_t>
ThrownShadows::OneLight::facets_to_look_at(const ClosedBodies& bodies) const {
    std::vector<std::uint8_t> is_turned(receivers_.size());
    for (const Receiving& receiving : turned_)
        is_turned[receiving.face] = 1;
    const bool is_parallel = shadowed_.camera.projection == Camera::Projection::parallel;
    std::vector<std::uint8_t> is_outside(bodies.boxes.size());
    for (std::size_t i = 0; i < is_outside.size(); ++i) {
        const Box3& box = bodies.boxes[i];
        is_outside[i] = !contains(box, position_)
            && (is_parallel || !contains(box, shadowed_.camera.viewpoint));
    }
    std::vector<std::uint32_t> result;
    for (std::uint32_t i = 0; i < bodies.of_facet.size(); ++i) {
        const std::uint32_t body = bodies.of_facet[i];
        const bool may_be_left_out =
            body != no_body && is_outside[body] != 0 && is_turned[shadowed_.faces.of_facet[i]] == 0;
        if (!may_be_left_out || outer_height(i, position_) >= 0)
            result.push_back(i);
    }
    return result;
}

/// Tells of which of the faces the light reaches nothing, and leaves those of which it does a part.
void ThrownShadows::OneLight::keep_partly_lit(const LitFacets& lit) {
    std::erase_if(turned_, [&](Receiving& receiving) {
        const std::uint32_t face = receiving.face;
        bool all = true;
        bool any_shown = false;
        bool any_lit = false;
        double step = std::numeric_limits<double>::infinity();
        for (std::uint32_t i = shadowed_.faces.first_facet[face]; i < end_facet(shadowed_, face);
             ++i) {
            // What the light's views do not show is so small or near that nothing is before it.
            const bool is_shown = lit.is_shown(i) || !lit.is_opaque(i);
            any_shown = any_shown || is_shown;
            any_lit = any_lit || (is_shown && (lit.is_seen(i) || !lit.is_opaque(i)));
            all = all && (!is_shown || lit.is_wholly_seen(i));
            for (const std::uint32_t corner : shadowed_.facets.triangles[i].corners)
                step = std::min(
                    step,
                    shadowed_.map.size_of_pixel(
                        screen_size, screen_size, shadowed_.facets.corners[corner]));
        }
        receiving.flat = 0.25 * step;
        const bool is_unlit = any_shown && !any_lit;
        if (is_unlit)
            screen_.unlit[face] |= LightSet{1} << light_;
        return is_unlit || all;
    });
}

std::vector<Throw> ThrownShadows::OneLight::throws(const LightViews& views) const {
    constexpr std::uint32_t none = ~std::uint32_t{0};
    std::vector<std::uint32_t> number(receivers_.size(), none);
    for (std::uint32_t i = 0; i < turned_.size(); ++i)
        number[turned_[i].face] = i;
    std::vector<Throw> result;
    std::mutex mutex;
    const auto add_all = [&](const LightView& view, const ScreenScene& of) {
        parallel_ranges(of.triangles.size(), 1024, [&](std::size_t first, std::size_t last) {
            std::vector<Throw> found;
            for (std::size_t i = first; i < last; ++i) {
                stop_if_raised(cancel_);
                const ScreenTriangle& triangle = of.triangles[i];
                const std::uint32_t partly_lit = number[shadowed_.faces.of_facet[triangle.source]];
                if (partly_lit != none)
                    add_throws(
                        view,
                        views.lit,
                        triangle.source,
                        corners_of(of, triangle),
                        partly_lit,
                        found);
            }
            const std::lock_guard lock(mutex);
            if (result.size() + found.size() > result.capacity())
                require_throw_memory(result.size() + found.size());
            result.insert(result.end(), found.begin(), found.end());
        });
    };
    for (const LightView& view : views.views) {
        add_all(view, view.screen);
        add_all(view, view.transparent);
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

ThrownShadows::Light ThrownShadows::OneLight::find(
    const ClosedBodies& bodies,
    std::span<const LightFrame> frames,
    const Progress& progress,
    ShadowCounts& counts) {
    find_turned();
    std::vector<Throw> thrown;
    {
        const LightViews views = light_views(
            shadowed_.scene,
            shadowed_.facets,
            facets_to_look_at(bodies),
            position_,
            frames,
            progress,
            cancel_);
        counts.cut_nearness = std::max(counts.cut_nearness, views.cut_nearness);
        counts.light_step = std::max(counts.light_step, views.coarse_step);
        keep_partly_lit(views.lit);
        counts.partly_lit += turned_.size();
        thrown = throws(views);
    }
    Light light;
    light.throwing.reserve(thrown.size());
    for (std::size_t i = 0; i < thrown.size(); ++i) {
        if (i == 0 || thrown[i].partly_lit != thrown[i - 1].partly_lit) {
            const Receiving& on = turned_[thrown[i].partly_lit];
            light.faces.push_back({on.face, static_cast<std::uint32_t>(i), on.flat});
        }
        light.throwing.push_back(thrown[i].facet);
    }
    light.faces.push_back(
        {static_cast<std::uint32_t>(receivers_.size()), static_cast<std::uint32_t>(thrown.size())});
    return light;
}

ThrownShadows::ThrownShadows(
    const ShadowedScene& shadowed,
    ScreenScene& screen,
    const Progress& progress,
    const CancelFlag* cancel)
    : shadowed_(shadowed)
    , receivers_(receivers_of(screen, shadowed.seen, shadowed.faces.first_facet.size()))
    , count_on_(receivers_.size()) {
    const std::size_t lights =
        std::min<std::size_t>(shadowed.scene.lights.size(), most_lights_of_a_set);
    std::vector<Vec3> positions;
    for (std::size_t i = 0; i < lights; ++i)
        positions.push_back(shadowed.scene.lights[i].position);
    const std::vector<std::vector<LightFrame>> frames =
        frames_of_lights(shadowed, screen, positions, cancel);
    const ClosedBodies bodies = closed_bodies(shadowed.facets);
    screen.unlit.assign(receivers_.size(), 0);
    for (std::uint32_t i = 0; i < lights; ++i) {
        lights_.push_back(
            OneLight(shadowed_, receivers_, i, screen, cancel)
                .find(bodies, frames[i], progress_part(progress, i, lights), counts_));
        const std::vector<Lit>& faces = lights_.back().faces;
        for (std::size_t j = 0; j + 1 < faces.size(); ++j)
            count_on_[faces[j].face] += faces[j + 1].first - faces[j].first;
    }
}

std::size_t ThrownShadows::count() const {
    std::size_t count = 0;
    for (const Light& light : lights_)
        count += light.throwing.size();
    return count;
}

void ThrownShadows::forget_before(std::uint32_t face) {
    give_back_spent(receivers_, 0, face);
    for (Light& light : lights_) {
        const auto next = std::ranges::lower_bound(light.faces, face, {}, &Lit::face);
        give_back_spent(light.throwing, 0, next->first);
    }
}

ShadowCounts add_shadows(
    const ShadowedScene& shadowed,
    ScreenScene& screen,
    const Progress& progress,
    const CancelFlag* cancel) {
    const ThrownShadows thrown(shadowed, screen, progress, cancel);
    std::vector<std::uint32_t> faces(thrown.face_count());
    std::iota(faces.begin(), faces.end(), 0U);
    const std::size_t before = screen.triangles.size();
    thrown.add_on(faces, screen, cancel);
    ShadowCounts counts = thrown.counts();
    counts.shadows = screen.triangles.size() - before;
    return counts;
}

} // namespace vera
