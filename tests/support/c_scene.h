// A white square on the ground, a candle and an eye above it, as the C interface has them. SPDX-License-Identifier: MIT
#pragma once

#include <numbers>
#include <vector>

#include <vesper/vulkan.h>

#include "support/c_device.h"

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

// A scene of that, with a renderer when something is drawn.
class CScene : public CDevice {
protected:
    void SetUp() override {
        ASSERT_NO_FATAL_FAILURE(CDevice::SetUp());
        expect(vesper_scene_create(&scene, &error));
        const VesperMaterial material = white();
        expect(vesper_scene_add_material(scene, &material, &ground_material, &error));
        const VesperMesh mesh = square(ground_material);
        expect(vesper_scene_add_mesh(scene, &mesh, &ground_mesh, &error));
        expect(vesper_scene_add_node(scene, "ground", ground_mesh, nullptr, &ground, &error));
    }
    void TearDown() override {
        vesper_renderer_destroy(renderer), vesper_scene_destroy(scene);
        CDevice::TearDown();
    }
    void expect(VesperResult result) { ASSERT_EQ(result, VESPER_OK) << error.message; }
    uint32_t add(const VesperLamp& lamp) {
        uint32_t node = VESPER_NONE;
        expect(vesper_scene_add_lamp(scene, &lamp, &node, &error));
        return node;
    }
    std::vector<float> render(const VesperView& view) {
        if (!renderer) expect(vesper_renderer_create(device, scene, &renderer, &error));
        std::vector<float> luminance(4 * kSide * kSide);
        VesperOutputs outputs = VESPER_INIT(VesperOutputs);
        outputs.luminance = luminance.data();
        expect(vesper_render(renderer, nullptr, &view, 0, &outputs, &error));
        return luminance;
    }
    // Illuminance on the white, matt ground below, lx.
    float lux(float x = 0) { return render(down(x))[4 * kMiddle] * kPi; }

    VesperScene* scene = nullptr;
    VesperRenderer* renderer = nullptr;
    uint32_t ground_material = 0, ground_mesh = 0, ground = 0;
};

}  // namespace vesper::test
