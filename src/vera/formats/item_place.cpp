// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/item_place.h"

#include <algorithm>
#include <vector>

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

/// The words of the item's line.
std::vector<WordPlace> words_of_line(const Item& item, const SourceText& text) {
    const std::size_t begin = line_offset(text.text(), item.line);
    std::string_view line = text.text().substr(begin);
    line = line.substr(0, line.find('\n'));
    std::vector<WordPlace> words;
    for (std::size_t at = 0; at < line.size();) {
        const std::size_t first = std::min(line.find_first_not_of(" \t\r", at), line.size());
        const std::size_t last = std::min(line.find_first_of(" \t\r", first), line.size());
        if (first < last)
            words.push_back({&text, begin + first, begin, item.line, last - first});
        at = last;
    }
    if (words.empty())
        words.push_back({&text, begin, begin, item.line, 1});
    return words;
}

bool is_able(const WordPlace& word, const Item& item) {
    return makes(statement_named(word.text->text().substr(word.offset, word.length)), item.kind);
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
    const std::vector<WordPlace> words = words_of_line(item, text);
    const auto able =
        std::ranges::find_if(words, [&](const WordPlace& word) { return is_able(word, item); });
    return able == words.end() ? words.front() : *able;
}

WordPlace item_place(const Geometry& geometry, std::uint32_t number, const SourceText& text) {
    const Item& item = geometry.items[number];
    std::vector<WordPlace> able = words_of_line(item, text);
    std::erase_if(able, [&](const WordPlace& word) { return !is_able(word, item); });
    std::size_t before = 0;
    std::size_t all = 0;
    const auto is_beside = [&](std::size_t i) {
        return geometry.items[i].file == item.file && geometry.items[i].line == item.line;
    };
    std::size_t first = number;
    while (first > 0 && is_beside(first - 1))
        --first;
    for (std::size_t i = first; i < geometry.items.size() && is_beside(i); ++i) {
        const bool is_alike = geometry.items[i].kind == item.kind;
        before += is_alike && i < number ? 1 : 0;
        all += is_alike ? 1 : 0;
    }
    // Words in comments look like statements too.
    return able.size() == all ? able[before] : item_place(item, text);
}

} // namespace vera
