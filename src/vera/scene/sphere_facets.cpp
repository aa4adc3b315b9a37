// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/curved_facets.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace vera {

namespace {

/// A deviation that changes by more than this factor over a triangle may be still less within it.
constexpr double steep = 2;

/// The steepness no longer matters where the triangle is nearer to the surface than this part of
/// what was asked for.
constexpr double near_part = 1.0 / 256;

/// The smallest triangles are 2^-28 of the radius.
constexpr int most_passes = 56;

class SphereFacets {
public:
    SphereFacets(const Sphere& sphere, const LocalDeviation& deviation)
        : sphere_(sphere)
        , deviation_(deviation) {
        for (const Vec3 direction :
             {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}})
            add_corner(direction);
        faces_ = {
            {{0, 1, 2}},
            {{1, 3, 2}},
            {{3, 4, 2}},
            {{4, 0, 2}},
            {{1, 0, 5}},
            {{3, 1, 5}},
            {{4, 3, 5}},
            {{0, 4, 5}}};
        for (const Face& face : faces_)
            mark_all(face);
        split();
    }

    /// Divides what is too coarse, all of it once, unless there would be too many. Whether there
    /// was anything to do, and it was done.
    bool refine(std::size_t most) {
        for (Face& face : faces_) {
            if (!face.settled && is_coarse(face))
                midpoints_.emplace(edge(face, longest(face)), no_corner);
            face.settled = true;
        }
        mark_longest_edges();
        std::size_t count = faces_.size();
        for (const Face& face : faces_)
            for (std::size_t i = 0; i < 3; ++i)
                count += is_marked(edge(face, i)) ? 1 : 0;
        if (count == faces_.size() || count > most)
            return false;
        split();
        return true;
    }

    CurvedFacets result() const {
        CurvedFacets facets;
        facets.corners.reserve(directions_.size());
        for (const Vec3& direction : directions_)
            facets.corners.push_back(on_surface(direction));
        facets.triangles.reserve(faces_.size());
        for (const Face& face : faces_)
            facets.triangles.push_back({face.corners});
        return facets;
    }

private:
    static constexpr std::uint32_t no_corner = 0xffffffff;

    struct Face {
        std::array<std::uint32_t, 3> corners = {};
        bool settled = false; ///< was looked at
    };

    /// Both corners' numbers, the smaller one first.
    using Edge = std::uint64_t;

    static Edge edge_of(std::uint32_t a, std::uint32_t b) {
        return Edge{std::min(a, b)} << 32U | std::max(a, b);
    }

    static Edge edge(const Face& face, std::size_t i) {
        return edge_of(face.corners[i], face.corners[(i + 1) % 3]);
    }

    double length_squared(Edge edge) const {
        const Vec3 along = directions_[edge >> 32U] - directions_[edge & 0xffffffffU];
        return dot(along, along);
    }

    /// The number of the longest edge. All faces at an edge agree about it.
    std::size_t longest(const Face& face) const {
        const auto size = [&](std::size_t i) {
            return std::pair(length_squared(edge(face, i)), edge(face, i));
        };
        std::size_t result = 0;
        for (std::size_t i = 1; i < 3; ++i)
            if (size(i) > size(result))
                result = i;
        return result;
    }

    Vec3 on_surface(Vec3 direction) const { return sphere_.center + sphere_.radius * direction; }

    std::uint32_t add_corner(Vec3 direction) {
        directions_.push_back(direction);
        asked_.push_back(deviation_(on_surface(direction)));
        return static_cast<std::uint32_t>(directions_.size() - 1);
    }

    /// Of the smallest circle round the face, that is: round its corners, or on its longest edge.
    /// No point of the face is farther from the unit sphere than the middle of that circle.
    double squared_circle_radius(const Face& face) const {
        std::array<double, 3> sides = {};
        for (std::size_t i = 0; i < 3; ++i)
            sides[i] = length_squared(edge(face, i));
        std::sort(sides.begin(), sides.end());
        if (sides[2] >= sides[0] + sides[1])
            return sides[2] / 4;
        const Vec3 corner = directions_[face.corners[0]];
        const Vec3 doubled_area =
            cross(directions_[face.corners[1]] - corner, directions_[face.corners[2]] - corner);
        return sides[0] * sides[1] * sides[2] / (4 * dot(doubled_area, doubled_area));
    }

    bool is_coarse(const Face& face) const {
        const auto& [a, b, c] = face.corners;
        const Vec3 middle = normalized(directions_[a] + directions_[b] + directions_[c]);
        const std::array<double, 4> asked = {
            asked_[a], asked_[b], asked_[c], deviation_(on_surface(middle))};
        double least = asked[0];
        double most = 0;
        for (const double here : asked) {
            least = std::min(least, here);
            most = std::isfinite(here) ? std::max(most, here) : most;
        }
        const double circle = squared_circle_radius(face);
        const double off = sphere_.radius * circle / (1 + std::sqrt(1 - circle));
        return !(off <= least) || (most > steep * least && off > near_part * least);
    }

    bool is_marked(Edge edge) const { return midpoints_.count(edge) != 0; }

    void mark_all(const Face& face) {
        for (std::size_t i = 0; i < 3; ++i)
            midpoints_.emplace(edge(face, i), no_corner);
    }

    /// No face is divided without its longest edge, so that none becomes ever thinner.
    void mark_longest_edges() {
        for (bool changed = true; changed;) {
            changed = false;
            for (const Face& face : faces_) {
                const bool any = is_marked(edge(face, 0)) || is_marked(edge(face, 1))
                    || is_marked(edge(face, 2));
                if (any)
                    changed |= midpoints_.emplace(edge(face, longest(face)), no_corner).second;
            }
        }
    }

    std::uint32_t midpoint(Edge edge) {
        std::uint32_t& corner = midpoints_.find(edge)->second;
        if (corner == no_corner)
            corner =
                add_corner(normalized(directions_[edge >> 32U] + directions_[edge & 0xffffffffU]));
        return corner;
    }

    void split() {
        std::vector<Face> divided;
        divided.reserve(2 * faces_.size());
        for (const Face& face : faces_)
            split(face, divided);
        faces_ = std::move(divided);
        midpoints_.clear();
    }

    void split(const Face& face, std::vector<Face>& divided) {
        const std::size_t first = longest(face);
        if (!is_marked(edge(face, first))) {
            divided.push_back(face);
            return;
        }
        const std::uint32_t a = face.corners[first];
        const std::uint32_t b = face.corners[(first + 1) % 3];
        const std::uint32_t c = face.corners[(first + 2) % 3];
        const std::uint32_t middle = midpoint(edge(face, first));
        const Edge right = edge_of(b, c);
        const Edge left = edge_of(c, a);
        if (!is_marked(right) || !is_marked(left)) {
            split_half(middle, b, c, divided);
            split_half(middle, c, a, divided);
            return;
        }
        const std::uint32_t of_right = midpoint(right);
        const std::uint32_t of_left = midpoint(left);
        divided.push_back({{a, middle, of_left}});
        divided.push_back({{middle, b, of_right}});
        divided.push_back({{of_left, of_right, c}});
        divided.push_back({{middle, of_right, of_left}});
    }

    /// One half of a face, of which the edge opposite to the apex may be divided as well.
    void split_half(
        std::uint32_t apex, std::uint32_t from, std::uint32_t to, std::vector<Face>& divided) {
        if (!is_marked(edge_of(from, to))) {
            divided.push_back({{apex, from, to}});
            return;
        }
        const std::uint32_t between = midpoint(edge_of(from, to));
        divided.push_back({{apex, from, between}});
        divided.push_back({{apex, between, to}});
    }

    Sphere sphere_;
    const LocalDeviation& deviation_;
    std::vector<Vec3> directions_; ///< of the corners from the center, unit
    std::vector<double> asked_;    ///< the deviation there
    std::vector<Face> faces_;
    std::unordered_map<Edge, std::uint32_t> midpoints_; ///< of the edges to divide
};

} // namespace

CurvedFacets
curved_facets(const Sphere& sphere, const LocalDeviation& deviation, std::size_t most) {
    SphereFacets facets(sphere, deviation);
    for (int pass = 0; pass < most_passes && facets.refine(most); ++pass) {
    }
    return facets.result();
}

} // namespace vera
