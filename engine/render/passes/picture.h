// An external picture as scene luminance. SPDX-License-Identifier: MIT
#pragma once

#include "render/frame_context.h"

namespace vesper {

/// The RGB of an external picture times `scale`, rgba32f, cd/m^2 (alpha 1).
Resource add_picture(const FrameContext& frame, Resource picture, float scale);

}  // namespace vesper
