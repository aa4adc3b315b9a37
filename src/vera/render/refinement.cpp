// SPDX-License-Identifier: Apache-2.0
#include "vera/render/refinement.h"

#include "vera/image/develop.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace vera {

namespace {

/// Pixels around a tile of which the centres are known.
constexpr std::size_t frame = 2;

/// Rays along the side of a pixel: so many that nothing of a tenth of the side's length that
/// crosses it is missed.
constexpr std::size_t side_probes = 12;

/// Of the 5 x 5 places of a window row by row, the middle one, and the pairs of opposite ones among
/// its 8 neighbours.
constexpr std::size_t middle = 12;
constexpr std::array<std::array<std::size_t, 2>, 4> opposites = {
    {{11, 13}, {7, 17}, {6, 18}, {8, 16}}};

double largest_difference(Color a, Color b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

/// Whether at least so many places of the window show the same surface as one does.
template <typename Window>
bool shows(const Window& window, const Seen& one, int wanted) {
    return window.any([&](const Seen& other) { return same_surface(one, other) && --wanted == 0; });
}

template <typename Window>
bool is_thin(const Window& window, const Seen& one) {
    return !shows(window, one, 5);
}

/// The surface that more than half of the places of the window show, if there is one: each place of
/// another surface has cancelled one of its own at most (Boyer and Moore 1991).
template <typename Window>
const Seen& commonest(const Window& window) {
    const Seen* candidate = nullptr;
    int lead = 0;
    window.any([&](const Seen& one) {
        if (lead == 0)
            candidate = &one;
        lead += same_surface(*candidate, one) ? 1 : -1;
        return false;
    });
    return *candidate;
}

template <typename Window>
Refinement refinement_of_thin(const Window& window) {
    const bool is_plain = shows(window, commonest(window), 13);
    return is_plain ? Refinement::thin_alone : Refinement::thin;
}

} // namespace

TileRefiner::TileRefiner(const RefinedPicture& picture)
    : picture_(picture)
    , tracer_(picture.traced) {}

void TileRefiner::render(const Tile& tile) {
    begin(tile);
    see_all_centers();
    find_edges();
    send_probes();
    refine_pending();
}

void TileRefiner::refine(const Tile& tile, std::span<const RefinementRequest> requests) {
    begin(tile);
    for (const RefinementRequest& request : requests) {
        const std::size_t x = request.pixel % picture_.raster.width - tile.x;
        const std::size_t y = request.pixel / picture_.raster.width - tile.y;
        want(y * tile.width + x, request.refinement);
    }
    refine_pending();
}

void TileRefiner::begin(const Tile& tile) {
    tile_ = tile;
    const std::size_t framed = (tile.width + 2 * frame) * (tile.height + 2 * frame);
    centers_.resize(framed);
    is_known_.assign(framed, 0);
    pixels_.assign(tile.width * tile.height, {});
    pending_.clear();
}

std::size_t TileRefiner::center_of(std::size_t pixel) const {
    return (pixel / tile_.width + frame) * (tile_.width + 2 * frame) + pixel % tile_.width + frame;
}

std::uint64_t TileRefiner::picture_pixel(std::size_t pixel) const {
    const std::uint64_t row = tile_.y + pixel / tile_.width;
    return row * picture_.raster.width + tile_.x + pixel % tile_.width;
}

std::uint32_t TileRefiner::samples_wanted(const Pixel& pixel) const {
    constexpr std::uint32_t most = 256;
    constexpr std::uint32_t least_part = 4; // two agree by chance too often
    const std::uint32_t samples = picture_.settings.samples;
    if (pixel.wanted == Refinement::thin_alone)
        return std::max(samples, std::min(2 * samples, most));
    // The beginning of a net of samples is a net itself.
    const bool in_parts = pixel.wanted == Refinement::edge && samples > least_part;
    if (in_parts && (pixel.samples == 0 || !differ(pixel)))
        return std::max(samples / 4, least_part);
    return samples;
}

bool TileRefiner::differ(const Pixel& pixel) const {
    return !(largest_difference(pixel.least, pixel.most) <= picture_.settings.tolerance);
}

TileRefiner::Window TileRefiner::window(std::size_t pixel) const {
    const std::size_t stride = tile_.width + 2 * frame;
    return {&centers_[center_of(pixel) - frame * stride - frame], stride};
}

QueryRay TileRefiner::center_ray(std::size_t center) const {
    const std::size_t stride = tile_.width + 2 * frame;
    const std::size_t column = center % stride;
    const std::size_t row = center / stride;
    return picture_.raster.ray(
        static_cast<double>(tile_.x + column) - frame, static_cast<double>(tile_.y + row) - frame);
}

void TileRefiner::see_all_centers() {
    // Colours are compared across the tile's border, by one pixel; farther out it matters only
    // what is seen.
    const std::size_t stride = tile_.width + 2 * frame;
    rays_.clear();
    targets_.clear();
    const Tile compared = {frame - 1, frame - 1, tile_.width + 2, tile_.height + 2};
    for_each_pixel(compared, [&](std::size_t x, std::size_t y) {
        targets_.push_back(y * stride + x);
        rays_.push_back(center_ray(targets_.back()));
    });
    trace_samples();
    tracer_.statistics.extra_view_rays += rays_.size() - pixels_.size();
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        Seen& center = centers_[targets_[i]];
        center = seen_by_ray(i);
        center.color = clamped(colors_[i]);
        is_known_[targets_[i]] = 1;
    }
    targets_.resize(centers_.size());
    std::iota(targets_.begin(), targets_.end(), std::size_t{0});
    see_unknown_centers();

    for (std::size_t y = 0; y < tile_.height; ++y) {
        colors_.clear();
        for (std::size_t x = 0; x < tile_.width; ++x)
            colors_.push_back(centers_[center_of(y * tile_.width + x)].color);
        develop(colors_, picture_.image, tile_.x, tile_.y + y);
    }
}

void TileRefiner::see_unknown_centers() {
    rays_.clear();
    std::size_t unknown = 0;
    for (const std::size_t center : targets_) {
        if (is_known_[center] != 0)
            continue;
        is_known_[center] = 1;
        targets_[unknown++] = center;
        rays_.push_back(center_ray(center));
    }
    targets_.resize(unknown);
    probe();
    for (std::size_t i = 0; i < targets_.size(); ++i)
        centers_[targets_[i]] = seen_by_ray(i);
}

void TileRefiner::probe() {
    hits_.resize(rays_.size());
    surfaces_.resize(rays_.size());
    tracer_.nearest(rays_, hits_);
    tracer_.surfaces(rays_, hits_, surfaces_);
    tracer_.statistics.probe_rays += rays_.size();
}

void TileRefiner::find_edges() {
    for (std::size_t pixel = 0; pixel < pixels_.size(); ++pixel) {
        const Window around = window(pixel);
        if (differs(around))
            want(
                pixel,
                is_thin(around, around[middle]) ? refinement_of_thin(around) : Refinement::edge);
    }
}

Seen TileRefiner::seen_by_ray(std::size_t ray) const {
    Seen one = seen(hits_[ray], surfaces_[ray]);
    const auto& firmament = picture_.traced.firmament;
    if (!one.found && firmament && firmament->profile)
        one.below_profile = firmament->profile->hides(rays_[ray].ray.direction);
    return one;
}

bool TileRefiner::differs(const Window& window) const {
    const double tolerance = picture_.settings.tolerance;
    const Seen& own = window[middle];
    for (const auto& [first, second] : opposites) {
        const Seen& one = window[first];
        const Seen& other = window[second];
        if (!same_surface(own, one) || !same_surface(own, other))
            return true;
        if (largest_difference(own.color, one.color) <= tolerance
            && largest_difference(own.color, other.color) <= tolerance)
            continue;
        // A step of the tolerance lies half of it away from the middle of its two sides.
        const Color even = 0.5 * (one.color + other.color);
        if (!(largest_difference(own.color, even) <= 0.5 * tolerance))
            return true;
    }
    return false;
}

void TileRefiner::send_probes() {
    rays_.clear();
    targets_.clear();
    for_each_pixel(tile_, [&](std::size_t x, std::size_t y) {
        const std::size_t pixel = (y - tile_.y) * tile_.width + x - tile_.x;
        if (pixels_[pixel].wanted != Refinement::center)
            return;
        rays_.push_back(picture_.raster.ray(
            static_cast<double>(x), static_cast<double>(y), probe_position(x, y)));
        targets_.push_back(pixel);
    });
    probe();
    for (std::size_t i = 0; i < rays_.size(); ++i) {
        const Window around = window(targets_[i]);
        if (is_thin(around, seen_by_ray(i)))
            want(targets_[i], refinement_of_thin(around));
    }
}

void TileRefiner::want(std::size_t pixel, Refinement refinement) {
    if (refinement <= pixels_[pixel].wanted || refinement <= picture_.refined[picture_pixel(pixel)])
        return;
    pixels_[pixel].wanted = refinement;
    pending_.push_back(pixel);
}

bool TileRefiner::is_in_tile(std::size_t x, std::size_t y) const {
    return x >= tile_.x && x < tile_.x + tile_.width && y >= tile_.y && y < tile_.y + tile_.height;
}

void TileRefiner::want_neighbour(std::size_t x, std::size_t y, Refinement refinement) {
    if (is_in_tile(x, y))
        want((y - tile_.y) * tile_.width + x - tile_.x, refinement);
    else
        outward.push_back({y * picture_.raster.width + x, refinement});
}

void TileRefiner::refine_pending() {
    // Pixels are taken as they come up, as many at a time as make a generation of rays.
    for (std::size_t next = 0; next < pending_.size();) {
        jobs_.clear();
        std::size_t ray_count = 0;
        for (; next < pending_.size() && ray_count < picture_.traced.generation_size; ++next) {
            Pixel& pixel = pixels_[pending_[next]];
            const std::uint32_t wanted = std::max(samples_wanted(pixel), pixel.samples);
            if (wanted == pixel.samples && pixel.wanted == pixel.reached)
                continue;
            jobs_.push_back({pending_[next], pixel.samples, wanted, pixel.wanted});
            ray_count += wanted - pixel.samples;
            pixel.samples = wanted;
            pixel.reached = pixel.wanted;
        }
        see_centers_around(jobs_);

        rays_.clear();
        for (const Job& job : jobs_) {
            const std::size_t x = tile_.x + job.pixel % tile_.width;
            const std::size_t y = tile_.y + job.pixel / tile_.width;
            for (std::uint32_t sample = job.first_sample; sample < job.last_sample; ++sample)
                rays_.push_back(picture_.raster.ray(
                    static_cast<double>(x),
                    static_cast<double>(y),
                    net_position(picture_pixel(job.pixel), sample)));
        }
        trace_samples();
        tracer_.statistics.extra_view_rays += rays_.size();

        std::size_t first_ray = 0;
        followed_.clear();
        for (const Job& job : jobs_) {
            add_samples(job, first_ray);
            if (job.refinement >= Refinement::thin || sees_thin_things(job, first_ray))
                followed_.push_back(job.pixel);
            develop_pixel(job);
            if (samples_wanted(pixels_[job.pixel]) > job.last_sample)
                pending_.push_back(job.pixel);
            first_ray += job.last_sample - job.first_sample;
        }
        follow_thin_things();
    }
}

void TileRefiner::see_centers_around(std::span<const Job> jobs) {
    targets_.clear();
    const std::size_t stride = tile_.width + 2 * frame;
    for (const Job& job : jobs) {
        const std::size_t corner = center_of(job.pixel) - frame * stride - frame;
        for (std::size_t row = 0; row < Window::side; ++row)
            for (std::size_t column = 0; column < Window::side; ++column)
                targets_.push_back(corner + row * stride + column);
    }
    see_unknown_centers();
}

void TileRefiner::trace_samples() {
    hits_.resize(rays_.size());
    surfaces_.resize(rays_.size());
    colors_.resize(rays_.size());
    tracer_.nearest(rays_, hits_);
    tracer_.surfaces(rays_, hits_, surfaces_);
    tracer_.shade(rays_, hits_, surfaces_, colors_);
    tracer_.statistics.view_rays += rays_.size();
}

void TileRefiner::add_samples(const Job& job, std::size_t first_ray) {
    // One after another from the first, also when a pixel's samples come in two parts.
    Pixel& pixel = pixels_[job.pixel];
    if (job.first_sample == 0)
        pixel.least = pixel.most = centers_[center_of(job.pixel)].color;
    for (std::uint32_t i = 0; i < job.last_sample - job.first_sample; ++i) {
        const Color color = clamped(colors_[first_ray + i]);
        pixel.sum += color;
        pixel.least = min(pixel.least, color);
        pixel.most = max(pixel.most, color);
    }
}

bool TileRefiner::sees_thin_things(const Job& job, std::size_t first_ray) const {
    const Window around = window(job.pixel);
    const bool own_is_thin = is_thin(around, around[middle]);
    for (std::uint32_t i = 0; i < job.last_sample - job.first_sample; ++i) {
        const Seen sample = seen_by_ray(first_ray + i);
        if (!own_is_thin && same_surface(around[middle], sample))
            continue;
        if (is_thin(around, sample))
            return true;
    }
    return false;
}

void TileRefiner::follow_thin_things() {
    rays_.clear();
    crossings_.clear();
    for (const std::size_t pixel : followed_) {
        const std::size_t x = tile_.x + pixel % tile_.width;
        const std::size_t y = tile_.y + pixel / tile_.width;
        const Refinement refinement = refinement_of_thin(window(pixel));
        if (x > 0)
            look_along_side(pixel, refinement, x - 1, y);
        if (x + 1 < picture_.raster.width)
            look_along_side(pixel, refinement, x + 1, y);
        if (y > 0)
            look_along_side(pixel, refinement, x, y - 1);
        if (y + 1 < picture_.raster.height)
            look_along_side(pixel, refinement, x, y + 1);
    }
    probe();
    for (std::size_t i = 0; i < crossings_.size(); ++i) {
        const Crossing& crossing = crossings_[i];
        const Window around = window(crossing.pixel);
        std::optional<Seen> last;
        for (std::size_t ray = i * side_probes; ray < (i + 1) * side_probes; ++ray) {
            const Seen one = seen_by_ray(ray);
            // One ray after another sees the same face: a glance at one of them is enough.
            if (last && last->face == one.face && last->below_profile == one.below_profile)
                continue;
            last = one;
            if (is_thin(around, one)) {
                want_neighbour(crossing.x, crossing.y, crossing.refinement);
                break;
            }
        }
    }
}

void TileRefiner::look_along_side(
    std::size_t pixel, Refinement refinement, std::size_t x, std::size_t y) {
    if (is_in_tile(x, y) && pixels_[(y - tile_.y) * tile_.width + x - tile_.x].wanted >= refinement)
        return;
    crossings_.push_back({pixel, x, y, refinement});
    // The places lie on the side that the two pixels have in common, whose middle is halfway
    // between their centres.
    const std::size_t column = tile_.x + pixel % tile_.width;
    const std::size_t row = tile_.y + pixel / tile_.width;
    const auto own_x = static_cast<double>(column);
    const auto own_y = static_cast<double>(row);
    const double to_x = static_cast<double>(x) - own_x;
    const double to_y = static_cast<double>(y) - own_y;
    for (std::size_t i = 0; i < side_probes; ++i) {
        const double along = (static_cast<double>(i) + 0.5) / side_probes - 0.5;
        const SamplePosition position = {
            0.5 + 0.5 * to_x + along * std::abs(to_y), 0.5 + 0.5 * to_y + along * std::abs(to_x)};
        rays_.push_back(picture_.raster.ray(own_x, own_y, position));
    }
}

void TileRefiner::develop_pixel(const Job& job) {
    Refinement& refined = picture_.refined[picture_pixel(job.pixel)];
    if (refined == Refinement::center)
        ++tracer_.statistics.refined_pixels;
    refined = job.refinement;
    const Color mean = (1.0 / job.last_sample) * pixels_[job.pixel].sum;
    develop(
        std::span(&mean, 1),
        picture_.image,
        tile_.x + job.pixel % tile_.width,
        tile_.y + job.pixel / tile_.width);
}

} // namespace vera
