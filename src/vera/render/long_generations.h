// SPDX-License-Identifier: Apache-2.0
// How the places of a generation lie in blocks, and how threads share a long one: within
// GenerationTracer.
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/base/parallel.h"
#include "vera/render/generation_size.h"
#include "vera/shade/place_blocks.h"

#include <cstddef>
#include <functional>

namespace vera::detail {

/// Of the block that holds the place, and its lane there.
constexpr std::size_t block_of(std::size_t place) {
    return place / block_size;
}

constexpr std::size_t lane_of(std::size_t place) {
    return place % block_size;
}

constexpr BlockLanes lane_bit(std::size_t lane) {
    return BlockLanes{1} << lane;
}

/// Calls turn(first, last) for ranges that together cover [0, count). Generations of the usual size
/// stay with the thread that traces them; all threads share a long one.
template <typename Turn>
void for_each_range(std::size_t count, std::size_t grain, const Turn& turn) {
    if (count <= grain)
        turn(std::size_t{0}, count);
    else
        parallel_ranges(count, grain, std::cref(turn));
}

constexpr std::size_t rays_of_range = 4 * usual_generation_size;
constexpr std::size_t blocks_of_range = rays_of_range / block_size;

/// Lets the ray, of which the rest is at its default, start from a place on that face.
inline void
set_ray(QueryRay& query, const PlaceBlock& block, std::size_t lane, FaceId face, Vec3 direction) {
    query.ray.origin = vector_at(block.point, lane);
    query.ray.direction = direction;
    query.ray.origin_error = block.point_error[lane];
    query.start = face;
}

} // namespace vera::detail
