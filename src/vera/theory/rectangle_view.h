// SPDX-License-Identifier: Apache-2.0
// What is seen along the z axis of rectangles across it, in steps that go with what is seen:
// O((n + v) log^2 n) for n rectangles and v corners of what is seen of them, where a plane sweep
// takes O((n + k) log n) for k crossings, of hidden sides as well. Beyond the VERA paper: the bound
// is that of Güting and Ottmann (New algorithms for special cases of the hidden line elimination
// problem, 1987); Bern (Hidden surface removal for rectangles, 1990) has a better one.
//
// Rectangles come from the nearest to the farthest. What those before one of them cover together is
// known by its border: what of this lies in the rectangle, and what of its own sides lies outside,
// is the border of what is seen of it. All of that belongs to the map of what is seen, and what of
// the border a rectangle has covered is no border any more: each part comes once and goes once.
// Where no border lies in a rectangle it is hidden, or seen as a whole, which one cell tells.
#pragma once

#include "vera/base/parallel.h"
#include "vera/theory/iso_rectangle.h"
#include "vera/theory/window_tree.h"
#include "vera/visible/screen_scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// What is seen of each rectangle.
struct RectangleView {
    /// A closed way along which what is seen of the rectangle lies on the left, if y grows upward:
    /// round a part of it, or, to the right, round a hole in it. It turns at each of its corners,
    /// corners[first] to corners[first + count]; the first has the smallest x, and then y. Parts
    /// that meet in a corner only are apart.
    struct Ring {
        std::uint32_t rectangle = 0;
        std::size_t first = 0;
        std::size_t count = 0;
    };

    std::vector<Ring> rings; ///< by rectangle, then by first corner
    std::vector<PlanePoint> corners;

    std::span<const PlanePoint> corners_of(const Ring& ring) const {
        return std::span(corners).subspan(ring.first, ring.count);
    }
};

/// The view along z from far away at small z: the smaller z is in front, and of several rectangles
/// in one plane the one that comes first in the list. Of each is seen what
/// brute_force_first_rectangle() tells of rays along z that pass beside all sides, with its border.
/// One without an area is not seen, and hides nothing. The steps are added to the counts. Throws
/// std::invalid_argument as require_rectangles() does, std::runtime_error where memory would not
/// suffice, and Cancelled.
RectangleView rectangle_view(
    std::span<const IsoRectangle> rectangles,
    WindowCounts* counts = nullptr,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// The same rectangles for plane_sweep() and cell_raster(): two triangles each, whose source is the
/// number of the rectangle. Throws std::invalid_argument where corners lie outside the grid, which
/// is 0 to screen_size each way.
ScreenScene screen_scene(std::span<const IsoRectangle> rectangles);

} // namespace vera
