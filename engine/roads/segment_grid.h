// A grid of segments in the plane, to find segments near a point. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::roads {

/// A grid of square cells over the plane. Segments are numbered in the order of addition. Results are sorted.
class SegmentGrid {
public:
    explicit SegmentGrid(double cell = 16) : cell_(cell) {}

    /// Adds a segment; returns its number. Longer ones than a few cells should be cut.
    uint32_t add(glm::dvec2 from, glm::dvec2 to);
    /// Numbers of all segments within `reach` m of a point, and of some beyond.
    std::vector<uint32_t> near(glm::dvec2 point, double reach) const;
    size_t size() const { return count_; }

private:
    int64_t index(double at) const;

    double cell_;
    uint32_t count_ = 0;
    std::unordered_map<int64_t, std::vector<uint32_t>> cells_;
};

}  // namespace vesper::roads
