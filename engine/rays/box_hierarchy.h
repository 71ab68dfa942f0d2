// Boxes around triangles, in Embree's hierarchy. SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "rays/embree.h"
#include "rays/triangles.h"

namespace vesper::rays {

/// Functions that look at a triangle whose box a ray meets: its primID is the triangle's index.
struct TriangleLooks {
    RTCIntersectFunctionN nearest;
    RTCOccludedFunctionN any;
};

/// Says which triangles a ray may meet, never one too few: `looks` decides in double which of them it meets.
///
/// Boxes of Embree's own triangles have no margin: with a way along x, a box from z = 0 to 6 and a start at z = 6 the
/// ray leaves the box at (6 - 6) / 0, taken as 0, before it enters, in robust mode, too. So a wall of a closed room is
/// missed along its outer edge. Here triangles are given as boxes, each larger than what rays are rounded by. Per axis
/// a ray from o as floats is off at p by 2^-24 |o| (start) and 2^-24 |p - o| (way), at most 2^-24 (2 |o| + |p|); a box
/// is larger than the corners p of its triangle by
///
///     2^-22 (|p| + farthest) + 2^-20 (its size),
///
/// |p| and `farthest`, that of all triangles, from the middle. This is enough if |o| <= 2 farthest. Embree's robust
/// mode widens boxes for its own rounding. The sizes are for triangles, whose corners are rounded beside a ray.
class BoxHierarchy {
public:
    /// Throws Error if memory is short or the time of a Budget is over; `task` begins the message.
    BoxHierarchy(std::span<const Triangle> triangles, const TriangleLooks& looks, const std::string& task);
    BoxHierarchy(const BoxHierarchy&) = delete;
    BoxHierarchy& operator=(const BoxHierarchy&) = delete;

    RTCScene scene() const { return scene_.get(); }
    /// Of memory that Embree has taken.
    uint64_t bytes() const;

private:
    std::atomic<int64_t> bytes_{0};
    embree::Device device_;
    embree::Scene scene_;
};

}  // namespace vesper::rays
