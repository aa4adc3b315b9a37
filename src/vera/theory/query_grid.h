// SPDX-License-Identifier: Apache-2.0
// Boxes and rays of a scene as rectangles and rays in whole numbers (VERA 3.3.1: rectangles "arise
// from the faces of the rectangular bounding boxes of arbitrary primitives"), so that none is lost.
//
// There are three classes of rectangles, across each of the axes, and rays go through them upwards
// or downwards: six sweeps. A ray enters a box through one face, unless it begins within, and it is
// told where it enters. What comes from rounding is made good by boxes that are larger:
//
// - A ray that is steep in a class, since it goes 28 times as far along another axis, has no place
//   there. Boxes are larger by a 26th of their longest side, all round: then a ray that meets the
//   box itself leaves the larger one backwards through a face in whose class it is not steep. For
//   it goes as far as that margin across a steep class's faces only where it goes 28 margins along
//   another axis, and that is as long as the larger box.
// - Boxes end at multiples of a step of 2^-12 of the scene's size: planes have whole numbers.
// - A ray has a whole slope and offset. It is right to half a unit, of 2^-25, where it begins, and
//   half a unit a step farther off. Rectangles are larger by what that can come to.
//
// Rays are right where they begin, so that those from one point cross nowhere else in whole numbers
// either.
#pragma once

#include "vera/math/box3.h"
#include "vera/math/ray.h"
#include "vera/theory/sloped_ray.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace vera {

/// One of the six sweeps.
struct SweepDirection {
    std::size_t axis = 0; ///< that the planes are across
    bool upwards = true;  ///< or down it: z is turned round
};

/// A box of whole numbers of steps.
struct StepBox {
    std::array<std::int32_t, 3> lower = {};
    std::array<std::int32_t, 3> upper = {};
};

class QueryGrid {
public:
    static constexpr std::int32_t steps = 1 << 12; ///< in half the scene's size
    static constexpr std::int32_t units_in_step = 1 << 13;
    static constexpr double steepest = 28;

    /// The largest number of a plane: boxes reach beyond the scene by a 26th of its size.
    static constexpr std::int32_t farthest_step = 35 << 7;

    /// The farthest origin of a ray, in halves of the scene's size, and the largest error of one,
    /// for which everything is right to well below a step.
    static constexpr double farthest_origin = 0x1p19;
    static constexpr double largest_origin_error = 0x1p-34;

    /// Of a scene with these bounds, not empty.
    explicit QueryGrid(const Box3& bounds);

    /// What grids can tell of the ray: it has a beginning, and what was said of origins holds.
    bool can_hold(const Ray& ray) const;

    /// The t at which to let a ray begin that goes on backwards: where it does, or, of one without
    /// an end there, behind all boxes.
    double beginning(const Ray& ray) const;

    /// How far from (0, 0, 0) origins may lie that it can hold, and how large their errors may be:
    /// in the scene's coordinates.
    double reach() const;

    double origin_error() const { return largest_origin_error / scale_; }

    /// The larger box; nothing where it and the slack are not much smaller than the scene is.
    std::optional<StepBox> larger_box(const Box3& box, double slack) const;

    /// In the scene's coordinates.
    Box3 scene_box(const StepBox& box) const;

    /// The face through which a ray of that direction enters.
    IsoRectangle entry(const StepBox& box, SweepDirection direction) const;

    /// Nothing where the ray goes another way, is steep, or passes all boxes.
    std::optional<SlopedRay> sloped_ray(const Ray& ray, SweepDirection direction) const;

    /// The last plane that the ray comes to up to that t.
    std::int32_t last_step(const Ray& ray, double t, SweepDirection direction) const;

private:
    /// Of a point of the scene, in steps.
    double step_at(Vec3 point, std::size_t axis) const {
        return steps * (scale_ * (point[axis] - center_[axis]));
    }

    Vec3 center_;
    double scale_ = 1; ///< a power of two: the bounds become at most 2 long
};

} // namespace vera
