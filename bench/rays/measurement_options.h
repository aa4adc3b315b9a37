// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "measurement.h"
#include <CLI/CLI.hpp>

namespace vera {

/// The options that say how often and with how many rays is measured.
inline void add_measurement_options(CLI::App& app, MeasurementSettings& settings) {
    const auto add_number = [&](const char* name, std::size_t& number, const char* what) {
        return app.add_option(name, number, what)
            ->check(CLI::PositiveNumber)
            ->capture_default_str();
    };
    add_number("--runs", settings.runs, "of which the median is taken");
    add_number("--threads", settings.threads, "for building and for rays");
    add_number("--raster", settings.raster, "primary rays across the picture, and down")
        ->check([](const std::string& text) {
            return std::stoull(text) % 32 == 0 ? "" : "must be a multiple of 32";
        });
    add_number("--generation", settings.generation, "rays that our indexes get at a time");
    app.add_option("--embree", settings.embree_device, "settings for Embree's device: isa=avx2");
}

} // namespace vera
