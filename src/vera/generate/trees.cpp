// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/trees.h"

#include "vera/generate/chance.h"
#include "vera/generate/leaf.h"
#include "vera/generate/scene_parts.h"

#include <cmath>

#include <fmt/format.h>

namespace vera {

namespace {

struct TreeForm {
    std::size_t levels = 7;
    std::size_t limbs = 3;
    std::size_t leaves = 12;
    double spread_degrees = 36;
    std::size_t variants = 4;
    std::uint64_t seed = 1;
};

/// Branches are 1 long and so thick at their beginning; those they carry are smaller copies.
constexpr double thickness = 0.085;
constexpr double leader_ratio = 0.80; ///< size of the branch that goes on, by the one below it
constexpr double limb_ratio = 0.70;
constexpr double golden_turn = 137.50776405003785; // degrees

struct TreeParts {
    MaterialId bark;
    MaterialId foliage;
    SubsceneId leaf;
};

TreeParts add_tree_parts(Scene& scene) {
    TreeParts parts = {};
    parts.bark = add_material(scene, "tree-bark", {0.36, 0.27, 0.19});
    parts.foliage = add_material(scene, "tree-leaf", {0.44, 0.64, 0.19});
    scene.materials.back().arf = {0.06, 0.10, 0.02};
    scene.materials.back().sdi = {0.03, 0.06, 0.01};
    parts.leaf = add_subscene(scene, "tree-leaf-blade");
    add(geometry_of(scene, parts.leaf),
        leaf_blade({.half_width = 0.26, .droop = 0.3, .waves = 0, .rows = 6, .columns = 1}));
    return parts;
}

/// The part of a branch that carries smaller ones: wood, and for the last level leaves.
SubsceneId add_branch(
    Scene& scene,
    const TreeParts& parts,
    const TreeForm& form,
    std::size_t level,
    std::size_t variant) {
    const SubsceneId branch = add_subscene(scene, fmt::format("tree-{}-{}", level, variant + 1));
    Geometry& geometry = geometry_of(scene, branch);
    const double tip_radius = leader_ratio * thickness;
    add(geometry, cone_between({}, thickness, {0, 1, 0}, tip_radius), parts.bark);
    add(geometry, Sphere{{0, 1, 0}, tip_radius}, parts.bark);
    if (level > 0)
        return branch;
    Chance chance(form.seed, variant);
    for (std::size_t i = 0; i < form.leaves; ++i) {
        const double place = (static_cast<double>(i) + 1) / static_cast<double>(form.leaves);
        const double turn = golden_turn * static_cast<double>(i) + chance.between(-20, 20);
        // One after the other: compilers differ in which argument comes first.
        const double lean = chance.between(35, 75);
        const double size = chance.between(0.8, 1.2);
        const Affine3 map = in_turn(
            scaling(size),
            rotation({lean, 0, 0}),
            rotation({0, turn, 0}),
            translation({0, 0.25 + 0.75 * place, 0}));
        add_call(geometry, parts.leaf, short_decimals(map), parts.foliage);
    }
    return branch;
}

/// The trunks of so many different trees, each of a few branches of the level below it, and so on
/// down to twigs.
std::vector<SubsceneId> add_trees(Scene& scene, const TreeForm& form) {
    const TreeParts parts = add_tree_parts(scene);
    std::vector<SubsceneId> smaller;
    for (std::size_t level = 0; level <= form.levels; ++level) {
        std::vector<SubsceneId> branches;
        for (std::size_t variant = 0; variant < form.variants; ++variant) {
            const SubsceneId branch = add_branch(scene, parts, form, level, variant);
            branches.push_back(branch);
            if (level == 0)
                continue;
            Chance chance(form.seed, 1000 * level + variant);
            const double start = chance.between(0, 360);
            for (std::size_t i = 0; i < form.limbs; ++i) {
                // One goes on nearly straight, the others lean away all round, and begin lower.
                const bool leader = i == 0;
                const double lean = leader ? chance.between(2, 14)
                                           : form.spread_degrees * chance.between(0.8, 1.25);
                const double turn = start
                    + 360.0 / static_cast<double>(form.limbs - 1) * static_cast<double>(i)
                    + chance.between(-25, 25);
                const double size =
                    (leader ? leader_ratio : limb_ratio) * chance.between(0.93, 1.0);
                const double height = leader ? 1 : chance.between(0.72, 0.98);
                const Affine3 map = in_turn(
                    scaling(size),
                    rotation({0, chance.between(0, 360), 0}),
                    rotation({lean, 0, 0}),
                    rotation({0, turn, 0}),
                    translation({0, height, 0}));
                add_call(
                    geometry_of(scene, branch),
                    smaller[chance.below(smaller.size())],
                    short_decimals(map),
                    parts.bark);
            }
        }
        smaller = std::move(branches);
    }
    return smaller;
}

} // namespace

Scene make_tree(const ParameterValues& values) {
    Scene scene;
    const auto trees = add_trees(
        scene,
        {.levels = values.whole("levels"),
         .limbs = values.whole("limbs"),
         .leaves = values.whole("leaves"),
         .spread_degrees = values["spread"],
         .variants = values.whole("variants"),
         .seed = values.whole("seed")});
    add_call(scene.geometry, trees.front(), {});
    remove_unused_subscenes(scene);
    return scene;
}

Scene make_forest(const ParameterValues& values) {
    Scene scene;
    const std::uint64_t seed = values.whole("seed");
    const auto trees = add_trees(
        scene,
        {.levels = values.whole("levels"),
         .leaves = values.whole("leaves"),
         .variants = values.whole("variants"),
         .seed = seed});
    constexpr double spacing = 4;
    const std::size_t rows = values.whole("rows");
    const double first = -0.5 * spacing * static_cast<double>(rows - 1);
    for (std::size_t i = 0; i < rows * rows; ++i) {
        Chance chance(seed + 1, i);
        const std::size_t whole_rows = i / rows;
        const auto row = static_cast<double>(whole_rows);
        const auto column = static_cast<double>(i % rows);
        const Vec3 place = {
            first + spacing * column + chance.between(-1.3, 1.3),
            0,
            first + spacing * row + chance.between(-1.3, 1.3)};
        const Vec3 turn = {chance.between(-3, 3), chance.between(0, 360), chance.between(-3, 3)};
        const double size = chance.between(0.7, 1.2);
        const Affine3 map = in_turn(scaling(size), rotation(turn), translation(place));
        add_call(scene.geometry, trees[chance.below(trees.size())], short_decimals(map));
    }
    remove_unused_subscenes(scene);
    return scene;
}

} // namespace vera
