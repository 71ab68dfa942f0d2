// The scene as an eye resolves it. SPDX-License-Identifier: MIT
#pragma once

#include "render/passes/pyramid.h"

namespace vesper::render {

/// The scene as an eye adapted to each degree of it resolves it (Ward Larson et al. 1997): luminance blurred over
/// sqrt(2) of the smallest period that is seen, up to 32 px. rgba32f, cd/m^2. Without `loss` of acuity returns `scene`.
graph::Resource add_acuity(const FrameContext& frame, graph::Resource scene, const Pyramid& pyramid,
                           uint32_t foveal_level, bool loss = true);

}  // namespace vesper::render
