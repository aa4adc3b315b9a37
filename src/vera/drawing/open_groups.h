// SPDX-License-Identifier: Apache-2.0
// The groups of a drawing as marks of their beginnings and ends between the outlines: each outline
// tells its innermost group, and formats have groups round what is in them.
#pragma once

#include "vera/drawing/drawing.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace vera::detail {

/// The groups that the last outline stands in, from the outermost on.
class OpenGroups {
public:
    /// Calls end() for each of them that the outline of this group is no part of, and then
    /// begin(group, depth) for each that it is beside those left; the outermost has depth 0.
    template <typename Begin, typename End>
    void
    go_to(const std::shared_ptr<const DrawingGroup>& group, const Begin& begin, const End& end) {
        if (!groups_.empty() && groups_.back() == group)
            return;
        std::vector<std::shared_ptr<const DrawingGroup>> way;
        for (auto one = group; one; one = one->parent)
            way.push_back(one);
        std::reverse(way.begin(), way.end());
        std::size_t same = 0;
        while (same < std::min(way.size(), groups_.size())
               && is_same_group(way[same].get(), groups_[same].get()))
            ++same;
        for (; groups_.size() > same; groups_.pop_back())
            end();
        for (; groups_.size() < way.size(); groups_.push_back(way[groups_.size()]))
            begin(*way[groups_.size()], groups_.size());
    }

private:
    std::vector<std::shared_ptr<const DrawingGroup>> groups_;
};

} // namespace vera::detail
