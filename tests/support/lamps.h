// Lamps to test with, in the view frame. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <random>

#include <glm/glm.hpp>

#include "render/passes/cluster.h"

namespace vesper::test {

/// How many lamps of each kind.
struct LampMix {
    uint32_t cones = 0, powers = 0, directional = 0;
};

/// For frames without measured lamps and roads.
inline render::TableTexels no_tables(graph::FrameGraph& graph) {
    return {graph.upload("tables", std::vector<glm::vec4>(1), VK_FORMAT_R32G32B32A32_SFLOAT)};
}

/// Half of them points and spots, half of them cosine powers.
inline LampMix half_and_half(uint32_t count) { return {(count + 1) / 2, count / 2, 0}; }

/// Lamps at random along a street 400 m long that begins 20 m behind the eye, `candela` (within a factor of ten) each.
inline gpu_scene::LampList street_lamps(LampMix mix, float candela, uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    std::normal_distribution<float> normal;
    const auto direction = [&](glm::vec3 towards) {
        return glm::normalize(towards + 0.6f * glm::vec3(normal(random), normal(random), normal(random)));
    };
    const auto colour = [&] {
        const glm::vec3 c(0.4f + unit(random), 0.4f + unit(random), 0.4f + unit(random));
        return c / glm::dot(c, glm::vec3(0.212639f, 0.715169f, 0.072192f));
    };
    gpu_scene::LampList list;
    list.counts = {mix.cones, mix.powers, 0, mix.directional};
    for (uint32_t i = 0; i < mix.cones + mix.powers; ++i) {
        shared::Lamp lamp{};
        lamp.position = {40 * unit(random) - 20, 8 * unit(random) - 1.2f, 20 - 400 * unit(random)};
        lamp.intensity = candela * std::pow(10.0f, 2 * unit(random) - 1);
        lamp.axis = direction({0, -1, 0});
        lamp.colour = colour();
        if (i >= mix.cones) {
            lamp.lobe_a = 1 + 60 * unit(random) * unit(random);
        } else if (i % 2 == 0) {
            lamp.lobe_a = 0, lamp.lobe_b = 1;  // a point
        } else {
            const float inner = 0.2f + 0.4f * unit(random), outer = inner + 0.1f + 0.5f * unit(random);
            lamp.lobe_a = 1 / (std::cos(inner) - std::cos(outer));
            lamp.lobe_b = -std::cos(outer) * lamp.lobe_a;
        }
        list.lamps.push_back(lamp);
    }
    for (uint32_t i = 0; i < mix.directional; ++i) {
        shared::Lamp moon{};
        moon.intensity = 0.3f * unit(random), moon.axis = direction({0, -1, -1}), moon.colour = colour();
        list.lamps.push_back(moon);
    }
    return list;
}

}  // namespace vesper::test
