// A white square on the ground, a candle and an eye above it, as the C interface has them. SPDX-License-Identifier: MIT
#pragma once

#include <numbers>
#include <vector>

#include <vesper/vulkan.h>

namespace vesper::test {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr uint32_t kSide = 9, kMiddle = 40;

inline const std::vector<float> kSquare{-20, 0, -20, 20, 0, -20, 20, 0, 20, -20, 0, 20};
inline const std::vector<uint32_t> kTriangles{0, 2, 1, 0, 3, 2};

inline VesperMaterial white() {
    VesperMaterial m = VESPER_INIT(VesperMaterial);
    m.base_colour[0] = m.base_colour[1] = m.base_colour[2] = m.roughness = 1;
    return m;
}

inline VesperMesh square(uint32_t material) {
    VesperMesh mesh = VESPER_INIT(VesperMesh);
    mesh.material = material, mesh.vertex_count = 4, mesh.positions = kSquare.data(), mesh.index_count = 6,
    mesh.indices = kTriangles.data();
    return mesh;
}

// 1 cd, 1 m above the ground.
inline VesperLamp candle() {
    VesperLamp lamp = VESPER_INIT(VesperLamp);
    lamp.position[1] = lamp.intensity = lamp.colour[0] = lamp.colour[1] = lamp.colour[2] = 1;
    return lamp;
}

// Straight down on the ground at (x, 0, 0).
inline VesperView down(float x = 0) {
    VesperView view = VESPER_INIT(VesperView);
    view.width = view.height = kSide, view.eye[0] = x, view.eye[1] = 0.5f, view.forward[1] = -1, view.up[2] = -1,
    view.vertical_fov = 0.02f, view.near_plane = 0.1f;
    return view;
}

inline std::vector<float> at(float x, float y, float z) { return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1}; }

}  // namespace vesper::test
