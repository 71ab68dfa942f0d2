// The passes of a frame, from the scene to the luminance that the eye sees. SPDX-License-Identifier: MIT
#pragma once

#include "render/passes/blocks.h"
#include "render/passes/gbuffer.h"
#include "render/prepare.h"

namespace vesper::render {

/// What a frame shows before glare and the eye.
struct SceneLight {
    graph::Resource luminance;  ///< rgba32f, cd/m^2 RGB
    Clusters clusters;
    Blocks blocks;
    GBuffer surfaces;
};

/// Declares all that a frame needs of shadow maps and of light between surfaces, and the passes that render it. A frame
/// may be declared several times, as `frame.view` sees it: what the first brings up to date is up to date then.
SceneLight declare(const FrameContext& frame, ResidentScene& scene, const Prepared& prepared,
                   const gpu_scene::SceneFrame& poses, const gpu_scene::View& view);

}  // namespace vesper::render
