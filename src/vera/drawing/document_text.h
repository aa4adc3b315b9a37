// SPDX-License-Identifier: Apache-2.0
// Strings of the world in the texts of documents.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>

namespace vera::detail {

/// The text as content or attribute of an XML 1.0 document. Bytes that are not UTF-8, and
/// characters that XML forbids, become U+FFFD.
std::string xml_text(std::string_view utf8);

/// The text as a string of a PDF: "(...)", or in UTF-16 as "<FEFF...>" when it is not plain ASCII.
std::string pdf_string(std::string_view utf8);

/// The text in printable ASCII on one line of at most 200 characters, with '?' for all else.
std::string plain_line(std::string_view utf8);

/// Gives ids that no other element of the document has.
class UniqueIds {
public:
    /// The wanted id made of letters, digits, '-', '_' and '.', so that XML and CSS can name it;
    /// with "-2", "-3" ... behind it when it has been given before.
    std::string take(std::string_view wanted);

private:
    /// The number behind the last one made of each id, 1 for none: 0 where it was never given.
    std::unordered_map<std::string, std::uint64_t> taken_;
};

} // namespace vera::detail
