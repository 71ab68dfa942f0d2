// Lamps with openings to look at. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "resident/sources.h"

namespace vesper::test {

/// Lamps and where they stand: node i carries lamp i.
struct Lamps {
    SourceSet set;
    SceneFrame frame;

    void add(const Light& light, const glm::mat4& world) {
        set.lamps.push_back({light, uint32_t(frame.world.size())});
        frame.world.push_back(world);
    }
    SourceList seen(const View& view, std::optional<float> white = {}) const {
        return source_list(set, frame, view, white);
    }
};

/// A lamp of some candela behind an opening of width x height (m).
inline Light lamp_with_opening(float candela, double width, double height, bool round = false,
                               Light::Kind kind = Light::Kind::CosinePower) {
    Light light;
    light.kind = kind, light.intensity = candela, light.exponent = 1;
    light.opening = {.length = width, .width = height, .height = 0, .round = round};
    return light;
}

/// At `position`, its axis along `axis`.
inline glm::mat4 aimed(glm::vec3 position, glm::vec3 axis) {
    const glm::vec3 up = std::abs(axis.y) > 0.9f * glm::length(axis) ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    return glm::inverse(glm::lookAt(position, position + axis, up));
}

}  // namespace vesper::test
