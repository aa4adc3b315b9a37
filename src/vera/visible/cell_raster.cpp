// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/cell_raster.h"

#include "vera/base/free_room.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/visible/drawing_memory.h"
#include "vera/visible/edge_sweep.h"
#include "vera/visible/first_equal.h"
#include "vera/visible/point_numbers.h"
#include "vera/visible/sheets.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <mutex>
#include <span>

namespace vera {

namespace {

/// Whether the edge is a point, or lies behind what covers all its cells, if it is so near.
bool is_hidden(const CellRaster& raster, const ScreenEdges::Edge& edge, double near) {
    const ScreenPoint a = raster.scene.vertices[edge.begin].point;
    const ScreenPoint b = raster.scene.vertices[edge.end].point;
    return a == b || for_each_cell_along(raster.cells, a, b, [&](std::size_t cell) {
               return near < raster.cells.blocked[cell];
           });
}

/// Of each edge how near it is in the planes of all triangles that have it.
std::vector<double> nearness_of_edges(const CellRaster& raster) {
    std::vector<double> nearness(
        raster.edges.edges.size(), -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < raster.slopes.size(); ++i)
        for (const std::uint32_t edge : raster.edges.of_triangle[i]) {
            const auto& [begin, end] = raster.edges.edges[edge];
            nearness[edge] = std::max(
                nearness[edge],
                nearest_for_hiding(
                    raster.slopes[i],
                    std::array{
                        raster.scene.vertices[begin].point, raster.scene.vertices[end].point}));
        }
    return nearness;
}

/// Whether the edge parts two parts of one shadow: beside it the same is seen. (Where several are
/// on a side, it is followed like any other.)
bool is_inner(const ScreenScene& scene, const EdgeNeighbours& beside) {
    if (!beside.are_two())
        return false;
    const ScreenTriangle& left = scene.triangles[beside.left];
    const ScreenTriangle& right = scene.triangles[beside.right];
    return left.is_shadow() && left.light == right.light && left.source == right.source;
}

std::vector<std::uint32_t> shadowed_sources(const ScreenScene& scene, const ScreenEdges& edges) {
    constexpr std::uint32_t none = several_sources - 1;
    std::vector<std::uint32_t> sources(edges.edges.size(), none);
    for (std::size_t i = 0; i < scene.triangles.size(); ++i)
        for (const std::uint32_t edge : edges.of_triangle[i]) {
            const ScreenTriangle& triangle = scene.triangles[i];
            const std::uint32_t source = triangle.is_shadow() ? triangle.source : no_source;
            const bool is_same = sources[edge] == none || sources[edge] == source;
            sources[edge] = is_same ? source : several_sources;
        }
    return sources;
}

/// Which edges lie in a cell that what was changed touches, or did.
std::vector<std::uint8_t>
edges_near(const SceneChange& change, const CellRaster& raster, const Cells& cells) {
    std::vector<std::uint8_t> is_changed(cells.blocked.size());
    const auto mark = [&](const std::array<ScreenVertex, 3>& corners) {
        for_each_cell_of(cells, corners, [&](std::size_t cell) { is_changed[cell] = 1; });
    };
    for (const std::uint32_t triangle : change.triangles)
        mark(corners_of(raster.scene, raster.scene.triangles[triangle]));
    for (const std::array<ScreenVertex, 3>& corners : change.places)
        mark(corners);
    std::vector<std::uint8_t> near(raster.edges.edges.size());
    parallel_ranges(near.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const auto point = [&](std::uint32_t vertex) {
                return raster.scene.vertices[vertex].point;
            };
            const auto& [begin, end] = raster.edges.edges[i];
            const bool is_far =
                for_each_cell_along(cells, point(begin), point(end), [&](std::size_t cell) {
                    return is_changed[cell] == 0;
                });
            near[i] = is_far ? 0 : 1;
        }
    });
    return near;
}

/// The cells along the edges.
std::vector<std::uint8_t> cells_along(
    const std::vector<std::uint8_t>& is_edge_asked, const CellRaster& raster, const Cells& cells) {
    std::vector<std::uint8_t> is_asked(cells.blocked.size());
    for (std::size_t i = 0; i < is_edge_asked.size(); ++i) {
        if (is_edge_asked[i] == 0)
            continue;
        const auto& [begin, end] = raster.edges.edges[i];
        for_each_cell_along(
            cells,
            raster.scene.vertices[begin].point,
            raster.scene.vertices[end].point,
            [&](std::size_t cell) {
                is_asked[cell] = 1;
                return true;
            });
    }
    return is_asked;
}

/// How much of the time goes into what all edges are compared with.
constexpr double part_of_preparation = 0.2;

/// Of the whole scene or, where only that was changed, for the edges near it.
CellRaster raster_of(
    const ScreenScene& scene,
    const SceneChange* change,
    const Progress& progress,
    const CancelFlag* cancel) {
    StageProgress stages(progress_between(progress, 0, part_of_preparation), 6);
    const auto next_stage = [&] {
        stop_if_raised(cancel);
        stages.next(1);
    };
    next_stage();
    require_raster_memory(scene);
    CellRaster raster = {scene, slopes_of(scene), {}, {}, {}, {}, {}, {}, {}, {}};
    raster.corners.resize(scene.triangles.size());
    for (std::size_t i = 0; i < raster.corners.size(); ++i) {
        const std::array<ScreenVertex, 3> corners = corners_of(scene, scene.triangles[i]);
        raster.corners[i] = {corners[0].point, corners[1].point, corners[2].point};
    }
    next_stage();
    raster.edges = screen_edges(scene);
    next_stage();
    const std::vector<EdgeNeighbours> neighbours = edge_neighbours(scene, raster.edges);
    if (std::ranges::any_of(scene.triangles, &ScreenTriangle::is_shadow)) {
        raster.shadowed = shadowed_sources(scene, raster.edges);
        raster.inner.resize(neighbours.size());
        for (std::size_t i = 0; i < neighbours.size(); ++i)
            raster.inner[i] = is_inner(scene, neighbours[i]) ? 1 : 0;
    }
    next_stage();
    AskedCells asked;
    if (change != nullptr)
        asked = [&](const Cells& cells) {
            raster.is_near_change = edges_near(*change, raster, cells);
            return cells_along(raster.is_near_change, raster, cells);
        };
    raster.cells = cells_of(scene, raster.slopes, cancel, asked);
    next_stage();
    block_by_sheets(raster.cells, {scene, raster.edges, neighbours, raster.slopes}, cancel);
    raster.shadow_cells = shadow_cells_of(raster.cells, scene, raster.slopes, cancel);
    next_stage();
    const std::vector<double> nearness = nearness_of_edges(raster);
    raster.is_hidden.resize(raster.edges.edges.size());
    parallel_ranges(raster.is_hidden.size(), 4096, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        for (std::size_t i = first; i < last; ++i)
            raster.is_hidden[i] = is_hidden(raster, raster.edges.edges[i], nearness[i]) ? 1 : 0;
    });
    return raster;
}

/// Lends one EdgeSweep to each thread that works.
class EdgeSweeps {
public:
    explicit EdgeSweeps(const CellRaster& raster)
        : raster_(raster) {}

    std::unique_ptr<EdgeSweep> take() {
        const std::lock_guard lock(mutex_);
        if (idle_.empty())
            return std::make_unique<EdgeSweep>(raster_);
        std::unique_ptr<EdgeSweep> sweep = std::move(idle_.back());
        idle_.pop_back();
        return sweep;
    }

    void give_back(std::unique_ptr<EdgeSweep> sweep) {
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(sweep));
    }

    /// Of all edges that were followed, when all have been given back.
    CellCounts counts() const {
        CellCounts counts;
        for (const std::unique_ptr<EdgeSweep>& sweep : idle_)
            counts.add_followed(sweep->counts());
        return counts;
    }

private:
    const CellRaster& raster_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<EdgeSweep>> idle_;
};

/// Of the pieces before, those of edges from this one on.
auto first_piece_of(const std::vector<VisiblePiece>& before, ScreenEdges::Edge edge) {
    return std::lower_bound(
        before.begin(),
        before.end(),
        edge,
        [](const VisiblePiece& piece, const ScreenEdges::Edge& value) {
            return piece.edge < value;
        });
}

/// How many of the pieces before are those of the edge.
std::size_t count_pieces_of(const std::vector<VisiblePiece>& before, ScreenEdges::Edge edge) {
    std::size_t count = 0;
    for (auto i = first_piece_of(before, edge); i != before.end() && i->edge == edge; ++i)
        ++count;
    return count;
}

/// An edge, and how many marks at equal distances lie on it where all edges are laid end to end.
struct MarkedEdge {
    std::uint32_t edge = 0;
    double marks = 0;
    double weight = 0; ///< about as many cells as it touches
};

/// One edge of 256 or so, but enough of them in any case: long ones more often, since more can
/// cross them.
std::vector<MarkedEdge> marked_edges(const CellRaster& raster, double& distance) {
    constexpr double least_marks = 512;
    constexpr double edges_per_mark = 256;
    const auto weight_of = [&](const ScreenEdges::Edge& edge) {
        const ScreenStep along =
            step(raster.scene.vertices[edge.begin].point, raster.scene.vertices[edge.end].point);
        return 1
            + static_cast<double>(std::abs(along.x) + std::abs(along.y))
            / std::ldexp(1.0, raster.cells.shift);
    };
    const std::vector<ScreenEdges::Edge>& edges = raster.edges.edges;
    double whole = 0;
    for (const ScreenEdges::Edge& edge : edges)
        whole += weight_of(edge);
    distance = whole / std::max(least_marks, static_cast<double>(edges.size()) / edges_per_mark);
    std::vector<MarkedEdge> marked;
    double next = distance / 2;
    double end = 0;
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
        const double weight = weight_of(edges[i]);
        end += weight;
        if (next >= end)
            continue;
        const double marks = std::floor((end - next) / distance) + 1;
        next += marks * distance;
        marked.push_back({i, marks, weight});
    }
    return marked;
}

/// About how much will be found.
struct Expected {
    double pieces = 0;
    double pairs = 0; ///< that pass through each other, as often as edges tell them
};

/// From a few edges (systematic sampling, in proportion to their lengths).
Expected expected(
    const CellRaster& raster, const std::vector<VisiblePiece>& before, const CancelFlag* cancel) {
    EdgeSweeps sweeps(raster); // of its own: what they count is not counted
    double distance = 0;
    const std::vector<MarkedEdge> marked = marked_edges(raster, distance);
    std::vector<Expected> found(marked.size());
    parallel_ranges(marked.size(), 16, [&](std::size_t first, std::size_t last) {
        stop_if_raised(cancel);
        std::unique_ptr<EdgeSweep> sweep = sweeps.take();
        for (std::size_t i = first; i < last; ++i) {
            const std::uint32_t edge = marked[i].edge;
            if (!raster.is_near_change.empty() && raster.is_near_change[edge] == 0) {
                found[i].pieces =
                    static_cast<double>(count_pieces_of(before, raster.edges.edges[edge]));
                continue;
            }
            VisiblePieces pieces;
            sweep->follow(edge, pieces);
            found[i] = {
                static_cast<double>(pieces.pieces.size()),
                static_cast<double>(pieces.penetrating.size())};
        }
        sweeps.give_back(std::move(sweep));
    });
    Expected all;
    for (std::size_t i = 0; i < marked.size(); ++i) {
        const double edges = distance * marked[i].marks / marked[i].weight; // that it stands for
        all.pieces += edges * found[i].pieces;
        all.pairs += edges * found[i].pairs;
    }
    return all;
}

/// Of so few edges there are never so many pieces that memory could run out.
constexpr std::size_t few_edges = 1024;

void check_memory(
    const CellRaster& raster,
    const std::vector<VisiblePiece>& before,
    const ExpectPieces& expect,
    const CancelFlag* cancel) {
    if (raster.edges.edges.size() < few_edges)
        return;
    const auto [pieces, pairs] = expected(raster, before, cancel);
    require_piece_memory(pieces, pairs);
    if (expect)
        expect(pieces);
}

/// Follows the edges that are near what was changed, or all. What is found lies in parts, one
/// behind the other.
std::vector<VisiblePieces> follow_edges(
    const CellRaster& raster,
    const std::vector<VisiblePiece>& before,
    const ExpectPieces& expect,
    const Progress& progress,
    const CancelFlag* cancel,
    CellCounts& counts) {
    constexpr std::size_t part = 4096; // edges
    const std::vector<ScreenEdges::Edge>& edges = raster.edges.edges;
    std::vector<VisiblePieces> parts((edges.size() + part - 1) / part);
    EdgeSweeps sweeps(raster);
    check_memory(raster, before, expect, cancel);
    std::mutex mutex;
    std::size_t done = 0;
    const auto follow_part = [&](std::size_t number, EdgeSweep& sweep) {
        const std::size_t end = std::min(edges.size(), (number + 1) * part);
        VisiblePieces found;
        for (std::size_t i = number * part; i < end; ++i) {
            if (i % 16 == 0)
                stop_if_raised(cancel);
            if (raster.is_near_change.empty() || raster.is_near_change[i] != 0)
                sweep.follow(static_cast<std::uint32_t>(i), found);
        }
        // In as little room as it takes, with each point once, since all parts are there at a time.
        VisiblePieces& result = parts[number];
        result.pieces.reserve(found.pieces.size());
        PointNumbers numbers(result.points, found.points.size());
        for (VisiblePiece piece : found.pieces) {
            piece.from = numbers.number(found.points[piece.from]);
            piece.to = numbers.number(found.points[piece.to]);
            result.pieces.push_back(piece);
        }
        result.points.shrink_to_fit();
        result.unlit = std::move(found.unlit);
        result.penetrating = std::move(found.penetrating);
    };
    parallel_ranges(parts.size(), 1, [&](std::size_t first, std::size_t last) {
        std::unique_ptr<EdgeSweep> sweep = sweeps.take();
        for (std::size_t i = first; i < last; ++i)
            follow_part(i, *sweep);
        sweeps.give_back(std::move(sweep));
        const std::lock_guard lock(mutex);
        done += last - first;
        if (progress)
            progress(static_cast<double>(done) / static_cast<double>(parts.size()));
    });
    counts = sweeps.counts();
    return parts;
}

/// The points of the parts, each once, in the order in which they come; numbers tells which of them
/// each is, one part's behind the other's. Takes them out of the parts.
std::vector<RationalPoint> joined_points(
    std::vector<VisiblePieces>& parts,
    std::span<const std::size_t> starts,
    std::vector<std::uint32_t>& numbers) {
    std::vector<const RationalPoint*> points(starts.back());
    parallel_ranges(parts.size(), 1, [&](std::size_t part, std::size_t) {
        for (std::size_t i = 0; i < parts[part].points.size(); ++i)
            points[starts[part] + i] = &parts[part].points[i];
    });
    numbers = first_equal(
        points.size(),
        [&](std::size_t i) { return hash_of(*points[i]); },
        [&](std::size_t i, std::size_t j) { return *points[i] == *points[j]; });
    const std::vector<std::uint32_t> firsts = number_consecutively(numbers);
    std::vector<RationalPoint> result(firsts.size());
    parallel_ranges(firsts.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            result[i] = *points[firsts[i]];
    });
    for (VisiblePieces& part : parts)
        free_room(part.points);
    return result;
}

VisiblePieces joined(std::vector<VisiblePieces> parts) {
    std::vector<std::size_t> starts(parts.size() + 1); // of the parts' points
    std::size_t pieces = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        starts[i + 1] = starts[i] + parts[i].points.size();
        pieces += parts[i].pieces.size();
    }
    VisiblePieces result;
    std::vector<std::uint32_t> numbers;
    result.points = joined_points(parts, starts, numbers);
    result.pieces.reserve(pieces);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const VisiblePieces part = std::move(parts[i]);
        const auto number = [&](std::uint32_t point) { return numbers[starts[i] + point]; };
        for (VisiblePiece piece : part.pieces) {
            piece.from = number(piece.from);
            piece.to = number(piece.to);
            result.pieces.push_back(piece);
        }
        result.unlit.insert(result.unlit.end(), part.unlit.begin(), part.unlit.end());
        result.penetrating.insert(
            result.penetrating.end(), part.penetrating.begin(), part.penetrating.end());
    }
    return result;
}

/// Which of the pieces before are those of edges that are there still, and far from the change.
std::vector<std::uint8_t>
kept_pieces(const CellRaster& raster, const std::vector<VisiblePiece>& before) {
    const std::vector<ScreenEdges::Edge>& edges = raster.edges.edges;
    std::vector<std::uint8_t> is_kept(before.size());
    std::size_t edge = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        while (edge < edges.size() && edges[edge] < before[i].edge)
            ++edge;
        const bool is_there = edge < edges.size() && edges[edge] == before[i].edge;
        is_kept[i] = is_there && raster.is_near_change[edge] == 0 ? 1 : 0;
    }
    return is_kept;
}

/// Of each point its number among the others, or PointNumbers::none.
std::vector<std::uint32_t>
numbers_among(const std::vector<RationalPoint>& points, std::vector<RationalPoint> others) {
    const PointNumbers numbers(others, others.size());
    std::vector<std::uint32_t> result(points.size());
    parallel_ranges(points.size(), 4096, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            result[i] = numbers.find(points[i]);
    });
    return result;
}

/// The kept pieces of those before and the ones that were found, which are of other edges, as one
/// list. All that takes long is done of the found ones alone.
VisiblePieces
merged(const VisiblePieces& before, const std::vector<std::uint8_t>& is_kept, VisiblePieces found) {
    constexpr std::uint32_t none = PointNumbers::none;
    const std::vector<std::uint32_t> among_found = numbers_among(before.points, found.points);
    std::vector<std::uint32_t> of_before(before.points.size(), none);
    std::vector<std::uint32_t> of_found(found.points.size(), none);
    VisiblePieces result;
    result.pieces.reserve(before.pieces.size() + found.pieces.size());
    // In the order in which the pieces have them, as if all had been followed.
    const auto numbered = [&](std::uint32_t& number, const RationalPoint& point) {
        if (number == none) {
            number = static_cast<std::uint32_t>(result.points.size());
            result.points.push_back(point);
        }
        return number;
    };
    const auto add = [&](const VisiblePieces& from, std::size_t i, const auto& number_of) {
        VisiblePiece piece = from.pieces[i];
        piece.from = number_of(piece.from);
        piece.to = number_of(piece.to);
        result.pieces.push_back(piece);
        if (!before.unlit.empty() || !found.unlit.empty())
            result.unlit.push_back(from.unlit_beside(i));
    };
    std::size_t next = 0;
    const auto add_found_before = [&](const ScreenEdges::Edge* edge) {
        for (; next < found.pieces.size() && (edge == nullptr || found.pieces[next].edge < *edge);
             ++next)
            add(found, next, [&](std::uint32_t point) {
                return numbered(of_found[point], found.points[point]);
            });
    };
    for (std::size_t i = 0; i < before.pieces.size(); ++i) {
        if (is_kept[i] == 0)
            continue;
        add_found_before(&before.pieces[i].edge);
        add(before, i, [&](std::uint32_t point) {
            const std::uint32_t same = among_found[point];
            return numbered(same == none ? of_before[point] : of_found[same], before.points[point]);
        });
    }
    add_found_before(nullptr);
    result.penetrating = std::move(found.penetrating);
    return result;
}

/// Counts what was done before edges were followed, by doing it once more.
void count_cells(const CellRaster& raster, CellCounts& counts) {
    counts.cells = raster.cells.blocked.size();
    counts.entries = raster.cells.triangles.size();
    counts.edges = raster.edges.edges.size();
    for (const ScreenTriangle& triangle : raster.scene.triangles)
        for_each_cell_of(raster.cells, corners_of(raster.scene, triangle), [&](std::size_t) {
            ++counts.touched;
        });
    const std::vector<double> nearness = nearness_of_edges(raster);
    for (std::size_t i = 0; i < raster.edges.edges.size(); ++i) {
        const auto& [begin, end] = raster.edges.edges[i];
        for_each_cell_along(
            raster.cells,
            raster.scene.vertices[begin].point,
            raster.scene.vertices[end].point,
            [&](std::size_t cell) {
                ++counts.edge_cells;
                return nearness[i] < raster.cells.blocked[cell];
            });
    }
}

void sort_pairs(std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

} // namespace

VisiblePieces cell_raster(
    const ScreenScene& scene,
    const Progress& progress,
    const CancelFlag* cancel,
    const ExpectPieces& expect,
    CellCounts* counts) {
    std::vector<VisiblePieces> parts;
    {
        const CellRaster raster = raster_of(scene, nullptr, progress, cancel);
        CellCounts counted;
        parts = follow_edges(
            raster,
            {},
            expect,
            progress_between(progress, part_of_preparation, 1),
            cancel,
            counted);
        if (counts != nullptr) {
            count_cells(raster, counted);
            *counts = counted;
        }
    }
    VisiblePieces result = joined(std::move(parts));
    sort_pairs(result.penetrating);
    return result;
}

VisiblePieces cell_raster_after(
    const SceneChange& change,
    VisiblePieces before,
    const ScreenScene& scene,
    const Progress& progress,
    const CancelFlag* cancel,
    const ExpectPieces& expect) {
    std::vector<std::uint8_t> is_changed(scene.triangles.size());
    for (const std::uint32_t triangle : change.triangles)
        is_changed[triangle] = 1;
    // Where no shadow is near, there is none.
    const auto unlit = [&](std::uint32_t triangle) {
        return triangle == no_triangle ? 0 : scene.unlit_of(scene.triangles[triangle].source);
    };
    before.unlit.clear();
    std::vector<VisiblePieces> parts;
    std::vector<std::uint8_t> is_kept;
    {
        const CellRaster raster = raster_of(scene, &change, progress, cancel);
        if (raster.may_be_unlit())
            for (const VisiblePiece& piece : before.pieces)
                before.unlit.push_back({unlit(piece.left), unlit(piece.right)});
        is_kept = kept_pieces(raster, before.pieces);
        CellCounts uncounted;
        parts = follow_edges(
            raster,
            before.pieces,
            expect,
            progress_between(progress, part_of_preparation, 1),
            cancel,
            uncounted);
    }
    VisiblePieces result = merged(before, is_kept, joined(std::move(parts)));
    for (const auto& [a, b] : before.penetrating)
        if (is_changed[a] == 0 && is_changed[b] == 0)
            result.penetrating.emplace_back(a, b);
    sort_pairs(result.penetrating);
    return result;
}

} // namespace vera
