// SPDX-License-Identifier: Apache-2.0
#include "generation_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vera {

namespace {

std::uint64_t crossings(const GenerationCounts& generation) {
    return generation.sweeps.x_swaps + generation.sweeps.y_swaps;
}

} // namespace

nlohmann::ordered_json generations_json(std::span<const GenerationCounts> generations) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const GenerationCounts& generation : generations)
        list.push_back(
            {{"kind", generation.are_shadow_rays ? "shadow" : "rays"},
             {"rays", generation.rays},
             {"swept", generation.swept},
             {"apart", generation.apart},
             {"begun_within", generation.begun_within},
             {"pairs", generation.sweeps.pairs},
             {"crossings", crossings(generation)},
             {"rectangles", generation.sweeps.rectangles},
             {"nodes", generation.trees.nodes},
             {"reports", generation.reports()},
             {"steps", generation.steps()},
             {"tests", generation.tests}});
    return list;
}

std::string generations_text(std::span<const GenerationCounts> generations) {
    GenerationCounts all;
    for (const GenerationCounts& generation : generations) {
        all.rays += generation.rays;
        all.sweeps += generation.sweeps;
        all.trees += generation.trees;
        all.tests += generation.tests;
        all.apart += generation.apart;
    }
    std::string text = fmt::format("{} generations of {} rays: ", generations.size(), all.rays);
    if (all.sweeps.pairs > 0)
        text += fmt::format(
            "{} crossings of {:.3g} pairs in sweeps, ",
            crossings(all),
            static_cast<double>(all.sweeps.pairs));
    if (all.trees.nodes > 0)
        text +=
            fmt::format("{:.3g} nodes of trees looked at, ", static_cast<double>(all.trees.nodes));
    text += fmt::format(
        "{:.3g} tests a ray",
        all.rays == 0 ? 0 : static_cast<double>(all.tests) / static_cast<double>(all.rays));
    if (all.apart > 0)
        text += fmt::format("; {} rays were tested with every primitive", all.apart);
    return text;
}

} // namespace vera
