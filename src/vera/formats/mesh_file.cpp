// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace vera {

Mesh read_mesh(const std::filesystem::path& path, std::vector<Diagnostic>& warnings) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    const SourceText source(path);
    const std::string_view text = source.text();
    if (extension == ".obj")
        return read_obj(source, warnings);
    if (extension == ".ply" || text.substr(0, 4) == "ply\n" || text.substr(0, 5) == "ply\r\n")
        return read_ply(source, warnings);
    if (extension == ".stl" || text.substr(0, 6) == "solid ")
        return read_stl(source, warnings);
    throw InputError(
        {{.place = {source.name(), 0, 0},
          .problem = "neither the file's name nor its beginning says what format the mesh is in",
          .remedy = "give it a name that ends in .obj, .ply or .stl"}});
}

} // namespace vera
