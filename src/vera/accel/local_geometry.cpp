// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/local_geometry.h"

#include "vera/math/transform.h"
#include "vera/scene/bounds.h"

#include <algorithm>
#include <cmath>

namespace vera::detail {

LocalGeometry local_geometry(const Geometry& geometry, const std::vector<Box3>& subscene_bounds) {
    LocalGeometry local;
    local.geometry = &geometry;
    if (geometry.items.size() == 1 && geometry.meshes.size() == 1)
        local.mesh_corners = geometry.meshes.front().position_indices.data();
    local.bounds = bounds(geometry, subscene_bounds);
    if (local.bounds.empty())
        return local;
    local.center = center(local.bounds);
    int exponent = 0;
    const double largest = max_component(0.5 * local.bounds.upper - 0.5 * local.bounds.lower);
    if (largest > 0)
        std::frexp(largest, &exponent);
    exponent = std::max(exponent, -1000); // the scale must not overflow
    local.scale = std::ldexp(1.0, -exponent);
    local.local_bounds = {
        local_point(local, local.bounds.lower), local_point(local, local.bounds.upper)};
    local.coordinate_size = max_component(max(abs(local.bounds.lower), abs(local.bounds.upper)));
    for (const RotationalShape& shape : geometry.rotational_shapes)
        local.coordinate_size = std::max(local.coordinate_size, max_component(abs(shape.base)));
    return local;
}

Box3 local_box(
    const LocalGeometry& local, Element element, const std::vector<Box3>& subscene_bounds) {
    const Geometry& geometry = *local.geometry;
    const Item& item = geometry.items[element.item];
    Box3 box;
    if (item.kind == ItemKind::subscene_call) {
        const SubsceneCall& call = geometry.calls[item.index];
        box = transformed_box(
            call.to_parent, subscene_bounds[static_cast<std::size_t>(call.subscene)]);
    } else {
        box = bounds(geometry, element);
    }
    if (box.empty())
        return {};
    return {local_point(local, box.lower), local_point(local, box.upper)};
}

} // namespace vera::detail
