// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/hidden_parts.h"

#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"

#include <algorithm>
#include <compare>
#include <cstddef>
#include <numeric>
#include <utility>

namespace vera {

namespace {

/// A line of the picture: the same members for all segments upon it.
struct PictureLine {
    std::int32_t x = 0; ///< its direction in lowest terms, to the right or straight up
    std::int32_t y = 0;
    std::int64_t offset = 0; ///< the same cross product with each of its points

    friend constexpr auto operator<=>(const PictureLine&, const PictureLine&) = default;
};

PictureLine line_through(ScreenPoint a, ScreenPoint b) {
    const ScreenStep whole = b < a ? step(b, a) : step(a, b);
    const std::int64_t part = std::gcd(whole.x, whole.y);
    const ScreenStep direction = {whole.x / part, whole.y / part};
    return {
        static_cast<std::int32_t>(direction.x),
        static_cast<std::int32_t>(direction.y),
        cross(direction, {a.x, a.y})};
}

/// A part of a line, from its smaller end on: points upon a line are ordered along it.
struct Span {
    PictureLine line;
    RationalPoint from;
    RationalPoint to;
    std::uint32_t edge = 0;
};

bool is_before(const Span& a, const Span& b) {
    if (a.line != b.line)
        return a.line < b.line;
    if (const int found = order(a.from, b.from); found != 0)
        return found < 0;
    return a.edge < b.edge;
}

Span span_of(const ScreenScene& scene, const ScreenEdges::Edge& edge, std::uint32_t number) {
    const ScreenPoint a = scene.vertices[edge.begin].point;
    const ScreenPoint b = scene.vertices[edge.end].point;
    return {line_through(a, b), {std::min(a, b)}, {std::max(a, b)}, number};
}

Span span_of(const ScreenScene& scene, const VisiblePieces& pieces, const VisiblePiece& piece) {
    const ScreenPoint begin = scene.vertices[piece.edge.begin].point;
    const ScreenPoint end = scene.vertices[piece.edge.end].point;
    Span span = {line_through(begin, end), pieces.points[piece.from], pieces.points[piece.to]};
    if (order(span.to, span.from) < 0)
        std::swap(span.from, span.to);
    return span;
}

Span span_of(const HiddenIntersection& hidden, std::uint32_t number) {
    Span span = {line_through(hidden.begin, hidden.end), hidden.from, hidden.to, number};
    if (order(span.to, span.from) < 0)
        std::swap(span.from, span.to);
    return span;
}

/// Exact orders take long: the flag is looked at while they are asked for.
void sort_spans(std::vector<Span>& spans, const CancelFlag* cancel) {
    std::size_t asked = 0;
    std::sort(spans.begin(), spans.end(), [&](const Span& a, const Span& b) {
        if (++asked % 4096 == 0)
            stop_if_raised(cancel);
        return is_before(a, b);
    });
}

std::vector<Span> spans_to_draw(
    const ScreenScene& scene,
    const ScreenEdges& edges,
    std::span<const std::uint32_t> drawn,
    std::span<const HiddenIntersection> intersections,
    const CancelFlag* cancel) {
    std::vector<Span> spans;
    spans.reserve(drawn.size() + intersections.size());
    for (std::size_t i = 0; i < intersections.size(); ++i)
        spans.push_back(
            span_of(intersections[i], static_cast<std::uint32_t>(edges.edges.size() + i)));
    const LongLoop loop(drawn.size(), {}, cancel);
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        loop.turn(i);
        const std::uint32_t number = drawn[i];
        const ScreenEdges::Edge& edge = edges.edges[number];
        if (scene.vertices[edge.begin].point != scene.vertices[edge.end].point)
            spans.push_back(span_of(scene, edge, number));
    }
    sort_spans(spans, cancel);
    return spans;
}

/// The pieces on the lines of the edges.
std::vector<Span> spans_of_pieces(
    const ScreenScene& scene,
    const VisiblePieces& pieces,
    std::span<const Span> of,
    const CancelFlag* cancel) {
    std::vector<Span> spans;
    const LongLoop loop(pieces.pieces.size(), {}, cancel);
    for (std::size_t i = 0; i < pieces.pieces.size(); ++i) {
        loop.turn(i);
        const Span span = span_of(scene, pieces, pieces.pieces[i]);
        const auto found = std::lower_bound(
            of.begin(), of.end(), span.line, [](const Span& a, const PictureLine& line) {
                return a.line < line;
            });
        if (found != of.end() && found->line == span.line)
            spans.push_back(span);
    }
    sort_spans(spans, cancel);
    return spans;
}

} // namespace

std::vector<HiddenPart> hidden_parts(
    const ScreenScene& scene,
    const ScreenEdges& edges,
    std::span<const std::uint32_t> drawn,
    const VisiblePieces& pieces,
    std::span<const HiddenIntersection> intersections,
    const Progress& progress,
    const CancelFlag* cancel) {
    StageProgress stages(progress, 3);
    stages.next(1);
    const std::vector<Span> spans = spans_to_draw(scene, edges, drawn, intersections, cancel);
    stages.next(1);
    const std::vector<Span> seen = spans_of_pieces(scene, pieces, spans, cancel);
    std::vector<HiddenPart> parts;
    const auto add = [&](const RationalPoint& from, const RationalPoint& to, std::uint32_t edge) {
        if (order(from, to) < 0)
            parts.push_back({from, to, edge});
    };
    std::size_t next = 0; // of what is seen, the first that may lie beyond what is done
    const PictureLine* line = nullptr;
    RationalPoint done; // up to here on the line everything is told
    const LongLoop loop(spans.size(), stages.next(1), cancel);
    for (std::size_t i = 0; i < spans.size(); ++i) {
        loop.turn(i);
        const Span& span = spans[i];
        if (line == nullptr || *line != span.line)
            done = span.from;
        line = &span.line;
        if (order(done, span.from) < 0)
            done = span.from;
        while (next < seen.size() && seen[next].line < span.line)
            ++next;
        while (next < seen.size() && seen[next].line == span.line
               && order(seen[next].from, span.to) < 0 && order(done, span.to) < 0) {
            add(done, seen[next].from, span.edge);
            if (order(done, seen[next].to) < 0)
                done = seen[next].to;
            if (order(seen[next].to, span.to) > 0)
                break; // it goes on along the next edge
            ++next;
        }
        add(done, span.to, span.edge);
        if (order(done, span.to) < 0)
            done = span.to;
    }
    return parts;
}

} // namespace vera
