// Segments in the plane by cells, to find those near a point. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::roads {

/// A grid of square cells over the plane; segments are numbered as they are added. What comes back does not depend on
/// hashes: it is sorted.
class SegmentGrid {
public:
    explicit SegmentGrid(double cell = 16) : cell_(cell) {}

    /// Adds a segment; returns its number. Longer ones than a few cells should be cut.
    uint32_t add(glm::dvec2 from, glm::dvec2 to);
    /// Numbers of the segments that come near: all within `reach`, and some beyond.
    std::vector<uint32_t> near(glm::dvec2 point, double reach) const;
    size_t size() const { return count_; }

private:
    int64_t index(double at) const;

    double cell_;
    uint32_t count_ = 0;
    std::unordered_map<int64_t, std::vector<uint32_t>> cells_;
};

}  // namespace vesper::roads
