// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/item_place.h"

#include <algorithm>

namespace vera {

namespace {

/// Where a line begins, counted from 1; the text's end when it has fewer.
std::size_t line_offset(std::string_view text, std::uint64_t line) {
    std::size_t offset = 0;
    for (std::uint64_t i = 1; i < line; ++i) {
        const std::size_t end = text.find('\n', offset);
        if (end == std::string_view::npos)
            return text.size();
        offset = end + 1;
    }
    return offset;
}

} // namespace

bool makes(std::optional<Statement> statement, ItemKind kind) {
    switch (kind) {
    case ItemKind::sphere:
        return statement == Statement::sphere;
    case ItemKind::triangle:
        return statement == Statement::triangle || statement == Statement::quadrangle;
    case ItemKind::polygon:
        return statement == Statement::quadrangle || statement == Statement::polygon;
    case ItemKind::patch:
        return statement == Statement::patch;
    case ItemKind::rotational_shape:
        return statement == Statement::rotational_shape;
    case ItemKind::mesh:
        return statement == Statement::mesh;
    case ItemKind::subscene_call:
        return statement == Statement::subscene_call || statement == Statement::mesh
            || statement == Statement::make;
    }
    return false;
}

WordPlace item_place(const Item& item, const SourceText& text) {
    const std::size_t begin = line_offset(text.text(), item.line);
    std::string_view line = text.text().substr(begin);
    line = line.substr(0, line.find('\n'));
    WordPlace place = {&text, begin, begin, item.line, 1};
    bool any_word = false;
    for (std::size_t at = 0; at < line.size();) {
        const std::size_t first = std::min(line.find_first_not_of(" \t\r", at), line.size());
        const std::size_t last = std::min(line.find_first_of(" \t\r", first), line.size());
        const bool makes_item = makes(statement_named(line.substr(first, last - first)), item.kind);
        if (first < last && (makes_item || !any_word)) {
            place.offset = begin + first;
            place.length = last - first;
            any_word = true;
        }
        if (makes_item)
            break;
        at = last;
    }
    return place;
}

} // namespace vera
