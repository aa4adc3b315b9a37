// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "measurement.h"

namespace vera {

/// What was measured as tables: builds, then one for each kind of rays, with geometric means.
std::string as_text(const std::vector<SceneMeasurement>& scenes, const RaysBenchSettings& settings);

/// The same, and every call of Embree's, as JSON.
std::string as_json(const std::vector<SceneMeasurement>& scenes, const RaysBenchSettings& settings);

} // namespace vera
