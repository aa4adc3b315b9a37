// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/complaints.h"
#include "vera/formats/source_text.h"
#include "vera/scene/scene.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vera {

/// Where the items of a scene, which must outlive it, are written. Keeps the texts that it was
/// asked about.
class ItemPlaces {
public:
    explicit ItemPlaces(const Scene& scene)
        : scene_(scene) {}

    /// The statement of an item, or in an OBJ file the face of that triangle of it, counted from 0.
    SourcePlace
    place(const Geometry& geometry, std::uint32_t item, std::optional<std::uint64_t> triangle = {});

    /// What is to be said of it, with the line where that can be read again.
    Diagnostic diagnostic(
        Severity severity,
        const Geometry& geometry,
        std::uint32_t item,
        std::optional<std::uint64_t> triangle,
        std::string problem,
        std::string remedy);

private:
    struct File {
        std::unique_ptr<SourceText> text;          ///< empty: cannot be read again
        std::vector<std::uint32_t> triangle_lines; ///< of an OBJ file
    };

    const File& file(const Item& item);
    /// Nothing where the text cannot be read again.
    std::optional<WordPlace>
    word(const Geometry& geometry, std::uint32_t item, std::optional<std::uint64_t> triangle);
    /// The same without the text.
    SourcePlace line(const Item& item) const;

    const Scene& scene_;
    std::map<std::uint16_t, File> files_;
};

} // namespace vera
