// Cells of casters, kept from run to run. SPDX-License-Identifier: MIT
#pragma once

#include "base/cache.h"
#include "gpu_scene/caster_cells.h"

namespace vesper::gpu_scene {

/// The key of caster_cells() of a scene, whose occluder_digest() is `occluders`.
Digest::Value cells_key(const scene::Scene& scene, const Digest::Value& occluders);
/// As a cache has them, or caster_cells() and written there. `cache`: null: none. It is not settled.
std::vector<CasterCell> kept_or_made_cells(const scene::Scene& scene, const Digest::Value& occluders, Cache* cache);

}  // namespace vesper::gpu_scene
