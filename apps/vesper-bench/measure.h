// Driving a path and taking the time. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "render/renderer.h"
#include "result.h"

namespace vesper::bench {

/// One run: what is rendered and how often.
struct RunPlan {
    RunSettings settings;  ///< lamps and triangles are filled in by what is found
    render::RenderSettings render;
    std::string camera, device;
    std::shared_ptr<Cache> map_cache;  ///< see Renderer::keep_maps

    VkExtent2D extent() const { return {settings.width, settings.height}; }
};

/// The views of all channels at a moment: the camera's own turned about its vertical axis, each beside the next.
std::vector<gpu_scene::View> channel_views(const gpu_scene::View& camera, uint32_t channels);

/// Drives the path of the scene's animation (10 s of standing still where it has none) `laps` times in `frames` equal
/// steps, after `warm_up` frames from all along it that are not counted. The eye forgets before each lap, so that all
/// are alike. `last` is given the last frame. Throws Error.
RunResult measure(const RunPlan& plan, const scene::Scene& scene, const std::function<void()>& frame_done,
                  render::Frame* last = nullptr);

/// Opens the device, renders the first frame of the path, says so, and closes everything.
void first_frame(const RunPlan& plan, const scene::Scene& scene, const std::function<void()>& frame_done);

}  // namespace vesper::bench
