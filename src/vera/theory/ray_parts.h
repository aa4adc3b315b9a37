// SPDX-License-Identifier: Apache-2.0
// Rays divided into parts that are answered by themselves, on all threads. Each part has the rays
// of a node of a conjugation tree of their points (a, b), and is asked for the rectangles that the
// hull of these points leaves. How many parts there are depends on the rays, and never on the
// threads: so counts do not, either.
#pragma once

#include "vera/theory/moving_plane.h"
#include "vera/theory/partition_tree.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace vera {

/// Called for a part, from many threads: with the numbers of its rays, and of the rectangles that
/// it may meet, ascending.
using AnswerPart = std::function<void(
    std::span<const std::uint32_t> rays, const std::vector<std::uint32_t>& rectangles)>;

/// Of at most `most` rays each, but for equal points that stay together. Throws Cancelled.
void for_each_part(
    std::size_t most,
    EqualPoints equal,
    std::span<const IsoRectangle> rectangles,
    const SweptRays& swept,
    const AnswerPart& answer,
    const Progress& progress,
    const CancelFlag* cancel);

/// How many rays a part has at most where there are 2^level parts.
std::size_t part_size(std::size_t rays, std::size_t level);

/// The level that keeps some threads at work with parts that are large enough: up to 3.
std::size_t usual_parts_level(std::size_t rays);

/// How many parts are answered at once.
std::size_t parts_at_work(std::size_t level);

/// What for_each_part() takes of memory, in bytes, at most; without what answers take.
double parts_bytes_forecast(std::size_t level, std::size_t rectangles, std::size_t rays);

/// The rays and rectangles of a part, with numbers of their own. What it was made of must outlive
/// it.
class RayPart {
public:
    RayPart(
        std::span<const IsoRectangle> rectangles,
        const SweptRays& swept,
        std::span<const std::uint32_t> rays,
        std::span<const std::uint32_t> asked);

    std::span<const IsoRectangle> rectangles() const { return rectangles_; }

    SweptRays swept() const { return {rays_, last_z_}; }

    /// The same by the part's numbers. It must outlive what is returned, and so must the part.
    Meeting meeting(const Meeting& of_all) const;

    /// What it takes of memory for each.
    static constexpr std::size_t bytes_per_ray = sizeof(SlopedRay) + sizeof(std::int32_t);
    static constexpr std::size_t bytes_per_rectangle = sizeof(IsoRectangle);

private:
    std::span<const std::uint32_t> ray_numbers_;
    std::span<const std::uint32_t> rectangle_numbers_;
    std::vector<SlopedRay> rays_;
    std::vector<std::int32_t> last_z_;
    std::vector<IsoRectangle> rectangles_;
};

} // namespace vera
