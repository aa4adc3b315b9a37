// SPDX-License-Identifier: Apache-2.0
// The optional content of a PDF (ISO 32000-1, 8.11): what viewers show and hide, by name. The
// layers of the drawing stand beside each other, and within that of the outlines the groups.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace vera::detail {

struct PdfLayers {
    struct Group {
        std::string name;
        std::size_t depth = 0; ///< 0: within the layer alone, else within the last one less deep
    };

    std::vector<std::string> names;
    std::vector<Group> groups;   ///< each before those within it
    std::size_t first_layer = 0; ///< number of the object that stands for it; the others follow
    std::size_t first_group = 0; ///< likewise

    /// "<</L0 6 0 R/G0 9 0 R>>", by which a page calls them: the names of layers and groups by
    /// their numbers.
    std::string properties() const;

    /// The catalog's OCProperties. Empty where there is no layer.
    std::string content_properties() const;

private:
    std::string order() const;
};

/// An optional content group, as an object.
std::string pdf_layer(const std::string& name);

} // namespace vera::detail
