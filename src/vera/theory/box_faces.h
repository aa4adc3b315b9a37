// SPDX-License-Identifier: Apache-2.0
// The first face of boxes that a ray meets: what bounding boxes of a scene ask of rectangles (VERA
// 3.3.1). The faces across each axis are rectangles across z once the axes are turned, and have
// nested trees of their own (proposition 1); of the three faces that these find, the nearest is the
// first of all.
#pragma once

#include "vera/theory/nested_trees.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vera {

/// The points between two corners. It may be flat.
struct WholeBox {
    std::array<std::int32_t, 3> lower = {};
    std::array<std::int32_t, 3> upper = {};
};

struct FaceOfBox {
    std::uint32_t box = 0;
    std::uint8_t axis = 0; ///< that it stands across
    bool is_upper = false;

    friend bool operator==(const FaceOfBox&, const FaceOfBox&) = default;
};

class BoxFaces {
public:
    /// Throws as NestedTrees does.
    explicit BoxFaces(
        std::span<const WholeBox> boxes,
        std::optional<std::size_t> few = {},
        const CancelFlag* cancel = nullptr);

    /// As brute_force_first_face(), and throws likewise.
    std::optional<FaceOfBox> first_face(const WholeRay& ray, StepCounts* counts = nullptr) const;

private:
    std::vector<NestedTrees> trees_; ///< of the faces across each axis: 2 box, and 2 box + 1
};

/// The reference: of all faces that the ray meets, the nearest; of several at one place that of the
/// smallest box, then axis, then the lower one. A ray along a face meets it where it meets the
/// border of a face beside it. Looks at each. Throws std::invalid_argument where the direction is
/// nothing, or a number is too large.
std::optional<FaceOfBox>
brute_force_first_face(std::span<const WholeBox> boxes, const WholeRay& ray);

} // namespace vera
