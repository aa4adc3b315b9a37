// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/seen_parts.h"

#include <cstddef>
#include <vector>

namespace vera {

/// Parts to which further ones are added behind the others. Joins them in their order whenever they
/// have many pieces: half of the points of small ones are points of others as well.
class GrowingParts {
public:
    explicit GrowingParts(PieceStorage storage)
        : storage_(storage) {}

    std::vector<SeenPart> parts;

    /// Takes out those from that one on, as one list.
    VisiblePieces take_from(std::size_t first);

    void add(VisiblePieces list);

    /// When there are further ones.
    void join();

private:
    PieceStorage storage_;
    std::size_t first_ = 0; ///< of those that are not joined
};

} // namespace vera
