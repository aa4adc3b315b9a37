// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/word_reader.h"
#include "vera/math/transform.h"
#include "vera/scene/camera.h"
#include "vera/scene/light.h"
#include "vera/scene/material.h"
#include "vera/scene/primitives.h"

#include <array>
#include <optional>
#include <vector>

namespace vera {

// The statements of the scene language that stand for themselves. Each is called when its keyword
// has been taken, and returns nothing, and has complained, when the statement cannot be used.

/// SP center radius
std::optional<Sphere> read_sphere(WordReader& words);

/// P3 p1 p2 p3
std::optional<Triangle> read_triangle(WordReader& words);

/// P4 p1 p2 p3 p4: the corners alone
std::optional<std::array<Vec3, 4>> read_quadrangle(WordReader& words);

/// PN n p1 ... pn: the corners alone
std::optional<std::vector<Vec3>> read_polygon(WordReader& words);

/// PA p1 p2 p3 n1 n2 n3
std::optional<Patch> read_patch(WordReader& words);

/// RS | RK base P tip | V direction, then a contour; as many shapes as the contour has parts
std::optional<std::vector<RotationalShape>> read_rotational_shapes(WordReader& words);

/// PROJECTION viewpoint lower-left lower-right upper-left
std::optional<Camera> read_projection(WordReader& words);

/// PARALLEL direction lower-left lower-right upper-left
std::optional<Camera> read_parallel(WordReader& words);

/// LI point intensity r g b
std::optional<PointLight> read_light(WordReader& words);

/// {DRF r g b | ARF r g b | SDI r g b | SAN r g b | RAB r g b | TAB r g b | SPC x | REF x}
bool read_properties(WordReader& words, Material& material);

/// A map and its inverse.
struct Placement {
    bool moves = false; ///< whether any transformation was written
    Affine3 to_parent;
    Affine3 from_parent;
};

/// {MX m11..m34 | RT ax ay az | TR x y z | SC f}, applied in the order in which they are written.
std::optional<Placement> read_transformations(WordReader& words);

} // namespace vera
