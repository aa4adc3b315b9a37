// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/kept_vertices.h"

#include "vera/base/parallel.h"
#include "vera/visible/vertex_numbers.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace vera {

void KeptVertices::keep(
    std::span<const std::uint32_t> lights,
    const ScreenScene& screen,
    std::span<SeenPart> parts,
    PieceStorage storage) {
    constexpr std::uint32_t none = ~std::uint32_t{0};
    std::vector<std::uint32_t> numbers(screen.vertices.size() - first_, none);
    for (const SeenPart& part : parts) {
        const VisiblePieces list = part.list();
        for (const auto& [from, to, edge, left, right] : list.pieces)
            numbers[edge.begin - first_] = numbers[edge.end - first_] = 0;
    }
    std::vector<std::size_t>& ends = ends_.emplace_back();
    for (std::size_t light = 0; light + 1 < lights.size(); ++light) {
        for (std::size_t i = lights[light]; i < lights[light + 1]; ++i)
            if (std::uint32_t& number = numbers[i - first_]; number != none) {
                number = static_cast<std::uint32_t>(first_ + vertices_.size());
                vertices_.push_back(screen.vertices[i]);
            }
        ends.push_back(vertices_.size());
    }
    for (SeenPart& part : parts) {
        VisiblePieces list = part.take();
        for (VisiblePiece& piece : list.pieces)
            piece.edge = {numbers[piece.edge.begin - first_], numbers[piece.edge.end - first_]};
        list.penetrating = std::move(part.penetrating);
        part = SeenPart(std::move(list), storage);
    }
}

/// Light by light. Returns what number each has there: that of an equal vertex of a surface, if
/// there is one.
std::vector<std::uint32_t> KeptVertices::add_to(ScreenScene& screen) const {
    std::vector<std::uint32_t> numbers(vertices_.size());
    {
        const VertexNumbers of_surfaces(screen.vertices);
        parallel_ranges(numbers.size(), 4096, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                numbers[i] = of_surfaces.find(vertices_[i]);
        });
    }
    screen.vertices.reserve(screen.vertices.size() + vertices_.size());
    const std::size_t lights = ends_.empty() ? 0 : ends_.front().size();
    for (std::size_t light = 0; light < lights; ++light)
        for (std::size_t part = 0; part < ends_.size(); ++part) {
            std::size_t i = light > 0 ? ends_[part][light - 1]
                : part > 0            ? ends_[part - 1].back()
                                      : 0;
            for (; i < ends_[part][light]; ++i)
                if (numbers[i] == VertexNumbers::none) {
                    numbers[i] = static_cast<std::uint32_t>(screen.vertices.size());
                    screen.vertices.push_back(vertices_[i]);
                }
        }
    return numbers;
}

namespace {

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

void KeptVertices::move_to(ScreenScene& screen, VisiblePieces& pieces) {
    renumber_edges(first_, add_to(screen), pieces);
    vertices_ = {};
    ends_ = {};
}

} // namespace vera
