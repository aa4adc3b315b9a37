// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/terrain_view.h"

#include "vera/base/available_memory.h"
#include "vera/base/diagnostic.h"
#include "vera/base/long_loop.h"
#include "vera/theory/ground_order.h"
#include "vera/theory/seen_sides.h"
#include "vera/visible/edges.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace vera {

namespace {

void require_what_is_needed(const ScreenScene& scene) {
    for (const ScreenTriangle& triangle : scene.triangles)
        if (triangle.is_shadow())
            throw std::invalid_argument("terrain_pieces() takes surfaces, not shadows on them");
    // Of each level of the tree, up to two parts a triangle, and half as much again for jumps.
    const auto n = static_cast<double>(scene.triangles.size());
    constexpr double parts = 3;
    require_memory(
        parts * sizeof(ProfilePart) * n * (std::log2(n + 1) + 4),
        "the profiles of " + std::to_string(scene.triangles.size()) + " triangles",
        "take --engine cells, which keeps none");
}

[[noreturn]] void refuse(std::string problem) {
    Diagnostic diagnostic;
    diagnostic.problem = std::move(problem);
    diagnostic.remedy =
        "take a terrain in an upright picture, with all that lies between its parts";
    throw InputError({diagnostic});
}

class TerrainView {
public:
    TerrainView(
        const ScreenScene& scene,
        Upward upward,
        TerrainCounts& counts,
        const Progress& progress,
        const CancelFlag* cancel)
        : scene_(scene)
        , edges_(screen_edges(scene))
        , segments_(sweep_segments(scene, edges_, cancel))
        , merge_(segments_.segments, upward, counts.predicates)
        , counts_(counts)
        , progress_(progress)
        , cancel_(cancel)
        , order_(ground_order(scene, &counts.ground, cancel))
        , sides_(scene, edges_, segments_, upward) {
        gather_chains(upward);
    }

    VisiblePieces pieces() {
        if (order_.empty())
            return {};
        profiles_.resize(2 * order_.size() - 1);
        build({0, 0, order_.size()});
        const Profile nothing = {{at_end({0, 0}), at_end({screen_size, 0}), no_segment}};
        find({0, 0, order_.size()}, merge_.below(profiles_[0], nothing));
        counts_.stretches = merge_.stretches();
        check_borders();
        return sides_.pieces();
    }

private:
    /// Of the tree over the order: its number, and the triangles order_[first] to order_[last].
    /// Nodes are numbered so that the nearer child follows, and all below it before the farther.
    struct Node {
        std::size_t number = 0;
        std::size_t first = 0;
        std::size_t last = 0;

        bool is_leaf() const { return last - first == 1; }

        Node nearer() const { return {number + 1, first, first + (last - first) / 2}; }

        Node farther() const {
            const std::size_t middle = first + (last - first) / 2;
            return {number + 2 * (middle - first), middle, last};
        }
    };

    /// Where the terrain begins: nothing lies before this triangle in these columns.
    struct Border {
        ProfilePart part;
        std::uint32_t triangle = 0;
    };

    void gather_chains(Upward upward) {
        upper_.resize(scene_.triangles.size());
        lower_.resize(scene_.triangles.size());
        for (std::uint32_t i = 0; i < segments_.segments.size(); ++i) {
            const auto& [begin, end] = segments_.segments[i];
            if (begin.x == end.x)
                continue;
            for (const SweepSegments::Border& border : segments_.borders_of(i)) {
                const bool is_higher = border.is_above == (upward == Upward::with_y);
                auto& chain = is_higher ? lower_[border.triangle] : upper_[border.triangle];
                chain.push_back({at_end(begin), at_end(end), i});
            }
        }
        for (auto* chains : {&upper_, &lower_})
            for (Profile& chain : *chains)
                std::sort(
                    chain.begin(), chain.end(), [](const ProfilePart& a, const ProfilePart& b) {
                        return a.from.x < b.from.x;
                    });
    }

    void build(const Node& node) {
        if (node.is_leaf()) {
            profiles_[node.number] = upper_[order_[node.first]];
            return;
        }
        build(node.nearer());
        build(node.farther());
        profiles_[node.number] =
            merge_.higher(profiles_[node.nearer().number], profiles_[node.farther().number]);
    }

    /// `before` is the profile of what lies before the node, where some of the node is above it.
    void find(const Node& node, const Profile& before) {
        if (before.empty())
            return;
        if (node.is_leaf()) {
            see(order_[node.first], before);
            return;
        }
        stop_if_raised(cancel_);
        const Profile& nearer = profiles_[node.nearer().number];
        find(node.nearer(), merge_.below(nearer, before));
        const Profile& farther = profiles_[node.farther().number];
        find(node.farther(), merge_.below(farther, merge_.raised(nearer, before)));
        if (progress_ && node.last - node.first > 1024)
            progress_(static_cast<double>(node.last) / static_cast<double>(order_.size()));
    }

    /// Adds the border of what is seen of a triangle.
    void see(std::uint32_t triangle, const Profile& before) {
        sides_.add(triangle, upper_[triangle], floor_of(triangle, before), merge_);
    }

    /// What is seen of a triangle goes down to there: what lies before it, or its own lower sides.
    Profile floor_of(std::uint32_t triangle, const Profile& before) {
        Profile floor;
        merge_.compare(
            before,
            lower_[triangle],
            [&](const ProfilePart& part, std::uint32_t hiding, std::uint32_t own, int order) {
                if (hiding == ProfileMerge::absent)
                    return;
                if (hiding == no_segment) {
                    borders_.push_back({{part.from, part.to, own}, triangle});
                } else if (order < 0) {
                    refuse(
                        named(triangle) + " leaves a gap above " + named(triangle_at(hiding))
                        + ", which lies before it");
                }
                floor.push_back({part.from, part.to, hiding == no_segment ? own : hiding});
            });
        return floor;
    }

    /// What is covered begins at the lowest that there is, in every column: no triangle lies below
    /// the first one.
    void check_borders() {
        std::sort(borders_.begin(), borders_.end(), [](const Border& a, const Border& b) {
            return a.part.from.x < b.part.from.x;
        });
        Profile first;
        for (const Border& border : borders_)
            first.push_back(border.part);
        const Profile lowest = lowest_of(0, lower_.size());
        merge_.compare(
            first,
            lowest,
            [&](const ProfilePart& part, std::uint32_t, std::uint32_t below, int order) {
                if (order <= 0)
                    return;
                const auto at =
                    std::find_if(borders_.begin(), borders_.end(), [&](const Border& border) {
                        return border.part.to.x > part.from.x;
                    });
                refuse(
                    named(triangle_at(below)) + " reaches below " + named(at->triangle)
                    + ", which lies before it at the border of the terrain");
            });
    }

    Profile lowest_of(std::size_t first, std::size_t last) {
        if (last - first == 1)
            return std::move(lower_[first]);
        const std::size_t middle = first + (last - first) / 2;
        const Profile one = lowest_of(first, middle);
        return merge_.lower(one, lowest_of(middle, last));
    }

    std::uint32_t triangle_at(std::uint32_t segment) const {
        return segments_.borders_of(segment).front().triangle;
    }

    std::string named(std::uint32_t triangle) const {
        return "triangle " + std::to_string(triangle) + " (face "
            + std::to_string(scene_.triangles[triangle].source) + ")";
    }

    const ScreenScene& scene_;
    ScreenEdges edges_;
    SweepSegments segments_;
    ProfileMerge merge_;
    TerrainCounts& counts_;
    const Progress& progress_;
    const CancelFlag* cancel_;
    std::vector<std::uint32_t> order_;
    SeenSides sides_;
    std::vector<Profile> upper_; ///< sides of each triangle, but those that are vertical
    std::vector<Profile> lower_;
    std::vector<Profile> profiles_; ///< of each node's triangles
    std::vector<Border> borders_;
};

} // namespace

VisiblePieces terrain_pieces(
    const ScreenScene& scene,
    Upward upward,
    TerrainCounts* counts,
    const Progress& progress,
    const CancelFlag* cancel) {
    require_what_is_needed(scene);
    TerrainCounts here;
    VisiblePieces pieces = TerrainView(scene, upward, here, progress, cancel).pieces();
    if (counts != nullptr)
        *counts = here;
    return pieces;
}

} // namespace vera
