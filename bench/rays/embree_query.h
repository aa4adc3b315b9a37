// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "embree_scene.h"
#include "our_index.h"
#include "ray_sets.h"
#include <embree3/rtcore.h>

namespace vera {

/// How many rays a call of Embree's takes.
enum class EmbreeWidth { one, eight, sixteen, stream };

/// A way to ask Embree about rays.
struct EmbreeCall {
    EmbreeWidth width = EmbreeWidth::one;
    Coherence promise = Coherence::incoherent; ///< what Embree is told of the rays
    std::size_t generation = 1024;             ///< rays in a turn, and in a stream
};

/// As in "intersect16 coherent".
std::string name_of(const EmbreeCall& call, Question question);

/// The calls that are worth trying for such rays, the fastest of which is Embree's speed.
std::vector<EmbreeCall> embree_calls(Coherence coherence);

/// Asks Embree about rays. What it reads and writes is filled in and emptied outside of the time.
class EmbreeQuery {
public:
    EmbreeQuery(const RaySet& rays, std::size_t threads);

    /// Seconds that Embree takes for all rays.
    double run(const EmbreeScene& scene, const EmbreeCall& call);

    /// What the last run found.
    Distances distances() const;

private:
    template <typename Packet>
    double run_packets(RTCScene scene, const EmbreeCall& call, std::vector<Packet>& packets);

    const RaySet& rays_;
    std::size_t threads_;
    Distances distances_;
    // Kept from run to run, so that the memory is not asked for again each time.
    std::vector<RTCRayHit> hits_;
    std::vector<RTCRayHit8> hits_8_;
    std::vector<RTCRayHit16> hits_16_;
    std::vector<RTCRay> rays_1_;
    std::vector<RTCRay8> rays_8_;
    std::vector<RTCRay16> rays_16_;
};

} // namespace vera
