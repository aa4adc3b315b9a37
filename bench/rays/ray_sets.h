// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/scene/scene.h"
#include "vera/scene/surface.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace vera {

/// What is asked of each ray: the first face that it meets, or whether it meets any.
enum class Question { nearest, any };

/// Whether neighbours among the rays go nearly the same way.
enum class Coherence { coherent, incoherent };

/// A ray as Embree is asked about it. It starts a little beside the face, on the side that it goes
/// to, since Embree knows of no face that a ray starts from.
struct FloatRay {
    std::array<float, 3> origin;
    std::array<float, 3> direction;
    float t_max;
};

/// Rays of one kind, as either side is asked about them: ray i is the same one in both.
struct RaySet {
    std::string name;
    Question question = Question::nearest;
    Coherence coherence = Coherence::incoherent;
    std::vector<QueryRay> queries;
    std::vector<FloatRay> floats;
};

/// The kinds of rays, by name:
/// - primary: from the view point through the picture, in tiles of 32 x 32, within them in squares
///   of 4 x 4: sixteen that follow each other are a square, eight are half of one
/// - shadow: from what those hit to the first light, where it stands on the viewer's side
/// - diffuse: one from each hit, distributed by the cosine to the normal, in the picture's order
/// - shuffled: the same in no order
/// - ao: the same as diffuse, asked whether they meet anything
/// - mirror: from each hit, mirrored at a normal that waves slightly
const std::vector<std::string>& ray_set_names();

/// What the secondary rays start from: the primary rays and what they hit.
struct PrimaryHits {
    RaySet rays;
    std::vector<std::size_t> hitting;   ///< the numbers of the rays that hit something
    std::vector<SurfacePoint> surfaces; ///< where each of those does
    double beside = 0;                  ///< how far from there FloatRays start
};

/// How far beside a face FloatRays start, by the size of its coordinates: some roundings.
constexpr double usually_beside = 0x1p-20;

/// raster x raster rays; the raster is a multiple of 32.
PrimaryHits primary_hits(
    const Scene& scene, const RayIndex& index, std::size_t raster, double beside = usually_beside);

/// The rays of that name, which is one of ray_set_names().
RaySet ray_set(const std::string& name, const Scene& scene, const PrimaryHits& hits);

} // namespace vera
