// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/render/generation_size.h"
#include "vera/render/render_parts.h"
#include "vera/theory/primitive_query_index.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "prepared_scene.h"
#include "scene_index.h"

namespace CLI {
class App;
} // namespace CLI

namespace vera {

/// What finds the visible surfaces of a picture (sections 3.2 to 3.4 of the paper).
struct StrategyRequest {
    std::string kind = "rays";
    std::string queries;                   ///< how primitives find their rays; empty: not given
    std::optional<double> generation_size; ///< as it was typed

    /// Whether rays find what is seen: through an index, by maps, or by primitive.
    bool is_rays() const { return kind == "rays" || is_central() || is_by_primitive(); }

    /// Whether rays are looked up in maps (section 3.2 of the paper).
    bool is_central() const { return kind == "central"; }

    /// Whether each primitive is asked for its rays (section 3.3.2 of the paper).
    bool is_by_primitive() const { return kind == "primitive-query"; }
};

/// --strategy, --queries and --generation-size
void add_strategy_option(CLI::App& command, StrategyRequest& request);

/// Throws CommandLineError where an option of the picture means nothing to the strategy, or an
/// option of one strategy is given with another.
void check_options(
    const StrategyRequest& request, const IndexRequest& index, const PictureOptions& options);

/// Of rays, for render_scene(). Throws CommandLineError where it is no number of rays.
std::size_t generation_size(const StrategyRequest& request);

/// The index of rays that are asked for by primitive.
std::unique_ptr<PrimitiveQueryIndex>
primitive_query_index(const StrategyRequest& request, const Scene& scene, const CancelFlag& cancel);

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
