// SPDX-License-Identifier: Apache-2.0
#include "vera/render/center_rays.h"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/render/center_rays.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// normalized() of each of count vectors a and one more, which is added to it; count is a multiple
/// of 8. The same operations in the same order.
void unit_sums_kernel(
    const std::array<const double*, 3>& a,
    Vec3 added,
    std::size_t count,
    const std::array<double*, 3>& units) {
    const hn::CappedTag<double, 8> d;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const auto x = hn::Add(hn::LoadU(d, a[0] + i), hn::Set(d, added.x));
        const auto y = hn::Add(hn::LoadU(d, a[1] + i), hn::Set(d, added.y));
        const auto z = hn::Add(hn::LoadU(d, a[2] + i), hn::Set(d, added.z));
        const auto largest = hn::Max(hn::Max(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
        const auto norm = hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z)));
        hn::StoreU(hn::Div(x, norm), d, units[0] + i);
        hn::StoreU(hn::Div(y, norm), d, units[1] + i);
        hn::StoreU(hn::Div(z, norm), d, units[2] + i);
        // Otherwise length() does not take the root of the squares' sum as it is.
        const auto is_usual =
            hn::And(hn::Gt(largest, hn::Set(d, 1e-140)), hn::Lt(largest, hn::Set(d, 1e140)));
        if (hn::AllTrue(d, is_usual))
            continue;
        for (std::size_t j = i; j < i + hn::Lanes(d); ++j) {
            const Vec3 unit = normalized(Vec3{a[0][j], a[1][j], a[2][j]} + added);
            for (std::size_t axis = 0; axis < 3; ++axis)
                units[axis][j] = unit[axis];
        }
    }
}

} // namespace vera::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera {

HWY_EXPORT(unit_sums_kernel);

void CenterRays::find(
    const Raster& raster, const Tile& tile, std::vector<QueryRay>& rays, std::size_t frame_width) {
    // Counted from the frame's corner, as what lies outside the picture has no pixel's number.
    const Tile framed = {0, 0, tile.width + 2 * frame_width, tile.height + 2 * frame_width};
    rays.resize(framed.width * framed.height);
    const auto frame = static_cast<double>(frame_width);
    const auto across = [&](std::size_t x) {
        return raster.rays.place_across(raster.across(static_cast<double>(tile.x + x) - frame));
    };
    const auto up = [&](std::size_t y) {
        return raster.rays.place_up(raster.down(static_cast<double>(tile.y + y) - frame));
    };
    QueryRay* query = rays.data();
    if (raster.rays.projection == Camera::Projection::parallel) {
        for_each_pixel(framed, [&](std::size_t x, std::size_t y) {
            (query++)->ray = raster.rays.ray(across(x), up(y));
        });
        return;
    }

    constexpr std::size_t step = 8;
    const std::size_t stride = (framed.width + step - 1) / step * step;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        columns_[axis].resize(stride);
        directions_[axis].resize(stride * framed.height);
    }
    for (std::size_t x = 0; x < stride; ++x) {
        const Vec3 place = across(x);
        for (std::size_t axis = 0; axis < 3; ++axis)
            columns_[axis][x] = place[axis];
    }
    const std::array<const double*, 3> columns = {
        columns_[0].data(), columns_[1].data(), columns_[2].data()};
    for (std::size_t y = 0; y < framed.height; ++y)
        HWY_DYNAMIC_DISPATCH(unit_sums_kernel)
    (columns,
     up(y),
     stride,
     {directions_[0].data() + y * stride,
      directions_[1].data() + y * stride,
      directions_[2].data() + y * stride});
    for_each_pixel(framed, [&](std::size_t x, std::size_t y) {
        const std::size_t place = y * stride + x;
        query->ray.origin = raster.rays.origin_or_direction;
        query->ray.direction = {
            directions_[0][place], directions_[1][place], directions_[2][place]};
        ++query;
    });
}

} // namespace vera

#endif
