// SPDX-License-Identifier: Apache-2.0
#include "embree_scene.h"

#include <stdexcept>

#include <fmt/format.h>

namespace vera {

namespace {

[[noreturn]] void fail(RTCDevice device, const char* what) {
    throw std::runtime_error(
        fmt::format("Embree {} (error {})", what, static_cast<int>(rtcGetDeviceError(device))));
}

void attach(RTCScene scene, RTCGeometry geometry, RTCBuildQuality quality) {
    rtcSetGeometryBuildQuality(geometry, quality);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

} // namespace

std::string name_of(const EmbreeSettings& settings) {
    return fmt::format(
        "Embree {}{}",
        settings.quality == EmbreeQuality::medium ? "medium" : "high",
        settings.edges == EmbreeEdges::robust ? " robust" : "");
}

EmbreeDevice::EmbreeDevice(std::size_t threads, const std::string& settings)
    : device_(rtcNewDevice(fmt::format("threads={},{}", threads, settings).c_str())) {
    if (device_ == nullptr)
        fail(nullptr, "does not start");
    rtcSetDeviceMemoryMonitorFunction(
        device_,
        [](void* bytes, ssize_t more, bool) {
            *static_cast<std::atomic<std::int64_t>*>(bytes) += more;
            return true;
        },
        &bytes_);
}

EmbreeDevice::~EmbreeDevice() {
    rtcReleaseDevice(device_);
}

EmbreeScene::EmbreeScene(
    EmbreeDevice& device, const FloatGeometry& input, const EmbreeSettings& settings)
    : scene_(rtcNewScene(device.handle())) {
    const std::int64_t before = device.bytes();
    const RTCBuildQuality quality = settings.quality == EmbreeQuality::medium
        ? RTC_BUILD_QUALITY_MEDIUM
        : RTC_BUILD_QUALITY_HIGH;
    rtcSetSceneBuildQuality(scene_, quality);
    if (settings.edges == EmbreeEdges::robust)
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    const auto share = [](RTCGeometry geometry,
                          RTCBufferType type,
                          RTCFormat format,
                          const void* data,
                          std::size_t stride,
                          std::size_t count) {
        rtcSetSharedGeometryBuffer(geometry, type, 0, format, data, 0, stride, count);
    };
    if (!input.triangles.empty()) {
        RTCGeometry geometry = rtcNewGeometry(device.handle(), RTC_GEOMETRY_TYPE_TRIANGLE);
        share(
            geometry,
            RTC_BUFFER_TYPE_VERTEX,
            RTC_FORMAT_FLOAT3,
            input.corners.data(),
            sizeof input.corners.front(),
            input.corners.size() - 1);
        share(
            geometry,
            RTC_BUFFER_TYPE_INDEX,
            RTC_FORMAT_UINT3,
            input.triangles.data(),
            sizeof input.triangles.front(),
            input.triangles.size());
        attach(scene_, geometry, quality);
    }
    if (!input.spheres.empty()) {
        RTCGeometry geometry = rtcNewGeometry(device.handle(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
        share(
            geometry,
            RTC_BUFFER_TYPE_VERTEX,
            RTC_FORMAT_FLOAT4,
            input.spheres.data(),
            sizeof input.spheres.front(),
            input.spheres.size());
        attach(scene_, geometry, quality);
    }
    rtcCommitScene(scene_);
    if (rtcGetDeviceError(device.handle()) != RTC_ERROR_NONE) {
        rtcReleaseScene(scene_);
        throw std::runtime_error("Embree does not build its scene");
    }
    memory_ = device.bytes() - before;
}

EmbreeScene::~EmbreeScene() {
    rtcReleaseScene(scene_);
}

} // namespace vera
