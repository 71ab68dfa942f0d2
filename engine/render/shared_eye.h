// One eye that sees several pictures at once. SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "render/frame_queue.h"

namespace vesper::render {

/// Lets an eye adapt to several pictures, from each moment to the next: to the luminance where it looks in one of them
/// and to the votes of all. The same statistics lead to the same bits on one kind of device. Not thread-safe.
class SharedEye {
public:
    explicit SharedEye(gpu::Device& device) : frames_(device) {}

    /// `pictures`: at least one; the eye looks at `looked_at` of them, `seconds` after the last moment. Returns curve,
    /// histogram and state of the eye; no picture. Throws Error.
    ToneMapped adapt(const ToneChainSettings&, std::span<const ViewStatistics> pictures, size_t looked_at,
                     float seconds);

    void reset_adaptation() { frames_.set_eye({}); }
    void set_eye(const shared::EyeState& eye) { frames_.set_eye({eye}); }
    const shared::EyeState& eye() const { return frames_.eye().value; }

private:
    FrameQueue frames_;
};

}  // namespace vesper::render
