// SPDX-License-Identifier: Apache-2.0
#include "vera/render/refinement.h"

#include "vera/image/develop.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace vera {

namespace {

/// Pixels around a tile of which the centres are known.
constexpr std::size_t frame = 2;

/// Rays along the side of a pixel: so many that nothing of a tenth of the side's length that
/// crosses it is missed. They are sent in rounds, as the first are mostly enough.
constexpr std::size_t side_probes = 12;
constexpr std::size_t side_rounds = 3;

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

/// What shows no surface that anything else shows, and stands for a centre until its ray is sent.
Seen unknown_center() {
    Seen unknown;
    unknown.found = true;
    unknown.face.piece = no_piece;
    return unknown;
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
    strata_.clear();
}

std::size_t TileRefiner::center_of(std::size_t pixel) const {
    return (pixel / tile_.width + frame) * (tile_.width + 2 * frame) + pixel % tile_.width + frame;
}

std::uint64_t TileRefiner::picture_pixel(std::size_t pixel) const {
    const std::uint64_t row = tile_.y + pixel / tile_.width;
    return row * picture_.raster.width + tile_.x + pixel % tile_.width;
}

std::uint32_t TileRefiner::twice_samples() const {
    return std::min(2 * picture_.settings.samples, PictureLimits::most_samples);
}

std::uint32_t TileRefiner::shaded_wanted(std::size_t number) const {
    const Pixel& pixel = pixels_[number];
    constexpr std::uint32_t least_part = 4; // two agree by chance too often
    const std::uint32_t samples = picture_.settings.samples;
    // The beginning of a net of samples is a net itself.
    if (pixel.shaded == 0)
        return std::min(samples, std::max(samples / 4, least_part));
    if (pixel.shaded >= twice_samples())
        return pixel.shaded;
    // What is wrong falls as n^-0.75 with n samples of a net, where edges cross it, and what one
    // more of them brings as n^-1.75.
    const double quarters = 4.0 * pixel.shaded / samples;
    const double enough =
        picture_.settings.tolerance * quarters * std::sqrt(quarters * std::sqrt(quarters));
    // A pixel in which something thin is seen may know its centre without the colour.
    const bool has_color = pixel.reached == Refinement::edge;
    const Color* center = has_color ? &centers_[center_of(number)].color : nullptr;
    return strata_.deviation(pixel.strata, center) <= enough ? pixel.shaded : 2 * pixel.shaded;
}

std::uint32_t TileRefiner::covered_wanted(const Pixel& pixel) const {
    const std::uint32_t samples = picture_.settings.samples;
    if (pixel.reached == Refinement::thin_alone)
        return twice_samples();
    const bool is_edge = pixel.is_edge || strata_.shows_several(pixel.strata);
    return is_edge || pixel.reached == Refinement::thin ? samples : 0;
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
    // what is seen, and only where something looks thin without it.
    const std::size_t stride = tile_.width + 2 * frame;
    constexpr std::size_t compared = 1;
    center_rays_.find(picture_.raster, tile_, rays_, compared);
    targets_.clear();
    for_each_pixel(
        {frame - compared,
         frame - compared,
         tile_.width + 2 * compared,
         tile_.height + 2 * compared},
        [&](std::size_t x, std::size_t y) { targets_.push_back(y * stride + x); });
    trace_samples();
    tracer_.statistics.extra_view_rays += rays_.size() - pixels_.size();
    for (std::size_t i = 0; i < targets_.size(); ++i) {
        Seen& center = centers_[targets_[i]];
        center = seen_by_ray(i);
        center.color = clamped(colors_[i]);
        is_known_[targets_[i]] = 1;
    }
    for (std::size_t center = 0; center < centers_.size(); ++center)
        if (is_known_[center] == 0)
            centers_[center] = unknown_center();

    colors_.resize(tile_.width);
    for (std::size_t y = 0; y < tile_.height; ++y) {
        for (std::size_t x = 0; x < tile_.width; ++x)
            colors_[x] = centers_[center_of(y * tile_.width + x)].color;
        develop(colors_, picture_.image, tile_.x, tile_.y + y);
    }
}

void TileRefiner::see_centers_around(std::span<const std::size_t> pixels) {
    rays_.clear();
    targets_.clear();
    const std::size_t stride = tile_.width + 2 * frame;
    for (const std::size_t pixel : pixels) {
        const std::size_t corner = center_of(pixel) - frame * stride - frame;
        for (std::size_t row = 0; row < Window::side; ++row)
            for (std::size_t column = 0; column < Window::side; ++column) {
                const std::size_t center = corner + row * stride + column;
                if (is_known_[center] != 0)
                    continue;
                is_known_[center] = 1;
                targets_.push_back(center);
                rays_.push_back(center_ray(center));
            }
    }
    if (rays_.empty())
        return;
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
    edges_.clear();
    for_each_pixel({0, 0, tile_.width, tile_.height}, [&](std::size_t x, std::size_t y) {
        const std::size_t pixel = y * tile_.width + x;
        if (differs(window(pixel)))
            edges_.push_back(pixel);
    });
    see_centers_around(edges_);
    for (const std::size_t pixel : edges_) {
        const Window around = window(pixel);
        want(pixel, is_thin(around, around[middle]) ? refinement_of_thin(pixel) : Refinement::edge);
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
    thin_.clear();
    thin_seen_.clear();
    for (std::size_t i = 0; i < rays_.size(); ++i) {
        const Seen one = seen_by_ray(i);
        if (!is_thin(window(targets_[i]), one))
            continue;
        thin_.push_back(targets_[i]);
        thin_seen_.push_back(one);
    }
    // Centres that are not known yet may show more of it.
    see_centers_around(thin_);
    for (std::size_t i = 0; i < thin_.size(); ++i)
        if (is_thin(window(thin_[i]), thin_seen_[i]))
            want(thin_[i], refinement_of_thin(thin_[i]));
}

Refinement TileRefiner::refinement_of_thin(std::size_t pixel) {
    Refinement& found = pixels_[pixel].of_thin;
    if (found == Refinement::center) {
        const Window around = window(pixel);
        const bool is_plain = shows(around, commonest(around), 13);
        found = is_plain ? Refinement::thin_alone : Refinement::thin;
    }
    return found;
}

void TileRefiner::want(std::size_t pixel, Refinement refinement) {
    if (refinement <= pixels_[pixel].wanted || refinement <= picture_.refined[picture_pixel(pixel)])
        return;
    pixels_[pixel].wanted = refinement;
    queue(pixel);
}

void TileRefiner::queue(std::size_t pixel) {
    if (!pixels_[pixel].is_queued)
        pending_.push_back(pixel);
    pixels_[pixel].is_queued = true;
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
        const std::size_t first = next;
        jobs_.clear();
        std::size_t ray_count = 0;
        for (; next < pending_.size() && ray_count < picture_.traced.generation_size; ++next) {
            Pixel& pixel = pixels_[pending_[next]];
            pixel.is_queued = false;
            // From the beginning also where it has been refined less far: what is seen of a pixel
            // must not depend on when it was found out how far it is refined.
            if (pixel.reached != pixel.wanted) {
                pixel.shaded = 0;
                end_strata(pixel);
            }
            pixel.reached = pixel.wanted;
            const std::uint32_t wanted = shaded_wanted(pending_[next]);
            jobs_.push_back({pending_[next], pixel.shaded, wanted});
            ray_count += wanted - pixel.shaded;
            pixel.shaded = wanted;
        }
        see_centers_around(std::span(pending_).subspan(first, next - first));
        for (const Job& job : jobs_)
            if (job.first_shaded == 0)
                begin_strata(job.pixel);
        shade_samples();
        cover_pixels();

        followed_.clear();
        for (const Job& job : jobs_) {
            Pixel& pixel = pixels_[job.pixel];
            if (!pixel.is_followed && sees_thin_things(pixel, job.pixel)) {
                pixel.is_followed = true;
                followed_.push_back(job.pixel);
            }
            develop_pixel(job.pixel);
            if (shaded_wanted(job.pixel) > pixel.shaded)
                queue(job.pixel);
            else
                end_strata(pixel);
        }
        follow_thin_things();
    }
}

void TileRefiner::begin_strata(std::size_t number) {
    Pixel& pixel = pixels_[number];
    const Window around = window(number);
    const Seen& center = around[middle];
    const auto is_other = [&](std::size_t place) { return !same_surface(center, around[place]); };
    pixel.is_edge = std::any_of(opposites.begin(), opposites.end(), [&](const auto& pair) {
        return is_other(pair[0]) || is_other(pair[1]);
    });
    pixel.covered = 0;
    pixel.strata = strata_.begin(center);
}

void TileRefiner::end_strata(Pixel& pixel) {
    if (pixel.strata != PixelStrata::none)
        strata_.end(pixel.strata);
    pixel.strata = PixelStrata::none;
}

void TileRefiner::trace_samples() {
    hits_.resize(rays_.size());
    surfaces_.resize(rays_.size());
    colors_.resize(rays_.size());
    tracer_.trace(rays_, hits_, surfaces_, colors_);
    tracer_.statistics.view_rays += rays_.size();
}

void TileRefiner::shade_samples() {
    rays_.clear();
    samples_.clear();
    for (const Job& job : jobs_) {
        const SampleNet net(picture_pixel(job.pixel));
        for (std::uint32_t sample = job.first_shaded; sample < job.last_shaded; ++sample) {
            const bool is_shaded =
                strata_.any(pixels_[job.pixel].strata, [&](const Stratum& stratum) {
                    return stratum.shaded_ahead == sample;
                });
            if (!is_shaded)
                send_sample(job.pixel, net, sample);
        }
    }
    trace_samples();
    tracer_.statistics.extra_view_rays += rays_.size();

    for (std::size_t ray = 0; ray < rays_.size(); ++ray) {
        const auto [number, sample] = samples_[ray];
        const Pixel& pixel = pixels_[number];
        Stratum& stratum = strata_[strata_.find_or_add(pixel.strata, seen_by_ray(ray))];
        if (sample >= pixel.covered)
            ++stratum.covered;
        stratum.add(clamped(colors_[ray]));
    }
    for (const Job& job : jobs_)
        pixels_[job.pixel].covered = std::max(pixels_[job.pixel].covered, job.last_shaded);
}

void TileRefiner::cover_pixels() {
    rays_.clear();
    samples_.clear();
    for (const Job& job : jobs_) {
        Pixel& pixel = pixels_[job.pixel];
        const std::uint32_t wanted = covered_wanted(pixel);
        const SampleNet net(picture_pixel(job.pixel));
        for (std::uint32_t sample = pixel.covered; sample < wanted; ++sample)
            send_sample(job.pixel, net, sample);
        pixel.covered = std::max(pixel.covered, wanted);
    }
    probe();

    // What no ray has been shaded of gets its colour from the first that meets it.
    std::size_t ahead = 0;
    targets_.clear();
    for (std::size_t ray = 0; ray < rays_.size(); ++ray) {
        const auto [number, sample] = samples_[ray];
        const std::size_t met = strata_.find_or_add(pixels_[number].strata, seen_by_ray(ray));
        Stratum& stratum = strata_[met];
        if (++stratum.covered > 1)
            continue;
        stratum.shaded_ahead = sample;
        targets_.push_back(met);
        rays_[ahead] = rays_[ray];
        hits_[ahead] = hits_[ray];
        surfaces_[ahead] = surfaces_[ray];
        ++ahead;
    }
    rays_.resize(ahead);
    hits_.resize(ahead);
    surfaces_.resize(ahead);
    colors_.resize(ahead);
    tracer_.shade(rays_, hits_, surfaces_, colors_);
    tracer_.statistics.view_rays += ahead;
    tracer_.statistics.extra_view_rays += ahead;
    tracer_.statistics.probe_rays -= ahead;
    for (std::size_t i = 0; i < ahead; ++i)
        strata_[targets_[i]].add(clamped(colors_[i]));
}

void TileRefiner::send_sample(std::size_t pixel, const SampleNet& net, std::uint32_t sample) {
    samples_.push_back({pixel, sample});
    rays_.push_back(picture_.raster.ray(
        static_cast<double>(tile_.x + pixel % tile_.width),
        static_cast<double>(tile_.y + pixel / tile_.width),
        net[sample]));
}

bool TileRefiner::sees_thin_things(const Pixel& pixel, std::size_t number) const {
    if (pixel.reached >= Refinement::thin)
        return true;
    // What the centre shows is not thin, or the pixel would be refined as such.
    const Window around = window(number);
    return strata_.any(
        pixel.strata, [&](const Stratum& stratum) { return is_thin(around, stratum.seen); });
}

void TileRefiner::follow_thin_things() {
    crossings_.clear();
    for (const std::size_t pixel : followed_) {
        const std::size_t x = tile_.x + pixel % tile_.width;
        const std::size_t y = tile_.y + pixel / tile_.width;
        const Refinement refinement = refinement_of_thin(pixel);
        if (x > 0)
            look_along_side(pixel, refinement, x - 1, y);
        if (x + 1 < picture_.raster.width)
            look_along_side(pixel, refinement, x + 1, y);
        if (y > 0)
            look_along_side(pixel, refinement, x, y - 1);
        if (y + 1 < picture_.raster.height)
            look_along_side(pixel, refinement, x, y + 1);
    }
    for (std::size_t round = 0; round < side_rounds && !crossings_.empty(); ++round)
        probe_sides(round);
}

void TileRefiner::probe_sides(std::size_t round) {
    rays_.clear();
    for (const Crossing& crossing : crossings_)
        for (std::size_t i = round; i < side_probes; i += side_rounds)
            rays_.push_back(side_ray(crossing, i));
    probe();
    std::size_t ray = 0;
    std::size_t unfinished = 0;
    for (const Crossing& crossing : crossings_) {
        const Window around = window(crossing.pixel);
        std::optional<Seen> last;
        bool found = false;
        for (std::size_t i = round; i < side_probes; i += side_rounds, ++ray) {
            if (found)
                continue;
            const Seen one = seen_by_ray(ray);
            // One ray after another sees the same face: a glance at one of them is enough.
            if (last && last->face == one.face && last->below_profile == one.below_profile)
                continue;
            last = one;
            found = is_thin(around, one);
        }
        if (found)
            want_neighbour(crossing.x, crossing.y, crossing.refinement);
        else
            crossings_[unfinished++] = crossing;
    }
    crossings_.resize(unfinished);
}

void TileRefiner::look_along_side(
    std::size_t pixel, Refinement refinement, std::size_t x, std::size_t y) {
    if (is_in_tile(x, y) && pixels_[(y - tile_.y) * tile_.width + x - tile_.x].wanted >= refinement)
        return;
    crossings_.push_back({pixel, x, y, refinement});
}

QueryRay TileRefiner::side_ray(const Crossing& crossing, std::size_t i) const {
    // The places lie on the side that the two pixels have in common, whose middle is halfway
    // between their centres.
    const auto own_x = static_cast<double>(tile_.x + crossing.pixel % tile_.width);
    const auto own_y = static_cast<double>(tile_.y + crossing.pixel / tile_.width);
    const double to_x = static_cast<double>(crossing.x) - own_x;
    const double to_y = static_cast<double>(crossing.y) - own_y;
    const double along = (static_cast<double>(i) + 0.5) / side_probes - 0.5;
    const SamplePosition position = {
        0.5 + 0.5 * to_x + along * std::abs(to_y), 0.5 + 0.5 * to_y + along * std::abs(to_x)};
    return picture_.raster.ray(own_x, own_y, position);
}

void TileRefiner::develop_pixel(std::size_t number) {
    const Pixel& pixel = pixels_[number];
    Refinement& refined = picture_.refined[picture_pixel(number)];
    if (refined == Refinement::center)
        ++tracer_.statistics.refined_pixels;
    refined = pixel.reached;
    const Color color = strata_.color(pixel.strata);
    develop(
        std::span(&color, 1),
        picture_.image,
        tile_.x + number % tile_.width,
        tile_.y + number / tile_.width);
}

} // namespace vera
