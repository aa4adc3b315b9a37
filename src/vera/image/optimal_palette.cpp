// SPDX-License-Identifier: Apache-2.0
#include "vera/base/check.h"
#include "vera/image/compressed_raster.h"
#include "vera/image/palette.h"

#include <algorithm>

namespace vera {

namespace {

using Entry = ColorHistogram::Entry;
using Entries = std::span<Entry>;

constexpr std::size_t cell_of(Rgb8 color) {
    return std::size_t{color[0]} >> 3 << 11 | std::size_t{color[1]} >> 2 << 5
        | std::size_t{color[2]} >> 3;
}

double coordinate(const Oklab& color, int axis) {
    return axis == 0 ? color.lightness : (axis == 1 ? color.a : color.b);
}

/// What is needed to know the weighted squared distances from the mean.
struct Moments {
    double weight = 0;
    std::array<double, 3> sums = {};
    double squares = 0;

    void add(const Entry& entry) {
        weight += entry.weight;
        for (int axis = 0; axis < 3; ++axis) {
            const double value = coordinate(entry.mean, axis);
            sums[static_cast<std::size_t>(axis)] += entry.weight * value;
            squares += entry.weight * value * value;
        }
    }

    double sum_of_squares() const {
        if (weight == 0)
            return 0;
        return sums[0] * sums[0] / weight + sums[1] * sums[1] / weight + sums[2] * sums[2] / weight;
    }

    double error() const { return squares - sum_of_squares(); }

    Oklab mean() const { return {sums[0] / weight, sums[1] / weight, sums[2] / weight}; }
};

Moments moments(std::span<const Entry> entries) {
    Moments all;
    for (const Entry& entry : entries)
        all.add(entry);
    return all;
}

struct Box {
    Entries entries;
    double gain = 0; ///< by how much the error falls when it is cut in the best place
    int axis = 0;
    std::size_t cut = 0; ///< so many entries go to the first part, in the axis' order
};

void sort_along(Entries entries, int axis) {
    std::stable_sort(entries.begin(), entries.end(), [axis](const Entry& a, const Entry& b) {
        return coordinate(a.mean, axis) < coordinate(b.mean, axis);
    });
}

Box box_of(Entries entries) {
    Box box = {.entries = entries};
    const Moments all = moments(entries);
    for (int axis = 0; axis < 3; ++axis) {
        sort_along(entries, axis);
        Moments first;
        for (std::size_t i = 0; i + 1 < entries.size(); ++i) {
            first.add(entries[i]);
            Moments second = {.weight = all.weight - first.weight};
            for (std::size_t k = 0; k < 3; ++k)
                second.sums[k] = all.sums[k] - first.sums[k];
            const double gain =
                first.sum_of_squares() + second.sum_of_squares() - all.sum_of_squares();
            if (gain > box.gain) {
                box.gain = gain;
                box.axis = axis;
                box.cut = i + 1;
            }
        }
    }
    return box;
}

std::vector<Oklab> means_of_boxes(std::vector<Entry>& entries, std::size_t most_colors) {
    std::vector<Box> boxes = {box_of(entries)};
    while (boxes.size() < most_colors) {
        const auto widest = std::max_element(
            boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.gain < b.gain; });
        // What rounding makes of entries that are equal is no gain.
        if (widest->cut == 0 || widest->gain < 1e-12 * moments(entries).weight)
            break;
        sort_along(widest->entries, widest->axis);
        const Entries first = widest->entries.first(widest->cut);
        const Entries second = widest->entries.subspan(widest->cut);
        *widest = box_of(first);
        boxes.push_back(box_of(second));
    }
    std::vector<Oklab> means;
    for (const Box& box : boxes)
        means.push_back(moments(box.entries).mean());
    return means;
}

/// Lloyd's: each colour becomes the mean of what is nearest to it, some times.
void improve(std::vector<Oklab>& colors, std::span<const Entry> entries) {
    constexpr int rounds = 12;
    for (int round = 0; round < rounds; ++round) {
        std::vector<Moments> nearest(colors.size());
        for (const Entry& entry : entries)
            nearest[nearest_color(colors, entry.mean)].add(entry);
        for (std::size_t i = 0; i < colors.size(); ++i)
            if (nearest[i].weight > 0)
                colors[i] = nearest[i].mean();
    }
}

} // namespace

ColorHistogram::ColorHistogram()
    : cells_(std::size_t{1} << 16) {}

void ColorHistogram::add(Rgb8 color, std::uint64_t count) {
    Cell& cell = cells_[cell_of(color)];
    cell.count += count;
    for (std::size_t c = 0; c < 3; ++c)
        cell.sums[c] += count * color[c];
}

void ColorHistogram::add(const Image& image) {
    const auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
    for (std::size_t i = 0; i < samples.size(); i += 3)
        add({samples[i], samples[i + 1], samples[i + 2]});
}

void ColorHistogram::add(const CompressedRaster& raster) {
    Image tile = blank_image(0, 0, raster.type());
    std::vector<ColorRun> runs;
    for (std::size_t number = 0; number < raster.tile_count(); ++number) {
        raster.decode(number, tile, runs);
        const auto color = [&tile](std::size_t pixel) {
            return std::visit(
                [pixel](const auto& samples) {
                    Rgb8 rounded = {};
                    for (std::size_t c = 0; c < 3; ++c) {
                        const auto sample = static_cast<unsigned>(samples[3 * pixel + c]);
                        rounded[c] = static_cast<std::uint8_t>(
                            sizeof(samples[0]) == 1 ? sample : (sample + 128) / 257);
                    }
                    return rounded;
                },
                tile.samples);
        };
        std::size_t pixel = 0;
        for (const ColorRun& run : runs) {
            for (; pixel < run.first; ++pixel)
                add(color(pixel));
            add(color(pixel), run.count);
            pixel += run.count;
        }
        for (; pixel < tile.width * tile.height; ++pixel)
            add(color(pixel));
    }
}

bool ColorHistogram::empty() const {
    return std::all_of(
        cells_.begin(), cells_.end(), [](const Cell& cell) { return cell.count == 0; });
}

std::vector<Entry> ColorHistogram::entries() const {
    std::vector<Entry> entries;
    for (const Cell& cell : cells_) {
        if (cell.count == 0)
            continue;
        // The mean of near colours: whether in light or as displayed makes no difference to see.
        Rgb8 mean = {};
        for (std::size_t c = 0; c < 3; ++c)
            mean[c] = static_cast<std::uint8_t>((cell.sums[c] + cell.count / 2) / cell.count);
        entries.push_back({oklab(mean), static_cast<double>(cell.count)});
    }
    return entries;
}

Palette optimal_palette(const ColorHistogram& histogram, std::size_t most_colors) {
    VERA_CHECK(!histogram.empty() && most_colors >= 1 && most_colors <= 256);
    std::vector<Entry> entries = histogram.entries();
    std::vector<Oklab> colors = means_of_boxes(entries, most_colors);
    improve(colors, entries);
    std::stable_sort(colors.begin(), colors.end(), [](const Oklab& a, const Oklab& b) {
        return a.lightness < b.lightness;
    });
    Palette palette;
    for (const Oklab& color : colors)
        if (const Rgb8 rounded = rgb8(color);
            std::find(palette.begin(), palette.end(), rounded) == palette.end())
            palette.push_back(rounded);
    return palette;
}

} // namespace vera
