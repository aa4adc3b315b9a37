// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/mesh_index.h"
#include "vera/accel/sphere_index.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <ios>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace vera::testing {

inline std::string told(const MeshHit& hit) {
    std::ostringstream text;
    text << std::hexfloat << hit.t << " of " << hit.triangle << " at " << hit.u << " " << hit.v;
    return text.str();
}

inline std::string told(const SphereHit& hit) {
    std::ostringstream text;
    text << std::hexfloat << hit.t << " of " << hit.sphere;
    return text.str();
}

inline std::string told(const IndexRay& ray) {
    std::ostringstream text;
    text << std::hexfloat << "origin";
    for (const float x : ray.origin)
        text << " " << x;
    text << " direction";
    for (const float x : ray.direction)
        text << " " << x;
    text << " from " << ray.t_min << " to " << ray.t_max;
    return text.str();
}

template <typename Hit>
bool same_bits(const Hit& a, const Hit& b) {
    using Bits = std::array<std::uint32_t, sizeof(Hit) / sizeof(std::uint32_t)>;
    return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

template <typename Hit>
bool same_bits(const std::vector<Hit>& a, const std::vector<Hit>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Hit& x, const Hit& y) {
        return same_bits(x, y);
    });
}

template <typename Index, typename Answer>
void expect_answers_one_by_one(
    const Index& index,
    const std::vector<IndexRay>& rays,
    const std::vector<Answer>& expected,
    const std::string& what) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto nearest = index.nearest_hit(rays[i]);
        ASSERT_TRUE(same_bits(nearest, expected[i].nearest))
            << what << ", ray " << i << ": found " << told(nearest) << ", expected "
            << told(expected[i].nearest) << "\n"
            << told(rays[i]);
        const auto all = index.all_hits(rays[i]);
        ASSERT_TRUE(same_bits(all, expected[i].all))
            << what << ", ray " << i << ": found " << all.size() << " hits, expected "
            << expected[i].all.size() << "\n"
            << told(rays[i]);
    }
    // By themselves: how a ray is followed depends on the one that was asked about before.
    for (std::size_t i = 0; i < rays.size(); ++i)
        ASSERT_EQ(index.meets_any(rays[i]), expected[i].met) << what << ", ray " << i << "\n"
                                                             << told(rays[i]);
}

template <typename Index, typename Answer>
void expect_answers_by_spans(
    const Index& index,
    const std::vector<IndexRay>& rays,
    const std::vector<Answer>& expected,
    std::size_t span_size,
    const std::string& what) {
    std::vector<decltype(Answer::nearest)> hits(rays.size());
    std::vector<std::uint8_t> met(rays.size(), 7);
    for (std::size_t first = 0; first < rays.size(); first += span_size) {
        const std::size_t count = std::min(span_size, rays.size() - first);
        const auto some_rays = std::span(rays).subspan(first, count);
        index.nearest_hits(some_rays, std::span(hits).subspan(first, count));
        index.meet_any(some_rays, std::span(met).subspan(first, count));
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(same_bits(hits[i], expected[i].nearest))
            << what << ", ray " << i << " in spans of " << span_size << ": found " << told(hits[i])
            << ", expected " << told(expected[i].nearest) << "\n"
            << told(rays[i]);
        ASSERT_EQ(met[i], expected[i].met ? 1 : 0)
            << what << ", ray " << i << " in spans of " << span_size << "\n"
            << told(rays[i]);
    }
}

/// Asks a MeshIndex or a SphereIndex in every way there is.
template <typename Index, typename Answer>
void expect_answers(
    const Index& index,
    const std::vector<IndexRay>& rays,
    const std::vector<Answer>& expected,
    const std::string& what) {
    expect_answers_one_by_one(index, rays, expected, what);
    for (const std::size_t span_size : {1U, 15U, 16U, 17U, 33U, 257U, 1000U}) {
        if (::testing::Test::HasFailure())
            return;
        expect_answers_by_spans(index, rays, expected, span_size, what);
    }
}

} // namespace vera::testing
