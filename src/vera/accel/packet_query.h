// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/element_records.h"
#include "vera/accel/local_geometry.h"
#include "vera/accel/ray_index.h"
#include "vera/accel/searches.h"
#include "vera/accel/tree_child.h"
#include "vera/math/transform.h"
#include "vera/scene/prepared_ray.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include <hwy/cache_control.h>

namespace vera::detail {

/// Rays are asked about in packets, which look at a cell together. A set of lanes is a bit mask.
constexpr std::size_t packet_size = 32;
using LaneMask = std::uint32_t;

/// Rays, coordinate by coordinate.
struct RayRows {
    struct alignas(64) Row : std::array<double, packet_size> {};

    std::array<Row, 3> origin;
    std::array<Row, 3> direction;
    Row t_min;
    Row t_max;
    Row origin_error;

    Ray ray(std::size_t lane) const {
        return {
            {origin[0][lane], origin[1][lane], origin[2][lane]},
            {direction[0][lane], direction[1][lane], direction[2][lane]},
            t_min[lane],
            t_max[lane],
            origin_error[lane]};
    }
};

/// PreparedRays, row by row.
struct PreparedRows {
    RayRows::Row axis; ///< the number of the axis along the ray
    RayRows::Row shear_x;
    RayRows::Row shear_y;
    RayRows::Row direction_z;
    RayRows::Row origin_size;
    bool made = false;
};

/// A child that waits until lanes of a packet come to it, and the local distance before which none
/// enters its box.
struct WaitingTogether {
    TreeChild child;
    LaneMask lanes = 0;
    float near = 0;
};

/// A number for each lane.
struct alignas(64) FloatRow : std::array<float, packet_size> {};

/// Elements that some lanes may meet, and which wait for the test that decides.
struct Candidates {
    struct Candidate {
        std::uint32_t element = 0;
        LaneMask lanes = 0;
        ElementRecord::Kind kind = ElementRecord::Kind::box;
    };

    static constexpr std::size_t most = 64;
    std::size_t count = 0;
    std::array<Candidate, most> all;
    std::array<FloatRow, most> near; ///< the local distance before which it is surely not met
};

/// A packet as it visits a geometry: in its coordinates and double precision, for what decides, and
/// in local coordinates and single precision, for what only prunes.
///
/// In local coordinates the rays start where they enter the geometry's bounds, or near these (see
/// LocalStart), and have unit directions. A ray passes within slack of where its single precision
/// form says: that covers the rounding of both forms, of the element's record, and of the test that
/// decides.
struct alignas(64) Frame {
    using Row = FloatRow;

    std::array<Row, 3> origin;
    std::array<Row, 3> direction;
    std::array<Row, 3> inverse; ///< of the direction; large but finite where that is 0
    Row limit;                  ///< nothing farther away counts; slack included
    RayRows rays;
    RayRows::Row start_t; ///< where local distance is 0
    RayRows::Row speed;   ///< local distance for one unit of t
    std::array<std::uint32_t, packet_size> start_element;
    float slack = 0;
    float double_slack = 0;      ///< the part of slack that is not for single precision
    float box_slack = 0;         ///< how far boxes of a tree are enlarged: see box_rounding
    float behind = 0;            ///< twice the largest coincidence_tolerance() of the lanes
    LaneMask prepared_lanes = 0; ///< whose prepared rays were made
    const LocalGeometry* local = nullptr;
    std::uint32_t visit = 0; ///< tells this visit from all others in the mailbox
    std::uint32_t depth = 0;
    std::uint64_t first_primitive = 0;
    MaterialId material = inherited_material;
    std::array<PreparedRay, packet_size> prepared;
    PreparedRows prepared_rows;
    Candidates candidates;
    // What waits in a tree of boxes for the packet's streams, and for the packet.
    std::vector<TreeChild> waiting;
    std::vector<std::uint64_t> waiting_lanes;
    std::vector<WaitingTogether> waiting_together;
};

/// Local distances do not get larger: to the far end of the bounds it is less than 5.2 from any
/// point where rays start.
constexpr double farthest = 8;

/// Rounding to single precision moves a coordinate, or a point of a ray, by less than 2^-21 of the
/// unit that holds the bounds; the rest is for the tests' own rounding.
constexpr double least_slack = 0x1p-18;

/// Boxes of a tree are enlarged by twice the slack. What that is for single precision is taken as a
/// part of their own largest coordinate, which stands in the tree, and of the rays' origins', so
/// that what is small is not enlarged by what is large elsewhere.
constexpr float box_rounding = static_cast<float>(2 * least_slack);

/// Writes the rays row by row.
void fill_rows(std::span<const QueryRay> rays, RayRows& rows);

/// coincidence_reach() of each ray, to the bit.
void fill_reaches(const RayRows& rays, RayRows::Row& reaches);

/// Where rays start in local coordinates: where they enter the bounds, or, which is done faster, at
/// their origins if these are near.
enum class LocalStart : std::uint8_t { in_bounds, near_bounds };

/// Fills in the local form of the lanes' rays, their limits and the slack; returns the lanes that
/// may touch the bounds. limit says behind which t nothing counts; world_reach is that of the
/// query.
LaneMask place_rays(
    Frame& frame,
    LaneMask lanes,
    const RayRows::Row& limit,
    const RayRows::Row& world_reach,
    LocalStart local_start);

/// The lanes' rays, carried by the map as transformed_ray() does, to the bit.
void transform_rays(const Affine3& map, const RayRows& rays, RayRows& result);

/// Remembers which rays were tested against which element, so that none is twice.
class Mailbox {
public:
    Mailbox()
        : entries_(initial_size) {}

    /// Forgets everything. Then visits are numbered from next_visit() on.
    void clear();

    std::uint32_t next_visit() { return ++last_visit_; }

    /// Those of the lanes that were not posted for this element in this visit; posts them.
    LaneMask post(std::uint32_t visit, std::uint32_t element, LaneMask lanes) {
        std::size_t place = (element * 0x9e3779b1U + visit * 0x85ebca6bU) & mask_;
        while (true) {
            Entry& entry = entries_[place];
            if (entry.visit == visit && entry.element == element) {
                const LaneMask fresh = lanes & ~entry.lanes;
                entry.lanes |= lanes;
                return fresh;
            }
            if (entry.visit < first_visit_) {
                entry = {visit, element, lanes};
                if (++used_ * 2 > entries_.size())
                    grow();
                return lanes;
            }
            place = (place + 1) & mask_;
        }
    }

private:
    static constexpr std::size_t initial_size = 256;

    struct Entry {
        std::uint32_t visit = 0;
        std::uint32_t element = 0;
        LaneMask lanes = 0;
    };

    void grow();

    std::vector<Entry> entries_;
    std::size_t mask_ = initial_size - 1;
    std::size_t used_ = 0;
    std::uint32_t first_visit_ = 1; ///< entries of visits before it are free
    std::uint32_t last_visit_ = 0;
};

/// What is wanted of the crossings.
enum class Purpose : std::uint8_t {
    nearest,      ///< the first face
    window,       ///< the first face, when it is known where to stop
    any,          ///< whether there is one: then the lane is not active any more
    transmittance ///< what they let through
};

class WalkRecorder;

/// A packet of rays, asked about all at once. Holds its memory from one packet to the next.
struct PacketQuery {
    const Scene* scene = nullptr;
    /// Of the main scene, then of the subscenes: what the index made of them.
    std::span<const LocalGeometry* const> geometries;
    Purpose purpose = Purpose::nearest;
    LocalStart local_start = LocalStart::in_bounds;
    std::span<const QueryRay> rays;
    LaneMask active = 0;       ///< lanes that have no final answer
    std::uint32_t changes = 0; ///< how often a limit or active has changed
    RayRows::Row limit;        ///< crossings at a greater t do not count
    RayRows::Row reach;        ///< coincidence_reach(); at most 0 where it does not matter
    std::array<NearestSearch, packet_size> nearest;
    std::vector<WindowSearch> window;
    std::array<TransmittanceSearch, packet_size> transmittance;
    QueryCounts counts;
    Mailbox mailbox;
    std::deque<Frame> frames;         ///< by depth of subscenes
    WalkRecorder* recorder = nullptr; ///< whom a plain walk tells its steps; no search does
};

/// Writes the rays row by row into the frame of the main scene, and sets the limits to their ends.
void take_rays(PacketQuery& query, std::span<const QueryRay> rays);

/// Finds the reaches of the rays that were taken.
void find_reaches(PacketQuery& query);

/// Prepares the frame of the main scene; returns the lanes that touch its bounds.
LaneMask enter_scene(PacketQuery& query);

/// Prepares the frame of the subscene that the element calls, one deeper than the frame; returns
/// the lanes that touch its bounds.
LaneMask enter_call(PacketQuery& query, Frame& frame, std::uint32_t element, LaneMask lanes);

/// Whether subscenes are nested so deeply here that the stack must be spared: then the call is
/// searched by search_plainly.
inline bool too_deep(const Frame& frame) {
    return frame.depth >= 48;
}

void search_plainly(PacketQuery& query, Frame& frame, std::uint32_t element, LaneMask lanes);

/// Tests the lanes' rays against the element, which is not a call, in the arithmetic that decides.
void test_exactly(PacketQuery& query, Frame& frame, std::uint32_t element, LaneMask lanes);

/// Takes over the query's limits, which may have changed.
void refresh_limits(const PacketQuery& query, Frame& frame, LaneMask lanes);

/// Tests the lanes' candidates that lie before their limits in the arithmetic that decides. Does
/// not take over the limits that follow: see refresh_limits().
void decide(PacketQuery& query, Frame& frame, LaneMask lanes);

/// Lets the processor fetch what it takes to decide() the frame's candidates.
void fetch_candidates(const Frame& frame);

/// Does decide() for all that has remained undecided when the main scene was searched.
void decide_main_scene(PacketQuery& query);

/// How far behind the distance by which something is surely met that may lie which has to be told
/// from it: what coincides with it, and roundings.
inline float margin_behind(const Frame& frame) {
    return 4 * frame.slack + frame.behind;
}

/// Whether elements of the kind may wait to be decided: where it is not known by when they are
/// surely met, what lies behind would not be left out meanwhile.
constexpr bool may_wait(ElementRecord::Kind kind) {
    switch (kind) {
    case ElementRecord::Kind::sphere:
    case ElementRecord::Kind::triangle:
    case ElementRecord::Kind::quadrangle:
    case ElementRecord::Kind::mantle:
        return true;
    case ElementRecord::Kind::box:
    case ElementRecord::Kind::cylinder:
    case ElementRecord::Kind::call:
        break;
    }
    return false;
}

/// Lets there be room for one more candidate.
inline void make_room_for_candidate(PacketQuery& query, Frame& frame) {
    if (frame.candidates.count == Candidates::most) {
        decide(query, frame, ~LaneMask{0});
        refresh_limits(query, frame, ~LaneMask{0});
    }
}

/// Notes that the lanes' rays may meet the element, which is not a call, not before the local
/// distances that stand in the row of near behind the last candidate's. There must be room.
inline void
add_candidate(Frame& frame, ElementRecord::Kind kind, std::uint32_t element, LaneMask lanes) {
    Candidates& candidates = frame.candidates;
    candidates.all[candidates.count++] = {element, lanes, kind};
    if (frame.local->mesh_corners != nullptr)
        hwy::Prefetch(frame.local->mesh_corners + std::size_t{3} * element);
}

/// Whether nothing else counts for a ray that meets the element, which is not a call.
bool ends_search(const PacketQuery& query, const Frame& frame, std::uint32_t element);

/// Notes that nothing passes along the lanes' rays.
void block(PacketQuery& query, Frame& frame, LaneMask lanes);

/// Searches the whole scene, of which the query's geometries are GeometryGrids.
void search_grids(PacketQuery& query);

/// Searches the whole scene, of which the query's geometries are GeometryTrees.
void search_trees(PacketQuery& query);

} // namespace vera::detail
