// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/shadowed_raster.h"

#include "vera/base/free_room.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/base/spent_pages.h"
#include "vera/visible/cell_raster_stages.h"
#include "vera/visible/drawing_memory.h"
#include "vera/visible/face_batch.h"
#include "vera/visible/growing_parts.h"
#include "vera/visible/kept_vertices.h"
#include "vera/visible/piece_lists.h"
#include "vera/visible/pieces_before.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace vera {

namespace {

/// The raster of a screen, to which the shadows on a few faces are added at a time.
class ShadowedRaster {
public:
    ShadowedRaster(
        ScreenScene& screen,
        std::vector<SeenPart> before,
        bool sees_others,
        ThrownShadows& thrown,
        std::size_t at_a_time,
        const Progress& progress,
        const CancelFlag* cancel)
        : screen_(screen)
        , before_(std::move(before))
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
        , edges_(raster_.edges.edges.size())
        , kept_(vertices_) {
        constexpr std::size_t edges_of_shadow = 3;
        raster_.storage = storage_of(edges_ + edges_of_shadow * thrown.count());
    }

    /// Takes the shadows out of the screen.
    ~ShadowedRaster() { take_out(); }

    ShadowedRaster(const ShadowedRaster&) = delete;
    ShadowedRaster& operator=(const ShadowedRaster&) = delete;

    std::vector<SeenPart> follow_surfaces(const Progress& progress);
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

    bool has_shadows(std::uint32_t triangle) const {
        return thrown_.count_on(screen_.triangles[triangle].source) > 0;
    }

    ScreenScene& screen_;
    std::vector<SeenPart> before_; ///< without shadows, until surfaces are followed
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
std::vector<SeenPart> ShadowedRaster::follow_surfaces(const Progress& progress) {
    const LongLoop loop(edges_, progress, cancel_, 1);
    raster_.is_near_change.assign(edges_, 0);
    GrowingParts growing(raster_.storage);
    EdgeTriangles edge_triangles = vera::edge_triangles(screen_, raster_.edges);
    SeenBefore seen(screen_, before_);
    TakenBefore taken(before_, raster_.storage);
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
        const std::size_t before_these = growing.parts.size();
        if (!batch.empty()) {
            loop.turn(first);
            add(batch.take());
            mark_near_shadows(first, edge + 1);
            follow_edges(raster_, first, edge + 1, {}, cancel_, growing.parts);
        }
        VisiblePieces kept = taken.take(
            std::span(raster_.edges.edges).subspan(first, edge + 1 - first),
            std::span(raster_.is_near_change).subspan(first));
        if (!kept.pieces.empty()) {
            set_unlit(raster_, kept);
            growing.add(merged(std::move(kept), growing.take_from(before_these)));
        }
        growing.join();
        give_back_spent(edge_triangles.starts, 0, edge + 1);
        give_back_spent(edge_triangles.triangles, 0, edge_triangles.starts[edge + 1]);
        first = edge + 1;
    }
    take_out();
    made_ = batch.made();
    free_room(before_);
    free_room(raster_.is_near_change);
    free_room(is_asked_);
    return std::move(growing.parts);
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

/// The borders of shadows, in parts. What throws them is forgotten face by face.
std::vector<SeenPart> ShadowedRaster::follow_shadows(const Progress& progress) {
    GrowingParts growing(raster_.storage);
    FaceBatch batch(thrown_, most_);
    const LongLoop loop(thrown_.face_count(), progress, cancel_, 1);
    for (std::uint32_t face = 0; face < thrown_.face_count(); ++face) {
        batch.add(face);
        if (batch.empty() || (face + 1 < thrown_.face_count() && !batch.is_full()))
            continue;
        loop.turn(face);
        const std::vector<std::uint32_t> lights = add(batch.take());
        shadows_ += screen_.triangles.size() - triangles_;
        const std::size_t before = growing.parts.size();
        follow_edges(raster_, edges_, raster_.edges.edges.size(), {}, cancel_, growing.parts);
        kept_.keep(lights, screen_, std::span(growing.parts).subspan(before), raster_.storage);
        growing.join();
        thrown_.forget_before(face + 1);
    }
    return std::move(growing.parts);
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
    std::vector<std::pair<std::uint32_t, std::uint32_t>> penetrating =
        std::move(before.penetrating);
    std::vector<SeenPart> of_surfaces; // in parts: what edges are compared with is there yet
    std::vector<SeenPart> parts;
    KeptVertices kept(screen.vertices.size());
    {
        ThrownShadows own = std::move(thrown);
        std::vector<SeenPart> parts_before = parts_of(before);
        free_room(before.points);
        free_room(before.pieces);
        ShadowedRaster raster(
            screen,
            std::move(parts_before),
            !penetrating.empty(),
            own,
            at_a_time,
            progress,
            cancel);
        of_surfaces = raster.follow_surfaces(progress_between(progress, 0.2, 0.6));
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
    kept.move_to(screen, of_shadows);
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
