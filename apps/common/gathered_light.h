// Light between surfaces, gathered before the first frame. SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "base/cache.h"
#include "render/renderer.h"
#include "transport/radiosity.h"

namespace vesper::apps {

/// What surfaces at rest of a scene send each other: from the cache (null: none), or gathered, which it then keeps.
/// Shows its progress, and says if the cache fails.
std::shared_ptr<const transport::Radiosity> gathered(const scene::Scene&, std::span<const glm::dmat4> world,
                                                     const std::vector<bool>& moving, Cache* cache);
/// Gives a renderer what these settings want of it: that, and what surfaces at rest reflect of lamps that move.
void give_indirect(render::Renderer&, const render::RenderSettings&, const scene::Scene&,
                   std::span<const glm::dmat4> world, const std::vector<bool>& moving, Cache* cache);

}  // namespace vesper::apps
