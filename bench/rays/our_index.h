// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/scene/scene.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "ray_sets.h"

namespace vera {

/// The indexes that can be measured; the first is the one that is when none is named.
const std::vector<std::string>& index_names();

/// The index of that name, which is one of index_names(). The scene must outlive it.
std::unique_ptr<RayIndex> make_index(const std::string& name, const Scene& scene);

/// What is known of each ray when it has been asked about: the t of the first face that it meets;
/// where only that was asked, 0 when it meets any. Infinity where it meets none.
using Distances = std::vector<float>;

/// Asks an index about rays.
class OurQuery {
public:
    OurQuery(const RayIndex& index, const RaySet& rays, std::size_t threads);

    /// Seconds that the index takes for all rays, in generations of so many.
    double run(std::size_t generation);

    /// What the last run found.
    Distances distances() const;

private:
    const RayIndex& index_;
    const RaySet& rays_;
    std::size_t threads_;
    std::vector<Hit> hits_;
    std::vector<Color> transmitted_;
};

} // namespace vera
