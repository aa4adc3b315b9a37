// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/svg_areas.h"

#include "vera/drawing/svg_path.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace vera::detail {

namespace {

/// Some areas as text, in rings that are rounded one after the other in the same room.
class AreaWriter {
public:
    AreaWriter(const SharedAreas& areas, const Lattice& lattice)
        : areas_(areas)
        , lattice_(lattice) {}

    void write(std::size_t first, std::size_t last) {
        // About as much as there will be: what grows is copied again and again.
        constexpr std::size_t bytes_of_area = 32;
        constexpr std::size_t bytes_of_corner = 12;
        text_.reserve(
            bytes_of_area * (last - first)
            + bytes_of_corner * (first_corner_of(last) - first_corner_of(first)));
        for (std::size_t area = first; area < last; ++area)
            write(area);
    }

    std::string take() { return std::move(text_); }

private:
    std::size_t first_corner_of(std::size_t area) const {
        const std::uint32_t ring = area == 0 ? 0 : areas_.area_ends[area - 1];
        return ring == 0 ? 0 : areas_.ring_ends[ring - 1];
    }

    void write(std::size_t area) {
        const std::size_t begin = text_.size();
        text_ += "<path fill=\"";
        text_ += css_color(areas_.colors[area]);
        text_ += "\" d=\"";
        const std::size_t data = text_.size();
        SvgPathWriter path(text_, lattice_.digits());
        const std::uint32_t end = areas_.area_ends[area];
        for (std::uint32_t i = area == 0 ? 0 : areas_.area_ends[area - 1]; i < end; ++i) {
            round_ring(i);
            if (ring_.size() >= 3)
                path.write_ring(ring_);
        }
        if (text_.size() == data)
            text_.resize(begin); // nothing is left of it
        else
            text_ += "\"/>\n";
    }

    /// The points of the ring after rounding, each but once where several in a row are equal.
    void round_ring(std::uint32_t ring) {
        ring_.clear();
        const std::uint32_t end = areas_.ring_ends[ring];
        for (std::uint32_t i = ring == 0 ? 0 : areas_.ring_ends[ring - 1]; i < end; ++i)
            if (const SnappedPoint next = lattice_.snapped(areas_.places[areas_.corners[i]]);
                ring_.empty() || next != ring_.back())
                ring_.push_back(next);
        while (ring_.size() > 1 && ring_.back() == ring_.front())
            ring_.pop_back();
    }

    const SharedAreas& areas_;
    const Lattice& lattice_;
    std::string text_;
    std::vector<SnappedPoint> ring_;
};

} // namespace

std::string css_color(DrawingColor color) {
    constexpr char digits[] = "0123456789abcdef";
    std::string text = "#";
    for (const std::uint8_t component : {color.r, color.g, color.b}) {
        text += digits[component >> 4U];
        text += digits[component & 15U];
    }
    if (text[1] == text[2] && text[3] == text[4] && text[5] == text[6])
        return {'#', text[1], text[3], text[5]};
    return text;
}

std::vector<std::string>
svg_areas(const SharedAreas& areas, const Lattice& lattice, std::size_t first, std::size_t last) {
    constexpr std::size_t part = 256; // areas that a thread writes at a time
    std::vector<std::string> parts((last - first + part - 1) / part);
    parallel_ranges(parts.size(), 1, [&](std::size_t number, std::size_t) {
        AreaWriter writer(areas, lattice);
        const std::size_t end = std::min(last, first + (number + 1) * part);
        writer.write(first + number * part, end);
        parts[number] = writer.take();
    });
    return parts;
}

} // namespace vera::detail
