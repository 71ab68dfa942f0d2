// What of a scene can hide a lamp. SPDX-License-Identifier: MIT
#pragma once

#include "base/digest.h"

namespace vesper::scene {
struct Scene;
}

namespace vesper::gpu_scene {

/// A digest of all that shadow maps show of a scene, but for where nodes stand: the triangles of meshes, the nodes
/// that have one, and where materials let light through. Colours, lamps, and pictures that mask nothing are no part.
Digest::Value occluder_digest(const scene::Scene& scene);

}  // namespace vesper::gpu_scene
