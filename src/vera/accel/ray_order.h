// SPDX-License-Identifier: Apache-2.0
// Rays in no order are put in one before they are searched for: those of one octant that start in
// the same cell of a grid follow each other, cells along a Z curve (Morton 1966). What comes to the
// same nodes is then side by side in a stream, see float_search-inl.h. Answers do not depend on it.
#pragma once

#include "vera/accel/index_ray.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera::detail {

/// Of fewer rays, an order takes longer than it saves; more are put in order part by part, as
/// copies of them are to stay near the processor.
constexpr std::size_t least_ordered = 2048;
constexpr std::size_t most_ordered = 8192;

/// Whether most rays start far from the one before, as far as some of them tell.
bool start_apart(std::span<const IndexRay> rays);

/// The numbers of the rays, at most most_ordered, in this order. Rays with numbers that are none
/// may be anywhere.
void order_rays(std::span<const IndexRay> rays, std::vector<std::uint32_t>& numbers);

/// Lets search(rays, answers) answer about the rays, in parts and in an order that it is fast in.
template <typename Answer, typename Search>
void search_in_order(
    std::span<const IndexRay> rays, std::span<Answer> answers, const Search& search) {
    if (rays.size() < least_ordered || !start_apart(rays)) {
        search(rays, answers);
        return;
    }
    thread_local std::vector<std::uint32_t> numbers;
    thread_local std::vector<IndexRay> ordered;
    thread_local std::vector<Answer> found;
    for (std::size_t first = 0; first < rays.size(); first += most_ordered) {
        const auto some = rays.subspan(first, std::min(most_ordered, rays.size() - first));
        order_rays(some, numbers);
        ordered.resize(some.size());
        found.resize(some.size());
        for (std::size_t i = 0; i < some.size(); ++i)
            ordered[i] = some[numbers[i]];
        search(std::span<const IndexRay>(ordered), std::span<Answer>(found));
        for (std::size_t i = 0; i < some.size(); ++i)
            answers[first + numbers[i]] = found[i];
    }
}

} // namespace vera::detail
