// Means of samples of pixels in double. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace vesper::reference {

/// The mean of samples of every pixel, each a picture of the same size.
inline std::vector<glm::dvec3> mean_of_samples(const std::vector<std::vector<glm::vec4>>& samples) {
    std::vector<glm::dvec3> mean(samples.at(0).size());
    for (size_t i = 0; i < mean.size(); ++i) {
        glm::dvec3 sum(0);
        for (const std::vector<glm::vec4>& sample : samples) sum += glm::dvec3(glm::vec3(sample[i]));
        mean[i] = sum / double(samples.size());
    }
    return mean;
}

/// How much of the unit square about 0 lies where normal . place <= distance, by clipping it (Sutherland and Hodgman
/// 1974): the part of a pixel that a half plane covers.
inline double covered_by_half_plane(glm::dvec2 normal, double distance) {
    std::vector<glm::dvec2> square{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}, kept;
    for (size_t i = 0; i < square.size(); ++i) {
        const glm::dvec2 a = square[i], b = square[(i + 1) % square.size()];
        const double at_a = distance - glm::dot(normal, a), at_b = distance - glm::dot(normal, b);
        if (at_a >= 0) kept.push_back(a);
        if ((at_a >= 0) != (at_b >= 0)) kept.push_back(a + (b - a) * (at_a / (at_a - at_b)));
    }
    double twice = 0;
    for (size_t i = 0; i < kept.size(); ++i) {
        const glm::dvec2 a = kept[i], b = kept[(i + 1) % kept.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return twice / 2;
}

}  // namespace vesper::reference
