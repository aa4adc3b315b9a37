// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace vera {

/// The separator and "did you mean 'bunny.ply'?" when the path's folder holds a file of such a
/// name, else nothing.
std::string similar_file(const std::filesystem::path& path, std::string_view separator);

} // namespace vera
