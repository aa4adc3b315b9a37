// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/primitive_hit.h"

#include "vera/accel/searches.h"
#include "vera/base/check.h"
#include "vera/math/transform.h"
#include "vera/scene/primitive_location.h"

namespace vera {

namespace {

/// A primitive in its own geometry, and the ray as it comes there.
struct LocalPrimitive {
    const Geometry* geometry = nullptr;
    Element element;
    Ray ray;
};

/// The ray is carried call by call, as an index carries it.
LocalPrimitive local_primitive(const Scene& scene, const Ray& ray, std::uint64_t primitive) {
    LocalPrimitive local = {&scene.geometry, {}, ray};
    std::uint64_t number = primitive;
    while (true) {
        VERA_CHECK(number < local.geometry->primitive_count);
        const PrimitiveLocation location = location_of(*local.geometry, number);
        const Item& item = local.geometry->items[location.item];
        if (item.kind != ItemKind::subscene_call) {
            local.element = {location.item, static_cast<std::uint32_t>(location.within)};
            return local;
        }
        const SubsceneCall& call = local.geometry->calls[item.index];
        local.ray = transformed_ray(call.from_parent, local.ray);
        local.geometry = &scene.subscenes[static_cast<std::size_t>(call.subscene)];
        number = location.within;
    }
}

} // namespace

Hit primitive_hit(const Scene& scene, const Ray& ray, std::uint64_t primitive) {
    return primitive_hit(scene, QueryRay{ray, {}}, primitive);
}

Hit primitive_hit(const Scene& scene, const QueryRay& query, std::uint64_t primitive) {
    const Ray& ray = query.ray;
    const std::uint32_t start = query.start.primitive == primitive ? query.start.piece : no_piece;
    const LocalPrimitive local = local_primitive(scene, ray, primitive);
    const PreparedRay prepared(local.ray);
    const auto search_all = [&](auto& search) {
        for_each_crossing(
            *local.geometry, local.element, prepared, start, [&](double t, std::uint32_t piece) {
                search.add(t, FaceId{primitive, piece});
            });
    };
    detail::NearestSearch search;
    search.start(coincidence_reach(ray));
    search_all(search);
    if (!search.undecided())
        return search.hit();
    detail::WindowSearch window(search.window_end());
    search_all(window);
    return window.hit();
}

} // namespace vera
