// SPDX-License-Identifier: Apache-2.0
#include "vera/render/exposure.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace vera {

namespace {

constexpr std::size_t raster = 64;

/// Nearest rank: the smallest value that at least 95 % of the values do not exceed.
std::size_t quantile_rank(std::size_t count) {
    return (count * 95 + 99) / 100;
}

/// The rays of the exposure raster that hit something.
std::vector<QueryRay>
hitting_rays(const TracedScene& traced, const Camera& camera, RenderStatistics& statistics) {
    std::vector<QueryRay> rays(raster * raster);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::size_t column = i % raster;
        const std::size_t row = i / raster;
        rays[i].ray = view_ray(
            camera,
            (static_cast<double>(column) + 0.5) / raster,
            (static_cast<double>(row) + 0.5) / raster);
    }

    std::vector<Hit> hits(rays.size());
    GenerationTracer tracer(traced);
    tracer.nearest(rays, hits);
    tracer.statistics.probe_rays += rays.size();
    statistics += tracer.statistics;

    std::vector<QueryRay> hitting;
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (hits[i].found())
            hitting.push_back(rays[i]);
    return hitting;
}

std::vector<Color>
traced_colors(const TracedScene& traced, std::span<const QueryRay> rays, RenderStatistics& sum) {
    std::vector<Color> colors(rays.size());
    GenerationTracer tracer(traced);
    tracer.trace(rays, colors);
    tracer.statistics.view_rays += rays.size();
    sum += tracer.statistics;
    return colors;
}

/// What the rays see is linear in the light, so that two pictures tell all: one of the light alone
/// and one of all else.
std::vector<ExposureSample>
exposure_samples(const TracedScene& traced, const Camera& camera, RenderStatistics& statistics) {
    const std::vector<QueryRay> rays = hitting_rays(traced, camera, statistics);
    TracedScene light_alone = traced;
    light_alone.firmament.reset();
    light_alone.luminosity = false;
    TracedScene all_else = traced;
    all_else.illumination = {};

    const std::vector<Color> scaled = traced_colors(light_alone, rays, statistics);
    const std::vector<Color> fixed = traced_colors(all_else, rays, statistics);
    std::vector<ExposureSample> samples(rays.size());
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = {scaled[i], fixed[i]};
    return samples;
}

/// The largest factor with which the sample does not exceed the target. when_equal is what to take
/// for a sample that equals it with every factor.
double largest_factor(const ExposureSample& sample, double target, double when_equal) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double largest = infinity;
    double constant = -infinity;
    const auto limit = [&](double scaled, double fixed) {
        if (scaled > 0)
            largest = std::min(largest, (target - fixed) / scaled);
        else
            constant = std::max(constant, fixed);
    };
    limit(sample.scaled.r, sample.fixed.r);
    limit(sample.scaled.g, sample.fixed.g);
    limit(sample.scaled.b, sample.fixed.b);
    if (constant > target)
        return -infinity;
    return constant == target ? std::min(largest, when_equal) : largest;
}

/// The largest factor of as many samples as the quantile wants within the target.
double quantile_factor(std::span<const ExposureSample> samples, double target, double when_equal) {
    std::vector<double> factors;
    factors.reserve(samples.size());
    for (const ExposureSample& sample : samples)
        factors.push_back(largest_factor(sample, target, when_equal));
    const auto place =
        factors.begin() + static_cast<std::ptrdiff_t>(quantile_rank(factors.size())) - 1;
    std::nth_element(factors.begin(), place, factors.end(), std::greater<>());
    return *place;
}

} // namespace

double brightness(std::span<const ExposureSample> samples, double factor) {
    if (samples.empty())
        return 0;
    std::vector<double> values;
    values.reserve(samples.size());
    for (const ExposureSample& sample : samples)
        values.push_back(max_component(factor * sample.scaled + sample.fixed));
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(quantile_rank(values.size())) - 1;
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

std::optional<double> exposure_factor(std::span<const ExposureSample> samples, double target) {
    if (samples.empty())
        return std::nullopt;
    if (brightness(samples, 1) == target)
        return 1;

    // The brightness does not exceed the target up to the first of these factors and reaches it at
    // the second; they differ only where it equals the target for a while.
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double last = quantile_factor(samples, target, infinity);
    if (last > 0 && last < infinity)
        return last;
    const double first = quantile_factor(samples, target, -infinity);
    if (last > 0 && first > 0 && first < infinity)
        return first;
    return std::nullopt;
}

Exposure
expose(TracedScene& traced, const Camera& camera, double target, RenderStatistics& statistics) {
    const std::vector<ExposureSample> samples = exposure_samples(traced, camera, statistics);
    Exposure exposure;
    exposure.rays = samples.size();
    exposure.target = target;
    exposure.brightness = brightness(samples, 1);
    const auto too_bright = std::count_if(samples.begin(), samples.end(), [](const auto& sample) {
        return max_component(sample.scaled + sample.fixed) > 1;
    });
    if (!samples.empty())
        exposure.part_too_bright =
            static_cast<double>(too_bright) / static_cast<double>(samples.size());
    exposure.full_factor = exposure_factor(samples, 1);
    if (!(target > 0))
        return exposure;

    const std::optional<double> factor = exposure_factor(samples, target);
    exposure.reachable = factor.has_value();
    exposure.factor = factor.value_or(1);
    for (PointLight& light : traced.illumination.lights)
        light.intensity *= exposure.factor;
    traced.illumination.ambient = exposure.factor * traced.illumination.ambient;
    return exposure;
}

} // namespace vera
