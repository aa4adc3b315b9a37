// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/mesh_builder.h"
#include "vera/formats/mesh_file.h"
#include "vera/formats/obj_parts.h"
#include "vera/formats/statement_line.h"
#include "vera/formats/text_cursor.h"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

namespace vera {

namespace {

constexpr std::array<std::string_view, 26> passed_over = {
    "vt",   "vp",       "s",        "usemap", "maplib",     "p",      "l",   "mg",        "bevel",
    "lod",  "d_interp", "c_interp", "call",   "shadow_obj", "cstype", "deg", "trace_obj", "bmat",
    "step", "parm",     "trim",     "hole",   "scrv",       "sp",     "end", "con"};

constexpr std::array<std::string_view, 3> free_form = {"curv", "curv2", "surf"};

template <std::size_t Count>
bool is_one_of(const std::array<std::string_view, Count>& words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

class ObjReader {
public:
    explicit ObjReader(const SourceText& source)
        : report_(source)
        , cursor_(report_, TextCursor::Lines::continue_behind_backslash)
        , builder_(report_)
        , spent_(source) {}

    Mesh read(std::vector<Diagnostic>& warnings, ObjAttributes& attributes) {
        reserve();
        while (!at_end())
            read_line();
        warn();
        end_material_run();
        end_name_run();
        attributes = std::move(attributes_);
        return builder_.finish(warnings);
    }

    std::vector<std::uint32_t> triangle_lines() {
        std::vector<std::uint32_t> lines;
        const std::string_view text = report_.source().text();
        std::uint32_t line = 1;
        while (!at_end()) {
            const std::size_t start = cursor_.offset();
            read_line();
            lines.resize(builder_.mesh().triangle_count(), line);
            const std::string_view read = text.substr(start, cursor_.offset() - start);
            line += static_cast<std::uint32_t>(std::ranges::count(read, '\n'));
        }
        return lines;
    }

private:
    bool at_end() const { return cursor_.at_end() || report_.full(); }

    void read_line() {
        read_statement_line(cursor_, [&] { read_statement(); });
        spent_.up_to(cursor_.offset());
    }

    /// Counts the vertices and faces beforehand: that takes a small part of the time that reading
    /// them takes, and nothing has to be copied while the mesh grows.
    void reserve() {
        std::size_t positions = 0;
        std::size_t normals = 0;
        std::size_t triangles = 0;
        TextCursor counter = cursor_;
        for (; !counter.at_end(); counter.skip_line()) {
            const char first = counter.peek();
            if (first == 'f') {
                const std::string_view line = counter.rest_of_line();
                triangles += corner_count(line) - 2;
                counter.pass(line);
            } else if (first == 'v') {
                counter.step();
                positions += counter.peek() == ' ' ? 1 : 0;
                normals += counter.peek() == 'n' ? 1 : 0;
            }
        }
        // No line holds a point in less than "v 0 0 0".
        const std::size_t most = report_.source().text().size() / 8;
        builder_.reserve(std::min(positions, most), std::min(normals, most), triangles);
    }

    /// As many as the line of a face has blanks, at least 3, at most what there is room for.
    static std::size_t corner_count(std::string_view line) {
        const auto blanks = static_cast<std::size_t>(std::count(line.begin(), line.end(), ' '));
        return std::max<std::size_t>(std::min(blanks, line.size() / 2), 3);
    }

    void read_statement() {
        const std::size_t start = cursor_.offset();
        const std::string_view keyword = cursor_.word();
        cursor_.pass(keyword);
        if (keyword == "v") {
            read_point(builder_.mesh().positions, "the vertex", start);
        } else if (keyword == "f" || keyword == "fo") {
            read_face(start);
        } else if (keyword == "vn") {
            read_point(builder_.mesh().normals, "the normal", start);
        } else if (keyword == "usemtl") {
            begin_material_run(start);
        } else if (keyword == "g") {
            begin_name_run({0, name_run_.object, cursor_.name_of_line()}, start);
        } else if (keyword == "o") {
            // What follows is in no group of the object before.
            begin_name_run({0, cursor_.name_of_line(), {}}, start);
        } else if (keyword == "mtllib") {
            take_libraries();
        } else if (!keyword.empty()) {
            if (is_one_of(free_form, keyword))
                free_form_.add(start);
            else if (!is_one_of(passed_over, keyword))
                unknown_.add(start);
        }
    }

    /// What stands on this line and on those that continue it, of which a comment is the end.
    void take_libraries() {
        bool continues = true;
        while (continues) {
            std::string_view names = cursor_.name_of_line();
            continues = names.ends_with('\\') && names.find('#') == std::string_view::npos;
            if (continues)
                names = names.substr(0, names.find_last_not_of(" \t\\") + 1);
            if (!names.empty())
                attributes_.libraries.push_back(names);
            if (continues)
                cursor_.skip_comment(); // the line and nothing else
        }
        cursor_.pass(cursor_.rest_of_line());
    }

    /// Faces from here on have the material of that name.
    void begin_material_run(std::size_t start) {
        const std::string_view name = cursor_.name_of_line();
        if (name.empty() || attributes_.materials_left_out)
            return;
        end_material_run();
        material_run_ = {triangle_count(), ObjAttributes::none, start};
        material_name_ = name;
    }

    /// A run without triangles is none, and two that follow each other with one material are one.
    void end_material_run() {
        std::vector<ObjAttributes::MaterialRun>& runs = attributes_.material_runs;
        if (material_run_.first_triangle == triangle_count() || material_name_.empty()
            || (!runs.empty() && runs.back().material != ObjAttributes::none
                && attributes_.materials[runs.back().material] == material_name_))
            return;
        if (runs.empty() && material_run_.first_triangle > 0)
            runs.push_back({}); // before the first usemtl
        const auto [found, is_new] = material_numbers_.try_emplace(
            material_name_, static_cast<std::uint32_t>(material_numbers_.size()));
        if (is_new)
            attributes_.materials.push_back(material_name_);
        material_run_.material = found->second;
        runs.push_back(material_run_);
        attributes_.materials_left_out = runs.size() > most_material_runs;
    }

    /// Faces from here on are of that object and group.
    void begin_name_run(const ObjAttributes::NameRun& names, std::size_t start) {
        if (attributes_.names_left_out_at)
            return;
        end_name_run();
        if (attributes_.name_runs.size() > most_name_runs)
            attributes_.names_left_out_at = start;
        name_run_ = names;
        name_run_.first_triangle = triangle_count();
    }

    /// As for materials.
    void end_name_run() {
        std::vector<ObjAttributes::NameRun>& runs = attributes_.name_runs;
        const ObjAttributes::NameRun before = runs.empty() ? ObjAttributes::NameRun() : runs.back();
        if (name_run_.first_triangle < triangle_count()
            && (name_run_.object != before.object || name_run_.group != before.group))
            runs.push_back(name_run_);
    }

    std::uint32_t triangle_count() {
        return static_cast<std::uint32_t>(builder_.mesh().triangle_count());
    }

    /// What follows a vertex's coordinates on the line, a weight or a colour, is passed over.
    void read_point(std::vector<Vec3>& points, std::string_view what, std::size_t start) {
        Vec3 point;
        // One that cannot be read is kept all the same, so that those behind it keep their numbers.
        cursor_.take_point(point, what);
        if (builder_.room_for_another(points, start))
            points.push_back(point);
        else
            stop();
    }

    void read_face(std::size_t start) {
        corners_.clear();
        while (!cursor_.at_line_end() && cursor_.peek() != '#') {
            if (!take_corner(corners_.emplace_back()))
                return;
        }
        if (corners_.size() < 3)
            report_.error(
                cursor_.offset(),
                1,
                fmt::format(
                    "expected three or more vertices of the face, found {}", corners_.size()),
                "write 'f 1 2 3'");
        else if (!report_.any_error() && !builder_.add_face(corners_, start))
            stop();
    }

    /// position, position/texture, position//normal or position/texture/normal. No optional: that
    /// would be put together in memory, which takes longer than to read short numbers.
    bool take_corner(MeshCorner& corner) {
        const Mesh& mesh = builder_.mesh();
        if (!take_number(corner.position, mesh.positions.size(), "vertex", "v"))
            return false;
        if (cursor_.peek() != '/')
            return ends_word();
        cursor_.step();
        if (cursor_.peek() == '-' || cursor_.peek() == '+')
            cursor_.step();
        cursor_.taken_digits();
        if (cursor_.peek() == '/') {
            cursor_.step();
            if (!take_number(corner.normal, mesh.normals.size(), "normal", "vn"))
                return false;
        }
        return ends_word();
    }

    static bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }

    bool ends_word() {
        const char next = cursor_.peek();
        if (cursor_.at_end() || next == ' ' || next == '\n' || next == '\t' || next == '\r'
            || next == '\\')
            return true;
        cursor_.expected(
            "a blank behind the vertex of a face",
            "a corner is written 1, 1/2, 1//3 or 1/2/3: vertex, texture, normal");
        return false;
    }

    /// A number from 1 on, or from -1 backwards from what has been read last.
    bool
    take_number(std::uint32_t& index, std::size_t count, const char* thing, const char* keyword) {
        const std::size_t start = cursor_.offset();
        const bool backwards = cursor_.peek() == '-';
        if (backwards || cursor_.peek() == '+')
            cursor_.step();
        const std::uint64_t number = cursor_.taken_digits();
        if (number == 0 || number > count) {
            complain_of_index(start, count, thing, keyword);
            return false;
        }
        index = static_cast<std::uint32_t>(backwards ? count - number : number - 1);
        return true;
    }

    void complain_of_index(
        std::size_t start, std::size_t count, const char* thing, const char* keyword) {
        const std::size_t length = cursor_.offset() - start;
        const std::string_view written = report_.source().text().substr(start, length);
        if (written.empty() || !is_digit(written.back()))
            return cursor_.expected(
                fmt::format("the number of a {} of the face", thing),
                "a corner is written 1, 1/2, 1//3 or 1/2/3: vertex, texture, normal");
        report_.error(
            start,
            length,
            fmt::format(
                "there is no {} {}: {} '{}' before this face",
                thing,
                written.substr(0, 40),
                counted(count, "line begins with", "lines begin with"),
                keyword),
            fmt::format(
                "the first '{0}' has the number 1, and the last before the face the number -1",
                keyword));
    }

    void warn() {
        if (free_form_.count > 0)
            report_.warning(
                free_form_.first,
                1,
                fmt::format(
                    "free-form curves and surfaces are left out ({})",
                    counted(free_form_.count, "statement", "statements")),
                "let the program that wrote the file export polygons");
        if (unknown_.count > 0)
            report_.warning(
                unknown_.first,
                1,
                fmt::format(
                    "{} unknown, the first of them here, and left out",
                    counted(unknown_.count, "statement is", "statements are")));
    }

    /// There is no use in reading on.
    void stop() {
        while (!cursor_.at_end())
            cursor_.skip_line();
    }

    SourceReport report_;
    TextCursor cursor_;
    MeshBuilder builder_;
    SpentText spent_;
    std::vector<MeshCorner> corners_;
    ObjAttributes attributes_;
    ObjAttributes::MaterialRun material_run_; ///< that which goes on
    std::string_view material_name_;
    std::unordered_map<std::string_view, std::uint32_t> material_numbers_; ///< by name
    ObjAttributes::NameRun name_run_;                                      ///< that which goes on
    Tally free_form_;
    Tally unknown_;
};

} // namespace

Mesh read_obj(const SourceText& source, std::vector<Diagnostic>& warnings) {
    ObjAttributes left_out;
    return read_obj(source, warnings, left_out);
}

Mesh read_obj(
    const SourceText& source, std::vector<Diagnostic>& warnings, ObjAttributes& attributes) {
    return ObjReader(source).read(warnings, attributes);
}

std::vector<std::uint32_t> obj_triangle_lines(const SourceText& source) {
    return ObjReader(source).triangle_lines();
}

} // namespace vera
