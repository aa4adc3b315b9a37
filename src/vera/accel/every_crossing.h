// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/searches.h"
#include "vera/math/transform.h"

#include <cstdint>
#include <vector>

namespace vera::detail {

/// A scene or subscene as a ray comes to it: where its primitives' numbers begin, and the material
/// that is current there.
struct Visit {
    const Geometry* geometry = nullptr;
    Ray ray;
    std::uint64_t first_primitive = 0;
    MaterialId material = inherited_material;
};

/// Calls sink(t, face, material) for every crossing of the ray with what the visit's geometry
/// holds, subscenes included, to any depth; tests counts the primitives. Ends early when done() is
/// true.
template <typename Sink, typename Done>
void for_each_crossing_within(
    const Scene& scene,
    const Visit& from,
    FaceId start,
    std::uint64_t& tests,
    const Sink& sink,
    const Done& done) {
    struct Place {
        Visit visit;
        std::uint32_t item = 0;
        std::uint64_t primitive = 0;
    };

    // A stack of our own: subscenes may nest to any depth.
    std::vector<Place> stack = {{from, 0, from.first_primitive}};
    while (!stack.empty()) {
        Place& place = stack.back();
        const Geometry& geometry = *place.visit.geometry;
        if (place.item == geometry.items.size()) {
            stack.pop_back();
            continue;
        }
        const Item& item = geometry.items[place.item];
        const MaterialId material = resolved(item.material, place.visit.material);
        if (item.kind == ItemKind::subscene_call) {
            const SubsceneCall& call = geometry.calls[item.index];
            const Geometry& callee = scene.subscenes[static_cast<std::size_t>(call.subscene)];
            const Visit visit = {
                &callee,
                transformed_ray(call.from_parent, place.visit.ray),
                place.primitive,
                material};
            ++place.item;
            place.primitive += callee.primitive_count;
            stack.push_back({visit, 0, visit.first_primitive}); // place is no longer valid
            continue;
        }
        const std::size_t triangles = item.kind == ItemKind::mesh
            ? geometry.meshes[item.index].triangle_count()
            : std::size_t{1};
        for (std::size_t triangle = 0; triangle < triangles; ++triangle, ++place.primitive) {
            ++tests;
            for_each_crossing(
                geometry,
                {place.item, static_cast<std::uint32_t>(triangle)},
                place.visit.ray,
                place.primitive == start.primitive ? start.piece : no_piece,
                [&](double t, std::uint32_t piece) {
                    sink(t, FaceId{place.primitive, piece}, material);
                });
            if (done())
                return;
        }
        ++place.item;
    }
}

} // namespace vera::detail
