// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/mesh_builder.h"
#include "vera/formats/mesh_file.h"
#include "vera/formats/ply_header.h"
#include "vera/formats/text_cursor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

#include <fmt/format.h>

namespace vera {

namespace {

/// Takes the values of the elements of an ascii file.
class AsciiValues {
public:
    AsciiValues(SourceReport& report, PlyHeader::Encoding /*encoding*/, std::size_t offset)
        : cursor_(report, TextCursor::Lines::newlines_are_blanks, offset) {}

    std::size_t offset() {
        cursor_.skip_blanks();
        return cursor_.offset();
    }

    std::size_t word_length() const { return std::max<std::size_t>(cursor_.word().size(), 1); }

    bool take_number(double& value, PlyType /*type*/, std::string_view name) {
        return cursor_.take_number(value, "", name);
    }

    /// A whole number; negative ones and those with a fraction are given as they are.
    bool take_whole(double& value, PlyType type, std::string_view what) {
        return take_number(value, type, what);
    }

    bool skip(PlyType /*type*/, std::uint64_t count, std::string_view name) {
        for (; count > 0; --count) {
            cursor_.skip_blanks();
            const std::string_view word = cursor_.word();
            if (word.empty()) {
                cursor_.expected(
                    fmt::format("the property '{}'", name),
                    "the file is cut short: get a whole copy of it");
                return false;
            }
            cursor_.pass(word);
        }
        return true;
    }

private:
    TextCursor cursor_;
};

/// Takes the values of the elements of a binary file.
class BinaryValues {
public:
    BinaryValues(SourceReport& report, PlyHeader::Encoding encoding, std::size_t offset)
        : report_(&report)
        , text_(report.source().text())
        , at_(offset)
        , swap_(
              (encoding == PlyHeader::Encoding::little_endian)
              != (std::endian::native == std::endian::little)) {}

    std::size_t offset() const { return at_; }

    static std::size_t word_length() { return 1; }

    bool take_number(double& value, PlyType type, std::string_view name) {
        if (!take_whole(value, type, name))
            return false;
        if (std::isfinite(value))
            return true;
        report_->error(
            at_ - size_of(type),
            1,
            fmt::format("{} is not a finite number", name),
            "repair the program that wrote the file, or delete what uses this number");
        return false;
    }

    bool take_whole(double& value, PlyType type, std::string_view what) {
        if (text_.size() - at_ < size_of(type))
            return complain_of_end(what);
        value = loaded(text_.data() + at_, type);
        at_ += size_of(type);
        return true;
    }

    bool skip(PlyType type, std::uint64_t count, std::string_view name) {
        if ((text_.size() - at_) / size_of(type) < count)
            return complain_of_end(fmt::format("the property '{}'", name));
        at_ += count * size_of(type);
        return true;
    }

private:
    bool complain_of_end(std::string_view what) {
        report_->error(
            at_,
            1,
            fmt::format("expected {}, but the file ends", what),
            "the file is cut short: get a whole copy of it");
        return false;
    }

    template <typename Value>
    Value loaded_as(const char* bytes) const {
        char copy[sizeof(Value)];
        std::memcpy(copy, bytes, sizeof(Value));
        if (swap_)
            std::reverse(copy, copy + sizeof(Value));
        Value value;
        std::memcpy(&value, copy, sizeof(Value));
        return value;
    }

    double loaded(const char* bytes, PlyType type) const {
        switch (type) {
        case PlyType::int8:
            return loaded_as<std::int8_t>(bytes);
        case PlyType::uint8:
            return loaded_as<std::uint8_t>(bytes);
        case PlyType::int16:
            return loaded_as<std::int16_t>(bytes);
        case PlyType::uint16:
            return loaded_as<std::uint16_t>(bytes);
        case PlyType::int32:
            return loaded_as<std::int32_t>(bytes);
        case PlyType::uint32:
            return loaded_as<std::uint32_t>(bytes);
        case PlyType::float32:
            return static_cast<double>(loaded_as<float>(bytes));
        case PlyType::float64:
            break;
        }
        return loaded_as<double>(bytes);
    }

    SourceReport* report_;
    std::string_view text_;
    std::size_t at_;
    bool swap_;
};

/// Reads the elements, from whichever kind of values.
template <typename Values>
class PlyReader {
public:
    PlyReader(const SourceText& source, const PlyHeader& header)
        : report_(
            source,
            std::is_same_v<Values, AsciiValues> ? SourceReport::Places::lines
                                                : SourceReport::Places::bytes)
        , header_(header)
        , builder_(report_)
        , spent_(source)
        , values_(report_, header.encoding, header.data) {}

    Mesh read(std::vector<Diagnostic>& warnings) {
        const PlyElement* const vertices = header_.element("vertex");
        const PlyElement* const faces = header_.element("face");
        bool have_vertices = false;
        bool good = true;
        std::optional<Values> faces_before_vertices;
        for (const PlyElement& element : header_.elements) {
            if (!good)
                break;
            if (&element == vertices) {
                good = read_vertices(element);
                have_vertices = true;
            } else if (&element == faces && have_vertices) {
                good = read_faces(element, values_);
            } else {
                if (&element == faces)
                    faces_before_vertices = values_;
                good = skip(element);
            }
        }
        if (vertices == nullptr)
            report_.error(
                0,
                3,
                "the file has no element 'vertex'",
                "let the program that wrote the file export triangles");
        if (good && have_vertices && faces_before_vertices)
            read_faces(*faces, *faces_before_vertices);
        return builder_.finish(warnings);
    }

private:
    bool read_vertices(const PlyElement& element) {
        const std::optional<std::size_t> places[] = {
            element.property("x"), element.property("y"), element.property("z")};
        for (const auto& place : places)
            if (!place || element.properties[*place].count_type) {
                report_.error(
                    element.offset,
                    1,
                    "the element 'vertex' lacks a property x, y or z",
                    "write 'property float x', and y and z, below 'element vertex'");
                return false;
            }
        if (element.count > MeshBuilder::most_triangles) {
            report_.error(
                element.offset,
                1,
                fmt::format("more than {} vertices in one mesh", MeshBuilder::most_triangles),
                "split the mesh into several files");
            return false;
        }
        const std::optional<std::size_t> normal_places[] = {
            element.property("nx"), element.property("ny"), element.property("nz")};
        has_normals_ =
            std::all_of(std::begin(normal_places), std::end(normal_places), [&](const auto& place) {
                return place && !element.properties[*place].count_type;
            });

        // Where each property's value goes: x y z nx ny nz, or nowhere.
        std::vector<std::size_t> targets(element.properties.size(), nowhere);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            targets[*places[axis]] = axis;
            if (has_normals_)
                targets[*normal_places[axis]] = 3 + axis;
        }
        reserve(element.count);
        for (std::uint64_t i = 0; i < element.count && !report_.full(); ++i) {
            if (!read_vertex(element, targets))
                return false;
            spent_.up_to(values_.offset());
        }
        return true;
    }

    void reserve(std::size_t vertex_count) {
        const PlyElement* const faces = header_.element("face");
        std::size_t triangles = 0;
        if (faces != nullptr) {
            // A triangle in ascii takes at least "3 0 1 2" and a newline; in binary its list.
            std::size_t smallest = 8;
            if (header_.encoding != PlyHeader::Encoding::ascii)
                for (const PlyProperty& property : faces->properties)
                    smallest =
                        std::max(smallest, property.count_type ? 3 * size_of(property.type) : 1);
            triangles =
                std::min<std::size_t>(faces->count, report_.source().text().size() / smallest);
        }
        builder_.reserve(vertex_count, has_normals_ ? vertex_count : 0, triangles);
    }

    bool read_vertex(const PlyElement& element, const std::vector<std::size_t>& targets) {
        static constexpr std::string_view names[] = {
            "the x of the vertex",
            "the y of the vertex",
            "the z of the vertex",
            "the nx of the vertex",
            "the ny of the vertex",
            "the nz of the vertex"};
        double numbers[6] = {};
        for (std::size_t i = 0; i < targets.size(); ++i) {
            const PlyProperty& property = element.properties[i];
            if (targets[i] == nowhere) {
                if (!skip(property))
                    return false;
            } else if (!values_.take_number(
                           numbers[targets[i]], property.type, names[targets[i]])) {
                return false;
            }
        }
        builder_.mesh().positions.push_back({numbers[0], numbers[1], numbers[2]});
        if (has_normals_)
            builder_.mesh().normals.push_back({numbers[3], numbers[4], numbers[5]});
        return true;
    }

    bool read_faces(const PlyElement& element, Values& values) {
        auto list = element.property("vertex_indices");
        if (!list)
            list = element.property("vertex_index");
        const bool good = list && element.properties[*list].count_type
            && element.properties[*list].type != PlyType::float32
            && element.properties[*list].type != PlyType::float64;
        if (!good) {
            report_.error(
                element.offset,
                1,
                "the element 'face' lacks a list of whole numbers 'vertex_indices'",
                "write 'property list uchar int vertex_indices' below 'element face'");
            return false;
        }
        std::swap(values, values_);
        bool whole = true;
        for (std::uint64_t i = 0; i < element.count && whole && !report_.full(); ++i) {
            for (std::size_t p = 0; p < element.properties.size() && whole; ++p)
                whole = p == *list ? read_face(element.properties[p]) : skip(element.properties[p]);
            spent_.up_to(values_.offset());
        }
        std::swap(values, values_);
        return whole;
    }

    bool take_count(std::uint64_t& count, const PlyProperty& property) {
        const std::size_t start = values_.offset();
        const std::size_t length = values_.word_length();
        double number = 0;
        if (!values_.take_whole(number, *property.count_type, "the length of a list"))
            return false;
        // What a file can hold is far below 2^53.
        if (number >= 0 && number <= 0x1p53 && number == std::floor(number)) {
            count = static_cast<std::uint64_t>(number);
            return true;
        }
        report_.error(
            start,
            length,
            fmt::format("expected the length of a list, found {}", number),
            "the file is damaged: get another copy of it");
        return false;
    }

    /// Whether what follows can be read.
    bool read_face(const PlyProperty& property) {
        const std::size_t start = values_.offset();
        std::uint64_t count = 0;
        if (!take_count(count, property))
            return false;
        corners_.clear();
        bool good = true;
        for (std::uint64_t i = 0; i < count; ++i) {
            const std::size_t place = values_.offset();
            const std::size_t length = values_.word_length();
            double number = 0;
            if (!values_.take_whole(number, property.type, "the number of a vertex of the face"))
                return false;
            const std::size_t vertices = builder_.mesh().positions.size();
            if (good && number >= 0 && number < static_cast<double>(vertices)
                && number == std::floor(number)) {
                const auto index = static_cast<std::uint32_t>(number);
                corners_.push_back({index, has_normals_ ? index : MeshCorner::no_normal});
            } else if (good) {
                good = false;
                report_.error(
                    place,
                    length,
                    fmt::format(
                        "there is no vertex {}: the file has {}, numbered from 0",
                        number,
                        counted(vertices, "vertex", "vertices")),
                    "the file is damaged: get another copy of it");
            }
        }
        if (!good || report_.any_error())
            return true;
        if (count < 3) {
            report_.error(
                start,
                1,
                fmt::format("expected three or more vertices of the face, found {}", count),
                "let the program that wrote the file export polygons");
            return true;
        }
        return builder_.add_face(corners_, start);
    }

    bool skip(const PlyProperty& property) {
        std::uint64_t count = 1;
        if (property.count_type && !take_count(count, property))
            return false;
        return values_.skip(property.type, count, property.name);
    }

    bool skip(const PlyElement& element) {
        // Without properties it takes no room, whatever its count.
        if (element.properties.empty())
            return true;
        for (std::uint64_t i = 0; i < element.count; ++i)
            for (const PlyProperty& property : element.properties)
                if (!skip(property))
                    return false;
        return true;
    }

    static constexpr std::size_t nowhere = 6;

    SourceReport report_;
    const PlyHeader& header_;
    MeshBuilder builder_;
    SpentText spent_;
    Values values_;
    std::vector<MeshCorner> corners_;
    bool has_normals_ = false;
};

} // namespace

Mesh read_ply(const SourceText& source, std::vector<Diagnostic>& warnings) {
    const PlyHeader header = read_ply_header(source);
    if (header.encoding == PlyHeader::Encoding::ascii)
        return PlyReader<AsciiValues>(source, header).read(warnings);
    return PlyReader<BinaryValues>(source, header).read(warnings);
}

} // namespace vera
