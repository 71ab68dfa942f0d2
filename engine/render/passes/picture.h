// An external picture as scene luminance. SPDX-License-Identifier: MIT
#pragma once

#include "render/frame_context.h"

namespace vesper::render {

/// The RGB of an external picture times `scale`, rgba32f, cd/m^2 (alpha 1).
graph::Resource add_picture(const FrameContext& frame, graph::Resource picture, float scale);

}  // namespace vesper::render
