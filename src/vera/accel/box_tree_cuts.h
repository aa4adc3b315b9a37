// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/box_tree.h"
#include "vera/accel/box_tree_bins.h"

#include <cstddef>
#include <optional>
#include <span>
#include <utility>

namespace vera::detail {

/// References [first, last), and what holds their boxes and the doubled middles of these.
struct ReferenceRange {
    std::size_t first = 0;
    std::size_t last = 0;
    RegisterBox box = empty_box;
    RegisterBox middles = empty_box;

    std::size_t size() const { return last - first; }
};

/// The range of references [first, last).
ReferenceRange
range_of(std::span<const BoxReference> references, std::size_t first, std::size_t last);

using Halves = std::pair<ReferenceRange, ReferenceRange>;

/// Cuts a range of the references where lines have the least to do with the halves, weighed by
/// their surfaces (MacDonald and Booth 1990; in bins, Wald 2007): reorders it so that those of each
/// half, which is not empty, follow each other. Nothing where no cut tells any of them apart; their
/// order is then what it was.
std::optional<Halves>
halves_by_surface(std::span<BoxReference> references, const ReferenceRange& range);

} // namespace vera::detail
