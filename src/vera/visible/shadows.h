// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/scene/camera.h"
#include "vera/scene/facets.h"
#include "vera/scene/scene.h"
#include "vera/visible/cell_raster.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/projection.h"
#include "vera/visible/screen_scene.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vera {

/// A scene of which shadows are drawn, as a camera sees it.
struct ShadowedScene {
    const Scene& scene;
    const Facets& facets;
    const DrawnFaces& faces; ///< plane ones, FaceUnit::plane
    const Camera& camera;
    const CameraMap& map;
    double width = 1; ///< of the picture, in pixels
    double height = 1;
    const VisiblePieces& seen; ///< of the screen without shadows: these fall on what is seen alone
};

/// A face as what shadows fall on.
struct ShadowReceiver {
    /// Where it is on the screen, with some steps around it: shadows end there.
    ScreenPoint low = {screen_size, screen_size};
    ScreenPoint high = {0, 0};
    std::uint32_t largest = no_triangle; ///< of its triangles on the screen
    bool is_seen = false;
};

/// The plane of a face.
struct FacePlane {
    Vec3 point;
    Vec3 normal; ///< unit, or 0 of a face without an area

    double height(Vec3 p) const { return dot(normal, p - point); }
};

/// By the largest of the face's facets.
FacePlane plane_of_face(const ShadowedScene& shadowed, std::uint32_t face);

/// The same, on the side of a light: with the normal towards it.
FacePlane plane_towards(const ShadowedScene& shadowed, std::uint32_t face, Vec3 position);

/// How much there was to do.
struct ShadowCounts {
    std::size_t partly_lit = 0; ///< pairs of a light and a face of which it reaches a part
    std::size_t shadows = 0;    ///< triangles that were added
    double light_step = 0;      ///< what is smaller than that, in the scene's units, may throw no
                                ///< shadow; 0: nothing that is larger than 1/64 of a pixel
    double cut_nearness = 0; ///< what is so near a light, in the scene's units, throws no shadow;
                             ///< 0: everything does
};

/// Which facets throw shadows on which faces of a scene: what a light sees of it tells which faces
/// it reaches wholly, partly and not at all (3.4; Atherton, Weiler and Greenberg, Polygon shadow
/// generation, 1978). Where it is partly, the shadows are those of the facets that the light sees
/// before the face, carried to its plane by one projection from corner to grid, so that a corner of
/// a shadow is as exact as one of the scene. What lets light through throws none. Takes the scene's
/// first most_lights_of_a_set lights. Shadows are far larger than what tells where they fall, and
/// are made face by face when they are asked for.
class ThrownShadows {
public:
    /// Finds them, and tells the screen, whose sources are the faces, which lights reach nothing of
    /// which of them. What is shadowed must outlive this. Throws Cancelled, and std::runtime_error
    /// where the memory that is available would not suffice.
    ThrownShadows(
        const ShadowedScene& shadowed,
        ScreenScene& screen,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr);

    std::size_t face_count() const { return count_on_.size(); }

    /// How many shadows fall on the face.
    std::size_t count_on(std::uint32_t face) const { return count_on_[face]; }

    /// Of all faces.
    std::size_t count() const;

    /// Adds the shadows on these faces, which come in ascending order, to the screen: light by
    /// light, face by face. Those on one face have vertices in common, and with nothing else.
    /// Returns the vertex with which each light begins, and the end.
    std::vector<std::uint32_t> add_on(
        std::span<const std::uint32_t> faces,
        ScreenScene& screen,
        const CancelFlag* cancel = nullptr) const;

    /// Gives back the memory of what is told of the shadows on the faces before this one, which may
    /// not be asked for any more.
    void forget_before(std::uint32_t face);

    const ShadowCounts& counts() const { return counts_; }

private:
    /// A face on which shadows of a light fall.
    struct Lit {
        std::uint32_t face = 0;
        std::uint32_t first = 0; ///< of those that throw them
        /// What is no higher lies in its plane: within what the grid may have moved it.
        double flat = 0;
    };

    struct Light {
        std::vector<Lit> faces;              ///< in ascending order, and an end
        std::vector<std::uint32_t> throwing; ///< facets
    };

    class OneLight;
    struct Ground;
    struct Outline;

    Ground ground(std::size_t light, const Lit& lit, const ScreenScene& screen) const;
    Outline outline(const Ground& ground, std::uint32_t facet) const;

    ShadowedScene shadowed_;
    std::vector<ShadowReceiver> receivers_;
    std::vector<std::uint32_t> count_on_; ///< the faces
    std::vector<Light> lights_;
    ShadowCounts counts_;
};

/// Adds all shadows that the faces throw on each other to the screen.
ShadowCounts add_shadows(
    const ShadowedScene& shadowed,
    ScreenScene& screen,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
