// Tone mapping of pictures of other origin. SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "render/frame_queue.h"
#include "render/host_picture.h"

namespace vesper::render {

/// A picture on the device, in an external image that can be sampled.
struct DevicePicture {
    graph::ExternalImage image;                   ///< RGB in linear Rec. 709, rows from the top
    float scale = 1;                              ///< cd/m^2 per unit
    double vertical_fov = 0.7;                    ///< rad, in (0, pi): what angle the picture covers in height
    const vision::ImageAngles* angles = nullptr;  ///< as of HostPicture
};

/// Maps pictures of any size to the display, one after the other; the eye remembers from each to the next, also when
/// the size changes. Not thread-safe; several may share a device in one thread.
class ToneMapper {
public:
    explicit ToneMapper(gpu::Device& device);

    /// `seconds` have passed since the last picture. NaN and infinities are shown black and counted. Throws Error.
    ToneMapped map(const ToneChainSettings&, const HostPicture&, float seconds, Outputs outputs = {});

    /// The same for a picture on the device, shown in an image there: submitted between semaphores, without waiting.
    void submit(const ToneChainSettings&, const DevicePicture&, const graph::ExternalImage& shown, float seconds,
                const graph::SubmitSemaphores&);
    /// Waits for all submitted pictures. Returns the results of the last one, once.
    std::optional<ToneMapped> finish() { return frames_.finish(); }

    /// Forgets what the eye was adapted to, as between pictures that have nothing to do with each other.
    void reset_adaptation() { frames_.set_eye({}); }
    /// The next picture goes on from this state, such as ToneMapped::eye of an earlier run.
    void set_eye(const shared::EyeState& eye) { frames_.set_eye({eye}); }
    /// The state that the last finished picture left, or that was set since.
    const shared::EyeState& eye() const { return frames_.eye().value; }
    /// The plan of the last picture as text.
    std::string plan() const { return frames_.plan(); }

private:
    void submit(FrameQueue::Declared frame, graph::Resource scene, const ToneChainSettings& settings,
                const gpu_scene::View& view, const ChainInputs& inputs, const Outputs& outputs,
                const graph::SubmitSemaphores& semaphores);

    PictureUpload upload_;
    FrameQueue frames_;  // waits for its frames, which use the rest
};

}  // namespace vesper::render
