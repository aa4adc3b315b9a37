// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/shadowed_raster.h"

#include "vera/base/free_room.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/base/spent_pages.h"
#include "vera/visible/cell_raster_stages.h"
#include "vera/visible/drawing_memory.h"
#include "vera/visible/piece_lists.h"
#include "vera/visible/vertex_numbers.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <iterator>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace vera {

namespace {

/// What was seen beside each edge without shadows, for edges that come in ascending order.
class SeenBefore {
public:
    SeenBefore(const ScreenScene& screen, const std::vector<SeenPart>& before)
        : screen_(screen)
        , before_(before) {}

    /// Calls visit(source) for each, perhaps more than once.
    template <typename Visit>
    void for_each_beside(ScreenEdges::Edge edge, const Visit& visit) {
        for (; part_ < before_.size(); ++part_, next_ = 0) {
            if (listed_ != part_) {
                list_ = before_[part_].list();
                listed_ = part_;
            }
            for (; next_ < list_.pieces.size(); ++next_) {
                const VisiblePiece& piece = list_.pieces[next_];
                if (edge < piece.edge)
                    return;
                if (piece.edge != edge)
                    continue;
                for (const std::uint32_t triangle : {piece.left, piece.right})
                    if (triangle != no_triangle)
                        visit(screen_.triangles[triangle].source);
            }
        }
    }

private:
    const ScreenScene& screen_;
    const std::vector<SeenPart>& before_;
    std::size_t part_ = 0;
    VisiblePieces list_; ///< of the part listed_
    std::size_t listed_ = ~std::size_t{0};
    std::size_t next_ = 0; ///< of its pieces
};

/// What was seen without shadows, of which parts of the edges take what stays as it was.
class TakenBefore {
public:
    TakenBefore(std::vector<SeenPart>& before, PieceStorage storage)
        : before_(before)
        , storage_(storage) {}

    /// Of edges that come in ascending order, the pieces of those that are not near a change; which
    /// are forgotten with the others up to the last of these edges.
    VisiblePieces
    take(std::span<const ScreenEdges::Edge> edges, std::span<const std::uint8_t> is_near_change) {
        std::vector<SeenPart> all;
        for (std::size_t edge = 0; part_ < before_.size() && !edges.empty();) {
            if (listed_ != part_) {
                list_ = before_[part_].list();
                listed_ = part_;
            }
            VisiblePieces taken;
            PieceCopy copy(list_, taken);
            for (; next_ < list_.pieces.size(); ++next_) {
                const ScreenEdges::Edge here = list_.pieces[next_].edge;
                if (edges.back() < here)
                    break;
                while (edges[edge] < here)
                    ++edge;
                if (is_near_change[edge] == 0)
                    copy.add(next_);
            }
            if (!taken.pieces.empty())
                all.emplace_back(std::move(taken), storage_);
            if (next_ < list_.pieces.size())
                break;
            freed_.count(before_[part_].room());
            before_[part_] = {};
            ++part_;
            next_ = 0;
        }
        return joined(std::move(all));
    }

private:
    std::vector<SeenPart>& before_;
    PieceStorage storage_;
    FreedBlocks freed_;
    std::size_t part_ = 0;
    VisiblePieces list_; ///< of the part listed_
    std::size_t listed_ = ~std::size_t{0};
    std::size_t next_ = 0; ///< of its pieces
};

/// The faces of which the shadows are there at a time. Where the same ones come back again and
/// again, as where large faces are seen between each other all over the picture, four times as many
/// may be there from then on, and so on: else shadows would be made for every few edges anew.
class FaceBatch {
public:
    FaceBatch(const ThrownShadows& thrown, std::size_t most)
        : thrown_(thrown)
        , most_(most)
        , most_made_(often * thrown.count())
        , is_in_(thrown.face_count()) {}

    void add(std::uint32_t face) {
        if (is_in_[face] != 0 || thrown_.count_on(face) == 0)
            return;
        is_in_[face] = 1;
        faces_.push_back(face);
        shadows_ += thrown_.count_on(face);
    }

    bool empty() const { return faces_.empty(); }

    bool is_full() const { return shadows_ >= most_; }

    /// In ascending order.
    std::vector<std::uint32_t> take() {
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

    /// Shadows of all that were taken, as often as they were.
    std::size_t made() const { return made_; }

private:
    static constexpr std::size_t often = 2; ///< so often may all be made before more are at a time

    const ThrownShadows& thrown_;
    std::size_t most_;
    std::size_t most_made_;
    std::vector<std::uint8_t> is_in_;
    std::vector<std::uint32_t> faces_;
    std::size_t shadows_ = 0;
    std::size_t made_ = 0;
    std::size_t made_with_most_ = 0; ///< as large as it is now
};

/// How many shadows may be there at a time: several times as many as fall on one face, or those of
/// one that most edges are beside, as a floor's, would be made again for almost each.
std::size_t most_at_a_time(const ThrownShadows& thrown, std::size_t wanted) {
    constexpr std::size_t faces = 4;
    std::size_t most = wanted;
    for (std::uint32_t face = 0; face < thrown.face_count(); ++face)
        most = std::max(most, faces * thrown.count_on(face));
    return most;
}

/// Vertices of shadows between which pieces lie, light by light of one part of the faces after the
/// other.
struct KeptVertices {
    std::deque<ScreenVertex> vertices;          // which has no room twice while it grows
    std::vector<std::vector<std::size_t>> ends; ///< of the parts, of each light, among these
};

/// Makes one of the parts from that number on.
void join_from(std::size_t first, std::vector<SeenPart>& parts, PieceStorage storage) {
    const auto these = parts.begin() + static_cast<std::ptrdiff_t>(first);
    VisiblePieces one = joined({std::move_iterator(these), std::move_iterator(parts.end())});
    parts.erase(these, parts.end());
    parts.emplace_back(std::move(one), storage);
}

/// Joins parts in their order whenever they have many pieces: half of the points of small ones are
/// points of others as well.
class GrowingParts {
public:
    GrowingParts(std::vector<SeenPart>& parts, PieceStorage storage)
        : parts_(parts)
        , storage_(storage) {}

    /// When there are further ones.
    void join() {
        std::size_t pieces = 0;
        for (std::size_t i = first_; i < parts_.size(); ++i)
            pieces += parts_[i].size();
        if (pieces < many)
            return;
        join_from(first_, parts_, storage_);
        first_ = parts_.size();
    }

private:
    static constexpr std::size_t many = 65536;

    std::vector<SeenPart>& parts_;
    PieceStorage storage_;
    std::size_t first_ = 0; ///< of those that are not joined
};

class ShadowedRaster {
public:
    ShadowedRaster(
        ScreenScene& screen,
        const std::vector<SeenPart>& before,
        bool sees_others,
        ThrownShadows& thrown,
        std::size_t at_a_time,
        const Progress& progress,
        const CancelFlag* cancel)
        : screen_(screen)
        , before_(before)
        , thrown_(thrown)
        , cancel_(cancel)
        , triangles_(screen.triangles.size())
        , vertices_(screen.vertices.size())
        , sees_others_(sees_others)
        , most_(
              sees_others_ ? std::numeric_limits<std::size_t>::max()
                           : most_at_a_time(thrown, std::max(at_a_time, triangles_ / 32)))
        , raster_(raster_of(
              screen,
              [&](CellRaster& raster, const Cells& cells) { return asked_cells(raster, cells); },
              progress,
              cancel))
        , squares_(raster_.cells)
        , edges_(raster_.edges.edges.size()) {
        constexpr std::size_t edges_of_shadow = 3;
        raster_.storage = storage_of(edges_ + edges_of_shadow * thrown.count());
    }

    /// Takes the shadows out of the screen.
    ~ShadowedRaster() { take_out(); }

    ShadowedRaster(const ShadowedRaster&) = delete;
    ShadowedRaster& operator=(const ShadowedRaster&) = delete;

    std::vector<SeenPart> follow_surfaces(std::vector<SeenPart> before, const Progress& progress);
    double expected_of_shadows();
    std::vector<SeenPart> follow_shadows(const Progress& progress);

    /// Afterwards.
    KeptVertices take_kept() { return std::move(kept_); }

    std::size_t shadows() const { return shadows_; }

    std::size_t made() const { return made_; }

private:
    std::vector<std::uint8_t> asked_cells(const CellRaster& raster, const Cells& cells);
    void take_out();
    std::vector<std::uint32_t> add(std::span<const std::uint32_t> faces);
    void mark_near_shadows(std::size_t first, std::size_t last);
    void keep_vertices(std::span<const std::uint32_t> lights, std::span<SeenPart> parts);

    bool has_shadows(std::uint32_t triangle) const {
        return thrown_.count_on(screen_.triangles[triangle].source) > 0;
    }

    ScreenScene& screen_;
    const std::vector<SeenPart>& before_;
    ThrownShadows& thrown_;
    const CancelFlag* cancel_;
    std::size_t triangles_; ///< surfaces
    std::size_t vertices_;  ///< of these
    /// Where triangles that pass through each other are seen, others are as well than those that
    /// the pieces tell.
    bool sees_others_;
    std::size_t most_;                   ///< shadows at a time
    std::vector<std::uint8_t> is_asked_; ///< of surfaces' edges: there may be a shadow beside it
    CellRaster raster_;
    HiddenSquares squares_;
    std::size_t edges_; ///< of surfaces
    KeptVertices kept_;
    std::size_t shadows_ = 0;
    std::size_t made_ = 0; ///< beside the surfaces' edges
};

/// Those along the edges beside which there may be a shadow, and those of the surfaces that have
/// some. Where others are seen than the pieces tell, there may be one beside each edge.
std::vector<std::uint8_t>
ShadowedRaster::asked_cells(const CellRaster& raster, const Cells& cells) {
    is_asked_.assign(raster.edges.edges.size(), sees_others_ ? 1 : 0);
    SeenBefore seen(screen_, before_);
    for (std::size_t i = 0; i < is_asked_.size(); ++i)
        seen.for_each_beside(raster.edges.edges[i], [&](std::uint32_t source) {
            if (thrown_.count_on(source) > 0)
                is_asked_[i] = 1;
        });
    for (std::uint32_t i = 0; i < triangles_; ++i)
        if (has_shadows(i))
            for (const std::uint32_t edge : raster.edges.of_triangle[i])
                is_asked_[edge] = 1;
    std::vector<std::uint8_t> are_asked = cells_along(is_asked_, raster, cells);
    for (std::uint32_t i = 0; i < triangles_; ++i)
        if (has_shadows(i))
            for_each_cell_of(cells, corners_of(screen_, screen_.triangles[i]), [&](std::size_t at) {
                are_asked[at] = 1;
            });
    return are_asked;
}

void ShadowedRaster::take_out() {
    take_shadows_out(raster_, triangles_, edges_);
    screen_.triangles.resize(triangles_);
    screen_.vertices.resize(vertices_);
}

/// Shadows on these faces in place of others. Returns with which vertex each light begins.
std::vector<std::uint32_t> ShadowedRaster::add(std::span<const std::uint32_t> faces) {
    take_out();
    std::vector<std::uint32_t> starts = thrown_.add_on(faces, screen_, cancel_);
    add_shadows_to(raster_, triangles_, vertices_, squares_, cancel_);
    return starts;
}

/// Of the surfaces' edges from first to before last, those through a cell with a shadow.
void ShadowedRaster::mark_near_shadows(std::size_t first, std::size_t last) {
    const ShadowCells& shadows = raster_.shadow_cells;
    if (shadows.starts.empty())
        return;
    parallel_ranges(last - first, 1024, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = first + from; i < first + to; ++i) {
            if (is_asked_[i] == 0)
                continue;
            const auto& [begin, end] = raster_.edges.edges[i];
            const bool is_far = for_each_cell_along(
                raster_.cells,
                screen_.vertices[begin].point,
                screen_.vertices[end].point,
                [&](std::size_t cell) { return shadows.shadows_of(cell).empty(); });
            raster_.is_near_change[i] = is_far ? 0 : 1;
        }
    });
}

/// The borders of surfaces, in the shadows on both sides, in parts. What was before is forgotten
/// piece by piece.
std::vector<SeenPart>
ShadowedRaster::follow_surfaces(std::vector<SeenPart> before, const Progress& progress) {
    const LongLoop loop(edges_, progress, cancel_, 1);
    raster_.is_near_change.assign(edges_, 0);
    const auto unlit = [&](std::uint32_t triangle) {
        return triangle == no_triangle ? 0 : screen_.unlit_of(screen_.triangles[triangle].source);
    };
    std::vector<SeenPart> parts;
    GrowingParts growing(parts, raster_.storage);
    EdgeTriangles edge_triangles = vera::edge_triangles(screen_, raster_.edges);
    SeenBefore seen(screen_, before);
    TakenBefore taken(before, raster_.storage);
    FaceBatch batch(thrown_, most_);
    for (std::uint32_t face = 0; sees_others_ && face < thrown_.face_count(); ++face)
        batch.add(face);
    for (std::size_t first = 0, edge = 0; edge < edges_; ++edge) {
        const auto number = static_cast<std::uint32_t>(edge);
        if (raster_.hidden_eighths[edge] != all_eighths)
            for (const std::uint32_t triangle : edge_triangles.of(number))
                batch.add(screen_.triangles[triangle].source);
        seen.for_each_beside(
            raster_.edges.edges[edge], [&](std::uint32_t source) { batch.add(source); });
        if (edge + 1 < edges_ && !batch.is_full())
            continue;
        const std::size_t before_these = parts.size();
        if (!batch.empty()) {
            loop.turn(first);
            add(batch.take());
            mark_near_shadows(first, edge + 1);
            follow_edges(raster_, first, edge + 1, {}, cancel_, parts);
        }
        VisiblePieces kept = taken.take(
            std::span(raster_.edges.edges).subspan(first, edge + 1 - first),
            std::span(raster_.is_near_change).subspan(first));
        if (!kept.pieces.empty()) {
            for (const VisiblePiece& piece : kept.pieces)
                kept.unlit.push_back({unlit(piece.left), unlit(piece.right)});
            const auto these = parts.begin() + static_cast<std::ptrdiff_t>(before_these);
            VisiblePieces found =
                joined({std::move_iterator(these), std::move_iterator(parts.end())});
            parts.erase(these, parts.end());
            parts.emplace_back(merged(std::move(kept), std::move(found)), raster_.storage);
        }
        growing.join();
        give_back_spent(edge_triangles.starts, 0, edge + 1);
        give_back_spent(edge_triangles.triangles, 0, edge_triangles.starts[edge + 1]);
        first = edge + 1;
    }
    take_out();
    made_ = batch.made();
    free_room(raster_.is_near_change);
    free_room(is_asked_);
    return parts;
}

/// From the shadows on a few faces.
double ShadowedRaster::expected_of_shadows() {
    constexpr std::size_t least = 2048;
    constexpr std::size_t part = 128;
    const std::size_t all = thrown_.count();
    const std::size_t wanted = std::max(least, all / part);
    std::vector<std::uint32_t> faces;
    std::size_t taken = 0;
    std::size_t passed = 0;
    for (std::uint32_t face = 0; face < thrown_.face_count(); ++face) {
        passed += thrown_.count_on(face);
        if (thrown_.count_on(face) == 0 || taken * all > wanted * passed)
            continue;
        faces.push_back(face);
        taken += thrown_.count_on(face);
    }
    if (taken == 0)
        return 0;
    add(faces);
    return expected_pieces(raster_, edges_, raster_.edges.edges.size(), cancel_).pieces
        * static_cast<double>(all) / static_cast<double>(taken);
}

/// Of the shadows' vertices, which are forgotten and of which each light has those from there on,
/// keeps those between which pieces lie.
void ShadowedRaster::keep_vertices(
    std::span<const std::uint32_t> lights, std::span<SeenPart> parts) {
    constexpr std::uint32_t none = ~std::uint32_t{0};
    std::vector<std::uint32_t> numbers(screen_.vertices.size() - vertices_, none);
    for (const SeenPart& part : parts) {
        const VisiblePieces list = part.list();
        for (const auto& [from, to, edge, left, right] : list.pieces)
            numbers[edge.begin - vertices_] = numbers[edge.end - vertices_] = 0;
    }
    std::vector<std::size_t>& ends = kept_.ends.emplace_back();
    for (std::size_t light = 0; light + 1 < lights.size(); ++light) {
        for (std::size_t i = lights[light]; i < lights[light + 1]; ++i)
            if (std::uint32_t& number = numbers[i - vertices_]; number != none) {
                number = static_cast<std::uint32_t>(vertices_ + kept_.vertices.size());
                kept_.vertices.push_back(screen_.vertices[i]);
            }
        ends.push_back(kept_.vertices.size());
    }
    for (SeenPart& part : parts) {
        VisiblePieces list = part.take();
        for (VisiblePiece& piece : list.pieces)
            piece.edge = {
                numbers[piece.edge.begin - vertices_], numbers[piece.edge.end - vertices_]};
        list.penetrating = std::move(part.penetrating);
        part = SeenPart(std::move(list), raster_.storage);
    }
}

/// The borders of shadows, in parts. What throws them is forgotten face by face.
std::vector<SeenPart> ShadowedRaster::follow_shadows(const Progress& progress) {
    std::vector<SeenPart> parts;
    GrowingParts growing(parts, raster_.storage);
    FaceBatch batch(thrown_, most_);
    const LongLoop loop(thrown_.face_count(), progress, cancel_, 1);
    for (std::uint32_t face = 0; face < thrown_.face_count(); ++face) {
        batch.add(face);
        if (batch.empty() || (face + 1 < thrown_.face_count() && !batch.is_full()))
            continue;
        loop.turn(face);
        const std::vector<std::uint32_t> lights = add(batch.take());
        shadows_ += screen_.triangles.size() - triangles_;
        const std::size_t before = parts.size();
        follow_edges(raster_, edges_, raster_.edges.edges.size(), {}, cancel_, parts);
        keep_vertices(lights, std::span(parts).subspan(before));
        growing.join();
        thrown_.forget_before(face + 1);
    }
    return parts;
}

/// Adds the vertices to the screen, light by light. Returns what number each has there: that of an
/// equal vertex of a surface, if there is one.
std::vector<std::uint32_t> add_vertices(const KeptVertices& kept, ScreenScene& screen) {
    std::vector<std::uint32_t> numbers(kept.vertices.size());
    {
        const VertexNumbers of_surfaces(screen.vertices);
        parallel_ranges(numbers.size(), 4096, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                numbers[i] = of_surfaces.find(kept.vertices[i]);
        });
    }
    screen.vertices.reserve(screen.vertices.size() + kept.vertices.size());
    const std::size_t lights = kept.ends.empty() ? 0 : kept.ends.front().size();
    for (std::size_t light = 0; light < lights; ++light)
        for (std::size_t part = 0; part < kept.ends.size(); ++part) {
            std::size_t i = light > 0 ? kept.ends[part][light - 1]
                : part > 0            ? kept.ends[part - 1].back()
                                      : 0;
            for (; i < kept.ends[part][light]; ++i)
                if (numbers[i] == VertexNumbers::none) {
                    numbers[i] = static_cast<std::uint32_t>(screen.vertices.size());
                    screen.vertices.push_back(kept.vertices[i]);
                }
        }
    return numbers;
}

/// Gives the shadows' edges, whose vertices are numbered from `first` on, these numbers, and sorts
/// the pieces by them. An edge goes from the smaller number to the larger one.
void renumber_edges(
    std::size_t first, const std::vector<std::uint32_t>& numbers, VisiblePieces& list) {
    std::vector<std::uint8_t> is_turned(list.pieces.size());
    bool is_sorted = true;
    for (std::size_t i = 0; i < list.pieces.size(); ++i) {
        VisiblePiece& piece = list.pieces[i];
        piece.edge = {numbers[piece.edge.begin - first], numbers[piece.edge.end - first]};
        if (piece.edge.end < piece.edge.begin) {
            is_turned[i] = 1;
            std::swap(piece.edge.begin, piece.edge.end);
            std::swap(piece.from, piece.to);
            std::swap(piece.left, piece.right);
            std::swap(list.unlit[i].left, list.unlit[i].right);
        }
        is_sorted =
            is_sorted && is_turned[i] == 0 && (i == 0 || !(piece.edge < list.pieces[i - 1].edge));
    }
    if (is_sorted)
        return;
    std::vector<std::uint32_t> order(list.pieces.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        if (list.pieces[a].edge != list.pieces[b].edge)
            return list.pieces[a].edge < list.pieces[b].edge;
        if (is_turned[a] != is_turned[b])
            return is_turned[a] < is_turned[b];
        return is_turned[a] != 0 ? b < a : a < b; // along the edge
    });
    std::vector<VisiblePiece> pieces(order.size());
    std::vector<UnlitBeside> unlit(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        pieces[i] = list.pieces[order[i]];
        unlit[i] = list.unlit[order[i]];
    }
    list.pieces = std::move(pieces);
    list.unlit = std::move(unlit);
}

} // namespace

ShadowedPieces shadowed_cell_raster(
    ScreenScene& screen,
    VisiblePieces before,
    ThrownShadows thrown,
    const Progress& progress,
    const CancelFlag* cancel,
    const ExpectPieces& expect,
    std::size_t at_a_time) {
    ShadowedPieces result;
    const std::size_t vertices = screen.vertices.size();
    std::vector<std::pair<std::uint32_t, std::uint32_t>> penetrating =
        std::move(before.penetrating);
    std::vector<SeenPart> of_surfaces; // in parts: what edges are compared with is there yet
    std::vector<SeenPart> parts;
    KeptVertices kept;
    {
        ThrownShadows own = std::move(thrown);
        std::vector<SeenPart> parts_before = parts_of(before);
        free_room(before.points);
        free_room(before.pieces);
        ShadowedRaster raster(
            screen, parts_before, !penetrating.empty(), own, at_a_time, progress, cancel);
        of_surfaces =
            raster.follow_surfaces(std::move(parts_before), progress_between(progress, 0.2, 0.6));
        std::size_t surfaces = 0;
        for (const SeenPart& part : of_surfaces)
            surfaces += part.size();
        const double pieces = static_cast<double>(surfaces) + raster.expected_of_shadows();
        require_piece_memory(pieces);
        if (expect)
            expect(pieces);
        parts = raster.follow_shadows(progress_between(progress, 0.6, 1));
        kept = raster.take_kept();
        result.shadows = raster.shadows();
        result.made = raster.made();
    }
    screen.triangles.shrink_to_fit();
    give_back_freed_memory();
    VisiblePieces of_shadows = joined(std::move(parts));
    renumber_edges(vertices, add_vertices(kept, screen), of_shadows);
    kept.vertices = {};
    give_back_freed_memory();
    result.pieces = joined(std::move(of_surfaces), of_shadows.pieces.size());
    for (const VisiblePieces* found : {&result.pieces, &of_shadows})
        penetrating.insert(penetrating.end(), found->penetrating.begin(), found->penetrating.end());
    sort_pairs(penetrating);
    result.pieces = merged(std::move(result.pieces), std::move(of_shadows));
    result.pieces.penetrating = std::move(penetrating);
    return result;
}

} // namespace vera
