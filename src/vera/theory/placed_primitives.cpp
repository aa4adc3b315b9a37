// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/placed_primitives.h"

#include "vera/accel/searches.h"
#include "vera/base/available_memory.h"
#include "vera/base/long_loop.h"
#include "vera/scene/bounds.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace vera {

namespace {

/// The largest sum of the sizes of a row: how much the map may lengthen coordinates.
double growth(const Affine3& map) {
    double largest = 0;
    for (const Vec3& row : map.linear.rows)
        largest = std::fmax(largest, std::abs(row.x) + std::abs(row.y) + std::abs(row.z));
    return largest;
}

} // namespace

PlacedPrimitives::PlacedPrimitives(const Scene& scene, const CancelFlag* cancel) {
    const std::uint64_t count = scene.geometry.primitive_count;
    require_memory(
        static_cast<double>(count) * sizeof(PlacedPrimitive),
        "a list of " + std::to_string(count) + " primitives, subscenes expanded at each call,",
        "--strategy rays expands none");
    primitives_.reserve(count);
    place_all(scene, cancel);
}

void PlacedPrimitives::place_all(const Scene& scene, const CancelFlag* cancel) {
    struct Visit {
        std::uint32_t place = 0;
        std::uint32_t item = 0;
        MaterialId material = inherited_material;
    };

    places_.push_back({&scene.geometry, nullptr, 0, {}, {}});
    // A stack of our own: subscenes may nest to any depth.
    std::vector<Visit> stack = {{}};
    while (!stack.empty()) {
        Visit& visit = stack.back();
        const Geometry& geometry = *places_[visit.place].geometry;
        if (visit.item == geometry.items.size()) {
            stack.pop_back();
            continue;
        }
        stop_if_raised(cancel);
        const std::uint32_t number = visit.item++;
        const Item& item = geometry.items[number];
        const std::uint32_t place = visit.place;
        const MaterialId material = detail::resolved(item.material, visit.material);
        if (item.kind == ItemKind::subscene_call) {
            const SubsceneCall& call = geometry.calls[item.index];
            places_.push_back(
                {&scene.subscenes[static_cast<std::size_t>(call.subscene)],
                 &call,
                 place,
                 composed(places_[place].to_scene, call.to_parent),
                 composed(call.from_parent, places_[place].from_scene)});
            stack.push_back({static_cast<std::uint32_t>(places_.size() - 1), 0, material});
            continue;
        }
        const std::uint32_t triangles = item.kind == ItemKind::mesh
            ? static_cast<std::uint32_t>(geometry.meshes[item.index].triangle_count())
            : 1;
        for (std::uint32_t triangle = 0; triangle < triangles; ++triangle)
            primitives_.push_back({place, {number, triangle}, material});
    }
}

Box3 PlacedPrimitives::box(std::size_t number) const {
    const PlacedPrimitive& primitive = primitives_[number];
    const PlacedGeometry& place = places_[primitive.place];
    const Box3 own = bounds(*place.geometry, primitive.element);
    return primitive.place == 0 ? own : transformed_box(place.to_scene, own);
}

double PlacedPrimitives::slack(std::size_t number, double reach, double origin_error) const {
    const PlacedGeometry& place = places_[primitives_[number].place];
    const double out = growth(place.to_scene);
    const double in = growth(place.from_scene);
    // Tests err by less than 2^-44 of the coordinates that they are given (as place_rays() has it),
    // and so do the maps, of which the ray goes through one and the box through the other; both
    // there, and then here.
    const Vec3 moved = abs(place.from_scene.translation);
    const double reach_there = in * reach + max_component(moved);
    return 0x1p-44 * reach + out * (0x1p-42 * reach_there + 2 * in * origin_error);
}

Ray PlacedPrimitives::carried(std::uint32_t place, const Ray& ray) const {
    std::vector<const SubsceneCall*> calls;
    for (std::uint32_t at = place; at != 0; at = places_[at].caller)
        calls.push_back(places_[at].call);
    Ray result = ray;
    std::reverse(calls.begin(), calls.end());
    for (const SubsceneCall* call : calls)
        result = transformed_ray(call->from_parent, result);
    return result;
}

std::size_t PlacedPrimitives::bytes() const {
    return places_.capacity() * sizeof(PlacedGeometry)
        + primitives_.capacity() * sizeof(PlacedPrimitive);
}

} // namespace vera
