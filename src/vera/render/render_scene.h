// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/base/parallel.h"
#include "vera/image/image.h"
#include "vera/render/exposure.h"
#include "vera/render/generation_size.h"
#include "vera/render/statistics.h"
#include "vera/scene/camera.h"
#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"

#include <optional>

namespace vera {

/// A picture and what its making tells.
struct RenderResult {
    Image image;
    RenderStatistics statistics;
    std::optional<Exposure> exposure; ///< when EXPMES was asked for
};

/// The ray traced picture of the scene. The same bits for any number of threads and any index.
/// Beside the picture, memory does not grow with it but for a byte a pixel of anti-aliasing.
/// Throws Cancelled soon after the flag is raised. With a generation size of whole_generations all
/// rays of a generation are asked for at once, by one thread, and all threads shade them;
/// std::runtime_error is thrown where the memory that is available does not suffice for the first
/// one.
RenderResult render_scene(
    const Scene& scene,
    const Camera& camera,
    const RayIndex& index,
    const PictureSettings& settings,
    SampleType sample_type,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr,
    std::size_t generation_size = usual_generation_size);

} // namespace vera
