// Light of the pixels of a picture, traced on the host. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "transport/light_picture.h"

namespace vesper::commands {

/// TraceSettings::lamp_rays for pictures: in the same time more paths give less noise than more shadow rays.
constexpr uint32_t kLampRays = 2;

/// What one pixel sees, and its light; without a surface its normal and the light are 0.
struct TracedPicture {
    std::vector<transport::LitPoint> points;
    std::vector<transport::PointLight> light;
};

/// With everything in the scene at its pose of `poses`, and lamps and emission as the scene has them (without
/// SceneFrame::dimming). `resident` is the same scene. `progress` gets shares from 0 to 1.
TracedPicture traced_light(gpu::Device& device, const scene::Scene& scene, const gpu_scene::GpuScene& resident,
                           const gpu_scene::SceneFrame& poses, const gpu_scene::View& view,
                           const transport::TraceSettings& settings, const std::function<void(double)>& progress);

/// Illuminance for Renderer::set_illuminance.
std::vector<glm::vec4> other_light(const TracedPicture& picture);

}  // namespace vesper::commands
