// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/image.h"
#include "vera/render/buffer.h"
#include "vera/render/center_rays.h"
#include "vera/render/generations.h"
#include "vera/render/pixel_strata.h"
#include "vera/render/raster.h"
#include "vera/render/sample_positions.h"
#include "vera/render/seen.h"
#include "vera/render/tiles.h"
#include "vera/scene/picture_settings.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// How far a pixel is refined.
enum class Refinement : std::uint8_t {
    center,    ///< one ray
    edge,      ///< by Antialiasing::samples rays, a part of them if it shows one surface
    thin,      ///< by all of them
    thin_alone ///< by twice as many
};

/// The wish that a pixel, numbered row by row, be refined.
struct RefinementRequest {
    std::uint64_t pixel = 0;
    Refinement refinement = Refinement::edge;

    friend constexpr auto operator<=>(const RefinementRequest&, const RefinementRequest&) = default;
};

/// What the tiles of a picture have in common. refined[pixel] is written by the pixel's tile alone.
struct RefinedPicture {
    const TracedScene& traced;
    const Raster& raster;
    const Antialiasing& settings;
    Image& image;
    std::span<Refinement> refined;
};

/// Renders and refines tiles, one after another: what a thread needs for it.
class TileRefiner {
public:
    explicit TileRefiner(const RefinedPicture& picture);

    /// The rays through the centres, the probes, and what they lead to within the tile.
    void render(const Tile& tile);

    /// What the requests, all of pixels of the tile, lead to within the tile.
    void refine(const Tile& tile, std::span<const RefinementRequest> requests);

    /// Requests that have come up for pixels of other tiles.
    std::vector<RefinementRequest> outward;

    RenderStatistics statistics() const { return tracer_.statistics; }

private:
    /// Samples of a pixel that get a colour together.
    struct Job {
        std::size_t pixel = 0; ///< in the tile
        std::uint32_t first_shaded = 0;
        std::uint32_t last_shaded = 0;
    };

    /// A ray of a pixel.
    struct Sample {
        std::size_t pixel = 0; ///< in the tile
        std::uint32_t number = 0;
    };

    /// A side over which something thin may go on to a neighbour.
    struct Crossing {
        std::size_t pixel = 0; ///< in the tile
        std::size_t x = 0;     ///< of the neighbour, in the picture
        std::size_t y = 0;
        Refinement refinement = Refinement::edge; ///< which the neighbour then gets
    };

    /// A pixel of the tile, while it is worked on.
    struct Pixel {
        Refinement wanted = Refinement::center;
        Refinement reached = Refinement::center;
        Refinement of_thin = Refinement::center; ///< refinement_of_thin(), where that was asked
        bool is_edge = false;                    ///< a neighbour's centre shows another surface
        bool is_queued = false;                  ///< it is pending
        bool is_followed = false;                ///< it was asked where its thin things go on
        std::uint32_t shaded = 0;                ///< the first samples, which have a colour
        std::uint32_t covered = 0; ///< the first samples, of which it is known what they meet
        std::size_t strata = PixelStrata::none;
    };

    /// The centres in a pixel's surroundings.
    struct Window {
        static constexpr std::size_t side = 5;

        const Seen* corner = nullptr;
        std::size_t stride = 0; ///< from row to row

        /// Of the places row by row.
        const Seen& operator[](std::size_t place) const {
            return corner[place / side * stride + place % side];
        }

        /// Calls visit(centre), row by row, until it returns true; returns whether it did.
        template <typename Visit>
        bool any(const Visit& visit) const {
            for (std::size_t row = 0; row < side; ++row)
                for (std::size_t column = 0; column < side; ++column)
                    if (visit(corner[row * stride + column]))
                        return true;
            return false;
        }
    };

    void begin(const Tile& tile);
    void see_all_centers();
    void find_edges();
    void send_probes();
    void refine_pending();
    void see_centers_around(std::span<const std::size_t> pixels);
    void probe();
    void trace_samples();
    void begin_strata(std::size_t number);
    void end_strata(Pixel& pixel);
    void shade_samples();
    void cover_pixels();
    void send_sample(std::size_t pixel, const SampleNet& net, std::uint32_t sample);
    bool sees_thin_things(const Pixel& pixel, std::size_t number) const;
    void follow_thin_things();
    void look_along_side(std::size_t pixel, Refinement refinement, std::size_t x, std::size_t y);
    void probe_sides(std::size_t round);
    void develop_pixel(std::size_t number);
    Seen seen_by_ray(std::size_t ray) const;

    /// How far the pixel is refined if something thin is seen in it; the centres around it must be
    /// known.
    Refinement refinement_of_thin(std::size_t pixel);
    void want(std::size_t pixel, Refinement refinement);
    void queue(std::size_t pixel);
    void want_neighbour(std::size_t x, std::size_t y, Refinement refinement);
    bool differs(const Window& window) const;
    Window window(std::size_t pixel) const;
    QueryRay center_ray(std::size_t center) const;
    bool is_in_tile(std::size_t x, std::size_t y) const;
    std::size_t center_of(std::size_t pixel) const;
    std::uint64_t picture_pixel(std::size_t pixel) const;
    std::uint32_t shaded_wanted(std::size_t number) const;
    std::uint32_t twice_samples() const;
    std::uint32_t covered_wanted(const Pixel& pixel) const;
    QueryRay side_ray(const Crossing& crossing, std::size_t i) const;

    const RefinedPicture& picture_;
    GenerationTracer tracer_;
    CenterRays center_rays_;

    Tile tile_;
    std::vector<Seen> centers_;          ///< of the tile and a frame of two pixels around it
    std::vector<std::uint8_t> is_known_; ///< which of them
    std::vector<Pixel> pixels_;
    std::vector<std::size_t> edges_; ///< pixels whose centres differ from their neighbours'
    std::vector<std::size_t> thin_;  ///< pixels of which the probes have seen something thin
    std::vector<Seen> thin_seen_;
    std::vector<std::size_t> pending_;
    std::vector<Job> jobs_;
    PixelStrata strata_;
    std::vector<std::size_t> followed_; ///< pixels in which something thin is seen
    std::vector<Crossing> crossings_;

    std::vector<QueryRay> rays_;
    std::vector<std::size_t> targets_; ///< what the rays are for
    std::vector<Sample> samples_;      ///< of which the rays are
    Buffer<Hit> hits_;
    Buffer<SurfacePoint> surfaces_;
    Buffer<Color> colors_;
};

} // namespace vera
