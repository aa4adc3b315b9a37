// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/drawing/drawing.h"
#include "vera/math/vec3.h"
#include "vera/render/ray_tree.h"
#include "vera/scene/camera.h"
#include "vera/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// A ray of a ray tree as it is drawn: what is endless or very long ends early.
struct RayLine {
    enum class Kind : std::uint8_t {
        view,
        mirrored,
        refracted,
        lit,      ///< to a light, nothing between
        filtered, ///< to a light, through glass alone
        shadowed  ///< towards a light, up to what keeps the light away
    };

    Kind kind = Kind::view;
    Vec3 from;
    Vec3 to;
    std::size_t node = 0;  ///< that it belongs to
    std::size_t light = 0; ///< of rays to lights
    bool goes_on = false;  ///< it ends early
};

std::vector<RayLine> ray_lines(const RayTree& tree, const Scene& scene);

/// Somebody who looks at a ray tree from aside: in parallel, upright, from where the most of its
/// places are seen, the surfaces there are not edge-on and the rays are least foreshortened, of
/// some directions all round.
struct RayView {
    Camera camera;
    Vec3 right;            ///< unit, of the picture
    Vec3 up;               ///< unit, of the picture
    double left = 0;       ///< of the picture, along right
    double top = 0;        ///< of the picture, along up
    double scale = 1;      ///< pixels to a unit of the scene
    bool sees_all = false; ///< no place of the tree lies behind anything

    DrawingPoint on_picture(Vec3 point) const {
        return {scale * (dot(point, right) - left), scale * (top - dot(point, up))};
    }
};

RayView ray_view(
    const RayTree& tree,
    const std::vector<RayLine>& lines,
    const RayIndex& index,
    std::uint32_t width,
    std::uint32_t height);

} // namespace vera
