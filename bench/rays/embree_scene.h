// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include "float_geometry.h"
#include <embree3/rtcore.h>

namespace vera {

/// How much time Embree spends on building.
enum class EmbreeQuality { medium, high };

/// Whether Embree looks that no ray slips through an edge (its robust flag).
enum class EmbreeEdges { fast, robust };

struct EmbreeSettings {
    EmbreeQuality quality = EmbreeQuality::medium;
    EmbreeEdges edges = EmbreeEdges::fast;

    friend bool operator==(const EmbreeSettings&, const EmbreeSettings&) = default;
};

/// As in "Embree high robust".
std::string name_of(const EmbreeSettings& settings);

/// Embree's library, with so many threads.
class EmbreeDevice {
public:
    /// Settings are what rtcNewDevice takes beside the threads: "isa=avx2" for one. Throws
    /// std::runtime_error where Embree does not start.
    EmbreeDevice(std::size_t threads, const std::string& settings);
    ~EmbreeDevice();
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;

    RTCDevice handle() const { return device_; }

    /// Bytes that Embree holds now.
    std::int64_t bytes() const { return bytes_; }

private:
    RTCDevice device_;
    std::atomic<std::int64_t> bytes_ = 0;
};

/// What Embree finds rays' hits with.
class EmbreeScene {
public:
    /// Builds; device and input must outlive the scene.
    EmbreeScene(EmbreeDevice& device, const FloatGeometry& input, const EmbreeSettings& settings);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    RTCScene handle() const { return scene_; }

    /// Bytes that the building left, beside the input.
    std::int64_t memory() const { return memory_; }

private:
    RTCScene scene_;
    std::int64_t memory_ = 0;
};

} // namespace vera
