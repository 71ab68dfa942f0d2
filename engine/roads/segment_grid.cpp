// Segments by cells. SPDX-License-Identifier: MIT
#include "roads/segment_grid.h"

#include <algorithm>
#include <cmath>

#include "base/budget.h"

namespace vesper::roads {
namespace {

constexpr double kReach = 1e5;  // m; cells further out than this are not looked up one by one

int64_t key(int64_t x, int64_t y) { return x * (int64_t(1) << 32) + y; }

}  // namespace

int64_t SegmentGrid::index(double at) const {
    return static_cast<int64_t>(std::floor(std::clamp(at / cell_, -1e9, 1e9)));
}

uint32_t SegmentGrid::add(glm::dvec2 from, glm::dvec2 to) {
    const glm::dvec2 low = glm::min(from, to), high = glm::max(from, to);
    for (int64_t x = index(low.x); x <= index(high.x); ++x)
        for (int64_t y = index(low.y); y <= index(high.y); ++y) cells_[key(x, y)].push_back(count_);
    return count_++;
}

std::vector<uint32_t> SegmentGrid::near(glm::dvec2 point, double reach) const {
    check_time();
    std::vector<uint32_t> found;
    reach = std::min(reach, kReach);
    const int64_t left = index(point.x - reach), right = index(point.x + reach), bottom = index(point.y - reach),
                  top = index(point.y + reach);
    if (static_cast<double>(right - left + 1) * static_cast<double>(top - bottom + 1) >
        static_cast<double>(cells_.size())) {
        for (const auto& [cell, segments] : cells_) found.insert(found.end(), segments.begin(), segments.end());
    } else {
        for (int64_t x = left; x <= right; ++x)
            for (int64_t y = bottom; y <= top; ++y)
                if (const auto cell = cells_.find(key(x, y)); cell != cells_.end())
                    found.insert(found.end(), cell->second.begin(), cell->second.end());
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

}  // namespace vesper::roads
