// SPDX-License-Identifier: Apache-2.0
#include "vera/solids/shells.h"

#include "vera/base/disjoint_sets.h"
#include "vera/exact/orientation.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

namespace vera {

namespace {

/// A side of a face, its points in their order, whichever way the face has it.
struct Side {
    std::uint32_t lower = 0;
    std::uint32_t higher = 0;
    std::uint32_t face = 0;
    bool is_forward = true;
};

std::vector<Side> sorted_sides(const SolidFaces& faces) {
    std::vector<Side> sides;
    sides.reserve(faces.corners.size());
    for (std::uint32_t i = 0; i < faces.faces.size(); ++i) {
        const auto corners = faces.corners_of(faces.faces[i]);
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const std::uint32_t from = corners[k];
            const std::uint32_t to = corners[k + 1 < corners.size() ? k + 1 : 0];
            if (from != to)
                sides.push_back({std::min(from, to), std::max(from, to), i, from < to});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tuple(a.lower, a.higher, a.face) < std::tuple(b.lower, b.higher, b.face);
    });
    return sides;
}

/// Calls visit with the sides of each edge.
template <typename Visitor>
void for_each_edge(const std::vector<Side>& sides, const Visitor& visit) {
    for (std::size_t first = 0; first < sides.size();) {
        std::size_t last = first + 1;
        while (last < sides.size() && sides[last].lower == sides[first].lower
               && sides[last].higher == sides[first].higher)
            ++last;
        visit(std::span(sides).subspan(first, last - first));
        first = last;
    }
}

/// Which faces are turned against the first of their shell, found from neighbour to neighbour.
class Turns {
public:
    Turns(const SolidFaces& faces, const std::vector<Side>& sides)
        : neighbours_(faces.faces.size())
        , turns_(faces.faces.size(), unknown) {
        for_each_edge(sides, [&](std::span<const Side> edge) {
            if (edge.size() != 2)
                return;
            // Neighbours that agree go along their edge in opposite directions.
            const bool disagree = edge[0].is_forward == edge[1].is_forward;
            neighbours_[edge[0].face].push_back({edge[1].face, disagree});
            neighbours_[edge[1].face].push_back({edge[0].face, disagree});
        });
    }

    /// False where they contradict each other, as on a Moebius strip.
    bool follow_from(std::uint32_t first) {
        std::vector<std::uint32_t> open = {first};
        turns_[first] = 0;
        while (!open.empty()) {
            const std::uint32_t face = open.back();
            open.pop_back();
            for (const auto& [neighbour, disagrees] : neighbours_[face]) {
                const auto turn =
                    static_cast<std::int8_t>(disagrees ? 1 - turns_[face] : turns_[face]);
                if (turns_[neighbour] == unknown) {
                    turns_[neighbour] = turn;
                    open.push_back(neighbour);
                } else if (turns_[neighbour] != turn) {
                    return false;
                }
            }
        }
        return true;
    }

    bool is_turned(std::uint32_t face) const { return turns_[face] == 1; }

private:
    static constexpr std::int8_t unknown = -1;

    struct Neighbour {
        std::uint32_t face = 0;
        bool disagrees = false;
    };

    std::vector<std::vector<Neighbour>> neighbours_;
    std::vector<std::int8_t> turns_;
};

/// Six times the volume of each face's triangles with a point near them, and how large they are
/// without their signs.
struct Volume {
    double signed_sum = 0;
    double size = 0;
};

void add_volumes(
    const SolidFaces& faces,
    const Turns& turns,
    std::span<const std::uint32_t> shell_of,
    std::span<const Vec3> centers,
    std::vector<Volume>& volumes) {
    for (const SolidFaces::Triangle& triangle : faces.triangles) {
        const auto [a, b, c] = faces.corners_of(triangle);
        const Vec3 center = centers[shell_of[triangle.face]];
        const double volume = dot(a - center, cross(b - center, c - center));
        Volume& sum = volumes[shell_of[triangle.face]];
        sum.signed_sum += turns.is_turned(triangle.face) ? -volume : volume;
        sum.size += length(a - center) * length(b - center) * length(c - center);
    }
}

/// On which side of the face all of the points lie, but for its own corners and those in its plane:
/// 0 where they do not, or none is left.
int side_of_all(
    const SolidFaces& faces,
    const SolidFaces::Triangle& triangle,
    std::span<const std::uint32_t> points) {
    const auto [a, b, c] = faces.corners_of(triangle);
    const auto own = faces.corners_of(faces.faces[triangle.face]);
    int side = 0;
    for (const std::uint32_t point : points) {
        if (std::ranges::find(own, point) != own.end())
            continue;
        const int other = orientation(a, b, c, faces.points[point]);
        if (other != 0 && side != 0 && other != side)
            return 0;
        side = side == 0 ? other : side;
    }
    return side;
}

/// Finds the inside of shells with holes that are convex else.
void find_convex_sides(const SolidFaces& faces, std::vector<Shell>& shells) {
    constexpr std::size_t least_faces = 4; // of a solid
    constexpr std::size_t most_faces = 1000;
    std::vector<const SolidFaces::Triangle*> triangles(faces.faces.size());
    for (const SolidFaces::Triangle& triangle : faces.triangles)
        triangles[triangle.face] = &triangle;
    for (Shell& shell : shells) {
        if (shell.is_closed || shell.faces.size() < least_faces || shell.faces.size() > most_faces)
            continue;
        std::vector<std::uint32_t> points;
        for (const std::uint32_t face : shell.faces)
            for (const std::uint32_t point : faces.corners_of(faces.faces[face]))
                points.push_back(point);
        shell.has_inside = std::ranges::all_of(shell.faces, [&](std::uint32_t face) {
            const int side =
                triangles[face] == nullptr ? 0 : side_of_all(faces, *triangles[face], points);
            shell.is_turned.push_back(side > 0);
            return side != 0;
        });
        if (!shell.has_inside)
            shell.is_turned.clear();
    }
}

} // namespace

std::vector<Shell> shells(const SolidFaces& faces) {
    const std::vector<Side> sides = sorted_sides(faces);
    DisjointSets sets(faces.faces.size());
    for_each_edge(sides, [&](std::span<const Side> edge) {
        for (const Side& side : edge)
            sets.join(edge.front().face, side.face);
    });

    std::vector<Shell> shells;
    std::vector<std::uint32_t> shell_of(faces.faces.size());
    for (std::uint32_t i = 0; i < faces.faces.size(); ++i) {
        const std::uint32_t first = sets.first_of(i);
        if (first == i) {
            shell_of[i] = static_cast<std::uint32_t>(shells.size());
            shells.emplace_back().is_closed = true;
        }
        shell_of[i] = shell_of[first];
        shells[shell_of[i]].faces.push_back(i);
    }
    for_each_edge(sides, [&](std::span<const Side> edge) {
        Shell& shell = shells[shell_of[edge.front().face]];
        ++shell.edges;
        shell.is_closed = shell.is_closed && edge.size() == 2;
        const auto [lower, higher, face, is_forward] = edge.front();
        if (edge.size() == 1)
            shell.open.push_back({is_forward ? lower : higher, is_forward ? higher : lower, face});
    });

    for (Shell& shell : shells)
        std::ranges::stable_sort(shell.open, {}, &OpenEdge::face);

    Turns turns(faces, sides);
    std::vector<Vec3> centers;
    for (Shell& shell : shells) {
        shell.has_inside = shell.is_closed && turns.follow_from(shell.faces.front());
        centers.push_back(faces.points[faces.corners_of(faces.faces[shell.faces.front()]).front()]);
    }
    std::vector<Volume> volumes(shells.size());
    add_volumes(faces, turns, shell_of, centers, volumes);
    for (std::size_t i = 0; i < shells.size(); ++i) {
        Shell& shell = shells[i];
        // Far more than rounding makes of so many sums.
        constexpr double sure = 1e-9;
        shell.has_inside =
            shell.has_inside && std::abs(volumes[i].signed_sum) > sure * volumes[i].size;
        if (shell.has_inside)
            for (const std::uint32_t face : shell.faces)
                shell.is_turned.push_back(turns.is_turned(face) != (volumes[i].signed_sum < 0));
    }
    find_convex_sides(faces, shells);
    return shells;
}

} // namespace vera
