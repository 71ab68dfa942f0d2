// Light scattered in the eye. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "eye/scatter.h"
#include "render/frame_context.h"
#include "vision/light_elsewhere.h"

namespace vesper::render {

/// Light that scatters into a picture.
struct ScatterInputs {
    const eye::GpuScatter* fit = nullptr;              ///< of the size of the scene; none: no light is scattered
    std::vector<eye::OffscreenLamp> lamps;             ///< outside of the picture
    const vision::OffscreenLight* pictures = nullptr;  ///< of the other pictures of the same eye
};

/// The scene as it falls on the retina: every pixel keeps a part of its light and scatters the rest, as `fit` has it,
/// and light from outside of the picture scatters into it. rgba32f, cd/m^2. A picture loses the light that falls beside
/// it. A pixel that is not finite stays and scatters nothing. Without a fit returns `scene`.
graph::Resource add_eye_scatter(const FrameContext& frame, graph::Resource scene, const ScatterInputs& inputs);

}  // namespace vesper::render
