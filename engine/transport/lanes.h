// Four floats that the processor computes at once. SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include <glm/glm.hpp>

namespace vesper::transport {

/// Operators work on each.
using Lanes = float __attribute__((vector_size(16)));
using LaneBits = int32_t __attribute__((vector_size(16)));
constexpr size_t kLanes = 4;

/// Number of Lanes that hold `count` floats.
constexpr size_t lanes_for(size_t count) { return (count + kLanes - 1) / kLanes; }

inline Lanes all_of(float value) { return Lanes{value, value, value, value}; }
inline Lanes min(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes max(Lanes a, Lanes b) { return a > b ? a : b; }
/// 1 / root of each, of normal numbers, within 0.2 %; the same on all processors. From the bits of a float as about its
/// logarithm, and one step of Newton's (Blinn 1997).
inline Lanes inverse_root(Lanes v) {
    const Lanes about = std::bit_cast<Lanes>(0x5f375a86 - (std::bit_cast<LaneBits>(v) >> 1));
    return about * (1.5f - 0.5f * v * about * about);
}

/// Of vectors, by component.
struct Lanes3 {
    Lanes x{}, y{}, z{};

    void set(size_t lane, glm::vec3 v) { x[lane] = v.x, y[lane] = v.y, z[lane] = v.z; }
};
inline Lanes3 all_of(glm::vec3 v) { return {all_of(v.x), all_of(v.y), all_of(v.z)}; }
inline Lanes3 operator-(const Lanes3& a, const Lanes3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Lanes3 abs(const Lanes3& v) { return {max(v.x, -v.x), max(v.y, -v.y), max(v.z, -v.z)}; }
inline Lanes dot(const Lanes3& a, const Lanes3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

}  // namespace vesper::transport
