// Reference of the sums of light: double precision, tents written as the function they are. SPDX-License-Identifier:
// MIT
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "vision/light_nodes.h"

namespace vesper::reference {

/// Light of one picture at its nodes: RGBA, cd/m^2, rows from the top, in; lx on a plane at the eye out.
class LightSums {
public:
    LightSums(const vision::ImageAngles& image, std::span<const float> rgba) : nodes_(image), width_(image.width) {
        const glm::dvec2 step = (image.high - image.low) / glm::dvec2(image.width, image.height);
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                const double across = image.low.x + (x + 0.5) * step.x, up = image.high.y - (y + 0.5) * step.y;
                const double steradians = step.x * step.y / std::pow(1 + across * across + up * up, 1.5);
                const float* p = &rgba[size_t(4) * (size_t(y) * size_t(image.width) + size_t(x))];
                const bool finite = std::isfinite(p[0] + p[1] + p[2]);
                light_.push_back(finite ? steradians * glm::dvec3(p[0], p[1], p[2]) : glm::dvec3(0));
            }
    }
    /// Every pixel within a tent's width of the node, times the tent.
    glm::dvec3 at(int level, glm::ivec2 node) const {
        const int step = 1 << level, height = int(light_.size()) / width_;
        glm::dvec3 sum(0);
        for (int y = std::max(0, step * (node.y - 1)); y <= std::min(height - 1, step * (node.y + 1)); ++y)
            for (int x = std::max(0, step * (node.x - 1)); x <= std::min(width_ - 1, step * (node.x + 1)); ++x) {
                const double across = 1 - std::abs(double(x) / step - node.x),
                             down = 1 - std::abs(double(y) / step - node.y);
                sum += across * down * light_[size_t(y) * size_t(width_) + size_t(x)];
            }
        return sum;
    }
    glm::dvec3 at(uint32_t index) const {
        int level = 0;
        while (nodes_.first[size_t(level) + 1] <= index) ++level;
        const int within = int(index - nodes_.first[size_t(level)]), columns = nodes_.sizes[size_t(level)].x;
        return at(level, {within % columns, within / columns});
    }
    std::vector<glm::vec3> at(std::span<const uint32_t> nodes) const {
        std::vector<glm::vec3> light;
        for (const uint32_t node : nodes) light.emplace_back(at(node));
        return light;
    }
    const vision::LightNodes& nodes() const { return nodes_; }

private:
    vision::LightNodes nodes_;
    int width_;
    std::vector<glm::dvec3> light_;  // of each pixel, lx
};

}  // namespace vesper::reference
