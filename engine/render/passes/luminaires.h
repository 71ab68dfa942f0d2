// Lamps seen directly. SPDX-License-Identifier: MIT
#pragma once

#include "gpu_scene/luminaires.h"
#include "render/frame_context.h"

namespace vesper::render {

/// Adds to the scene image, in place, the lamps of `list` seen directly: their luminance times the part of each pixel
/// that their silhouette covers, exactly, where no `surface` (GBuffer::surface) lies before them. However small a lamp
/// is, the sum over the image of luminance times solid angle is I / d^2. Without luminaires returns `scene`.
graph::Resource add_luminaires(const FrameContext& frame, graph::Resource scene, graph::Resource surface,
                               const gpu_scene::LuminaireList& list);

}  // namespace vesper::render
