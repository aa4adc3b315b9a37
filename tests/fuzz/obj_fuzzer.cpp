// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/obj_parts.h"

#include "mesh_check.h"

namespace vera {

/// Of a text without errors, parts in the order of their beginnings, each within its parent.
void check_named_parts(const std::uint8_t* data, std::size_t size) {
    std::vector<Diagnostic> warnings;
    const SourceText source("fuzz", std::string(reinterpret_cast<const char*>(data), size));
    Geometry geometry;
    try {
        geometry = read_obj_parts(source, warnings, ObjMaterials::none).geometry;
    } catch (const InputError&) {
        return;
    }
    const auto triangles = static_cast<std::uint32_t>(geometry.meshes.front().triangle_count());
    const std::vector<NamedPart>& parts = geometry.named_parts;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        VERA_CHECK(!parts[i].name.empty() && parts[i].first < parts[i].end);
        VERA_CHECK(parts[i].first.triangle < triangles);
        VERA_CHECK((parts[i].end <= Element{1, 0}) && parts[i].end.triangle < triangles);
        VERA_CHECK(i == 0 || parts[i - 1].first <= parts[i].first);
        if (parts[i].parent == NamedPart::none)
            continue;
        VERA_CHECK(parts[i].parent < i);
        const NamedPart& parent = parts[parts[i].parent];
        VERA_CHECK(parent.first <= parts[i].first && parts[i].end <= parent.end);
    }
}

} // namespace vera

/// Whatever the bytes: a mesh whose numbers hold, or an InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    vera::check_mesh_reader(
        [](const vera::SourceText& source, std::vector<vera::Diagnostic>& warnings) {
            return vera::read_obj(source, warnings);
        },
        data,
        size);
    vera::check_named_parts(data, size);
    return 0;
}
