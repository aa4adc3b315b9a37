// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/render/render_parts.h"

#include <cstddef>
#include <memory>
#include <string>

#include "prepared_scene.h"

namespace CLI {
class App;
} // namespace CLI

namespace vera {

/// What finds the visible surfaces of a picture (sections 3.2 and 3.4 of the paper).
struct StrategyRequest {
    std::string kind = "rays";

    bool is_central() const { return kind == "central"; }

    /// Whether rays through pixels find what is seen.
    bool is_rays() const { return kind == "rays" || is_central(); }
};

/// --strategy
void add_strategy_option(CLI::App& command, StrategyRequest& request);

/// Throws CommandLineError where an option of the picture means nothing to the strategy.
void check_options(const StrategyRequest& request, const PictureOptions& options);

/// What is seen, found without rays.
struct SeenParts {
    std::unique_ptr<const Facets> facets;
    PictureParts::OfBand of_band;
    std::size_t penetrating = 0; ///< pairs of facets that were left uncut
    double cut_nearness = 0;     ///< as in ScreenScene
};

/// For any strategy that sends no rays through pixels. Throws Cancelled, and InputError as facets()
/// does.
SeenParts seen_parts(
    const StrategyRequest& request,
    const PreparedScene& prepared,
    const Progress& progress,
    const CancelFlag& cancel);

/// Whether the picture's light takes rays that an index answers.
bool needs_index(const StrategyRequest& request, const PreparedScene& prepared);

} // namespace vera
