// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/scene_writer.h"

#include "vera/base/check.h"
#include "vera/base/long_loop.h"
#include "vera/formats/vera_keywords.h"

#include <algorithm>
#include <set>
#include <vector>

#include <fmt/format.h>

namespace vera {

namespace {

using Text = fmt::memory_buffer;

template <typename... Values>
void append(Text& text, fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text), format, std::forward<Values>(values)...);
}

void append(Text& text, std::string_view word) {
    text.append(word.data(), word.data() + word.size());
}

void append(Text& text, Vec3 a) {
    append(text, " {} {} {}", a.x, a.y, a.z);
}

void append(Text& text, Color a) {
    append(text, " {} {} {}", a.r, a.g, a.b);
}

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_name(std::string_view name) {
    const auto fits = [](char c) {
        return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-';
    };
    return !name.empty() && is_letter(name[0]) && std::all_of(name.begin(), name.end(), fits)
        && std::find(scene_words.begin(), scene_words.end(), name) == scene_words.end();
}

/// For each of these things a name of its own that the language takes.
template <typename Things>
std::vector<std::string> names_of(const Things& things, std::string_view sort) {
    std::vector<std::string> names;
    std::set<std::string> taken;
    for (const auto& thing : things) {
        std::string name = is_name(thing.name) ? thing.name : std::string(sort);
        const std::string stem = name;
        for (std::size_t i = 2; !taken.insert(name).second; ++i)
            name = fmt::format("{}-{}", stem, i);
        names.push_back(std::move(name));
    }
    return names;
}

/// How many statements tell the geometry: one for each item, but of a mesh for each triangle.
std::size_t statement_count(const Geometry& geometry) {
    std::size_t count = geometry.items.size() - geometry.meshes.size();
    for (const Mesh& mesh : geometry.meshes)
        count += mesh.position_indices.size() / 3;
    return count;
}

std::size_t statement_count(const Scene& scene) {
    std::size_t count = (scene.camera ? 1 : 0) + scene.lights.size() + scene.materials.size()
        + statement_count(scene.geometry);
    for (const Geometry& geometry : scene.subscenes)
        count += statement_count(geometry);
    return count;
}

class SceneWriter {
public:
    SceneWriter(
        const Scene& scene,
        const std::function<void(std::string_view)>& write,
        const Progress& progress,
        const CancelFlag* cancel)
        : scene_(scene)
        , write_(write)
        , progress_(progress)
        , cancel_(cancel)
        , statements_(statement_count(scene))
        , materials_(names_of(scene.materials, "material"))
        , subscenes_(names_of(scene.subscenes, "part")) {}

    void write() {
        if (scene_.camera)
            append_camera(*scene_.camera);
        for (const PointLight& light : scene_.lights)
            append_light(light);
        for (std::size_t i = 0; i < scene_.materials.size(); ++i)
            append_material(scene_.materials[i], materials_[i]);
        // Before the first SCENE all belongs to the main scene.
        append_geometry(scene_.geometry);
        for (std::size_t i = 0; i < scene_.subscenes.size(); ++i) {
            append(text_, "\nSCENE {}\n", subscenes_[i]);
            append_geometry(scene_.subscenes[i]);
        }
        flush();
    }

private:
    void flush() {
        stop_if_raised(cancel_);
        write_({text_.data(), text_.size()});
        text_.clear();
        if (progress_ && statements_ > 0)
            progress_(static_cast<double>(written_) / static_cast<double>(statements_));
    }

    void end_statement() {
        append(text_, "\n");
        ++written_;
        constexpr std::size_t enough = 1U << 16U;
        if (text_.size() > enough)
            flush();
    }

    void append_camera(const Camera& camera) {
        if (camera.projection == Camera::Projection::parallel) {
            append(text_, "PARALLEL  ");
            append(text_, camera.direction);
        } else {
            append(text_, "PROJECTION");
            append(text_, camera.viewpoint);
        }
        for (const Vec3 corner : {camera.lower_left, camera.lower_right, camera.upper_left}) {
            append(text_, "\n          ");
            append(text_, corner);
        }
        end_statement();
    }

    void append_light(const PointLight& light) {
        VERA_CHECK(light.falloff == Falloff::inverse_square);
        append(text_, "LI");
        append(text_, light.position);
        append(text_, "  {} ", light.intensity);
        append(text_, light.color);
        end_statement();
    }

    void append_material(const Material& material, const std::string& name) {
        append(text_, "MA {}", name);
        const auto color = [&](const char* property, Color value) {
            if (value == Color{})
                return;
            append(text_, "  {}", property);
            append(text_, value);
        };
        color("DRF", material.drf);
        color("ARF", material.arf);
        color("SDI", material.sdi);
        color("SAN", material.san);
        color("RAB", material.rab);
        color("TAB", material.tab);
        if (material.spc != 1)
            append(text_, "  SPC {}", material.spc);
        if (material.ref != 1)
            append(text_, "  REF {}", material.ref);
        end_statement();
    }

    void append_geometry(const Geometry& geometry) {
        MaterialId material = inherited_material;
        for (const Item& item : geometry.items) {
            VERA_CHECK(item.outside == Outside::by_normal);
            if (item.material != material) {
                VERA_CHECK(item.material != inherited_material);
                material = item.material;
                append(text_, "CM {}\n", materials_[static_cast<std::size_t>(material)]);
            }
            append_item(geometry, item);
        }
    }

    void append_item(const Geometry& geometry, const Item& item) {
        switch (item.kind) {
        case ItemKind::sphere:
            append(text_, "SP");
            append(text_, geometry.spheres[item.index].center);
            append(text_, "  {}", geometry.spheres[item.index].radius);
            return end_statement();
        case ItemKind::triangle:
            return append_triangle(geometry.triangles[item.index].corners);
        case ItemKind::polygon:
            return append_polygon(geometry, geometry.polygons[item.index]);
        case ItemKind::patch:
            return append_patch(geometry.patches[item.index]);
        case ItemKind::rotational_shape:
            return append_rotational_shape(geometry.rotational_shapes[item.index]);
        case ItemKind::mesh:
            return append_mesh(geometry.meshes[item.index]);
        case ItemKind::subscene_call:
            return append_call(geometry.calls[item.index]);
        }
    }

    void append_triangle(const std::array<Vec3, 3>& corners) {
        append(text_, "P3");
        for (const Vec3 corner : corners)
            append(text_, corner);
        end_statement();
    }

    void append_patch(const Patch& patch) {
        append(text_, "PA");
        for (const Vec3 corner : patch.corners)
            append(text_, corner);
        for (const Vec3 normal : patch.normals)
            append(text_, normal);
        end_statement();
    }

    void append_polygon(const Geometry& geometry, const Polygon& polygon) {
        if (polygon.corner_count == 4)
            append(text_, "P4");
        else
            append(text_, "PN {}", polygon.corner_count);
        for (std::uint32_t i = 0; i < polygon.corner_count; ++i)
            append(text_, geometry.corners[polygon.first_corner + i]);
        end_statement();
    }

    void append_rotational_shape(const RotationalShape& shape) {
        append(text_, "RS");
        append(text_, shape.base);
        append(text_, "  V");
        append(text_, shape.axis);
        append(text_, "  AN {} {}", shape.start.r, shape.start.h);
        for (const ContourPiece& piece : shape.contour) {
            const auto& [a, b] = piece.control;
            switch (piece.kind) {
            case ContourPiece::Kind::line:
                append(text_, "  GE");
                break;
            case ContourPiece::Kind::conic:
                append(text_, "  KE {} {} {}", a.r, a.h, piece.weight);
                break;
            case ContourPiece::Kind::cubic:
                append(text_, "  KU {} {} {} {}", a.r, a.h, b.r, b.h);
                break;
            }
            append(text_, " {} {}", piece.end.r, piece.end.h);
        }
        end_statement();
    }

    void append_mesh(const Mesh& mesh) {
        const auto& normal_indices =
            mesh.normal_indices.empty() ? mesh.position_indices : mesh.normal_indices;
        for (std::size_t i = 0; i < mesh.position_indices.size(); i += 3) {
            Patch patch;
            for (std::size_t c = 0; c < 3; ++c) {
                patch.corners[c] = mesh.positions[mesh.position_indices[i + c]];
                if (!mesh.normals.empty())
                    patch.normals[c] = mesh.normals[normal_indices[i + c]];
            }
            if (mesh.normals.empty())
                append_triangle(patch.corners);
            else
                append_patch(patch);
        }
    }

    void append_call(const SubsceneCall& call) {
        append(text_, "SSC {}", subscenes_[static_cast<std::size_t>(call.subscene)]);
        const Affine3& map = call.to_parent;
        if (map.linear != Matrix3{}) {
            append(text_, "  MX");
            for (std::size_t row = 0; row < 3; ++row) {
                append(text_, map.linear.rows[row]);
                append(text_, " {} ", map.translation[row]);
            }
        } else if (map.translation != Vec3{}) {
            append(text_, "  TR");
            append(text_, map.translation);
        }
        end_statement();
    }

    const Scene& scene_;
    const std::function<void(std::string_view)>& write_;
    const Progress& progress_;
    const CancelFlag* cancel_;
    std::size_t statements_;
    std::size_t written_ = 0; ///< of the statements
    std::vector<std::string> materials_;
    std::vector<std::string> subscenes_;
    Text text_;
};

} // namespace

void write_vera_scene(
    const Scene& scene,
    const std::function<void(std::string_view)>& write,
    const Progress& progress,
    const CancelFlag* cancel) {
    SceneWriter(scene, write, progress, cancel).write();
}

std::string vera_scene_text(const Scene& scene) {
    std::string text;
    write_vera_scene(scene, [&](std::string_view part) { text += part; });
    return text;
}

} // namespace vera
