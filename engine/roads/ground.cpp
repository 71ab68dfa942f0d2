// Heights of the ground. SPDX-License-Identifier: MIT
#include "roads/ground.h"

#include <algorithm>
#include <cmath>

namespace vesper::roads {
namespace {

constexpr double kMaxNodes = 600'000;
constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr int kSmoothings = 24;

}  // namespace

Ground::Ground(glm::dvec2 low, glm::dvec2 high, double cell) : low_(low), cell_(cell) {
    const glm::dvec2 size = high - low;
    cell_ = std::max(cell_, std::sqrt(size.x * size.y / kMaxNodes));
    columns_ = static_cast<uint32_t>(std::ceil(size.x / cell_)) + 1,
    rows_ = static_cast<uint32_t>(std::ceil(size.y / cell_)) + 1;
    heights_.assign(size_t(columns_) * rows_, kUnknown);
}

void Ground::stay_below(glm::dvec3 point) {
    // Any triangle over the point has its corners within a cell's diagonal of it.
    const double reach = 1.5 * cell_;
    const auto first = [&](double at) { return static_cast<int64_t>(std::ceil((at - reach) / cell_)); };
    const auto last = [&](double at) { return static_cast<int64_t>(std::floor((at + reach) / cell_)); };
    const double x = point.x - low_.x, y = point.y - low_.y;
    for (int64_t row = std::max<int64_t>(first(y), 0); row <= std::min<int64_t>(last(y), rows_ - 1); ++row)
        for (int64_t column = std::max<int64_t>(first(x), 0); column <= std::min<int64_t>(last(x), columns_ - 1);
             ++column) {
            double& height = heights_[index(static_cast<uint32_t>(column), static_cast<uint32_t>(row))];
            height = std::min(height, point.z - kBelow);
        }
}

void Ground::spread() {
    std::vector<size_t> front, unknown;
    for (size_t i = 0; i < heights_.size(); ++i) (heights_[i] < kUnknown ? front : unknown).push_back(i);
    if (front.empty()) std::fill(heights_.begin(), heights_.end(), 0.0);
    const auto neighbours = [&](size_t i, const auto& visit) {
        const size_t column = i % columns_, row = i / columns_;
        if (column > 0) visit(i - 1);
        if (column + 1 < columns_) visit(i + 1);
        if (row > 0) visit(i - columns_);
        if (row + 1 < rows_) visit(i + columns_);
    };
    while (!front.empty()) {
        std::vector<size_t> next;
        for (const size_t i : front)
            neighbours(i, [&](size_t j) {
                if (heights_[j] < kUnknown) return;
                heights_[j] = heights_[i];
                next.push_back(j);
            });
        front = std::move(next);
    }
    for (int pass = 0; pass < kSmoothings; ++pass)
        for (const size_t i : unknown) {
            double sum = 0;
            int count = 0;
            neighbours(i, [&](size_t j) { sum += heights_[j], ++count; });
            heights_[i] = sum / std::max(count, 1);
        }
}

glm::dvec3 Ground::node(uint32_t column, uint32_t row) const {
    return {low_.x + column * cell_, low_.y + row * cell_, heights_[index(column, row)]};
}

double Ground::height(glm::dvec2 at) const {
    const double x = std::clamp((at.x - low_.x) / cell_, 0.0, columns_ - 1.0),
                 y = std::clamp((at.y - low_.y) / cell_, 0.0, rows_ - 1.0);
    const auto column = std::min(static_cast<uint32_t>(x), columns_ - 2),
               row = std::min(static_cast<uint32_t>(y), rows_ - 2);
    const double fx = x - column, fy = y - row;
    const double low = glm::mix(heights_[index(column, row)], heights_[index(column + 1, row)], fx);
    const double high = glm::mix(heights_[index(column, row + 1)], heights_[index(column + 1, row + 1)], fx);
    return glm::mix(low, high, fy);
}

glm::dvec3 Ground::normal(uint32_t column, uint32_t row) const {
    const uint32_t left = column > 0 ? column - 1 : 0, right = std::min(column + 1, columns_ - 1);
    const uint32_t below = row > 0 ? row - 1 : 0, above = std::min(row + 1, rows_ - 1);
    const glm::dvec3 x = node(right, row) - node(left, row), y = node(column, above) - node(column, below);
    return glm::normalize(glm::cross(x, y));
}

}  // namespace vesper::roads
