// SPDX-License-Identifier: Apache-2.0
#include "vera/depth_buffer/depth_buffer.h"

#include "vera/base/check.h"

#include <algorithm>
#include <numeric>

namespace vera {

namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

constexpr int sample_bits = 24;

// The longest products of covered() have the factors: a side of the triangle, twice the samples
// along one axis, and a coordinate times twice the samples along the other; two are added.
static_assert((screen_bits + 1) + (sample_bits + 1) + (screen_bits + sample_bits + 2) + 2 < 127);

Int128 floor_divided(Int128 a, Int128 b) {
    const Int128 quotient = a / b;
    return quotient * b > a ? quotient - 1 : quotient; // b is positive
}

/// Samples from first to below last of a row.
struct Run {
    std::int64_t first = 0;
    std::int64_t last = 0;
};

/// The samples of a row that the triangle covers. Sample i of row j lies at
/// ((2 i + 1) / (2 columns), (2 j + 1) / (2 rows)) of the picture, and a side has it on the left,
/// or on itself, where constant + i * slope >= 0.
Run covered(
    const std::array<ScreenVertex, 3>& corners,
    std::int64_t columns,
    std::int64_t rows,
    std::int64_t row) {
    Run run = {0, columns};
    for (std::size_t i = 0; i < 3; ++i) {
        const ScreenPoint from = corners[i].point;
        const ScreenStep side = step(from, corners[(i + 1) % 3].point);
        const std::int64_t down = (2 * row + 1) * screen_size - 2 * rows * from.y;
        const std::int64_t across = screen_size - 2 * columns * from.x;
        const Int128 rise = 2 * Int128{side.x} * columns;
        const Int128 fall = 2 * Int128{side.y} * rows;
        const Int128 constant = rise * down - fall * across;
        const Int128 slope = -2 * fall * screen_size;
        if (slope == 0 && constant < 0)
            return {};
        // Compared in their own type: far out the bounds exceed 64 bits.
        if (slope > 0)
            run.first = static_cast<std::int64_t>(std::max(
                Int128{run.first}, std::min(-floor_divided(constant, slope), Int128{columns})));
        if (slope < 0)
            run.last = static_cast<std::int64_t>(std::min(
                Int128{run.last}, std::max(floor_divided(constant, -slope) + 1, Int128{0})));
    }
    return run;
}

/// The row of samples in which the coordinate lies, from 0 to rows.
std::size_t row_of(std::int32_t y, std::size_t rows) {
    return static_cast<std::size_t>(y) * rows / static_cast<std::size_t>(screen_size);
}

} // namespace

DepthBuffer::DepthBuffer(std::span<const DepthTriangle> triangles, const DepthSamples& samples)
    : samples_(samples) {
    constexpr std::size_t most = std::size_t{1} << sample_bits;
    VERA_CHECK(columns() <= most && rows() <= most);
    faces_.reserve(triangles.size());
    for (const DepthTriangle& triangle : triangles)
        faces_.push_back(
            {{triangle.corners, nearness_slope(depth_plane(triangle.corners))}, triangle.source});
    sort_into_bands();
}

void DepthBuffer::sort_into_bands() {
    const PixelBands picture = bands();
    const std::size_t rows_of_band = PixelBands::rows * samples_.down;
    const auto for_each_band = [&](const Face& face, const auto& visit) {
        const auto [low, high] = std::minmax(
            {face.face.corners[0].point.y,
             face.face.corners[1].point.y,
             face.face.corners[2].point.y});
        const std::size_t last = std::min(row_of(high, rows()) / rows_of_band + 1, picture.count());
        for (std::size_t band = row_of(low, rows()) / rows_of_band; band < last; ++band)
            visit(band);
    };
    starts_.assign(picture.count() + 1, 0);
    for (const Face& face : faces_)
        for_each_band(face, [&](std::size_t band) { ++starts_[band + 1]; });
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    listed_.resize(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    for (std::uint32_t i = 0; i < faces_.size(); ++i)
        for_each_band(faces_[i], [&](std::size_t band) { listed_[next[band]++] = i; });
}

/// Where both are.
bool DepthBuffer::is_in_front(std::uint32_t one, std::uint32_t other, NearnessPlace place) const {
    const Face& a = faces_[one];
    const Face& b = faces_[other];
    FrontOrder found = order_along(a.face.slope, b.face.slope, {place, place});
    if (found == FrontOrder::unknown)
        found = order_in_overlap(a.face, b.face);
    if (found == FrontOrder::penetrating) {
        const double ahead = a.face.slope.at(place) - b.face.slope.at(place);
        if (ahead != 0)
            return ahead > 0;
        found = FrontOrder::coincident;
    }
    if (found == FrontOrder::coincident)
        return a.source != b.source ? a.source < b.source : one < other;
    return found == FrontOrder::first;
}

/// Puts the triangle into a row of the buffer, which holds the numbers of triangles.
void DepthBuffer::cover(
    std::uint32_t triangle,
    std::size_t row,
    std::span<std::uint32_t> seen,
    DepthCounts& counts) const {
    const Run run = covered(
        faces_[triangle].face.corners,
        static_cast<std::int64_t>(columns()),
        static_cast<std::int64_t>(rows()),
        static_cast<std::int64_t>(row));
    const double width = screen_size / static_cast<double>(columns());
    const double y = (static_cast<double>(row) + 0.5) * screen_size / static_cast<double>(rows());
    for (std::int64_t i = run.first; i < run.last; ++i) {
        std::uint32_t& nearest = seen[static_cast<std::size_t>(i)];
        ++counts.filled;
        counts.compared += nearest == none ? 0 : 1;
        if (nearest == none
            || is_in_front(triangle, nearest, {(static_cast<double>(i) + 0.5) * width, y}))
            nearest = triangle;
    }
}

void DepthBuffer::see(
    std::size_t band, std::vector<std::uint32_t>& sources, DepthCounts* counts) const {
    DepthCounts here;
    const std::size_t first_row = bands().first_row(band) * samples_.down;
    const std::size_t last_row = bands().last_row(band) * samples_.down;
    sources.assign((last_row - first_row) * columns(), none);
    for (std::size_t i = starts_[band]; i < starts_[band + 1]; ++i) {
        const auto& corners = faces_[listed_[i]].face.corners;
        const auto [low, high] =
            std::minmax({corners[0].point.y, corners[1].point.y, corners[2].point.y});
        const std::size_t last = std::min(row_of(high, rows()) + 1, last_row);
        for (std::size_t row = std::max(row_of(low, rows()), first_row); row < last; ++row)
            cover(
                listed_[i],
                row,
                std::span(sources).subspan((row - first_row) * columns(), columns()),
                here);
    }
    if (counts != nullptr) {
        counts->filled += here.filled;
        counts->compared += here.compared;
    }
    for (std::uint32_t& seen : sources)
        seen = seen == none ? PixelPart::background : faces_[seen].source;
}

void DepthBuffer::add_parts(std::size_t band, std::vector<PixelPart>& parts) const {
    std::vector<std::uint32_t> sources;
    see(band, sources);
    const double share = 1 / static_cast<double>(samples_.across * samples_.down);
    const std::size_t first_row = bands().first_row(band);
    for (std::size_t y = first_row; y < bands().last_row(band); ++y)
        for (std::size_t x = 0; x < samples_.width; ++x) {
            const std::size_t first_part = parts.size();
            for (std::size_t i = 0; i < samples_.across * samples_.down; ++i) {
                const std::size_t column = i % samples_.across;
                const std::size_t row = i / samples_.across;
                const std::uint32_t source = sources
                    [((y - first_row) * samples_.down + row) * columns() + x * samples_.across
                     + column];
                auto part = std::find_if(
                    parts.begin() + static_cast<std::ptrdiff_t>(first_part),
                    parts.end(),
                    [&](const PixelPart& one) { return one.source == source; });
                if (part == parts.end()) {
                    parts.push_back(
                        {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), source, 0});
                    part = parts.end() - 1;
                    part->across = part->down = 0;
                }
                // Sums, until all samples are there.
                part->area += share;
                part->across += (static_cast<double>(column) + 0.5)
                    / static_cast<double>(samples_.across) * share;
                part->down +=
                    (static_cast<double>(row) + 0.5) / static_cast<double>(samples_.down) * share;
            }
            for (std::size_t i = first_part; i < parts.size(); ++i) {
                parts[i].across /= parts[i].area;
                parts[i].down /= parts[i].area;
            }
            std::sort(
                parts.begin() + static_cast<std::ptrdiff_t>(first_part),
                parts.end(),
                [](const PixelPart& a, const PixelPart& b) { return a.source < b.source; });
        }
}

} // namespace vera
