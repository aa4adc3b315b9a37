// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/base/parallel.h"

#include <cstddef>
#include <cstdint>
#include <memory>

namespace vera {

/// What a wide hierarchy of boxes is made of.
struct WideBvhStatistics {
    std::size_t geometries = 0; ///< the main scene and the subscenes
    std::size_t levels = 0;     ///< of nodes, the deepest tree's
    std::size_t nodes = 0;
    std::size_t blocks = 0;   ///< leaves
    std::size_t elements = 0; ///< primitives, and subscene calls once each
    std::size_t bytes = 0;

    friend bool operator==(const WideBvhStatistics&, const WideBvhStatistics&) = default;
};

/// An index that can tell what it is made of.
class WideBvh : public RayIndex {
public:
    virtual WideBvhStatistics statistics() const = 0;
};

/// A hierarchy of hulls (VERA 3.1): boxes in boxes, eight to a node, so that a ray is tested
/// against all of a node's at once, and packets of rays against one after another. A tree for the
/// main scene and one for each subscene, which stands in its callers' trees like a primitive. The
/// same tree whatever the number of threads. Throws Cancelled, and std::runtime_error where the
/// forecast exceeds the memory that is available. The scene must outlive it.
std::unique_ptr<WideBvh> make_wide_bvh(
    const Scene& scene, const Progress& progress = {}, const CancelFlag* cancel = nullptr);

/// What building it will take, estimated from the number of elements.
IndexForecast wide_bvh_forecast(const Scene& scene);

} // namespace vera
