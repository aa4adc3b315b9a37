// SPDX-License-Identifier: Apache-2.0
#include "embree_scene.h"

#include "vera/scene/crossings.h"

#include <span>
#include <stdexcept>

#include <fmt/format.h>

namespace vera {

namespace {

[[noreturn]] void fail(RTCDevice device, const char* what) {
    throw std::runtime_error(
        fmt::format("Embree {} (error {})", what, static_cast<int>(rtcGetDeviceError(device))));
}

std::uint32_t add_corner(EmbreeInput& input, Vec3 point) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        input.corners.push_back(static_cast<float>(point[axis]));
    return static_cast<std::uint32_t>(input.corners.size() / 3 - 1);
}

void add_fan(EmbreeInput& input, std::span<const Vec3> corners) {
    const std::uint32_t first = add_corner(input, corners[0]);
    for (std::size_t i = 1; i < corners.size(); ++i) {
        const std::uint32_t last = add_corner(input, corners[i]);
        if (i > 1)
            input.triangles.insert(input.triangles.end(), {first, last - 1, last});
    }
}

void add_mesh(EmbreeInput& input, const Mesh& mesh) {
    const auto first = static_cast<std::uint32_t>(input.corners.size() / 3);
    for (const Vec3& point : mesh.positions)
        add_corner(input, point);
    for (const std::uint32_t corner : mesh.position_indices)
        input.triangles.push_back(first + corner);
}

void add_item(EmbreeInput& input, const Geometry& geometry, const Item& item) {
    switch (item.kind) {
    case ItemKind::mesh:
        add_mesh(input, geometry.meshes[item.index]);
        return;
    case ItemKind::triangle:
        add_fan(input, geometry.triangles[item.index].corners);
        return;
    case ItemKind::patch:
        add_fan(input, geometry.patches[item.index].corners);
        return;
    case ItemKind::polygon: {
        const Polygon& polygon = geometry.polygons[item.index];
        if (polygon.shape == Polygon::Shape::simple)
            break;
        add_fan(input, corners_of(geometry, polygon));
        return;
    }
    case ItemKind::sphere: {
        const Sphere& sphere = geometry.spheres[item.index];
        for (const double number :
             {sphere.center.x, sphere.center.y, sphere.center.z, sphere.radius})
            input.spheres.push_back(static_cast<float>(number));
        return;
    }
    case ItemKind::rotational_shape:
    case ItemKind::subscene_call:
        break;
    }
    throw std::runtime_error("this scene holds what Embree is not asked about");
}

void attach(RTCScene scene, RTCGeometry geometry, RTCBuildQuality quality) {
    rtcSetGeometryBuildQuality(geometry, quality);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

} // namespace

const char* name_of(EmbreeQuality quality) {
    return quality == EmbreeQuality::medium ? "medium" : "high";
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

EmbreeInput embree_input(const Scene& scene) {
    EmbreeInput input;
    for (const Item& item : scene.geometry.items)
        add_item(input, scene.geometry, item);
    input.corners.push_back(0);
    return input;
}

EmbreeScene::EmbreeScene(
    EmbreeDevice& device, const EmbreeInput& input, const EmbreeSettings& settings)
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
            3 * sizeof(float),
            input.corners.size() / 3);
        share(
            geometry,
            RTC_BUFFER_TYPE_INDEX,
            RTC_FORMAT_UINT3,
            input.triangles.data(),
            3 * sizeof(std::uint32_t),
            input.triangles.size() / 3);
        attach(scene_, geometry, quality);
    }
    if (!input.spheres.empty()) {
        RTCGeometry geometry = rtcNewGeometry(device.handle(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
        share(
            geometry,
            RTC_BUFFER_TYPE_VERTEX,
            RTC_FORMAT_FLOAT4,
            input.spheres.data(),
            4 * sizeof(float),
            input.spheres.size() / 4);
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
