// SPDX-License-Identifier: Apache-2.0
// Strings of the world in the texts of documents.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vera::detail {

/// The text as content or attribute of an XML 1.0 document. Bytes that are not UTF-8, and
/// characters that XML forbids, become U+FFFD.
std::string xml_text(std::string_view utf8);

/// The text as a string of a PDF: "(...)", or in UTF-16 as "<FEFF...>" when it is not plain ASCII.
std::string pdf_string(std::string_view utf8);

/// The text in printable ASCII on one line of at most 200 characters, with '?' for all else.
std::string plain_line(std::string_view utf8);

/// Of the bytes: the same on every machine.
std::uint64_t hash_of(std::string_view bytes);

/// Gives ids that no other element of the document has.
class UniqueIds {
public:
    /// The wanted id made of letters, digits, '-', '_' and '.', so that XML and CSS can name it;
    /// with "-2", "-3" ... behind it when it has been given before.
    std::string take(std::string_view wanted);

private:
    std::uint32_t last_number_of(std::string_view id) const;
    void set_last_number(std::string_view id, std::uint32_t number);
    std::size_t place_of(std::uint64_t hash) const;

    /// Of the ids that were given or asked for, each at its place or, where that is taken, at one
    /// of the next ones (open addressing); a quarter of the places at least is free. A drawing has
    /// as many ids as regions that are seen: they themselves would take ten times the memory. Two
    /// with one hash would be told apart by a number that neither needs.
    std::vector<std::uint64_t> hashes_ = std::vector<std::uint64_t>(16);
    /// Behind the last one made of each, 1 for none; 0: the place is free.
    std::vector<std::uint32_t> last_numbers_ = std::vector<std::uint32_t>(16);
    std::size_t count_ = 0;
};

} // namespace vera::detail
