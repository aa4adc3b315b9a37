// SPDX-License-Identifier: Apache-2.0
// What the areas of a drawing are part of, as whoever edits it asks for: the objects of the scene,
// what they consist of, and the material of each.
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/scene/scene.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace vera {

/// Of each material of a scene, in their order: what it is called ("material-2" where the scene
/// gives the second one no name), and the class of its groups, which no other has and CSS can name
/// without escapes: "material-" and the name.
std::vector<std::shared_ptr<const DrawingMaterial>> drawing_materials(const Scene& scene);

/// Gives the groups of primitives in ascending order. An object is a statement of the main scene,
/// or of a file that is the main scene what it names: its id is "object-" and the number of its
/// first primitive, from 1, seen or not. In a call of a subscene, statements of it are groups
/// within, and so are parts that have names: "part-", within these "group-", and within these
/// "piece-", and the number of the first primitive. Of a part in which there are other parts or
/// several materials, what is in none of those parts and of one material is a group within. So the
/// innermost group has one material, and groups that hold groups hold nothing else. The same
/// statement with the same material is one group as long as nothing else comes between, as where a
/// call is repeated: its id is of the first that is asked for. So an id never names another thing
/// in another view. Statements of the main scene that stand in no text, as programs make them, are
/// one object while they are of one kind and material. A copy goes on from where it was copied.
/// Refers to the scene and its materials.
class ObjectGroups {
public:
    ObjectGroups(
        const Scene& scene, const std::vector<std::shared_ptr<const DrawingMaterial>>& materials)
        : scene_(&scene)
        , materials_(&materials) {}

    std::shared_ptr<const DrawingGroup> of(std::uint64_t primitive);

private:
    using Group = std::shared_ptr<const DrawingGroup>;

    /// Of primitives that follow each other.
    struct Run {
        std::uint64_t first = 0;
        std::uint64_t end = 0;

        bool contains(std::uint64_t primitive) const {
            return primitive >= first && primitive < end;
        }
    };

    /// A named part that groups stand in.
    struct OpenPart {
        std::uint32_t number = 0;
        std::uint64_t first = 0; ///< primitive
        Group group;
    };

    /// What is in the same parts of the same statement.
    struct Stretch {
        const Item* item = nullptr;
        Element first;
        std::uint32_t part = NamedPart::none; ///< number of the innermost one
        MaterialId material = inherited_material;

        friend bool operator==(const Stretch&, const Stretch&) = default;
    };

    void begin_stretch(std::uint64_t primitive);
    void begin_object(std::uint64_t primitive);
    bool is_one_with_last(const Stretch& stretch, bool is_other_object) const;
    void open_parts(const Geometry& geometry, std::uint64_t origin, bool is_leaf);
    Group made_group(
        std::uint64_t first, std::string name, MaterialId material, std::string given = {}) const;

    const Scene* scene_;
    const std::vector<std::shared_ptr<const DrawingMaterial>>* materials_;
    Run object_;
    Run run_; ///< of the stretch, where it is called this time
    Stretch stretch_;
    Group call_;                       ///< where the object is one
    std::vector<OpenPart> open_parts_; ///< from the outermost on
    Group group_;
};

} // namespace vera
