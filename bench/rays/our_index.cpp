// SPDX-License-Identifier: Apache-2.0
#include "our_index.h"

#include "vera/base/check.h"

#include <algorithm>

#include "float_query.h"
#include "scene_query.h"
#include <fmt/format.h>

namespace vera {

namespace {

/// How an index is made, and whether it is measured unless another is named.
struct Recipe {
    const char* name;
    bool usual;
    std::unique_ptr<OurIndex> (*make)(const IndexInput& input);
};

/// Every index that there is: a further one is a line here.
constexpr Recipe recipes[] = {
    {"mesh", true, [](const IndexInput& input) { return mesh_of(input, IndexQuality::usual); }},
    {"mesh_high",
     false,
     [](const IndexInput& input) { return mesh_of(input, IndexQuality::high); }},
    {"spheres",
     true,
     [](const IndexInput& input) { return spheres_of(input, IndexQuality::usual); }},
    {"spheres_high",
     false,
     [](const IndexInput& input) { return spheres_of(input, IndexQuality::high); }},
    {"bvh", true, [](const IndexInput& input) { return bvh_of(input.scene); }},
    {"grid", true, [](const IndexInput& input) { return grid_of(input.scene); }},
    {"brute", false, [](const IndexInput& input) { return brute_force_of(input.scene); }}};

template <typename Predicate>
std::vector<std::string> names_where(const Predicate& wanted) {
    std::vector<std::string> names;
    for (const Recipe& recipe : recipes)
        if (wanted(recipe))
            names.emplace_back(recipe.name);
    return names;
}

} // namespace

std::string name_of(OurCall call, std::size_t generation) {
    switch (call) {
    case OurCall::generation:
        return fmt::format("in {}", generation);
    case OurCall::all:
        return "at once";
    case OurCall::one:
        return "one by one";
    }
    VERA_CHECK(false);
    return {};
}

const std::vector<std::string>& index_names() {
    static const auto names = names_where([](const Recipe&) { return true; });
    return names;
}

const std::vector<std::string>& usual_index_names() {
    static const auto names = names_where([](const Recipe& recipe) { return recipe.usual; });
    return names;
}

std::unique_ptr<OurIndex> make_index(const std::string& name, const IndexInput& input) {
    const Recipe* const recipe =
        std::find_if(std::begin(recipes), std::end(recipes), [&](const Recipe& each) {
            return each.name == name;
        });
    VERA_CHECK(recipe != std::end(recipes));
    return recipe->make(input);
}

} // namespace vera
