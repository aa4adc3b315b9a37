// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/complaints.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace vera {

/// The names of one sort of things, which may be used before they are defined. Each gets a number,
/// from 0 on, when it is first met.
class NameTable {
public:
    struct Entry {
        std::string_view name;
        std::optional<WordPlace> use;        ///< the first
        std::optional<WordPlace> definition; ///< the first
    };

    /// The sort of things, in the singular: "material".
    explicit NameTable(const char* sort)
        : sort_(sort) {}

    /// The number of a name, which must outlive the table.
    std::uint32_t used(std::string_view name, const WordPlace& place);

    /// The number of a name that is being defined; complains, and gives nothing, when it has been
    /// defined already.
    std::optional<std::uint32_t>
    defined(std::string_view name, const WordPlace& place, Complaints& complaints);

    /// Whether it had no definition until now, when it gets one of the program's own.
    bool defined_by_default(std::string_view name, const WordPlace& place);

    /// A number for something that has no name in the text.
    std::uint32_t unnamed();

    const std::vector<Entry>& entries() const { return entries_; }

    /// Complains of names that are used and never defined.
    void complain_of_undefined(Complaints& complaints) const;

    /// Warns of those defined and never used.
    void warn_of_unused(Complaints& complaints) const;

private:
    std::uint32_t number(std::string_view name);

    const char* sort_;
    std::vector<Entry> entries_;
    std::unordered_map<std::string_view, std::uint32_t> numbers_;
};

} // namespace vera
