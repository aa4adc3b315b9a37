// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/sure_nearness.h"
#include "vera/visible/triangle_order.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace vera {

enum Sides : std::uint8_t { left_side = 1, right_side = 2 };

/// Finds what is seen on both sides of an edge, part by part. Both ways to find what is visible ask
/// this, and the answer is no matter of who else is there and surely hidden. Of two triangles that
/// pass through each other the nearer one is in front at each place; others have one order along
/// all of the edge's line.
class SeenBeside {
public:
    static constexpr std::uint32_t nothing = ~std::uint32_t{0};

    /// Numbers of what was added, in the order in which it was, or nothing.
    struct Seen {
        std::uint32_t left = nothing;
        std::uint32_t right = nothing;
        /// What covers both sides and surely hides all that covers but one, where that was found.
        std::uint32_t hidden_by = nothing;
    };

    /// slopes[i] is that of triangle i. Both must outlive this.
    SeenBeside(const ScreenScene& scene, std::span<const NearnessSlope> slopes)
        : scene_(scene)
        , slopes_(slopes) {}

    /// Goes on with another edge.
    void follow(ScreenPoint begin, ScreenPoint end);

    /// Forgets what was added, and goes on with the part of the edge between the places, which come
    /// in the direction of the edge.
    void start(NearnessPlace first, NearnessPlace last, Hiding hiding = Hiding::by_what_covers) {
        hiding_ = hiding;
        places_ = {{{first.x - bit_.x, first.y - bit_.y}, {last.x + bit_.x, last.y + bit_.y}}};
        candidates_.clear();
        on_one_side_.clear();
        foremost_ = nothing;
    }

    /// A triangle that covers one or both sides all along that part.
    void add(std::uint32_t triangle, std::uint8_t sides) {
        const auto number = static_cast<std::uint32_t>(candidates_.size());
        candidates_.push_back(candidate(triangle, sides));
        if (sides != (left_side | right_side))
            on_one_side_.push_back(number);
        else if (foremost_ == nothing || is_before(number, foremost_))
            foremost_ = number;
    }

    /// Of what was added, what covers both sides and surely is the nearest at the first place; or
    /// nothing.
    std::uint32_t foremost() const { return foremost_; }

    /// Whether triangle a surely hides b all along that part, if both are there.
    bool hides(std::uint32_t a, std::uint32_t b) const {
        return candidate(a, 0).hides(candidate(b, 0));
    }

    /// Nothing on both sides where what covers but one of them is surely hidden: the same is then
    /// seen on both. Triangles that pass through each other where they are seen are added to
    /// penetrating, the smaller number first; what is seen is then told for the middle. Who always
    /// asks is told what is seen also where it is the same on both sides.
    Seen find(
        std::vector<std::pair<std::uint32_t, std::uint32_t>>& penetrating,
        bool asks_always = false);

    /// How often two triangles were put in order.
    std::uint64_t comparisons() const { return comparisons_; }

private:
    struct Candidate {
        std::array<double, 2> near = {}; ///< at both places
        double margin = 0;
        std::uint32_t triangle = 0;
        std::uint8_t sides = 0;

        double near_at(double part) const { return near[0] + part * (near[1] - near[0]); }

        SureNearness sure() const {
            return {{near[0] - margin, near[1] - margin}, {near[0] + margin, near[1] + margin}};
        }

        /// By more than the margins at both places.
        bool hides(const Candidate& other) const { return sure().hides(other.sure()); }
    };

    /// A candidate that nothing surely hides on a side.
    struct InFront {
        std::uint32_t candidate = 0;
        OnLine on_line;
    };

    /// What is seen at a part of the way, from 0 to 1.
    struct Top {
        double part = 0;
        std::uint32_t candidate = nothing;
    };

    Candidate candidate(std::uint32_t triangle, std::uint8_t sides) const {
        const NearnessSlope& slope = slopes_[triangle];
        return {{slope.at(places_[0]), slope.at(places_[1])}, sure_margin(slope), triangle, sides};
    }

    /// By what is sure at the first place.
    bool is_before(std::uint32_t a, std::uint32_t b) const {
        return candidates_[a].near[0] - candidates_[a].margin
            > candidates_[b].near[0] - candidates_[b].margin;
    }

    using Front = std::vector<InFront>;

    std::uint32_t foremost_on(std::uint8_t side) const;
    std::optional<std::uint32_t> only_one_on(std::uint8_t side) const;
    void find_front(std::uint8_t side, Front& front);
    void find_front_among_all(std::uint8_t side, Front& front);
    bool has_one_sided(const Front& front) const;
    void put_in_order(Front& front) const;
    void find_chords(Front& front) const;
    std::uint32_t find_in(Front& front);
    Top top_at(double part, const Front& front);
    bool is_in_front(const InFront& a, const InFront& b, double part);
    std::vector<std::uint32_t> foremost_among_all(double part, const Front& front);
    std::uint32_t find_among_all(const Front& front);
    void find_penetrating(Top first, Top last, const Front& front);

    const ScreenScene& scene_;
    std::span<const NearnessSlope> slopes_;
    Hiding hiding_ = Hiding::by_what_covers; ///< along that part
    ScreenPoint begin_;
    ScreenPoint end_;
    NearnessPlace bit_; ///< of the way along the edge
    std::array<NearnessPlace, 2> places_;
    std::vector<Candidate> candidates_;
    std::vector<std::uint32_t> on_one_side_; ///< candidates
    std::uint32_t foremost_ = nothing;       ///< of those on both, as is_before() tells
    std::array<Front, 2> fronts_;            ///< on the left and on the right
    std::vector<SureNearness> in_front_;     ///< of the candidates of one of these
    std::vector<std::uint32_t> behind_;      ///< candidates that are not among them
    HiddenOfMany hidden_;
    bool changes_ = false; ///< somebody comes to be in front of somebody on the way
    std::vector<std::pair<std::uint32_t, std::uint32_t>>* penetrating_ = nullptr;
    std::uint64_t comparisons_ = 0;
};

} // namespace vera
