// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/theory/central_index.h"

#include <memory>

#include "prepared_scene.h"

namespace vera {

/// The index of --strategy central: simple ray tracing (VERA 3.2). The scene must outlive it.
/// Throws CommandLineError where the scene's picture takes rays that start anywhere: mirrored and
/// refracted ones, and those of PARALLEL. Throws as facets() and CentralIndex do.
std::unique_ptr<CentralIndex>
central_index(const PreparedScene& prepared, const Progress& progress, const CancelFlag& cancel);

} // namespace vera
