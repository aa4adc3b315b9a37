// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "float_geometry.h"
#include "ray_sets.h"

namespace vera {

/// What is known of each ray when it has been asked about: the t of the first face that it meets;
/// where only that was asked, 0 when it meets any. Infinity where it meets none.
using Distances = std::vector<float>;

/// How many rays a call of ours gets.
enum class OurCall { generation, all, one };

/// As in "in 1024".
std::string name_of(OurCall call, std::size_t generation);

/// Steps that were counted for all rays together.
struct Steps {
    std::uint64_t nodes = 0; ///< or cells
    std::uint64_t tests = 0; ///< with primitives
};

/// Asks one of our indexes about rays. What it reads and writes is filled in and emptied outside of
/// the time.
class OurQuery {
public:
    OurQuery() = default;
    OurQuery(const OurQuery&) = delete;
    OurQuery& operator=(const OurQuery&) = delete;
    virtual ~OurQuery() = default;

    /// Seconds that all rays take.
    virtual double run(OurCall call) = 0;

    /// What the last run found.
    virtual Distances distances() const = 0;

    /// What all rays take in generations.
    virtual Steps steps() = 0;
};

/// One of our indexes, built.
class OurIndex {
public:
    OurIndex() = default;
    OurIndex(const OurIndex&) = delete;
    OurIndex& operator=(const OurIndex&) = delete;
    virtual ~OurIndex() = default;

    /// Bytes beside what it was built for.
    virtual std::size_t bytes() const = 0;

    /// Nodes, or cells.
    virtual std::size_t nodes() const = 0;

    /// The calls that it has.
    virtual std::vector<OurCall> calls() const = 0;

    /// Generations are of so many rays. Index and rays must outlive the query.
    virtual std::unique_ptr<OurQuery>
    query(const RaySet& rays, std::size_t threads, std::size_t generation) const = 0;
};

/// The indexes that can be measured.
const std::vector<std::string>& index_names();

/// Those of them that are when none is named.
const std::vector<std::string>& usual_index_names();

/// What an index is built for, twice the same. Must outlive it.
struct IndexInput {
    const Scene& scene;
    const FloatGeometry& floats;
    bool one_mesh = false;     ///< the scene is nothing but that
    bool only_spheres = false; ///< nor anything but these
};

/// The index of that name, which is one of index_names(); null where it is not for such a scene.
std::unique_ptr<OurIndex> make_index(const std::string& name, const IndexInput& input);

} // namespace vera
