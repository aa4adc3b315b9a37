// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/grid_build.h"
#include "vera/accel/grid_tree.h"
#include "vera/accel/index_memory.h"
#include "vera/scene/bounds.h"

namespace vera {

IndexForecast grid_forecast(const Scene& scene, const GridSettings& settings) {
    const std::vector<Box3> boxes = subscene_bounds(scene);
    IndexForecast forecast;
    forecast.bytes = detail::forecast_bytes(scene.geometry, boxes, settings);
    for (const Geometry& subscene : scene.subscenes)
        forecast.bytes += detail::forecast_bytes(subscene, boxes, settings);
    forecast.available_bytes = detail::memory_to_give();
    return forecast;
}

} // namespace vera
