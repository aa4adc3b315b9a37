// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/complaints.h"
#include "vera/formats/obj_parts.h"
#include "vera/formats/source_text.h"
#include "vera/scene/scene.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace vera {

/// The other files that a scene text names, each read once.
class IncludedFiles {
public:
    explicit IncludedFiles(Complaints& complaints)
        : complaints_(complaints) {}

    /// INCLUDE: the text of the file; nothing, and a complaint, when it cannot be read.
    const SourceText* text(std::string_view name, const WordPlace& place);

    /// MESH: the path of a mesh file that exists; nothing, and a complaint, when there is none.
    std::optional<std::filesystem::path> mesh_path(std::string_view name, const WordPlace& place);

    /// The mesh in the file, as a scene of one mesh or, of a file that names materials which are
    /// taken, one for each stretch of one of them; nothing, and complaints, when it cannot be read.
    std::optional<Scene>
    mesh(const std::filesystem::path& path, ObjMaterials materials, const WordPlace& place);

    /// The files of the meshes and of their materials, as they were read.
    const std::set<std::string>& mesh_files() const { return mesh_files_; }

private:
    std::optional<std::filesystem::path> existing(std::string_view name, const WordPlace& place);

    Complaints& complaints_;
    std::map<std::filesystem::path, std::unique_ptr<SourceText>> texts_; ///< by canonical path
    std::set<std::string> mesh_files_;
};

} // namespace vera
