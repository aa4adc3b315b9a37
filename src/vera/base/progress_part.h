// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"

#include <cstddef>
#include <utility>

namespace vera {

/// What some work tells of its own progress, as the progress of a whole of which it is the part
/// from `begin` to `end`.
inline Progress progress_between(Progress whole, double begin, double end) {
    if (!whole)
        return {};
    return [whole = std::move(whole), begin, end](double done) {
        whole(begin + done * (end - begin));
    };
}

/// Of the part number `part` of `parts` equal ones.
inline Progress progress_part(Progress whole, std::size_t part, std::size_t parts) {
    const auto count = static_cast<double>(parts);
    return progress_between(
        std::move(whole), static_cast<double>(part) / count, static_cast<double>(part + 1) / count);
}

/// The progress of stages that follow each other.
class StageProgress {
public:
    /// `total` is the sum of what the stages weigh.
    StageProgress(Progress whole, double total)
        : whole_(std::move(whole))
        , total_(total) {}

    /// Of the next stage, which takes about so much of the total; tells that those before are done.
    Progress next(double weight) {
        const double begin = weight_ / total_;
        weight_ += weight;
        if (whole_)
            whole_(begin);
        return progress_between(whole_, begin, weight_ / total_);
    }

private:
    Progress whole_;
    double total_;
    double weight_ = 0;
};

} // namespace vera
