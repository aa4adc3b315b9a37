// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/base/parallel.h"

#include <cstddef>
#include <cstdint>
#include <memory>

namespace vera {

/// How fine the grids are. None of it changes a picture.
struct GridSettings {
    double density = 2;       ///< cells for each element
    std::uint32_t crowd = 16; ///< so many elements in a cell may earn it a grid of its own
    double crowd_density = 2; ///< cells for each element of such a grid
    double references = 32;   ///< for each element, in all lists together; at most about so many
    std::uint32_t levels = 8; ///< of grids in grids of one scene or subscene, the first included
};

/// What a tree of grids is made of. References are the entries of the cells' lists.
struct GridTreeStatistics {
    std::size_t geometries = 0; ///< the main scene and the subscenes
    std::size_t levels = 0;     ///< of grids within grids, the deepest
    std::size_t grids = 0;
    std::size_t cells = 0;
    std::size_t empty_cells = 0;
    std::size_t elements = 0; ///< primitives, and subscene calls once each
    std::size_t references = 0;
    std::size_t longest_list = 0;
    std::size_t bytes = 0;

    friend bool operator==(const GridTreeStatistics&, const GridTreeStatistics&) = default;
};

/// An index that can tell what it is made of.
class GridTree : public RayIndex {
public:
    virtual GridTreeStatistics statistics() const = 0;
};

/// The paper's tree of grids (VERA 2.2): a regular grid over the main scene and one over each
/// subscene, which stands in its callers' cells like a primitive; crowded cells have grids of their
/// own. The same tree whatever the number of threads. Throws Cancelled, and std::runtime_error
/// where the forecast exceeds the memory that is available. The scene must outlive the tree.
std::unique_ptr<GridTree> make_grid_tree(
    const Scene& scene,
    const GridSettings& settings = {},
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// What building the tree will take, estimated from a sample of the elements.
IndexForecast grid_forecast(const Scene& scene, const GridSettings& settings = {});

} // namespace vera
