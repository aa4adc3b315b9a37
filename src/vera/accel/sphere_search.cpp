// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/ray_order.h"
#include "vera/accel/sphere_tree.h"

#include <algorithm>
#include <cstdint>
#include <span>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/accel/sphere_search.cpp"
#include <hwy/foreach_target.h>
// Behind the line above, which includes this file once for each instruction set.
#include "vera/accel/float_search-inl.h"
#include "vera/accel/sphere_hits-inl.h"
#include "vera/accel/sphere_leaves-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

void search_nearest_kernel(
    const SphereTree& tree,
    std::span<const IndexRay> rays,
    std::span<SphereHit> hits,
    SearchCounts& counts) {
    search_nearest_in(tree, rays, hits, counts);
}

void search_any_kernel(
    const SphereTree& tree,
    std::span<const IndexRay> rays,
    std::span<std::uint8_t> met,
    SearchCounts& counts) {
    search_any_in(tree, rays, met, counts);
}

void search_nearest_alone_kernel(const SphereTree& tree, const IndexRay& ray, SphereHit& hit) {
    search_nearest_alone_in(tree, ray, hit);
}

bool search_any_alone_kernel(const SphereTree& tree, const IndexRay& ray) {
    return search_any_alone_in(tree, ray);
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera::detail {

HWY_EXPORT(search_nearest_kernel);
HWY_EXPORT(search_any_kernel);
HWY_EXPORT(search_nearest_alone_kernel);
HWY_EXPORT(search_any_alone_kernel);

void search_nearest(
    const SphereTree& tree,
    std::span<const IndexRay> rays,
    std::span<SphereHit> hits,
    SearchCounts& counts) {
    if (tree.nodes.empty()) {
        std::fill(hits.begin(), hits.end(), SphereHit{});
        return;
    }
    search_in_order(rays, hits, [&](auto some_rays, auto some_hits) {
        HWY_DYNAMIC_DISPATCH(search_nearest_kernel)(tree, some_rays, some_hits, counts);
    });
}

void search_any(
    const SphereTree& tree,
    std::span<const IndexRay> rays,
    std::span<std::uint8_t> met,
    SearchCounts& counts) {
    if (tree.nodes.empty()) {
        std::fill(met.begin(), met.end(), std::uint8_t{0});
        return;
    }
    search_in_order(rays, met, [&](auto some_rays, auto some_met) {
        HWY_DYNAMIC_DISPATCH(search_any_kernel)(tree, some_rays, some_met, counts);
    });
}

void search_nearest_alone(const SphereTree& tree, const IndexRay& ray, SphereHit& hit) {
    if (tree.nodes.empty())
        hit = {};
    else
        HWY_DYNAMIC_DISPATCH(search_nearest_alone_kernel)(tree, ray, hit);
}

bool search_any_alone(const SphereTree& tree, const IndexRay& ray) {
    return !tree.nodes.empty() && HWY_DYNAMIC_DISPATCH(search_any_alone_kernel)(tree, ray);
}

} // namespace vera::detail

#endif
