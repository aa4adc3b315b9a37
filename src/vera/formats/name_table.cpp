// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/name_table.h"

#include "vera/formats/word_reader.h"

#include <fmt/format.h>

namespace vera {

std::uint32_t NameTable::number(std::string_view name) {
    const auto [entry, added] =
        numbers_.try_emplace(name, static_cast<std::uint32_t>(entries_.size()));
    if (added)
        entries_.push_back({name, {}, {}});
    return entry->second;
}

std::uint32_t NameTable::used(std::string_view name, const WordPlace& place) {
    const std::uint32_t id = number(name);
    if (!entries_[id].use)
        entries_[id].use = place;
    return id;
}

std::optional<std::uint32_t>
NameTable::defined(std::string_view name, const WordPlace& place, Complaints& complaints) {
    const std::uint32_t id = number(name);
    auto& definition = entries_[id].definition;
    if (definition) {
        const SourcePlace first = source_place(*definition);
        complaints.error(
            place,
            fmt::format("{} '{}' is defined twice", sort_, name),
            fmt::format("the first definition is at {}:{}", first.file, first.line));
        return std::nullopt;
    }
    definition = place;
    return id;
}

bool NameTable::defined_by_default(std::string_view name, const WordPlace& place) {
    auto& definition = entries_[number(name)].definition;
    if (definition)
        return false;
    definition = place;
    return true;
}

std::uint32_t NameTable::unnamed() {
    entries_.push_back({});
    return static_cast<std::uint32_t>(entries_.size() - 1);
}

void NameTable::complain_of_undefined(Complaints& complaints) const {
    std::vector<std::string_view> defined_names;
    for (const Entry& entry : entries_) {
        if (!entry.use || entry.definition)
            continue;
        if (complaints.full())
            return;
        if (defined_names.empty())
            for (const Entry& other : entries_)
                if (other.definition)
                    defined_names.push_back(other.name);
        complaints.error(
            *entry.use,
            fmt::format(
                "there is no {} {}{}",
                sort_,
                shown(entry.name),
                did_you_mean(entry.name, defined_names)),
            fmt::format(
                "define it, anywhere in the text, by {} {}",
                std::string_view(sort_) == "material" ? "MA" : "SCENE",
                shown(entry.name).substr(1, entry.name.size())));
    }
}

void NameTable::warn_of_unused(Complaints& complaints) const {
    for (const Entry& entry : entries_)
        if (entry.definition && !entry.use)
            complaints.warn(
                fmt::format("unused {}s", sort_),
                *entry.definition,
                fmt::format("{} {} is never used", sort_, shown(entry.name)));
}

} // namespace vera
