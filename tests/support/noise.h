// Numbers at random that surfaces are made of. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include <glm/glm.hpp>

namespace vesper::test {

class Noise {
public:
    explicit Noise(uint32_t seed) : random_(seed) {}

    float unit() { return unit_(random_); }                    ///< [0, 1)
    double normal() { return normal_(random_); }               ///< standard normal distribution
    float fine() { return std::floor(unit() * 1024) / 1024; }  ///< [0, 1), exact in a half float
    /// A unit vector on the side of +Z; the larger `least`, the steeper.
    glm::dvec3 facing(double least) {
        const double x = normal(), y = normal();
        return glm::normalize(glm::dvec3(x, y, std::abs(normal()) + least));
    }

private:
    std::mt19937 random_;
    std::uniform_real_distribution<float> unit_{0, 1};
    std::normal_distribution<double> normal_;
};

}  // namespace vesper::test
