// The surfaces that a view sees, on the host. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "transport/light_picture.h"

namespace vesper::render {

/// Where the pixels of a view see surfaces, as the G-buffer has them: rgba32f texels, row by row. Points lie before
/// their surface, so that what a device rounds does not put them behind it: by kBefore of their distance, and by what
/// depth changes within kSnapped px, as vertices are snapped to 1/256 px.
constexpr double kBefore = 1e-5, kSnapped = 1.0 / 256;
std::vector<transport::LitPoint> points_of(std::span<const glm::vec4> surface, const gpu_scene::View& view);

/// The same of a scene with everything at its pose of `poses`, drawn for it. Throws Error if the device fails.
std::vector<transport::LitPoint> seen_surfaces(gpu::Device& device, const gpu_scene::GpuScene& scene,
                                               const gpu_scene::SceneFrame& poses, const gpu_scene::View& view);

}  // namespace vesper::render
