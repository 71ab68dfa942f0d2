// Lamps with openings to look at. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "gpu_scene/luminaires.h"

namespace vesper::test {

/// Lamps and where they stand: node i carries lamp i.
struct Lamps {
    gpu_scene::LuminaireSet set;
    gpu_scene::SceneFrame frame;

    void add(const scene::Lamp& lamp, const glm::mat4& world) {
        set.lamps.push_back({lamp, uint32_t(frame.world.size())});
        frame.world.push_back(world);
    }
    gpu_scene::LuminaireList seen(const gpu_scene::View& view, std::optional<float> white = {}) const {
        return gpu_scene::luminaire_list(set, frame, view, white);
    }
};

/// A lamp of some candela behind an opening of width x height (m).
inline scene::Lamp lamp_with_opening(float candela, double width, double height, bool round = false,
                                     scene::Lamp::Kind kind = scene::Lamp::Kind::CosinePower) {
    scene::Lamp lamp;
    lamp.kind = kind, lamp.intensity = candela, lamp.exponent = 1;
    lamp.opening = {.length = width, .width = height, .height = 0, .round = round};
    return lamp;
}

/// At `position`, its axis along `axis`.
inline glm::mat4 aimed(glm::vec3 position, glm::vec3 axis) {
    const glm::vec3 up = std::abs(axis.y) > 0.9f * glm::length(axis) ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    return glm::inverse(glm::lookAt(position, position + axis, up));
}

}  // namespace vesper::test
