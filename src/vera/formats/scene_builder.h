// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/complaints.h"
#include "vera/formats/name_table.h"
#include "vera/formats/scene_file.h"
#include "vera/formats/scene_limits.h"
#include "vera/formats/statement_count.h"
#include "vera/formats/vera_statements.h"
#include "vera/scene/scene.h"

#include <array>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vera {

/// Puts a scene together from its statements in the order of the text: keeps the attributes that
/// hold, gives names their numbers, and checks what can only be checked with other statements in
/// view. The texts that places and names point into must outlive it.
class SceneBuilder {
public:
    SceneBuilder(Complaints& complaints, const SceneLimits& limits)
        : complaints_(complaints)
        , limits_(limits) {}

    /// What is added from now on stands in this text.
    void set_text(const SourceText& text);

    /// Geometry up to end_subscene belongs to the subscene; it starts without inner point and with
    /// the material of its caller.
    void begin_subscene(std::string_view name, const WordPlace& place);
    /// Goes back to the main scene, if not there already, and the attributes that held there.
    void end_subscene();

    bool in_subscene() const { return current_ != &main_; }

    /// Makes room in the current scene or subscene.
    void reserve(const StatementCounts& counts);

    void set_material(std::string_view name, const WordPlace& place);
    void set_inner_point(Vec3 point);
    void set_camera(const Camera& camera, const WordPlace& place);
    void add_light(const PointLight& light);
    /// The material to fill in; one of no use when the name is defined already.
    Material& begin_material(std::string_view name, const WordPlace& place);

    // The place is that of the statement's keyword.
    void add(const Sphere& sphere, const WordPlace& place);
    void add(const Triangle& triangle, const WordPlace& place);
    void add(const Patch& patch, const WordPlace& place);
    void add(RotationalShape shape, const WordPlace& place);
    /// One mesh of a file of that name. Parts that it names stand within one that has the file's.
    void add_mesh(const std::string& file, Geometry made, const WordPlace& place);
    void add_quadrangle(const std::array<Vec3, 4>& corners, const WordPlace& place);
    void add_polygon(const std::vector<Vec3>& corners, const WordPlace& place);
    void add_call(
        std::string_view name,
        const WordPlace& name_place,
        const Placement& placement,
        const WordPlace& place);
    void add_call(SubsceneId subscene, const Placement& placement, const WordPlace& place);

    /// Whether what is added now has a material, and not its caller's.
    bool has_material() const { return current_->material != inherited_material; }

    /// A subscene of what a generator made or a file holds, of which the text knows no name. Its
    /// materials are those of the text that have their names; where there are none, its own. Where
    /// another one brought a different material of that name, this one gets a number behind it.
    SubsceneId add_made_subscene(std::string name, Scene made, const WordPlace& place);

    /// The scene; if the complaints hold an error after the last checks, one without use.
    Scene finish();

private:
    /// A scene or subscene while it is being read.
    struct Section {
        Geometry* geometry;
        MaterialId material = inherited_material;
        std::optional<Vec3> inner_point = {};
        std::size_t first_with_inner_point = 0; ///< number of an item
    };

    void add_item(
        ItemKind kind,
        std::size_t index,
        const WordPlace& place,
        Outside outside = Outside::by_normal);
    Outside outside(Vec3 normal, Vec3 first_corner, const WordPlace& place);
    void add_plane_polygon(
        const Vec3* corners,
        std::size_t count,
        Polygon::Shape shape,
        Vec3 normal,
        Outside outside,
        const WordPlace& place);
    void add_split_quadrangle(const std::array<Vec3, 4>& corners, const WordPlace& place);
    Geometry& new_unnamed_subscene(SubsceneId& id);
    const Material& standard_material(Material material, const WordPlace& place);
    void define_standard_materials();
    void warn_no_area(const WordPlace& place, std::string_view what);
    void check_inner_point(const Section& section);
    void check_materials(const std::vector<std::size_t>& callees_first);
    std::vector<std::size_t> check_calls();
    void warn_of_idle_materials();

    Complaints& complaints_;
    SceneLimits limits_;
    Scene scene_;
    std::vector<const SourceText*> texts_; ///< in the order of Scene::files
    std::uint16_t file_ = 0;
    std::deque<Geometry> subscenes_; ///< whose addresses stay
    Geometry discarded_;             ///< what belongs to a subscene that is defined twice
    NameTable material_names_{"material"};
    NameTable subscene_names_{"subscene"};
    Material discarded_material_;
    /// Of generators and files, by name; material_names_ points at their names.
    std::map<std::string, std::pair<Material, WordPlace>> standard_materials_;
    std::optional<WordPlace> camera_place_;
    Section main_ = {.geometry = &scene_.geometry};
    Section subscene_ = {.geometry = &discarded_};
    Section* current_ = &main_;
};

} // namespace vera
