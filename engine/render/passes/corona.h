// Needles and halo of bright lamps. SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <glm/glm.hpp>

#include "render/frame_context.h"

namespace vesper::render {

/// Adds needles and halo of the brightest lamps of `scene` to `retina` (add_eye_scatter of it), in place. A lamp is the
/// light of a square of shared::kCoronaTile px of the picture, whatever its source; hidden lamps have none. The
/// shared::kCoronaLamps brightest count, each less as the next one is nearer to it. `pattern`: corona_texels. Without a
/// pattern returns `retina`.
graph::Resource add_corona(const FrameContext& frame, graph::Resource scene, graph::Resource retina,
                           std::span<const glm::vec4> pattern);

}  // namespace vesper::render
