// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/packet_query.h"

#include "vera/accel/every_crossing.h"
#include "vera/accel/exact_polygons.h"
#include "vera/accel/exact_round.h"
#include "vera/accel/exact_triangles.h"
#include "vera/base/check.h"
#include "vera/math/transform.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>

#include <hwy/cache_control.h>

namespace vera::detail {

namespace {

constexpr std::uint32_t no_element = ~std::uint32_t{0};

float limit_of(const PacketQuery& query, const Frame& frame, std::size_t lane) {
    if (frame.speed[lane] == 0) // see place_rays
        return static_cast<float>((query.active >> lane & 1U) != 0 ? farthest : -farthest);
    const double distance = (query.limit[lane] - frame.start_t[lane]) * frame.speed[lane]
        + 2 * static_cast<double>(frame.slack);
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

Frame& frame_at(PacketQuery& query, std::size_t depth) {
    while (query.frames.size() <= depth)
        query.frames.emplace_back();
    return query.frames[depth];
}

void start_frame(
    PacketQuery& query, Frame& frame, const LocalGeometry& local, std::uint64_t first_primitive) {
    frame.local = &local;
    frame.prepared_lanes = 0;
    frame.prepared_rows.made = false;
    frame.visit = query.mailbox.next_visit();
    frame.first_primitive = first_primitive;
}

void set_start_elements(const PacketQuery& query, Frame& frame) {
    const Geometry& geometry = *frame.local->geometry;
    for (std::size_t lane = 0; lane < query.rays.size(); ++lane) {
        const FaceId& face = query.rays[lane].start;
        const std::uint64_t start = face.primitive - frame.first_primitive; // large for none
        const bool is_here = start < geometry.primitive_count && face.piece != no_piece;
        frame.start_element[lane] = is_here ? static_cast<std::uint32_t>(start) : no_element;
    }
    if (geometry.calls.empty())
        return;
    for (std::size_t lane = 0; lane < query.rays.size(); ++lane)
        if (frame.start_element[lane] != no_element)
            frame.start_element[lane] =
                element_of(geometry, query.rays[lane].start.primitive - frame.first_primitive);
}

/// Completes a frame whose rays were filled in; returns the lanes that touch the bounds.
LaneMask entering(PacketQuery& query, Frame& frame, LaneMask lanes) {
    const LaneMask touching = place_rays(frame, lanes, query.limit, query.reach, query.local_start);
    if (touching != 0)
        set_start_elements(query, frame);
    return touching;
}

const PreparedRay& prepared_ray(Frame& frame, std::size_t lane) {
    if ((frame.prepared_lanes >> lane & 1U) == 0) {
        frame.prepared_lanes |= LaneMask{1} << lane;
        std::construct_at(&frame.prepared[lane], frame.rays.ray(lane));
    }
    return frame.prepared[lane];
}

/// Whether a ray that starts on the element never meets it again.
bool is_plane(const Geometry& geometry, Element element) {
    const Item& item = geometry.items[element.item];
    switch (item.kind) {
    case ItemKind::triangle:
    case ItemKind::patch:
    case ItemKind::mesh:
        return true;
    case ItemKind::polygon:
        return geometry.polygons[item.index].shape != Polygon::Shape::split_quadrangle;
    case ItemKind::sphere:
    case ItemKind::rotational_shape:
    case ItemKind::subscene_call:
        break;
    }
    return false;
}

/// take_crossing() where the nearest face is looked for.
inline bool take_nearest(PacketQuery& query, std::size_t lane, double t, FaceId face) {
    NearestSearch& search = query.nearest[lane];
    search.add(t, face);
    if (!(search.limit() < query.limit[lane]))
        return false;
    query.limit[lane] = search.limit();
    return true;
}

/// Notes what a crossing means; true when the lane's limit or its being active has changed.
bool take_crossing(
    PacketQuery& query, std::size_t lane, double t, FaceId face, MaterialId material) {
    switch (query.purpose) {
    case Purpose::nearest:
        return take_nearest(query, lane, t, face);
    case Purpose::window:
        query.window[lane].add(t, face);
        return false;
    case Purpose::any:
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

void take_rays(PacketQuery& query, std::span<const QueryRay> rays) {
    RayRows& rows = frame_at(query, 0).rays;
    query.rays = rays;
    fill_rows(rays, rows);
    query.limit = rows.t_max;
}

void find_reaches(PacketQuery& query) {
    fill_reaches(query.frames.front().rays, query.reach);
}

LaneMask enter_scene(PacketQuery& query) {
    const LocalGeometry& local = *query.geometries.front();
    Frame& frame = query.frames.front();
    frame.candidates.count = 0;
    if (local.bounds.empty())
        return 0;
    start_frame(query, frame, local, 0);
    frame.depth = 0;
    frame.material = inherited_material;
    return entering(query, frame, query.active);
}

LaneMask enter_call(PacketQuery& query, Frame& frame, std::uint32_t element, LaneMask lanes) {
    const Geometry& geometry = *frame.local->geometry;
    const Element place = element_at(geometry, element);
    const Item& item = geometry.items[place.item];
    const SubsceneCall& call = geometry.calls[item.index];
    Frame& inner = frame_at(query, frame.depth + std::size_t{1});
    start_frame(
        query,
        inner,
        *query.geometries[static_cast<std::size_t>(call.subscene) + 1],
        frame.first_primitive + primitive_number(geometry, place));
    inner.depth = frame.depth + 1;
    inner.material = resolved(item.material, frame.material);
    transform_rays(call.from_parent, frame.rays, inner.rays);
    return entering(query, inner, lanes);
}

void search_plainly(PacketQuery& query, Frame& frame, std::uint32_t element, LaneMask lanes) {
    const Geometry& geometry = *frame.local->geometry;
    const Element place = element_at(geometry, element);
    const Item& item = geometry.items[place.item];
    const SubsceneCall& call = geometry.calls[item.index];
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        const Visit visit = {
            &query.scene->subscenes[static_cast<std::size_t>(call.subscene)],
            transformed_ray(call.from_parent, frame.rays.ray(lane)),
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

namespace {

void make_prepared_rows(Frame& frame) {
    if (frame.prepared_rows.made)
        return;
    prepare_rays(frame);
    frame.prepared_rows.made = true;
}

/// So many rays or more are tested together against a polygon of many corners.
constexpr int few_lanes = 3;

} // namespace

void test_exactly(PacketQuery& query, Frame& frame, std::uint32_t element, LaneMask lanes) {
    const Geometry& geometry = *frame.local->geometry;
    const OutlineTable& outlines = frame.local->outlines;
    const Element place = element_at(geometry, element);
    const Item& item = geometry.items[place.item];
    const MaterialId material = resolved(item.material, frame.material);
    const std::uint64_t primitive = frame.first_primitive
        + (geometry.calls.empty() ? element : primitive_number(geometry, place));
    const auto start_piece = [&](std::size_t lane) {
        return frame.start_element[lane] == element ? query.rays[lane].start.piece : no_piece;
    };
    const auto lower_limit = [&](std::size_t lane) {
        ++query.changes;
        frame.limit[lane] = std::min(frame.limit[lane], limit_of(query, frame, lane));
    };
    if (is_plane(geometry, place))
        for (LaneMask rest = lanes; rest != 0; rest &= rest - 1)
            if (start_piece(static_cast<std::size_t>(std::countr_zero(rest))) != no_piece)
                lanes &= ~(rest & -rest);
    const OutlineStrips* const outline =
        item.kind == ItemKind::polygon ? outlines.of_polygon(item.index) : nullptr;
    if (outline != nullptr && std::popcount(lanes) >= few_lanes) {
        const Polygon& polygon = geometry.polygons[item.index];
        const Vec3& corner = corners_of(geometry, polygon).front();
        PolygonCrossings crossings;
        make_prepared_rows(frame);
        cross_polygon(frame, lanes, corner, polygon.normal, outlines, *outline, crossings);
        for (LaneMask rest = crossings.met; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            if (take_crossing(query, lane, crossings.t[lane], {primitive, 0}, material))
                lower_limit(lane);
        }
        lanes = crossings.undecided;
    }
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        bool changed = false;
        for_each_crossing(
            geometry,
            outlines,
            place,
            prepared_ray(frame, lane),
            start_piece(lane),
            [&](double t, std::uint32_t piece) {
                changed = take_crossing(query, lane, t, {primitive, piece}, material) || changed;
            });
        if (changed)
            lower_limit(lane);
    }
}

namespace {

/// Where the corners of a triangle stand.
struct CornerPlaces {
    const Vec3* corner[3];
};

CornerPlaces corners_in(const Mesh& mesh, std::uint32_t triangle) {
    const Vec3* const positions = mesh.positions.data();
    const std::uint32_t* const corners = mesh.position_indices.data() + std::size_t{3} * triangle;
    return {{positions + corners[0], positions + corners[1], positions + corners[2]}};
}

CornerPlaces corner_places(const LocalGeometry& local, std::uint32_t element) {
    const Geometry& geometry = *local.geometry;
    if (local.mesh_corners != nullptr)
        return corners_in(geometry.meshes.front(), element);
    const Element place = element_at(geometry, element);
    const Item& item = geometry.items[place.item];
    if (item.kind == ItemKind::mesh)
        return corners_in(geometry.meshes[item.index], place.triangle);
    VERA_CHECK(item.kind == ItemKind::triangle || item.kind == ItemKind::patch);
    const Vec3* const first = item.kind == ItemKind::triangle
        ? geometry.triangles[item.index].corners.data()
        : geometry.patches[item.index].corners.data();
    return {{first, first + 1, first + 2}};
}

MaterialId material_at(const Geometry& geometry, const Frame& frame, std::uint32_t element) {
    const Item& item = geometry.items[element_at(geometry, element).item];
    return resolved(item.material, frame.material);
}

/// An element for each lane.
using ElementRow = std::array<std::uint32_t, packet_size>;

/// Takes the crossings of lanes' rays with their elements.
void take_crossings(
    PacketQuery& query,
    const Frame& frame,
    LaneMask met,
    const ElementRow& elements,
    const RayRows::Row& t) {
    const Geometry& geometry = *frame.local->geometry;
    const bool nearest = query.purpose == Purpose::nearest;
    for (LaneMask rest = met; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        const std::uint32_t element = elements[lane];
        const std::uint64_t number = frame.first_primitive
            + (geometry.calls.empty() ? element
                                      : primitive_number(geometry, element_at(geometry, element)));
        if (nearest) {
            query.changes += take_nearest(query, lane, t[lane], {number, 0}) ? 1 : 0;
            continue;
        }
        const MaterialId material = query.purpose == Purpose::transmittance
            ? material_at(geometry, frame, element)
            : inherited_material; // which does not count
        if (take_crossing(query, lane, t[lane], {number, 0}, material))
            ++query.changes;
    }
}

void decide_triangles(
    PacketQuery& query, Frame& frame, LaneMask lanes, const ElementRow& elements) {
    std::array<CornerPlaces, packet_size> places;
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        places[lane] = corner_places(*frame.local, elements[lane]);
        for (const Vec3* corner : places[lane].corner)
            hwy::Prefetch(corner);
    }
    make_prepared_rows(frame);
    TriangleRows triangles;
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vec3& point = *places[lane].corner[corner];
            triangles[corner][0][lane] = point.x;
            triangles[corner][1][lane] = point.y;
            triangles[corner][2][lane] = point.z;
        }
    }
    RayRows::Row t;
    const LaneMask met = cross_triangles(frame, lanes, triangles, t);
    take_crossings(query, frame, met, elements, t);
}

void decide_quadrangles(
    PacketQuery& query, Frame& frame, LaneMask lanes, const ElementRow& elements) {
    const Geometry& geometry = *frame.local->geometry;
    QuadrangleRows quadrangles;
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        const std::uint32_t item = element_at(geometry, elements[lane]).item;
        const Polygon& polygon = geometry.polygons[geometry.items[item].index];
        const Vec3* const corners = geometry.corners.data() + polygon.first_corner;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t i = 0; i < 4; ++i)
                quadrangles.corners[i][axis][lane] = corners[i][axis];
            quadrangles.normal[axis][lane] = polygon.normal[axis];
        }
    }
    make_prepared_rows(frame);
    RayRows::Row t;
    const LaneMask met = cross_quadrangles(frame, lanes, quadrangles, t);
    take_crossings(query, frame, met, elements, t);
}

void put(const Sphere& sphere, std::size_t lane, SphereRows& rows) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        rows.center[axis][lane] = sphere.center[axis];
    rows.radius[lane] = sphere.radius;
}

void put(const RotationalShape& shape, std::size_t lane, MantleRows& rows) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        rows.base[axis][lane] = shape.base[axis];
        rows.axis[axis][lane] = shape.axis[axis];
    }
    const ContourPiece::Point end = shape.contour.front().end;
    rows.start_r[lane] = shape.start.r;
    rows.start_h[lane] = shape.start.h;
    rows.end_r[lane] = end.r;
    rows.end_h[lane] = end.h;
}

/// Of the elements, which are all of these shapes; what no closed formula tells is asked one by
/// one.
template <typename Rows, typename Shape, typename Cross>
void decide_round(
    PacketQuery& query,
    Frame& frame,
    LaneMask lanes,
    const ElementRow& elements,
    const std::vector<Shape>& shapes,
    const Cross& cross) {
    const Geometry& geometry = *frame.local->geometry;
    Rows rows;
    LaneMask starting = 0;
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        starting |= LaneMask{frame.start_element[lane] == elements[lane]} << lane;
        const std::uint32_t item = element_at(geometry, elements[lane]).item;
        put(shapes[geometry.items[item].index], lane, rows);
    }
    RoundCrossings crossings;
    cross(frame, lanes, starting, rows, crossings);
    for (std::size_t i = 0; i < crossings.met.size(); ++i)
        take_crossings(query, frame, crossings.met[i], elements, crossings.t[i]);
    for (LaneMask rest = crossings.undecided; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        test_exactly(query, frame, elements[lane], LaneMask{1} << lane);
    }
}

/// Those of the lanes of which that is the element.
LaneMask lanes_of(std::uint32_t element, LaneMask lanes, const ElementRow& elements) {
    LaneMask same = 0;
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        if (elements[lane] == element)
            same |= LaneMask{1} << lane;
    }
    return same;
}

} // namespace

void decide(PacketQuery& query, Frame& frame, LaneMask lanes) {
    Candidates& candidates = frame.candidates;
    while (candidates.count > 0) {
        TakenCandidates candidate_of;
        const LaneMask taken = take_candidates(frame, lanes & query.active, candidate_of);
        if (taken == 0)
            break;
        const ElementRow& elements = candidate_of.elements;
        const auto of_kind = [&](ElementRecord::Kind kind) {
            return candidate_of.of_kind[static_cast<std::size_t>(kind)];
        };
        const LaneMask triangles = of_kind(ElementRecord::Kind::triangle);
        const LaneMask quadrangles = of_kind(ElementRecord::Kind::quadrangle);
        const LaneMask spheres = of_kind(ElementRecord::Kind::sphere);
        const LaneMask mantles = of_kind(ElementRecord::Kind::mantle);
        for (LaneMask rest = taken & ~(triangles | quadrangles | spheres | mantles); rest != 0;) {
            const std::uint32_t element =
                elements[static_cast<std::size_t>(std::countr_zero(rest))];
            const LaneMask same = lanes_of(element, rest, elements);
            test_exactly(query, frame, element, same);
            rest &= ~same;
        }
        const Geometry& geometry = *frame.local->geometry;
        if (triangles != 0)
            decide_triangles(query, frame, triangles, elements);
        if (quadrangles != 0)
            decide_quadrangles(query, frame, quadrangles, elements);
        if (spheres != 0)
            decide_round<SphereRows>(
                query, frame, spheres, elements, geometry.spheres, cross_spheres);
        if (mantles != 0)
            decide_round<MantleRows>(
                query, frame, mantles, elements, geometry.rotational_shapes, cross_mantles);
        LaneMask more = 0;
        for (std::size_t i = 0; i < candidates.count; ++i)
            more |= candidates.all[i].lanes;
        refresh_limits(query, frame, taken & more);
    }
    // Those of other lanes remain.
    std::size_t kept = 0;
    for (std::size_t i = 0; i < candidates.count; ++i) {
        const LaneMask remaining = candidates.all[i].lanes & ~lanes & query.active;
        if (remaining == 0)
            continue;
        candidates.all[kept] = candidates.all[i];
        candidates.all[kept].lanes = remaining;
        candidates.near[kept++] = candidates.near[i];
    }
    candidates.count = kept;
}

void fetch_candidates(const Frame& frame) {
    const Candidates& candidates = frame.candidates;
    for (std::size_t i = 0; i < candidates.count; ++i)
        if (candidates.all[i].kind == ElementRecord::Kind::triangle)
            for (const Vec3* corner : corner_places(*frame.local, candidates.all[i].element).corner)
                hwy::Prefetch(corner);
}

void decide_main_scene(PacketQuery& query) {
    if (!query.frames.empty())
        decide(query, query.frames.front(), ~LaneMask{0});
}

bool ends_search(const PacketQuery& query, const Frame& frame, std::uint32_t element) {
    switch (query.purpose) {
    case Purpose::any:
        return true;
    case Purpose::transmittance: {
        const MaterialId material = material_at(*frame.local->geometry, frame, element);
        return is_black(transmission(*query.scene, material));
    }
    case Purpose::nearest:
    case Purpose::window:
        break;
    }
    return false;
}

void block(PacketQuery& query, Frame& frame, LaneMask lanes) {
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        if (query.purpose == Purpose::transmittance)
            query.transmittance[lane].block();
        query.limit[lane] = -std::numeric_limits<double>::infinity();
        frame.limit[lane] = static_cast<float>(-farthest);
    }
    query.active &= ~lanes;
    query.changes += lanes != 0 ? 1 : 0;
}

void refresh_limits(const PacketQuery& query, Frame& frame, LaneMask lanes) {
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        frame.limit[lane] = std::min(frame.limit[lane], limit_of(query, frame, lane));
    }
}

} // namespace vera::detail
