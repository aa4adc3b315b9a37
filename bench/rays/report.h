// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "measurement.h"
#include <nlohmann/json_fwd.hpp>

namespace vera {

/// The geometric mean of what is added.
class GeometricMean {
public:
    void add(double value);

    std::size_t count() const { return count_; }

    double value() const;

private:
    double logarithms_ = 0;
    std::size_t count_ = 0;
};

/// What was measured as tables: builds, then one for each kind of rays, with geometric means.
std::string
as_text(const std::vector<SceneMeasurement>& scenes, const MeasurementSettings& settings);

/// How it was measured, and then every number, of every call of Embree's as well.
nlohmann::ordered_json as_json(const MeasurementSettings& settings);
nlohmann::ordered_json as_json(const SceneMeasurement& scene);

} // namespace vera
