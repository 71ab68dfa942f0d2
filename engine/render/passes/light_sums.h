// Light of parts of a picture, for other pictures of the same eye. SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "render/frame_context.h"

namespace vesper::render {

/// Light of nodes of a picture (vision::LightNodes::index of the view's angles; at least one): RGB lx on a plane at the
/// eye that faces the node, a buffer of glm::vec4. Pixels that are not finite have no light. `picture`: rgba32f,
/// cd/m^2. Throws Error where the sums of all levels are more than a buffer may hold.
graph::Resource add_light_sums(const FrameContext& frame, graph::Resource picture, std::span<const uint32_t> nodes);

}  // namespace vesper::render
