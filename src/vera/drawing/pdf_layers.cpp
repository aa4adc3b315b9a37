// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/pdf_layers.h"

#include "vera/drawing/document_text.h"

#include <fmt/format.h>

namespace vera::detail {

namespace {

/// "6 0 R 7 0 R"
std::string references(std::size_t first, std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i)
        text += fmt::format("{}{} 0 R", i == 0 ? "" : " ", first + i);
    return text;
}

} // namespace

std::string PdfLayers::properties() const {
    std::string text = "<<";
    for (std::size_t i = 0; i < names.size(); ++i)
        text += fmt::format("/L{} {} 0 R", i, first_layer + i);
    for (std::size_t i = 0; i < groups.size(); ++i)
        text += fmt::format("/G{} {} 0 R", i, first_group + i);
    return text + ">>";
}

std::string PdfLayers::content_properties() const {
    if (names.empty())
        return {};
    const std::string layers = references(first_layer, names.size());
    std::string all = layers;
    if (!groups.empty())
        all.append(" ").append(references(first_group, groups.size()));
    // Groups are on as well, where nothing else is said.
    return fmt::format("<</OCGs[{}]/D<</Order[{}]/ON[{}]>>>>", all, order(), layers);
}

/// What is within a group stands behind it as a list.
std::string PdfLayers::order() const {
    if (groups.empty())
        return references(first_layer, names.size());
    std::string text = references(first_layer, 1);
    std::size_t lists = 0;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const bool is_next = lists == groups[i].depth + 1;
        for (; lists > groups[i].depth + 1; --lists)
            text += ']';
        for (; lists < groups[i].depth + 1; ++lists)
            text += '[';
        text += fmt::format("{}{} 0 R", is_next ? " " : "", first_group + i);
    }
    text.append(lists, ']');
    return text + references(first_layer + 1, names.size() - 1);
}

std::string pdf_layer(const std::string& name) {
    return fmt::format("<</Type/OCG/Name{}>>", pdf_string(name));
}

} // namespace vera::detail
