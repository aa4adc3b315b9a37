// SPDX-License-Identifier: Apache-2.0
// What `vera info` tells of the parts that mesh files name: objects (o) and groups (g) of OBJ
// files.
#pragma once

#include "vera/scene/scene.h"

#include <nlohmann/json_fwd.hpp>

namespace vera {

/// All of them as a list: of the main scene, then of the subscenes, which are named. Each has its
/// `parts` likewise, where there are any.
nlohmann::ordered_json named_parts_json(const Scene& scene);

/// A line for each of the first hundred, to standard output; nothing where there are none.
void print_named_parts(const Scene& scene);

} // namespace vera
