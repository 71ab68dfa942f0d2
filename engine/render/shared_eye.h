// One eye that sees several pictures at once, or whose state comes from another process. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "render/frame_queue.h"
#include "render/host_picture.h"
#include "render/stored_picture.h"
#include "render/view_statistics.h"

namespace vesper::render {

/// The stages of a frame after its light (render/stages.h), one call each: pictures stay on the device, and what they
/// have to do with one another, statistics and the state of the eye, may come from other processes. The same pictures
/// and statistics lead to the same bits on one kind of device, and to those of a frame in one graph. Not thread-safe.
/// Throws Error.
class SharedEye {
public:
    /// Keeps fitted scatter of up to `pictures` sizes or angles of pictures.
    explicit SharedEye(gpu::Device& device, size_t pictures = 1);

    /// Puts a picture of the host on the device, and brings one back: RGBA, cd/m^2.
    void upload(const HostPicture&, StoredPicture& light);
    std::vector<float> read(const StoredPicture&);
    /// Light of nodes of a picture, in their order: RGB lx on a plane at the eye that faces each (vision::LightNodes).
    std::vector<glm::vec3> light_of(const StoredPicture& light, std::span<const uint32_t> nodes);

    /// How a picture is seen.
    struct Seen {
        ViewStatistics statistics;
        std::vector<graph::Timing> timings;
        double pupil = 0, pattern_milliseconds = 0, milliseconds = 0;  ///< as of a ToneMapped
    };
    /// Retina and statistics: scatters the light in the eye, with what comes from beside it (no fit), and measures the
    /// middle of it that `shown` covers, which is kept as `retina`. `seconds` after the last moment.
    Seen see(const ToneChainSettings&, const StoredPicture& light, const ScatterInputs& beside, float seconds,
             const gpu_scene::View& shown, StoredPicture& retina);

    /// Adapt: to the luminance where the eye looks in one of at least one picture, and to the votes of all. The eye
    /// looks at `looked_at` of them, `seconds` after the last moment. Returns curve, histogram and state of the eye.
    ToneMapped adapt(const ToneChainSettings&, std::span<const ViewStatistics> pictures, size_t looked_at,
                     float seconds);

    /// Show: a retina with a curve, such as that of adapt().
    ToneMapped show(const ToneChainSettings&, const StoredPicture& retina, const shared::ToneCurve&, const Outputs&);

    void reset_adaptation() { set_eye({}); }
    void set_eye(const shared::EyeState& eye) { adapting_.set_eye({eye}); }
    const shared::EyeState& eye() const { return adapting_.eye().value; }

private:
    gpu::Device& device_;
    PictureUpload upload_;
    FrameQueue summing_, seeing_, adapting_, showing_;  // apart, so that each has the same frames again and again
};

}  // namespace vesper::render
