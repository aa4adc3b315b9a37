// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"
#include "vera/base/parallel.h"
#include "vera/math/color.h"
#include "vera/render/buffer.h"
#include "vera/render/generation_size.h"
#include "vera/render/ray_terms.h"
#include "vera/render/statistics.h"
#include "vera/scene/light.h"
#include "vera/scene/picture_settings.h"
#include "vera/scene/scene.h"
#include "vera/scene/surface.h"
#include "vera/shade/place_blocks.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace vera {

/// The light that EXPMES scales: the light sources and AMBIENT.
struct Illumination {
    std::vector<PointLight> lights;
    Color ambient;
};

/// What all rays of a picture have in common. The scene and its index must outlive it.
struct TracedScene {
    const Scene& scene;
    const RayIndex& index;
    Illumination illumination;
    std::optional<Firmament> firmament;
    bool shadows = true;
    bool luminosity = true;  ///< SDI and SAN count
    std::uint32_t depth = 2; ///< levels of the ray tree
    const CancelFlag* cancel = nullptr;
    std::size_t generation_size = usual_generation_size; ///< at least 1
};

TracedScene traced_scene(
    const Scene& scene,
    const RayIndex& index,
    const PictureSettings& settings,
    const CancelFlag* cancel = nullptr);

/// Traces whole generations of rays: all rays given, then all that those send on from mirrors and
/// glass, and so on. A ray's colour is the sum of the lighting formula, its terms added in their
/// order, and so depends on nothing but the ray. The buffers are kept from one call to the next;
/// each thread uses a tracer of its own, which gives parts of a long generation to all threads.
class GenerationTracer {
public:
    explicit GenerationTracer(const TracedScene& traced);

    /// What a ray takes of memory in work, at each level of the ray tree that it or what it sends
    /// on comes to.
    static std::size_t bytes_per_ray();

    /// The first face that each ray meets, and where; the others' surface is left as it was.
    void nearest(std::span<const QueryRay> rays, std::span<Hit> hits);

    /// Where the rays of which the hits are meet a face.
    void
    surfaces(std::span<const QueryRay> rays, std::span<const Hit> hits, std::span<SurfacePoint> at);

    /// What rays see that meet no face (hits[i] not found) or meet it at at[i]. Where terms is not
    /// empty it is filled with those that the colours are made of, ray by ray, and of each ray by
    /// term_number(); added up they are the colour, but for rounding.
    void shade(
        std::span<const QueryRay> rays,
        std::span<const Hit> hits,
        std::span<const SurfacePoint> at,
        std::span<Color> colors,
        std::span<Color> terms = {});

    /// What the rays see: all of the above.
    void trace(std::span<const QueryRay> rays, std::span<Color> colors);

    /// The same, which tells what they meet as well, and where.
    void trace(
        std::span<const QueryRay> rays,
        std::span<Hit> hits,
        std::span<SurfacePoint> at,
        std::span<Color> colors);

    /// How the terms of this scene's rays are numbered.
    RayTerms terms() const { return {traced_.illumination.lights.size()}; }

    /// Counted since the tracer was made, the view and probe rays by those who send them.
    RenderStatistics statistics;

private:
    /// A material, and what of it decides which rays are sent on.
    struct Look {
        const Material* material = nullptr;
        bool mirrors = false;
        bool refracts = false;
        bool is_luminous = false;
    };

    /// A place that a ray of the generation meets; the rest of it stands in a lane of a block.
    struct Place {
        FaceId face;
        const Look* look = nullptr;
        std::uint32_t ray = 0;
    };

    /// A ray of the next generation, and what sends it.
    struct Child {
        enum class Kind : std::uint8_t { mirrored, refracted, mirrored_and_totally_reflected };

        std::uint32_t place = 0;
        Kind kind = Kind::mirrored;
    };

    /// What is in work at one level of the ray tree.
    struct Level {
        Buffer<Hit> hits;
        Buffer<Place> places;
        Buffer<PlaceBlock> blocks; ///< place i in lane i % block_size of i / block_size
        bool mirrors = false;      ///< whether any place does
        bool refracts = false;
        Buffer<Child> children;            ///< those that are mirrored first
        std::size_t mirrored_children = 0; ///< how many these are
        Buffer<QueryRay> child_rays;
        Buffer<Color> child_colors;

        /// Where the terms of the rays go, each ray's apart by term_stride; nullptr where nobody
        /// asks for them. Those of view rays are kept apart by the way on which they come, those of
        /// others are not.
        Color* terms = nullptr;
        std::size_t term_stride = 0;
        Buffer<Color> child_terms;
    };

    void trace_part(
        std::uint32_t level,
        std::span<const QueryRay> rays,
        std::span<Hit> hits,
        std::span<SurfacePoint> at,
        std::span<Color> colors);
    /// put_surfaces_of(places, block) puts up to block_size places into a block, and returns their
    /// materials.
    template <typename PutSurfaces>
    void find_places(
        Level& level,
        std::span<const QueryRay> rays,
        std::span<const Hit> hits,
        const PutSurfaces& put_surfaces_of,
        std::span<Color> colors);
    void shade_places(std::uint32_t level, std::span<Color> colors);
    void light_places(Level& level, std::size_t light);
    void note_light(const Level& level, std::size_t light) const;
    void cast_shadows(const Level& level);
    void color_places(const Level& level, std::span<Color> colors);
    void color_place(const Level& level, std::size_t number, std::span<Color> colors) const;
    void trace_children(std::uint32_t level, std::span<Color> colors);
    void find_mirrored(Level& level);
    void find_refracted(Level& level);
    void set_child_rays(Level& level) const;
    void add_children(const Level& level, std::span<Color> colors) const;
    void add_child(const Level& level, std::size_t number, std::span<Color> colors) const;
    void add_child_terms(const Level& level, std::size_t child) const;
    Level& level_buffers(std::uint32_t level);

    const TracedScene& traced_;
    std::vector<Look> looks_; ///< of the scene's materials, and of what stands for a missing one
    std::vector<std::unique_ptr<Level>> levels_;

    // What is in work between two queries, at any level.
    Buffer<LightBlock> lights_;
    Buffer<RefractionBlock> refractions_;
    Buffer<BlockRows> reflected_;
    Buffer<std::uint32_t> first_shadow_rays_; ///< of each block
    Buffer<QueryRay> shadow_rays_;
    Buffer<Color> visibilities_;
};

} // namespace vera
