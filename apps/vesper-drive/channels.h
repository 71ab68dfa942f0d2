// Several views of one eye point: screens around a driver. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "channel_glare.h"
#include "render/renderer.h"
#include "render/tone_mapper.h"

namespace vesper::drive {

/// One screen, or one projector.
struct ScreenChannel {
    std::string name;
    VkExtent2D extent{1680, 1050};        ///< px
    double yaw = 0, pitch = 0, roll = 0;  ///< of its axis against the driver's: left, up, clockwise; in that order; rad
    double left = 0, right = 0, bottom = 0,
           top = 0;  ///< edges of the picture, from the axis, rad; left and bottom negative
};

struct Channels {
    std::vector<ScreenChannel> screens;  ///< from left to right, as they are put together
    size_t gaze = 0;                     ///< the one that the eye looks at (RenderSettings: tone.gaze)
};
/// Reads a file of channels (docs/channels.md). Throws Error, naming file, place and reason.
Channels read_channels(const std::filesystem::path&);

/// What a channel of the driver's view sees.
gpu_scene::View channel_view(const ScreenChannel&, const gpu_scene::View& driver);

/// All channels of a moment, side by side, tops aligned; what lies below the shorter ones is black.
struct ChannelMosaic {
    render::ToneMapped shown;       ///< the picture of all of them; `scene`: before anything is scattered in the eye
    std::vector<uint32_t> columns;  ///< where each begins
    std::vector<render::Frame> channels;  ///< each with its lamps and times; of `retina` and `scene` the first is empty
                                          ///< where nothing is scattered
};

/// The channel that is looked at, with the eye, curve and times of the whole: what is logged.
render::Frame looked_at(ChannelMosaic&, const Channels&);

/// Renders channels one after the other, scatters the light of all of them in the one eye, then adapts and shows them
/// as one picture: one histogram, one eye, one tone curve.
class ChannelRenderer {
public:
    explicit ChannelRenderer(gpu::Device& device) : glare_(device), mapper_(device) {}

    ChannelMosaic render(render::Renderer&, const Channels&, const render::RenderSettings&,
                         const gpu_scene::View& driver, const gpu_scene::SceneFrame&, float seconds, render::Outputs);
    void reset_adaptation() { eye_.reset(), mapper_.reset_adaptation(); }
    void set_eye(const shared::EyeState& eye) { eye_ = eye, mapper_.set_eye(eye); }

private:
    ChannelGlare glare_;
    render::ToneMapper mapper_;
    std::optional<shared::EyeState> eye_;  // what the last frame left
};

}  // namespace vesper::drive
