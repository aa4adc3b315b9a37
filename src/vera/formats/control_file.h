// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/diagnostic.h"
#include "vera/formats/source_text.h"
#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"

#include <filesystem>
#include <vector>

namespace vera {

/// The settings that a control file asks for. SHADOWS and ANTI-ALIAS are off unless it names them;
/// what else it does not name is as in defaults, the scene's (of NFF scenes RTDEPTH is 5 and the
/// firmament their background; of others both are as in PictureSettings). Throws InputError with
/// all that is wrong, and std::system_error when the file cannot be read.
PictureSettings read_control_file(
    const std::filesystem::path& path,
    const PictureSettings& defaults,
    std::vector<Diagnostic>& warnings);

/// The same, of a text from memory.
PictureSettings read_control_text(
    const SourceText& text, const PictureSettings& defaults, std::vector<Diagnostic>& warnings);

/// Multiplies the intensities of the scene's lights by the factors of LIGHTS. Throws InputError,
/// which names the control file, where there are not as many factors as lights.
void scale_lights(
    Scene& scene, const PictureSettings& settings, const std::filesystem::path& control_file);

} // namespace vera
