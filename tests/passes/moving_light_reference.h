// What moving bodies hide and what lit patches give, one surface after another, in double. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "gpu_scene/gpu_scene.h"
#include "passes/shade_reference.h"
#include "transport/lamp_reflections.h"
#include "transport/moving_bodies.h"

namespace vesper::reference {

/// The part of the light on a surface that a body hides; point and unit normal in the frame of its node. Every place of
/// the volume is asked what it gives.
inline double hidden(const transport::MovingBodies& bodies, const transport::OcclusionVolume& volume, dvec3 point,
                     dvec3 normal) {
    const dvec3 at = (point - volume.low) / volume.step + normal;
    for (int axis = 0; axis < 3; ++axis)
        if (!(at[axis] >= 0 && at[axis] < volume.count[axis] - 1.0)) return 0;
    double sum = 0;
    uint32_t i = volume.first;
    for (uint32_t z = 0; z < volume.count.z; ++z)
        for (uint32_t y = 0; y < volume.count.y; ++y)
            for (uint32_t x = 0; x < volume.count.x; ++x, ++i) {
                const dvec3 tent = glm::max(1.0 - glm::abs(at - dvec3(x, y, z)), dvec3(0));
                const double weight = tent.x * tent.y * tent.z;
                if (weight == 0) continue;
                for (uint32_t side = 0; side < 6; ++side) {
                    const double component = side % 2 ? -normal[int(side / 2)] : normal[int(side / 2)];
                    if (component > 0)
                        sum += weight * component * component * bodies.hidden[i][side] /
                               double(transport::MovingBodies::kAll);
                }
            }
    return sum;
}

/// Of all bodies, what they leave; in the world.
inline double left_open(const transport::MovingBodies& bodies, const gpu_scene::SceneFrame& poses, dvec3 point,
                        dvec3 normal) {
    double open = 1;
    for (const auto& [node, volume] : bodies.bodies) {
        const glm::dmat4 back = glm::inverse(poses.world[node]);
        open *= 1 - hidden(bodies, bodies.volumes[volume], dvec3(back * glm::dvec4(point, 1)),
                           glm::normalize(glm::dmat3(back) * normal));
    }
    return open;
}

/// Illuminance by a patch, RGB lx; in the world. E = I cos cos / (d^2 + r^2): on the axis of a disc of uniform
/// luminance L, whose I is L pi r^2, this is Lambert's E = pi L r^2 / (d^2 + r^2).
inline dvec3 light_of(const transport::LitPatch& patch, dvec3 point, dvec3 normal) {
    const dvec3 to = patch.position - point;
    const double distance = glm::length(to), cosine = glm::dot(normal, to) / distance,
                 sent = -glm::dot(patch.normal, to) / distance;
    if (!(cosine > 0 && sent > 0)) return dvec3(0);
    return patch.intensity * cosine * sent / (distance * distance + patch.radius * patch.radius);
}

}  // namespace vesper::reference
