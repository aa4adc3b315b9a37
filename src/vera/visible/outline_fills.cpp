// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/outline_fills.h"

#include "vera/base/free_room.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/visible/drawn_borders.h"
#include "vera/visible/face_color.h"
#include "vera/visible/object_groups.h"
#include "vera/visible/region_outlines.h"
#include "vera/visible/shaded_outlines.h"
#include "vera/visible/shaded_underlays.h"
#include "vera/visible/trapping.h"
#include "vera/visible/underlays.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace vera {

namespace {

std::vector<DrawingColor> colors_of(
    const FillSources& sources,
    const RegionOutlines& regions,
    const Progress& progress,
    const CancelFlag* cancel) {
    std::vector<DrawingColor> colors(regions.count());
    long_parallel_loop(regions.count(), progress, cancel, 256, [&](std::size_t i) {
        colors[i] = region_color(sources, regions.rings(i));
    });
    return colors;
}

/// The faces' outlines, made from the map whenever they are asked for.
class RegionFills {
public:
    /// Adds what lies below the outlines to the drawing.
    RegionFills(
        const FillSources& sources,
        std::shared_ptr<const void> kept,
        StageProgress stages,
        const CancelFlag* cancel,
        Drawing& drawing)
        : kept_(std::move(kept))
        , sources_(sources)
        , materials_(drawing_materials(sources.scene))
        , regions_(sources.map, curved_borders(sources, stages.next(1), cancel)) {
        if (is_shaded())
            start_shaded(stages, cancel, drawing);
        else
            start_flat(stages, cancel, drawing);
        primitives_.reserve(regions_.count());
        ObjectGroups groups(sources.scene, materials_);
        std::size_t corners = 0; // of the block
        for (std::size_t i = 0; i < regions_.count(); ++i) {
            corners += regions_.corner_count(i);
            if (blocks_.empty() || corners > most_corners
                || i - blocks_.back().first == most_regions) {
                blocks_.push_back({i, groups});
                corners = regions_.corner_count(i);
            }
            primitives_.push_back(sources.facets.triangles[facet_of(i)].primitive);
            groups.of(primitives_.back());
        }
        find_seams(stages.next(1), cancel);
        stages.next(0);
    }

    std::size_t blocks() const { return blocks_.size(); }

    std::vector<FilledOutline> block(std::size_t number, const CancelFlag* cancel) const {
        std::vector<std::uint32_t> numbers(end_of(number) - blocks_[number].first);
        std::iota(
            numbers.begin(), numbers.end(), static_cast<std::uint32_t>(blocks_[number].first));
        return outlines_of(blocks_[number], numbers, cancel);
    }

    /// Those of the block that have seams.
    std::vector<FilledOutline> with_seams(std::size_t number, const CancelFlag* cancel) const {
        const auto place_of = [&](std::size_t region) {
            return std::lower_bound(with_seams_.begin(), with_seams_.end(), region);
        };
        return outlines_of(
            blocks_[number], {place_of(blocks_[number].first), place_of(end_of(number))}, cancel);
    }

private:
    // Of a block, but of one region: its outlines take a few hundred bytes a corner.
    static constexpr std::size_t most_regions = 2048;
    static constexpr std::size_t most_corners = 16384;

    /// Outlines that are made together.
    struct Block {
        std::size_t first = 0; ///< region
        ObjectGroups groups;   ///< as they were before it
    };

    std::size_t end_of(std::size_t block) const {
        return block + 1 < blocks_.size() ? blocks_[block + 1].first : regions_.count();
    }

    bool is_shaded() const { return sources_.style == DrawingStyle::shaded; }

    PaintTolerance tolerance() const {
        constexpr double part_amid = 0.003; // next to nothing: only jumps of a light notice
        return {sources_.color_tolerance, part_amid * sources_.deviation, sources_.deviation};
    }

    std::uint32_t facet_of(std::size_t region) const {
        return sources_.faces.first_facet[regions_.rings(region).front().source];
    }

    /// The firmament, and what lies below the outlines.
    void start_shaded(StageProgress& stages, const CancelFlag* cancel, Drawing& drawing) {
        if (sources_.given_map != nullptr)
            free_room(sources_.given_map->vertices); // their places are known
        DrawnFirmament firmament =
            drawn_firmament(sources_.camera, sources_.picture, tolerance(), cancel);
        drawing.background = firmament.background;
        drawing.fills = std::move(firmament.sky);
        ShadedUnderlays underlays = shaded_underlays(sources_, regions_, stages.next(8), cancel);
        std::ranges::move(underlays.outlines, std::back_inserter(drawing.fills));
        has_underlay_ = std::move(underlays.has_one);
    }

    /// What goes below what, and what lies below all.
    void start_flat(StageProgress& stages, const CancelFlag* cancel, Drawing& drawing) {
        widths_ = widths_of_regions(regions_, stages.next(2), cancel);
        colors_ = colors_of(sources_, regions_, stages.next(3), cancel);
        drawing.fills = underlays(regions_, colors_, stages.next(3), cancel);
    }

    void find_seams(const Progress& progress, const CancelFlag* cancel) {
        const LongLoop loop(regions_.count(), progress, cancel);
        for (std::size_t i = 0; i < regions_.count(); ++i) {
            loop.turn(i);
            if (is_shaded() ? has_seams_closely(regions_, i) : has_seams(regions_, widths_, i))
                with_seams_.push_back(static_cast<std::uint32_t>(i));
        }
    }

    std::vector<FilledOutline> outlines_of(
        const Block& block,
        std::span<const std::uint32_t> numbers,
        const CancelFlag* cancel) const {
        return is_shaded() ? shaded(block, numbers, cancel) : flat(block, numbers, cancel);
    }

    /// Of regions of the block, in their order.
    std::vector<std::shared_ptr<const DrawingGroup>>
    groups_of(const Block& block, std::span<const std::uint32_t> numbers) const {
        std::vector<std::shared_ptr<const DrawingGroup>> groups;
        ObjectGroups of_block = block.groups;
        groups.reserve(numbers.size());
        for (const std::uint32_t number : numbers)
            groups.push_back(of_block.of(primitives_[number]));
        return groups;
    }

    std::vector<FilledOutline> flat(
        const Block& block,
        std::span<const std::uint32_t> numbers,
        const CancelFlag* cancel) const {
        std::vector<FilledOutline> fills(numbers.size());
        const auto groups = groups_of(block, numbers);
        long_parallel_loop(numbers.size(), {}, cancel, 64, [&](std::size_t i) {
            PaintedRegion region = named(numbers[i], groups[i]);
            region.outline.color = colors_[numbers[i]];
            cover_seams(regions_, widths_, colors_, numbers[i], region);
            add_rings(region, regions_.curves().all());
            fills[i] = std::move(region.outline);
        });
        return fills;
    }

    /// As the light shades them.
    std::vector<FilledOutline> shaded(
        const Block& block,
        std::span<const std::uint32_t> numbers,
        const CancelFlag* cancel) const {
        std::vector<LitOutline> lit(numbers.size());
        const auto groups = groups_of(block, numbers);
        long_parallel_loop(numbers.size(), {}, cancel, 64, [&](std::size_t i) {
            const std::uint32_t number = numbers[i];
            PaintedRegion region = named(number, groups[i]);
            region.lies_on_underlay = has_underlay_[number];
            cover_seams_closely(regions_, number, region);
            lit[i] = {std::move(region), facet_of(number), ~sources_.map.regions[number].unlit};
        });
        return shaded_outlines(
            std::move(lit),
            {sources_.scene,
             sources_.camera,
             sources_.picture,
             sources_.facets,
             tolerance(),
             regions_.curves().all(),
             {},
             cancel});
    }

    /// The region with its rings, and the id and group of what it shows.
    PaintedRegion named(std::size_t number, std::shared_ptr<const DrawingGroup> group) const {
        PaintedRegion region;
        region.rings = regions_.borders(number);
        region.outline.id = "face-" + std::to_string(primitives_[number] + 1);
        region.outline.group = std::move(group);
        return region;
    }

    std::shared_ptr<const void> kept_; ///< what the sources refer to, where nobody else keeps it
    FillSources sources_;
    std::vector<std::shared_ptr<const DrawingMaterial>> materials_;
    RegionOutlines regions_;
    std::vector<std::uint64_t> primitives_; ///< of the regions
    std::vector<Block> blocks_;
    std::vector<float> widths_;             ///< of the regions; of areas in one colour each
    std::vector<DrawingColor> colors_;      ///< likewise
    std::vector<bool> has_underlay_;        ///< likewise; of areas in gradients
    std::vector<std::uint32_t> with_seams_; ///< regions
};

} // namespace

void add_later_fills(
    const FillSources& sources,
    std::shared_ptr<const void> kept,
    const Progress& progress,
    const CancelFlag* cancel,
    Drawing& drawing) {
    drawing.background = background_color(sources);
    const auto fills = std::make_shared<const RegionFills>(
        sources, std::move(kept), StageProgress(progress, 10), cancel, drawing);
    drawing.later_fills = {
        fills->blocks(),
        sources.style == DrawingStyle::shaded,
        [fills](std::size_t block, const CancelFlag* flag) { return fills->block(block, flag); },
        [fills](std::size_t block, const CancelFlag* flag) {
            return fills->with_seams(block, flag);
        }};
}

void add_fills(
    const FillSources& sources,
    const Progress& progress,
    const CancelFlag* cancel,
    Drawing& drawing) {
    StageProgress stages(progress, 10);
    add_later_fills(sources, nullptr, stages.next(3), cancel, drawing);
    const LaterFills later = std::exchange(drawing.later_fills, {});
    const LongLoop loop(later.blocks, stages.next(7), cancel, 1);
    for (std::size_t i = 0; i < later.blocks; ++i) {
        loop.turn(i);
        std::ranges::move(later.block(i, cancel), std::back_inserter(drawing.fills));
    }
}

} // namespace vera
