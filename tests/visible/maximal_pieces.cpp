// SPDX-License-Identifier: Apache-2.0
#include "visible/maximal_pieces.h"

#include <algorithm>
#include <map>
#include <utility>

namespace vera::testing {

bool operator<(const MaximalPiece& a, const MaximalPiece& b) {
    if (a.from != b.from)
        return order(a.from, b.from) < 0;
    return a.to != b.to ? order(a.to, b.to) < 0
                        : std::pair(a.left, a.right) < std::pair(b.left, b.right);
}

namespace {

struct LessPoint {
    bool operator()(const RationalPoint& a, const RationalPoint& b) const {
        return order(a, b) < 0;
    }
};

/// Joins pieces where nothing else ends.
class Joining {
public:
    Joining(const ScreenScene& scene, const VisiblePieces& found) {
        const auto source = [&](std::uint32_t triangle) {
            return triangle == no_triangle ? no_source : scene.triangles[triangle].source;
        };
        for (const VisiblePiece& piece : found.pieces) {
            const RationalPoint& from = found.points[piece.from];
            const RationalPoint& to = found.points[piece.to];
            const bool is_rightward = order(from, to) < 0;
            const ScreenPoint begin = scene.vertices[piece.edge.begin].point;
            const ScreenPoint end = scene.vertices[piece.edge.end].point;
            MaximalPiece one = {
                from,
                to,
                source(piece.left),
                source(piece.right),
                is_rightward ? step(begin, end) : step(end, begin)};
            if (!is_rightward) {
                std::swap(one.from, one.to);
                std::swap(one.left, one.right);
            }
            at_[one.from].push_back(pieces_.size());
            at_[one.to].push_back(pieces_.size());
            pieces_.push_back(one);
        }
    }

    /// In an order that is no matter of how they were found.
    std::vector<MaximalPiece> result() {
        std::vector<MaximalPiece> result;
        for (std::size_t first = 0; first < pieces_.size(); ++first) {
            if (neighbor(first, pieces_[first].from) != none)
                continue;
            MaximalPiece whole = pieces_[first];
            for (std::size_t next = neighbor(first, whole.to); next != none;
                 next = neighbor(next, whole.to))
                whole.to = pieces_[next].to;
            result.push_back(whole);
        }
        std::sort(result.begin(), result.end());
        return result;
    }

private:
    static constexpr std::size_t none = ~std::size_t{0};

    /// The one that goes on straight at that end of the piece, with the same beside it.
    std::size_t neighbor(std::size_t piece, const RationalPoint& end) {
        const std::vector<std::size_t>& here = at_[end];
        if (here.size() != 2)
            return none;
        const std::size_t other = here[0] == piece ? here[1] : here[0];
        const MaximalPiece& a = pieces_[piece];
        const MaximalPiece& b = pieces_[other];
        const bool goes_on = (a.to == b.from || a.from == b.to) && cross(a.way, b.way) == 0
            && a.left == b.left && a.right == b.right;
        return goes_on ? other : none;
    }

    std::vector<MaximalPiece> pieces_;
    std::map<RationalPoint, std::vector<std::size_t>, LessPoint> at_;
};

} // namespace

std::vector<MaximalPiece> maximal_pieces(const ScreenScene& scene, const VisiblePieces& found) {
    return Joining(scene, found).result();
}

} // namespace vera::testing
