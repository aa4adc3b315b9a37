// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/ply_header.h"

#include "vera/formats/text_cursor.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace vera {

namespace {

struct TypeName {
    std::string_view name;
    PlyType type;
};

constexpr std::array<TypeName, 16> type_names = {
    {{"char", PlyType::int8},
     {"int8", PlyType::int8},
     {"uchar", PlyType::uint8},
     {"uint8", PlyType::uint8},
     {"short", PlyType::int16},
     {"int16", PlyType::int16},
     {"ushort", PlyType::uint16},
     {"uint16", PlyType::uint16},
     {"int", PlyType::int32},
     {"int32", PlyType::int32},
     {"uint", PlyType::uint32},
     {"uint32", PlyType::uint32},
     {"float", PlyType::float32},
     {"float32", PlyType::float32},
     {"double", PlyType::float64},
     {"float64", PlyType::float64}}};

class HeaderReader {
public:
    explicit HeaderReader(const SourceText& source)
        : report_(source)
        , cursor_(report_, TextCursor::Lines::end_at_newline) {}

    PlyHeader read() {
        if (cursor_.word() != "ply")
            fail("'ply' at the beginning of a PLY file", "check the file's name and format");
        cursor_.skip_line();
        while (!ended_) {
            cursor_.skip_blanks();
            if (cursor_.at_end())
                fail("'end_header'", "the file ends within its header: get a whole copy of it");
            const std::size_t start = cursor_.offset();
            read_line(take_word(), start);
            cursor_.skip_line();
        }
        if (!has_format_)
            fail_at(
                0, 3, "the header has no 'format' line", "write 'format ascii 1.0' below 'ply'");
        header_.data = cursor_.offset();
        check_counts();
        return std::move(header_);
    }

private:
    std::string_view take_word() {
        cursor_.skip_blanks();
        const std::string_view word = cursor_.word();
        cursor_.pass(word);
        return word;
    }

    void read_line(std::string_view keyword, std::size_t start) {
        if (keyword == "format") {
            read_format();
        } else if (keyword == "element") {
            read_element(start);
        } else if (keyword == "property") {
            read_property(start);
        } else if (keyword == "end_header") {
            ended_ = true;
        } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
            cursor_ = TextCursor(report_, TextCursor::Lines::end_at_newline, start);
            fail(
                "'format', 'element', 'property', 'comment' or 'end_header'",
                "check that the file is a PLY file and whole");
        }
    }

    void read_format() {
        cursor_.skip_blanks();
        const std::string_view name = cursor_.word();
        if (name == "ascii")
            header_.encoding = PlyHeader::Encoding::ascii;
        else if (name == "binary_little_endian")
            header_.encoding = PlyHeader::Encoding::little_endian;
        else if (name == "binary_big_endian")
            header_.encoding = PlyHeader::Encoding::big_endian;
        else
            fail("'ascii', 'binary_little_endian' or 'binary_big_endian'");
        has_format_ = true;
    }

    void read_element(std::size_t start) {
        PlyElement element;
        element.offset = start;
        element.name = take_word();
        if (element.name.empty())
            fail("the name of the element");
        cursor_.skip_blanks();
        const std::string_view digits = cursor_.word();
        const bool good = !digits.empty() && digits.size() <= 18
            && std::all_of(
                digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
        if (!good)
            fail("how many of the element follow");
        for (const char digit : digits)
            element.count = 10 * element.count + static_cast<std::uint64_t>(digit - '0');
        if (header_.element(element.name) != nullptr)
            fail_at(
                start,
                7,
                fmt::format("the element '{}' stands twice in the header", element.name),
                "delete one of them");
        header_.elements.push_back(std::move(element));
    }

    void read_property(std::size_t start) {
        if (header_.elements.empty())
            fail_at(start, 8, "a property before any element", "write the 'element' line above it");
        PlyProperty property;
        cursor_.skip_blanks();
        if (cursor_.word() == "list") {
            take_word();
            cursor_.skip_blanks();
            property.count_type = take_type();
            if (*property.count_type == PlyType::float32
                || *property.count_type == PlyType::float64)
                fail_at(
                    start,
                    8,
                    "the length of a list must be a whole number",
                    "write 'property list uchar int vertex_indices'");
        }
        property.type = take_type();
        property.name = take_word();
        if (property.name.empty())
            fail("the name of the property");
        header_.elements.back().properties.push_back(property);
    }

    PlyType take_type() {
        cursor_.skip_blanks();
        const std::string_view word = cursor_.word();
        const auto known =
            std::find_if(type_names.begin(), type_names.end(), [&](const TypeName& t) {
                return t.name == word;
            });
        if (known == type_names.end())
            fail(
                "the type of the property",
                "the types are char, uchar, short, ushort, int, uint, float and double");
        cursor_.pass(word);
        return known->type;
    }

    /// The file must be long enough for all the elements together.
    void check_counts() {
        const std::size_t room = report_.source().text().size() - header_.data;
        std::size_t left = room;
        for (const PlyElement& element : header_.elements) {
            const std::size_t size = smallest_size(element, header_.encoding);
            if (size == 0)
                continue;
            if (element.count > left / size)
                fail_at(
                    element.offset,
                    7,
                    fmt::format(
                        "{} elements '{}' of at least {} are promised, but at most {} are left of "
                        "the file",
                        element.count,
                        element.name,
                        counted(size, "byte", "bytes"),
                        counted(left, "byte", "bytes")),
                    "the file is cut short: get a whole copy of it");
            left -= element.count * size;
        }
    }

    [[noreturn]] void fail(std::string_view what, const char* remedy = "") {
        cursor_.expected(what, remedy);
        throw_errors();
    }

    [[noreturn]] void
    fail_at(std::size_t offset, std::size_t length, std::string problem, const char* remedy) {
        report_.error(offset, length, std::move(problem), remedy);
        throw_errors();
    }

    [[noreturn]] void throw_errors() {
        std::vector<Diagnostic> warnings;
        report_.finish(warnings);
        throw InputError({}); // not reached: the report holds an error
    }

    SourceReport report_;
    TextCursor cursor_;
    PlyHeader header_;
    bool has_format_ = false;
    bool ended_ = false;
};

} // namespace

std::size_t size_of(PlyType type) {
    switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
        return 1;
    case PlyType::int16:
    case PlyType::uint16:
        return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
        return 4;
    case PlyType::float64:
        break;
    }
    return 8;
}

std::optional<std::size_t> PlyElement::property(std::string_view property_name) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
        if (properties[i].name == property_name)
            return i;
    return std::nullopt;
}

const PlyElement* PlyHeader::element(std::string_view name) const {
    for (const PlyElement& element : elements)
        if (element.name == name)
            return &element;
    return nullptr;
}

std::size_t smallest_size(const PlyElement& element, PlyHeader::Encoding encoding) {
    std::size_t size = 0;
    for (const PlyProperty& property : element.properties) {
        // In ascii, a digit and a blank; the very last element may end without.
        if (encoding == PlyHeader::Encoding::ascii)
            size += 2;
        else
            size += size_of(property.count_type.value_or(property.type));
    }
    return encoding == PlyHeader::Encoding::ascii && size > 0 ? size - 1 : size;
}

PlyHeader read_ply_header(const SourceText& source) {
    return HeaderReader(source).read();
}

} // namespace vera
