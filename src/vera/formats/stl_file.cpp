// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/mesh_builder.h"
#include "vera/formats/mesh_file.h"
#include "vera/formats/shared_points.h"
#include "vera/formats/text_cursor.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

namespace vera {

namespace {

constexpr std::size_t header_size = 80;
constexpr std::size_t triangles_begin = header_size + 4;
constexpr std::size_t triangle_size = 50;

std::uint32_t little_endian(const char* bytes) {
    std::array<unsigned char, 4> b = {};
    std::memcpy(b.data(), bytes, 4);
    return static_cast<std::uint32_t>(b[0]) | static_cast<std::uint32_t>(b[1]) << 8U
        | static_cast<std::uint32_t>(b[2]) << 16U | static_cast<std::uint32_t>(b[3]) << 24U;
}

/// Equal but for the case of letters; the second is in lower case.
bool is_keyword(std::string_view word, std::string_view keyword) {
    return word.size() == keyword.size()
        && std::equal(word.begin(), word.end(), keyword.begin(), [](char a, char b) {
               return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
           });
}

/// Many a program writes binary files that begin with "solid": their size tells, and if the file is
/// cut short, that they hold what no text does.
bool is_binary(std::string_view text) {
    const std::size_t start =
        std::min(text.find_first_not_of(" \t\r\n", encoding_mark_length(text)), text.size());
    if (!is_keyword(text.substr(start, 5), "solid"))
        return true;
    if (text.size() >= triangles_begin) {
        const std::uint64_t count = little_endian(text.data() + header_size);
        if (text.size() == triangles_begin + triangle_size * count)
            return true;
    }
    return text.substr(0, 1024).find('\0') != std::string_view::npos;
}

class BinaryReader {
public:
    explicit BinaryReader(const SourceText& source)
        : report_(source, SourceReport::Places::bytes)
        , text_(source.text())
        , builder_(report_)
        , points_(builder_.mesh().positions)
        , spent_(source) {}

    Mesh read(std::vector<Diagnostic>& warnings) {
        const std::uint64_t count = triangle_count();
        // Room for corners that are all different, as far as that is ever touched.
        builder_.reserve(3 * count, 0, count);
        for (std::uint64_t i = 0; i < count && !report_.full(); ++i) {
            if (!read_triangle(i))
                break;
            spent_.up_to(triangles_begin + i * triangle_size);
        }
        return builder_.finish(warnings);
    }

private:
    /// As many as there are in the file, whatever it promises.
    std::uint64_t triangle_count() {
        if (text_.size() < triangles_begin) {
            report_.error(
                text_.size(),
                1,
                "expected the 84 bytes that a binary STL file begins with, but the file ends",
                "an ascii STL file begins with 'solid'");
            return 0;
        }
        const std::uint64_t count = little_endian(text_.data() + header_size);
        const std::uint64_t room = (text_.size() - triangles_begin) / triangle_size;
        if (count > room) {
            report_.error(
                header_size,
                4,
                fmt::format(
                    "{} promised, but the file has room for {}",
                    counted(count, "triangle is", "triangles are"),
                    room),
                "the file is cut short: get a whole copy of it (an ascii STL file begins with "
                "'solid')");
            return 0;
        }
        const std::uint64_t end = triangles_begin + count * triangle_size;
        if (text_.size() > end)
            report_.warning(
                end,
                1,
                "what follows the last triangle is passed over: "
                    + counted(text_.size() - end, "byte", "bytes"));
        return count;
    }

    /// Whether there is use in reading on.
    bool read_triangle(std::uint64_t i) {
        const std::size_t start = triangles_begin + i * triangle_size;
        std::array<MeshCorner, 3> corners;
        for (std::size_t c = 0; c < 3; ++c) {
            // Behind the facet's normal, which follows from the corners.
            const std::size_t place = start + 12 + 12 * c;
            const Vec3 point = {coordinate(place), coordinate(place + 4), coordinate(place + 8)};
            if (!is_finite(point)) {
                report_.error(
                    place,
                    12,
                    fmt::format(
                        "corner {} of triangle {} has a coordinate that is not a finite number",
                        c + 1,
                        i + 1),
                    "repair the program that wrote the file, or delete what uses this number");
                return true;
            }
            if (!builder_.room_for_another(builder_.mesh().positions, start))
                return false;
            corners[c].position = points_.number_of(point);
        }
        return builder_.add_face(corners, start);
    }

    double coordinate(std::size_t offset) const {
        return static_cast<double>(std::bit_cast<float>(little_endian(text_.data() + offset)));
    }

    SourceReport report_;
    std::string_view text_;
    MeshBuilder builder_;
    SharedPoints points_;
    SpentText spent_;
};

class AsciiReader {
public:
    explicit AsciiReader(const SourceText& source)
        : report_(source)
        , cursor_(report_, TextCursor::Lines::newlines_are_blanks)
        , builder_(report_)
        , points_(builder_.mesh().positions)
        , spent_(source) {}

    Mesh read(std::vector<Diagnostic>& warnings) {
        // A facet takes some 250 bytes, and hardly less than 100.
        const std::size_t triangles = report_.source().text().size() / 100;
        builder_.reserve(triangles, 0, triangles);
        while (!report_.full() && read_solid()) {
        }
        return builder_.finish(warnings);
    }

private:
    /// solid name, facets, endsolid name. Several may follow one another.
    bool read_solid() {
        cursor_.skip_blanks();
        if (cursor_.at_end() || !take("solid"))
            return false;
        cursor_.skip_line();
        while (true) {
            cursor_.skip_blanks();
            const std::string_view word = cursor_.word();
            if (is_keyword(word, "endsolid")) {
                cursor_.skip_line();
                return true;
            }
            if (!is_keyword(word, "facet")) {
                cursor_.expected(
                    "'facet' or 'endsolid'",
                    cursor_.at_end() ? "the file is cut short: get a whole copy of it" : "");
                return false;
            }
            if (!read_facet())
                return false;
            spent_.up_to(cursor_.offset());
        }
    }

    /// facet normal x y z, outer loop, three vertices, endloop, endfacet. The normal follows from
    /// the corners; not a few files have nan there.
    bool read_facet() {
        const std::size_t start = cursor_.offset();
        if (!take("facet"))
            return false;
        cursor_.skip_line();
        if (!take("outer") || !take("loop"))
            return false;
        corners_.clear();
        while (true) {
            cursor_.skip_blanks();
            if (!is_keyword(cursor_.word(), "vertex"))
                break;
            take("vertex");
            Vec3 point;
            if (!cursor_.take_point(point, "the vertex")
                || !builder_.room_for_another(builder_.mesh().positions, start))
                return false;
            corners_.push_back({points_.number_of(point)});
        }
        if (corners_.size() < 3) {
            cursor_.expected("'vertex'", "a facet has three of them");
            return false;
        }
        return take("endloop") && take("endfacet") && builder_.add_face(corners_, start);
    }

    bool take(std::string_view keyword) {
        cursor_.skip_blanks();
        const std::string_view word = cursor_.word();
        if (is_keyword(word, keyword)) {
            cursor_.pass(word);
            return true;
        }
        cursor_.expected(
            fmt::format("'{}'", keyword),
            cursor_.at_end() ? "the file is cut short: get a whole copy of it" : "");
        return false;
    }

    SourceReport report_;
    TextCursor cursor_;
    MeshBuilder builder_;
    SharedPoints points_;
    SpentText spent_;
    std::vector<MeshCorner> corners_;
};

} // namespace

Mesh read_stl(const SourceText& source, std::vector<Diagnostic>& warnings) {
    if (is_binary(source.text()))
        return BinaryReader(source).read(warnings);
    return AsciiReader(source).read(warnings);
}

} // namespace vera
