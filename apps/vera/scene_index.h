// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/base/parallel.h"

#include <memory>
#include <string>

namespace CLI {
class App;
} // namespace CLI

namespace vera {

/// Which index answers the rays.
struct IndexRequest {
    std::string kind = "auto";
};

/// --index
void add_index_options(CLI::App& command, IndexRequest& request);

/// The index asked for; auto is the wide hierarchy of boxes.
std::unique_ptr<RayIndex> scene_index(
    const Scene& scene,
    const IndexRequest& request,
    const Progress& progress,
    const CancelFlag& cancel);

} // namespace vera
