// What things that move change of the light between surfaces. SPDX-License-Identifier: MIT
#pragma once

#include "gpu_scene/moving_things.h"
#include "render/passes/gbuffer.h"

namespace vesper::render {

/// Bodies and patches near an eye.
struct MovingLight {
    graph::Resource volumes;  ///< rgba32ui, of all bodies; none: there are no bodies
    gpu_scene::MovingThings things;
};

/// An image of what they do on each surface: RGB, the illuminance that patches give it, lx; A, the part of the light
/// between surfaces that bodies do not hide. None if there are neither.
graph::Resource add_moving_light(const FrameContext& frame, const GBuffer& surfaces, const MovingLight& moving);

}  // namespace vesper::render
