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
             {"pairs", generation.pairs},
             {"crossings", crossings(generation)},
             {"rectangles", generation.sweeps.rectangles},
             {"nodes", generation.trees.nodes},
             {"reports", generation.sweeps.reports},
             {"steps", generation.steps()},
             {"tests", generation.tests}});
    return list;
}

std::string generations_text(std::span<const GenerationCounts> generations) {
    GenerationCounts all;
    std::uint64_t crossed = 0;
    for (const GenerationCounts& generation : generations) {
        all.rays += generation.rays;
        all.pairs += generation.pairs;
        all.tests += generation.tests;
        all.apart += generation.apart;
        crossed += crossings(generation);
    }
    std::string text = fmt::format(
        "{} generations of {} rays: {} crossings of {:.3g} pairs in sweeps, {:.3g} tests a ray",
        generations.size(),
        all.rays,
        crossed,
        static_cast<double>(all.pairs),
        all.rays == 0 ? 0 : static_cast<double>(all.tests) / static_cast<double>(all.rays));
    if (all.apart > 0)
        text += fmt::format("; {} rays were tested with every primitive", all.apart);
    return text;
}

} // namespace vera
