// SPDX-License-Identifier: Apache-2.0
#include "vera/base/check.h"
#include "vera/formats/nff.h"

#include <cstdint>
#include <string>

/// Whatever the bytes: a scene whose parts exist, or an InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vera;
    const SourceText source("fuzz", std::string(reinterpret_cast<const char*>(data), size));
    try {
        const SceneFile file = read_nff(source);
        const Geometry& geometry = file.scene.geometry;
        VERA_CHECK(geometry.primitive_count == geometry.items.size());
        for (const Item& item : geometry.items)
            VERA_CHECK(
                item.material == inherited_material
                || static_cast<std::size_t>(item.material) < file.scene.materials.size());
        for (const Polygon& polygon : geometry.polygons)
            VERA_CHECK(
                std::size_t{polygon.first_corner} + polygon.corner_count
                <= geometry.corners.size());
        for (const Sphere& sphere : geometry.spheres)
            VERA_CHECK(sphere.radius > 0);
        for (const Material& material : file.scene.materials)
            VERA_CHECK(material.ref > 0 && material.spc >= -1 && material.spc <= 1);
    } catch (const InputError& error) {
        VERA_CHECK(!error.diagnostics().empty() && error.diagnostics().size() < 40);
        for (const Diagnostic& diagnostic : error.diagnostics())
            VERA_CHECK(!to_text(diagnostic).empty());
    }
    return 0;
}
