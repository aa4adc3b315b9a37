// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/packet_query.h"

#include "vera/accel/every_crossing.h"
#include "vera/math/transform.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace vera::detail {

namespace {

constexpr std::uint32_t no_element = ~std::uint32_t{0};

/// Rounding to single precision moves a coordinate, or a point of a ray, by less than 2^-21 of the
/// unit that holds the bounds; the rest is for the tests' own rounding.
constexpr double least_slack = 0x1p-18;

/// Local distances do not get larger: the bounds' diagonal is less than 4.
constexpr double farthest = 8;

float limit_of(const PacketQuery& query, const Frame& frame, std::size_t lane) {
    if (frame.speed[lane] == 0) // see set_lane_everywhere
        return static_cast<float>((query.active >> lane & 1U) != 0 ? farthest : -farthest);
    const double distance =
        (query.limit[lane] - frame.start_t[lane]) * frame.speed[lane] + 2.0 * double{frame.slack};
    return static_cast<float>(std::min(distance, farthest) * (1 + 0x1p-20));
}

/// The number of the element that the primitive, counted within the geometry, is; none when it
/// lies in a subscene.
std::uint32_t element_of(const Geometry& geometry, std::uint64_t primitive) {
    const auto& compounds = geometry.compounds;
    const auto after = std::upper_bound(
        compounds.begin(),
        compounds.end(),
        primitive,
        [](std::uint64_t number, const Compound& compound) {
            return number < compound.first_primitive;
        });
    if (after == compounds.begin())
        return static_cast<std::uint32_t>(primitive);
    const Compound& compound = *(after - 1);
    const std::uint64_t within = primitive - compound.first_primitive;
    const Item& item = geometry.items[compound.item];
    if (item.kind == ItemKind::mesh)
        return static_cast<std::uint32_t>(compound.first_element + within);
    const std::uint64_t next =
        after == compounds.end() ? geometry.primitive_count : after->first_primitive;
    const std::uint64_t next_element =
        after == compounds.end() ? geometry.element_count : after->first_element;
    const std::uint64_t behind = next_element - compound.first_element - 1;
    if (primitive < next - behind)
        return no_element; // in the call
    return static_cast<std::uint32_t>(next_element - (next - primitive));
}

void set_lane(Frame& frame, std::size_t lane, Vec3 origin, Vec3 direction) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        frame.origin[axis][lane] = static_cast<float>(origin[axis]);
        const double along = direction[axis];
        frame.direction[axis][lane] = static_cast<float>(along);
        constexpr double least = 1e-20;
        frame.inverse[axis][lane] = static_cast<float>(
            std::abs(along) > least ? 1 / along : std::copysign(1 / least, along));
    }
}

/// A ray that cannot be followed (of no direction, or not finite) is let meet everything.
void set_lane_everywhere(Frame& frame, std::size_t lane) {
    set_lane(frame, lane, {}, {1, 0, 0});
    frame.slack = 64;
    frame.start_t[lane] = 0;
    frame.speed[lane] = 0;
}

/// Fills in a lane of a frame; false when the ray misses the bounds.
bool place_ray(const PacketQuery& query, Frame& frame, std::size_t lane, const Ray& ray) {
    const GeometryGrids& grids = *frame.grids;
    const double norm = length(ray.direction);
    const double speed = norm * grids.scale;
    const Vec3 origin = local_point(grids, ray.origin);
    frame.rays[lane] = PreparedRay(ray);
    if (!(speed > 0) || !std::isfinite(speed) || !is_finite(origin)) {
        set_lane_everywhere(frame, lane);
        return true;
    }
    const Vec3 direction = ray.direction / norm;
    const double origin_size = max_component(abs(origin));
    const double slack = least_slack + 0x1p-44 * (origin_size + grids.scale * grids.coordinate_size)
        + 2 * grids.scale * ray.origin_error;
    double near = ray.t_min * speed;
    double far = std::min(ray.t_max, query.limit[lane]) * speed;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double lower = grids.local_bounds.lower[axis] - slack - origin[axis];
        const double upper = grids.local_bounds.upper[axis] + slack - origin[axis];
        if (direction[axis] == 0) {
            if (lower > 0 || upper < 0)
                return false;
            continue;
        }
        const double at_lower = lower / direction[axis];
        const double at_upper = upper / direction[axis];
        near = std::max(near, std::min(at_lower, at_upper));
        far = std::min(far, std::max(at_lower, at_upper));
    }
    if (!(near <= far + slack))
        return false;
    set_lane(frame, lane, origin + near * direction, direction);
    frame.slack = std::max(frame.slack, static_cast<float>(slack));
    frame.start_t[lane] = near / speed;
    frame.speed[lane] = speed;
    return true;
}

Frame& frame_at(PacketQuery& query, std::size_t depth) {
    while (query.frames.size() <= depth)
        query.frames.emplace_back();
    return query.frames[depth];
}

void start_frame(
    PacketQuery& query, Frame& frame, const GeometryGrids& grids, std::uint64_t first_primitive) {
    frame.grids = &grids;
    frame.slack = static_cast<float>(least_slack);
    frame.visit = query.mailbox.next_visit();
    frame.first_primitive = first_primitive;
}

void set_start_element(const PacketQuery& query, Frame& frame, std::size_t lane) {
    const std::uint64_t start = query.rays[lane].start.primitive - frame.first_primitive;
    const Geometry& geometry = *frame.grids->geometry;
    frame.start_element[lane] =
        start < geometry.primitive_count ? element_of(geometry, start) : no_element;
}

/// Notes what a crossing means; true when the lane's limit or its being active has changed.
bool take_crossing(
    PacketQuery& query, std::size_t lane, double t, FaceId face, MaterialId material) {
    switch (query.purpose) {
    case Purpose::nearest: {
        NearestSearch& search = query.nearest[lane];
        search.add(t, face);
        if (!(search.limit() < query.limit[lane]))
            return false;
        query.limit[lane] = search.limit();
        return true;
    }
    case Purpose::window:
        query.window[lane].add(t, face);
        return false;
    case Purpose::any:
        query.transmittance[lane].block();
        break;
    case Purpose::transmittance:
        query.transmittance[lane].add(t, face, transmission(*query.scene, material));
        if (!query.transmittance[lane].blocked())
            return false;
        break;
    }
    query.active &= ~(LaneMask{1} << lane);
    query.limit[lane] = -std::numeric_limits<double>::infinity();
    return true;
}

} // namespace

std::array<PreparedRay, packet_size> Frame::empty_rays() {
    const PreparedRay ray{Ray{{}, {1, 0, 0}}};
    return {ray, ray, ray, ray, ray, ray, ray, ray, ray, ray, ray, ray, ray, ray, ray, ray};
}

void Mailbox::clear() {
    constexpr std::uint32_t last_to_begin = 0xf0000000U;
    if (last_visit_ > last_to_begin) {
        std::fill(entries_.begin(), entries_.end(), Entry{});
        last_visit_ = 0;
    }
    first_visit_ = last_visit_ + 1;
    used_ = 0;
}

void Mailbox::grow() {
    const std::vector<Entry> old = std::move(entries_);
    entries_.assign(old.size() * 2, {});
    mask_ = entries_.size() - 1;
    used_ = 0;
    for (const Entry& entry : old)
        if (entry.visit >= first_visit_)
            post(entry.visit, entry.element, entry.lanes);
}

LaneMask enter_scene(PacketQuery& query) {
    const GeometryGrids& grids = query.geometries->front();
    if (grids.grids.empty())
        return 0;
    Frame& frame = frame_at(query, 0);
    start_frame(query, frame, grids, 0);
    frame.depth = 0;
    frame.material = inherited_material;
    LaneMask lanes = 0;
    for (std::size_t lane = 0; lane < query.rays.size(); ++lane) {
        if (!place_ray(query, frame, lane, query.rays[lane].ray))
            continue;
        lanes |= LaneMask{1} << lane;
        set_start_element(query, frame, lane);
    }
    refresh_limits(query, frame, lanes);
    return lanes;
}

LaneMask enter_call(PacketQuery& query, Frame& frame, std::uint32_t element, LaneMask lanes) {
    const Geometry& geometry = *frame.grids->geometry;
    const Element place = element_at(geometry, element);
    const Item& item = geometry.items[place.item];
    const SubsceneCall& call = geometry.calls[item.index];
    Frame& inner = frame_at(query, frame.depth + std::size_t{1});
    start_frame(
        query,
        inner,
        (*query.geometries)[static_cast<std::size_t>(call.subscene) + 1],
        frame.first_primitive + primitive_number(geometry, place));
    inner.depth = frame.depth + 1;
    inner.material = resolved(item.material, frame.material);
    LaneMask entering = 0;
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        const Ray ray = transformed_ray(call.from_parent, frame.rays[lane].ray);
        if (!place_ray(query, inner, lane, ray))
            continue;
        entering |= LaneMask{1} << lane;
        set_start_element(query, inner, lane);
    }
    refresh_limits(query, inner, entering);
    return entering;
}

void search_plainly(PacketQuery& query, Frame& frame, std::uint32_t element, LaneMask lanes) {
    const Geometry& geometry = *frame.grids->geometry;
    const Element place = element_at(geometry, element);
    const Item& item = geometry.items[place.item];
    const SubsceneCall& call = geometry.calls[item.index];
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        const Visit visit = {
            &query.scene->subscenes[static_cast<std::size_t>(call.subscene)],
            transformed_ray(call.from_parent, frame.rays[lane].ray),
            frame.first_primitive + primitive_number(geometry, place),
            resolved(item.material, frame.material)};
        for_each_crossing_within(
            *query.scene,
            visit,
            query.rays[lane].start,
            query.counts.tests,
            [&](double t, FaceId face, MaterialId material) {
                query.changes += take_crossing(query, lane, t, face, material) ? 1 : 0;
            },
            [&] { return (query.active >> lane & 1U) == 0; });
    }
    refresh_limits(query, frame, lanes);
}

void test_exactly(PacketQuery& query, Frame& frame, std::uint32_t element, LaneMask lanes) {
    const Geometry& geometry = *frame.grids->geometry;
    const Element place = element_at(geometry, element);
    const MaterialId material = resolved(geometry.items[place.item].material, frame.material);
    const std::uint64_t primitive = frame.first_primitive
        + (geometry.calls.empty() ? element : primitive_number(geometry, place));
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        bool changed = false;
        for_each_crossing(
            geometry,
            place,
            frame.rays[lane],
            frame.start_element[lane] == element ? query.rays[lane].start.piece : no_piece,
            [&](double t, std::uint32_t piece) {
                changed = take_crossing(query, lane, t, {primitive, piece}, material) || changed;
            });
        if (changed) {
            ++query.changes;
            frame.limit[lane] = limit_of(query, frame, lane);
        }
    }
}

void refresh_limits(const PacketQuery& query, Frame& frame, LaneMask lanes) {
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        frame.limit[lane] = limit_of(query, frame, lane);
    }
}

} // namespace vera::detail
