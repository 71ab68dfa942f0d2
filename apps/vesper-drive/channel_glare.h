// One eye behind several screens: what each of them scatters in it falls on all. SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/renderer.h"
#include "render/tone_mapper.h"
#include "vision/light_elsewhere.h"

namespace vesper::drive {

/// Scatters the light of several pictures in the one eye that sees them, so that the veil of what one of them shows
/// goes on in the others. Its memory of where light falls is made anew when pictures or eye change; with each pair of
/// pictures it takes some megabytes of the host.
class ChannelGlare {
public:
    explicit ChannelGlare(gpu::Device& device) : device_(device) {}

    /// A view with as many more pixels on every side as its glare needs.
    static gpu_scene::View guarded(const gpu_scene::View&);

    /// Scatters the light of all guarded views into each other. Input: retinas without scatter. Output: the visible
    /// parts, before and after scatter. `turns`: of each view, from its frame to that of the eye. `eye`: the state that
    /// the last frame left, if there was one.
    void scatter(const render::RenderSettings&, std::span<const gpu_scene::View> guarded,
                 std::span<const glm::dmat3> turns, const std::optional<shared::EyeState>& eye, float seconds,
                 std::vector<render::Frame>& frames);

private:
    gpu::Device& device_;
    gpu_scene::ScatterSettings settings_;
    std::vector<vision::EyePicture> pictures_;
    std::vector<vision::LightSums> sums_;
    std::vector<vision::LightElsewhere> elsewhere_;
    std::unique_ptr<render::ToneMapper> mapper_;  // for as many views
};

}  // namespace vesper::drive
