// SPDX-License-Identifier: Apache-2.0
#include "vera/render/antialiasing.h"

#include "vera/render/refinement.h"
#include "vera/render/tiles.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace vera {

namespace {

using Refiners = Workspaces<TileRefiner>;

/// Larger tiles trace fewer centres twice, along their borders; smaller ones share out better.
std::size_t usual_tile_side(const Raster& raster) {
    constexpr std::size_t large_picture = std::size_t{1} << 20;
    return raster.width * raster.height >= large_picture ? 64 : 32;
}

/// The requests of tiles for pixels of other tiles that are not fulfilled yet, by tile.
std::vector<RefinementRequest>
take_requests(Refiners& refiners, const RefinedPicture& picture, const Tiling& tiling) {
    std::vector<RefinementRequest> requests;
    refiners.for_each([&](TileRefiner& refiner) {
        for (const RefinementRequest& request : refiner.outward)
            if (request.refinement > picture.refined[request.pixel])
                requests.push_back(request);
        refiner.outward.clear();
    });
    const auto tile_of = [&](const RefinementRequest& request) {
        return tiling.tile_of(request.pixel % tiling.width, request.pixel / tiling.width);
    };
    std::sort(requests.begin(), requests.end(), [&](const auto& a, const auto& b) {
        const std::size_t tile_a = tile_of(a);
        const std::size_t tile_b = tile_of(b);
        return tile_a != tile_b ? tile_a < tile_b : a < b;
    });
    requests.erase(std::unique(requests.begin(), requests.end()), requests.end());
    return requests;
}

/// Carries out requests that are sorted by tile.
void refine_tiles(
    Refiners& refiners, const Tiling& tiling, std::span<const RefinementRequest> requests) {
    std::vector<std::span<const RefinementRequest>> groups;
    const auto tile_of = [&](const RefinementRequest& request) {
        return tiling.tile_of(request.pixel % tiling.width, request.pixel / tiling.width);
    };
    for (std::size_t first = 0, last = 0; first < requests.size(); first = last) {
        const std::size_t tile = tile_of(requests[first]);
        while (last < requests.size() && tile_of(requests[last]) == tile)
            ++last;
        groups.push_back(requests.subspan(first, last - first));
    }
    parallel_ranges(groups.size(), 1, [&](std::size_t first, std::size_t last) {
        refiners.lend([&](TileRefiner& refiner) {
            for (std::size_t i = first; i < last; ++i)
                refiner.refine(tiling.tile(tile_of(groups[i].front())), groups[i]);
        });
    });
}

} // namespace

RenderStatistics render_antialiased(
    const TracedScene& traced,
    const Raster& raster,
    const Antialiasing& settings,
    Image& image,
    ProgressMeter& done) {
    std::vector<Refinement> refined(raster.width * raster.height, Refinement::center);
    const RefinedPicture picture = {traced, raster, settings, image, refined};
    const Tiling tiling = {
        raster.width,
        raster.height,
        tile_side(usual_tile_side(raster), traced.generation_size, raster.width, raster.height)};
    Refiners refiners([&] { return std::make_unique<TileRefiner>(picture); });

    parallel_ranges(tiling.count(), 1, [&](std::size_t first, std::size_t last) {
        refiners.lend([&](TileRefiner& refiner) {
            for (std::size_t number = first; number < last; ++number) {
                const Tile tile = tiling.tile(number);
                refiner.render(tile);
                done.add(static_cast<double>(tile.width * tile.height));
            }
        });
    });
    // Each turn follows what is thin across the border of one more tile. The pixels that are
    // refined in the end are the smallest set that the rules allow, whatever the tiles are.
    while (true) {
        const std::vector<RefinementRequest> requests = take_requests(refiners, picture, tiling);
        if (requests.empty())
            break;
        refine_tiles(refiners, tiling, requests);
    }

    RenderStatistics statistics;
    refiners.for_each([&](const TileRefiner& refiner) { statistics += refiner.statistics(); });
    return statistics;
}

} // namespace vera
