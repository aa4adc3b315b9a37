// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/obj_parts.h"

#include "vera/formats/mesh_file.h"
#include "vera/formats/mtl_file.h"
#include "vera/formats/similar_file.h"
#include "vera/formats/source_report.h"
#include "vera/formats/word_reader.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

namespace vera {

namespace {

/// Numbers points anew, in the order in which a run first needs them. Between runs only what was
/// used is cleared, so that many short ones cost no more than one long one.
class Renumbering {
public:
    explicit Renumbering(const std::vector<Vec3>& points)
        : points_(points)
        , numbers_(points.size(), unused) {}

    std::uint32_t number(std::uint32_t point, std::vector<Vec3>& taken) {
        std::uint32_t& number = numbers_[point];
        if (number == unused) {
            number = static_cast<std::uint32_t>(taken.size());
            taken.push_back(points_[point]);
            used_.push_back(point);
        }
        return number;
    }

    void clear() {
        for (const std::uint32_t point : used_)
            numbers_[point] = unused;
        used_.clear();
    }

private:
    static constexpr std::uint32_t unused = 0xffffffff;

    const std::vector<Vec3>& points_;
    std::vector<std::uint32_t> numbers_;
    std::vector<std::uint32_t> used_;
};

bool is_file(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(path, error);
}

/// Objects, and groups within them, made of runs of names, and the elements of the meshes that the
/// triangles have become.
class PartMaker {
public:
    explicit PartMaker(const Geometry& geometry)
        : geometry_(geometry) {}

    std::vector<NamedPart> make(const std::vector<ObjAttributes::NameRun>& runs) {
        ObjAttributes::NameRun last;
        for (const ObjAttributes::NameRun& run : runs) {
            go_to(run.first_triangle);
            const bool is_other = run.object != last.object;
            if (is_other || run.group != last.group)
                end(group_);
            if (is_other)
                end(object_);
            if (is_other)
                begin(object_, run.object);
            if (is_other || run.group != last.group)
                begin(group_, run.group);
            last = run;
        }
        at_ = {static_cast<std::uint32_t>(geometry_.items.size()), 0};
        end(group_);
        end(object_);
        return std::move(parts_);
    }

private:
    void go_to(std::size_t triangle) {
        for (;; ++at_.item) {
            const std::size_t end = first_of_mesh_ + geometry_.meshes[at_.item].triangle_count();
            if (triangle < end)
                break;
            first_of_mesh_ = end;
        }
        at_.triangle = static_cast<std::uint32_t>(triangle - first_of_mesh_);
    }

    void begin(std::uint32_t& part, std::string_view name) {
        if (name.empty())
            return;
        part = static_cast<std::uint32_t>(parts_.size());
        parts_.push_back({std::string(name), at_, at_, &part == &group_ ? object_ : none});
    }

    void end(std::uint32_t& part) {
        if (part != none)
            parts_[part].end = at_;
        part = none;
    }

    static constexpr std::uint32_t none = NamedPart::none;

    const Geometry& geometry_;
    std::vector<NamedPart> parts_;
    Element at_;
    std::size_t first_of_mesh_ = 0; ///< triangle of the file
    std::uint32_t object_ = none;   ///< number of the part that goes on
    std::uint32_t group_ = none;
};

class PartReader {
public:
    PartReader(const SourceText& source, std::vector<Diagnostic>& warnings, ObjMaterials materials)
        : source_(source)
        , warnings_(warnings)
        , materials_(materials)
        , folder_(std::filesystem::path(source.name()).parent_path()) {
        if (folder_.empty())
            folder_ = "."; // so that no file name is taken for standard input
    }

    Scene read() {
        Mesh mesh = read_obj(source_, warnings_, said_);
        if (materials_ == ObjMaterials::none)
            leave_materials_out();
        if (said_.materials_left_out) {
            warn(
                said_.material_runs.back().offset,
                fmt::format(
                    "the material changes more than {} times: none of the file is taken",
                    most_material_runs),
                "order the faces by material");
            leave_materials_out();
        }
        if (said_.names_left_out_at) {
            warn(
                *said_.names_left_out_at,
                fmt::format(
                    "objects and groups (o and g) change more than {} times: none is taken",
                    most_name_runs),
                "order the faces by object and group");
            said_.name_runs.clear();
        }
        for (const std::string_view names : said_.libraries)
            read_libraries(names);
        choose_materials();
        add_meshes(std::move(mesh));
        scene_.geometry.named_parts = PartMaker(scene_.geometry).make(said_.name_runs);
        return std::move(scene_);
    }

private:
    void warn(std::size_t offset, std::string problem, std::string remedy) {
        warnings_.push_back(source_.diagnostic(
            Severity::warning, offset, 1, std::move(problem), std::move(remedy)));
    }

    void leave_materials_out() {
        said_.libraries.clear();
        said_.materials.clear();
        said_.material_runs.clear();
        said_.materials_left_out = false;
    }

    std::size_t offset_of(std::string_view part) const {
        return static_cast<std::size_t>(part.data() - source_.text().data());
    }

    /// The line is the name of one file, blanks and all, or the names of several and a comment.
    void read_libraries(std::string_view names) {
        if (is_file(folder_ / names) || names.find_first_of(" \t") == std::string_view::npos)
            return read_library(names);
        while (!names.empty() && names.front() != '#') {
            const std::size_t end = std::min(names.find_first_of(" \t"), names.size());
            if (end > 0)
                read_library(names.substr(0, end));
            names.remove_prefix(std::min(end + 1, names.size()));
        }
    }

    static std::string problem_of(std::string_view name, const std::filesystem::path& path) {
        std::error_code error;
        if (std::filesystem::exists(path, error))
            return fmt::format("{} is not a file", shown(name));
        const std::string similar = similar_file(path, " (");
        return fmt::format(
            "there is no file {}{}{}", shown(name), similar, similar.empty() ? "" : ")");
    }

    void read_library(std::string_view name) {
        std::filesystem::path path = (folder_ / name).lexically_normal();
        if (path == "-")
            path = folder_ / name;
        if (!read_.insert(path).second)
            return;
        if (!is_file(path)) {
            missing_.add(offset_of(name));
            // The first few say enough.
            constexpr std::size_t most_told = 3;
            if (missing_.count <= most_told)
                warn(
                    offset_of(name),
                    fmt::format("{}: its materials have default colours", problem_of(name, path)),
                    "put it into the folder of the OBJ file");
            return;
        }
        const SourceText text(path);
        scene_.files.push_back(path.string());
        for (Material& material : read_mtl(text, warnings_))
            defined_.emplace(material.name, std::move(material));
    }

    /// Those that have triangles, of the file or of default colours.
    void choose_materials() {
        std::size_t undefined = 0;
        std::string_view first;
        for (const std::string_view name : said_.materials) {
            const auto found = defined_.find(std::string(name));
            if (found == defined_.end() && undefined++ == 0)
                first = name;
            Material material = found == defined_.end() ? Material::fallback() : found->second;
            material.name = name;
            scene_.materials.push_back(std::move(material));
        }
        if (undefined == 0 || missing_.count > 0)
            return;
        warn(
            offset_of(first),
            said_.libraries.empty()
                ? "no 'mtllib' names a file that defines materials: they have default colours"
                : fmt::format(
                    "{} in no file that 'mtllib' names, the first of them here: default colours",
                    counted(undefined, "material is", "materials are")),
            said_.libraries.empty() ? "write 'mtllib FILE.mtl', or 'CM NAME' before MESH in a scene"
                                    : "define it there with 'newmtl'");
    }

    void add_meshes(Mesh mesh) {
        Geometry& geometry = scene_.geometry;
        if (said_.material_runs.size() > 1) {
            std::vector<std::uint32_t> ends;
            for (std::size_t i = 1; i < said_.material_runs.size(); ++i)
                ends.push_back(said_.material_runs[i].first_triangle);
            ends.push_back(static_cast<std::uint32_t>(mesh.triangle_count()));
            geometry.meshes = split_mesh(mesh, ends);
        } else {
            geometry.meshes.push_back(std::move(mesh));
        }
        std::uint32_t line = 1;
        std::size_t counted_to = 0;
        for (std::uint32_t i = 0; i < geometry.meshes.size(); ++i) {
            Item item = {.kind = ItemKind::mesh, .index = i};
            if (!said_.material_runs.empty()) {
                const ObjAttributes::MaterialRun& run = said_.material_runs[i];
                const std::string_view before =
                    source_.text().substr(counted_to, run.offset - counted_to);
                line += static_cast<std::uint32_t>(std::ranges::count(before, '\n'));
                counted_to = run.offset;
                if (run.material != ObjAttributes::none)
                    item.material = MaterialId{run.material};
            }
            item.line = line;
            geometry.items.push_back(item);
        }
    }

    const SourceText& source_;
    std::vector<Diagnostic>& warnings_;
    ObjMaterials materials_;
    std::filesystem::path folder_;
    ObjAttributes said_;
    std::set<std::filesystem::path> read_;
    std::unordered_map<std::string, Material> defined_; ///< of two with one name the first
    Tally missing_;                                     ///< files
    Scene scene_;
};

} // namespace

std::vector<Mesh> split_mesh(const Mesh& mesh, std::span<const std::uint32_t> ends) {
    // Normals without indices of their own have those of the positions.
    const bool has_own = !mesh.normal_indices.empty();
    const bool has_shared = !has_own && !mesh.normals.empty();
    Renumbering positions(mesh.positions);
    Renumbering normals(mesh.normals);
    std::vector<Mesh> parts;
    std::size_t i = 0;
    for (const std::uint32_t end : ends) {
        Mesh& part = parts.emplace_back();
        part.position_indices.reserve(3 * std::size_t{end} - i);
        for (; i < 3 * std::size_t{end}; ++i) {
            const std::uint32_t position = mesh.position_indices[i];
            part.position_indices.push_back(positions.number(position, part.positions));
            if (has_shared)
                normals.number(position, part.normals);
            else if (has_own)
                part.normal_indices.push_back(normals.number(mesh.normal_indices[i], part.normals));
        }
        positions.clear();
        normals.clear();
    }
    return parts;
}

Scene read_obj_parts(
    const SourceText& source, std::vector<Diagnostic>& warnings, ObjMaterials materials) {
    return PartReader(source, warnings, materials).read();
}

} // namespace vera
