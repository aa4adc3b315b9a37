// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/math/color.h"
#include "vera/math/ray.h"
#include "vera/scene/crossings.h"
#include "vera/scene/hit.h"
#include "vera/scene/scene.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace vera::detail {

/// Finds the first face that a ray meets, from its crossings in any order. With t* the smallest t,
/// the answer is the smallest FaceId among the crossings with t <= t* + coincidence_tolerance(t*).
///
/// t* is known at the end only. Until then those crossings are kept that may be the answer: none is
/// when another has neither a greater t nor a greater face, because wherever the window ends, that
/// one lies in it as well.
class NearestSearch {
public:
    /// Begins anew, for a ray of the world of which coincidence_reach() is this.
    void start(double reach) {
        reach_ = reach;
        smallest_t_ = std::numeric_limits<double>::infinity();
        limit_ = smallest_t_;
        count_ = 0;
        overflowed_ = false;
    }

    void add(double t, FaceId face) {
        if (t > limit_)
            return;
        if (t < smallest_t_) {
            smallest_t_ = t;
            // Twice the tolerance, so that no rounding of the sum makes a later window end behind
            // what was left out because of this one.
            limit_ = t + 2 * coincidence_tolerance(reach_, t);
        }
        keep({t, face});
    }

    /// What lies behind this t need not be added any more.
    double limit() const { return limit_; }

    /// There were so many coincident faces that the answer is not known: go through the crossings
    /// again with a WindowSearch.
    bool undecided() const { return overflowed_; }

    double window_end() const { return smallest_t_ + coincidence_tolerance(reach_, smallest_t_); }

    /// Only where not undecided.
    Hit hit() const {
        Hit result;
        if (count_ <= 1)
            return count_ == 0 ? result : candidates_[0];
        const double end = window_end();
        for (std::size_t i = 0; i < count_; ++i)
            if (candidates_[i].t <= end && candidates_[i].face < result.face)
                result = candidates_[i];
        return result;
    }

private:
    void keep(const Hit& hit) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            const Hit& other = candidates_[i];
            if (other.t <= hit.t && other.face <= hit.face)
                return; // nothing was removed: what the hit rules out, the other had ruled out
            if (other.t <= limit_ && !(hit.t <= other.t && hit.face <= other.face))
                candidates_[kept++] = other;
        }
        if (kept == candidates_.size()) {
            overflowed_ = true;
            return;
        }
        candidates_[kept] = hit;
        count_ = kept + 1;
    }

    double reach_ = 0;
    double smallest_t_ = std::numeric_limits<double>::infinity();
    double limit_ = std::numeric_limits<double>::infinity();
    std::array<Hit, 4> candidates_ = {};
    std::size_t count_ = 0;
    bool overflowed_ = false;
};

/// The second pass of a NearestSearch that remained undecided.
class WindowSearch {
public:
    explicit WindowSearch(double window_end)
        : window_end_(window_end) {}

    void add(double t, FaceId face) {
        if (t <= window_end_ && (face < hit_.face || (face == hit_.face && t < hit_.t)))
            hit_ = {t, face};
    }

    double limit() const { return window_end_; }

    const Hit& hit() const { return hit_; }

private:
    double window_end_;
    Hit hit_;
};

/// Multiplies the light that the faces a ray crosses let through.
class TransmittanceSearch {
public:
    void add(double t, FaceId face, const Color& tab) {
        if (is_black(tab))
            blocked_ = true;
        else if (!blocked_)
            crossings_.push_back({{t, face}, tab});
    }

    /// Nothing passes, whatever else is crossed.
    bool blocked() const { return blocked_; }

    void block() { blocked_ = true; }

    void clear() {
        crossings_.clear();
        blocked_ = false;
    }

    /// The product in the order of t and then of the face, each crossing counted once.
    Color transmitted() {
        if (blocked_)
            return {};
        std::sort(crossings_.begin(), crossings_.end(), [](const Crossing& a, const Crossing& b) {
            return a.hit.t < b.hit.t || (a.hit.t == b.hit.t && a.hit.face < b.hit.face);
        });
        Color product = {1, 1, 1};
        for (std::size_t i = 0; i < crossings_.size(); ++i)
            if (i == 0 || crossings_[i].hit != crossings_[i - 1].hit)
                product = product * crossings_[i].tab;
        return product;
    }

private:
    struct Crossing {
        Hit hit;
        Color tab;
    };

    std::vector<Crossing> crossings_;
    bool blocked_ = false;
};

/// The material of an item in a scene or subscene that was called where `current` held.
inline MaterialId resolved(MaterialId item, MaterialId current) {
    return item == inherited_material ? current : item;
}

/// TAB of the material; of a missing one, which is opaque, black.
inline Color transmission(const Scene& scene, MaterialId material) {
    return material == inherited_material ? Color{}
                                          : scene.materials[static_cast<std::size_t>(material)].tab;
}

/// Whether no material of the scene lets light through.
inline bool is_opaque(const Scene& scene) {
    return std::all_of(
        scene.materials.begin(), scene.materials.end(), [](const Material& material) {
            return is_black(material.tab);
        });
}

} // namespace vera::detail
