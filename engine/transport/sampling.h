// Numbers and directions by chance, the same in every run. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/glm.hpp>

namespace vesper::transport {

/// SplitMix64 (Steele, Lea and Flood 2014).
class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}
    uint64_t next_bits() {
        uint64_t z = state_ += 0x9e3779b97f4a7c15;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
        z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
        return z ^ (z >> 31);
    }
    /// From 0 to 1, without 1.
    double next() { return double(next_bits() >> 11) * 0x1p-53; }

private:
    uint64_t state_;
};

/// Points that fill the unit square evenly, however many there are: the lattice of the generalized golden ratio
/// (Roberts 2018), moved by chance.
class Lattice {
public:
    explicit Lattice(Random& random) : start_{random.next(), random.next()} {}
    glm::dvec2 at(uint32_t number) const {
        return glm::fract(start_ + double(number) * glm::dvec2(0.7548776662466927, 0.5698402909980532));
    }

private:
    glm::dvec2 start_;
};

/// At an angle to a unit axis, by its sine and cosine, and at a turn about it, rad.
inline glm::dvec3 direction_about(glm::dvec3 axis, double sine, double cosine, double turn) {
    const glm::dvec3 other = std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 a = glm::normalize(glm::cross(axis, other)), b = glm::cross(axis, a);
    return sine * std::cos(turn) * a + sine * std::sin(turn) * b + cosine * axis;
}

/// Distributed as cosines about a unit normal; both numbers from 0 to 1.
inline glm::dvec3 cosine_direction(glm::dvec3 normal, glm::dvec2 chance) {
    return direction_about(normal, std::sqrt(chance.x), std::sqrt(1 - chance.x), 2 * std::numbers::pi * chance.y);
}

/// Even over a triangle: the weights of its corners (Turk 1990).
inline glm::dvec3 triangle_weights(glm::dvec2 chance) {
    const double root = std::sqrt(chance.x);
    return {1 - root, root * (1 - chance.y), root * chance.y};
}

}  // namespace vesper::transport
