// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/base/output_file.h"
#include "vera/image/image.h"

#include <string>

#include "command.h"
#include "prepared_scene.h"

namespace vera {

/// What the file of layers is called must tell that it is an EXR file: throws CommandLineError.
void check_layers_name(const std::string& path);

/// Renders the picture in layers, a ray through the centre of each pixel, into the file, which the
/// caller commits. The metadata are those of the picture; more is added.
void write_layers(
    const PreparedScene& prepared,
    const RayIndex& index,
    const PictureMetadata& metadata,
    OutputFile& file,
    const Console& console);

} // namespace vera
