// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/face_batch.h"

#include <algorithm>
#include <utility>

namespace vera {

std::size_t most_at_a_time(const ThrownShadows& thrown, std::size_t wanted) {
    constexpr std::size_t faces = 4;
    std::size_t most = wanted;
    for (std::uint32_t face = 0; face < thrown.face_count(); ++face)
        most = std::max(most, faces * thrown.count_on(face));
    return most;
}

std::vector<std::uint32_t> FaceBatch::take() {
    for (const std::uint32_t face : faces_)
        is_in_[face] = 0;
    made_ += shadows_;
    made_with_most_ += shadows_;
    shadows_ = 0;
    if (made_with_most_ > most_made_) {
        most_ *= 4;
        made_with_most_ = 0;
    }
    std::sort(faces_.begin(), faces_.end());
    return std::exchange(faces_, {});
}

} // namespace vera
