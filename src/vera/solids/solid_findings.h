// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/diagnostic.h"
#include "vera/base/parallel.h"
#include "vera/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vera {

/// Something about the solids that faces make, found by exact tests of their coordinates.
struct SolidFinding {
    enum class Kind : std::uint8_t {
        duplicate,         ///< the item is the same as an earlier one
        wrong_inner_point, ///< of a face of a closed solid: the inner point is not on its inner
                           ///< side
        turned_face,       ///< of a closed solid without inner point: its normal points inwards
        turned_solid,      ///< the same, of all its faces or of triangles of a mesh
        open,              ///< edges of what looks like a solid have no partner
        crossing,          ///< the item and the other pass through each other
        covering           ///< they lie in one plane, and have an area in common
    };

    Kind kind = Kind::duplicate;
    Severity severity = Severity::note; ///< a warning or a note: a picture can be made of all
    std::size_t subscene = 0;           ///< 0: the main scene; else number subscene - 1
    std::uint32_t item = 0;
    /// Of a mesh the first of its triangles that this is about, counted from 0.
    std::optional<std::uint32_t> triangle = {};
    std::optional<std::uint32_t> other = {}; ///< an item of the same geometry
    std::string problem = {};
    std::string remedy = {};

    const Geometry& geometry(const Scene& scene) const {
        return subscene == 0 ? scene.geometry : scene.subscenes[subscene - 1];
    }
};

/// A word for the kind, in the plural.
const char* name_of(SolidFinding::Kind kind);

/// What is doubtful about the solids of each geometry, by itself: where subscenes meet one another
/// is not looked at, nor are shapes of revolution but for those that stand in the text twice.
/// Spheres cross each other and faces where they do so by more than touching_part. Of one geometry
/// in the order of the kinds, then of the text. Takes about n log n for n faces that spread over
/// space; looks at a million pairs that cross or cover, at most. Throws Cancelled.
std::vector<SolidFinding> solid_findings(
    const Scene& scene, const Progress& progress = {}, const CancelFlag* cancel = nullptr);

} // namespace vera
