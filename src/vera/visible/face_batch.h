// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/shadows.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// How many shadows may be there at a time: several times as many as fall on one face, or those of
/// one that most edges are beside, as a floor's, would be made again for almost each.
std::size_t most_at_a_time(const ThrownShadows& thrown, std::size_t wanted);

/// The faces of which the shadows are there at a time. Where the same ones come back again and
/// again, as where large faces are seen between each other all over the picture, four times as many
/// may be there from then on, and so on: else shadows would be made for every few edges anew.
class FaceBatch {
public:
    FaceBatch(const ThrownShadows& thrown, std::size_t most)
        : thrown_(thrown)
        , most_(most)
        , most_made_(often * thrown.count())
        , is_in_(thrown.face_count()) {}

    void add(std::uint32_t face) {
        if (is_in_[face] != 0 || thrown_.count_on(face) == 0)
            return;
        is_in_[face] = 1;
        faces_.push_back(face);
        shadows_ += thrown_.count_on(face);
    }

    bool empty() const { return faces_.empty(); }

    bool is_full() const { return shadows_ >= most_; }

    /// In ascending order.
    std::vector<std::uint32_t> take();

    /// Shadows of all that were taken, as often as they were.
    std::size_t made() const { return made_; }

private:
    static constexpr std::size_t often = 2; ///< so often may all be made before more are at a time

    const ThrownShadows& thrown_;
    std::size_t most_;
    std::size_t most_made_;
    std::vector<std::uint8_t> is_in_;
    std::vector<std::uint32_t> faces_;
    std::size_t shadows_ = 0;
    std::size_t made_ = 0;
    std::size_t made_with_most_ = 0; ///< as large as it is now
};

} // namespace vera
