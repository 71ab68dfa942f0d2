// Several views of one eye point: screens around a driver. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "channels/channel_glare.h"
#include "render/renderer.h"
#include "render/shared_eye.h"

namespace vesper::drive {

/// One screen, or one projector.
struct ScreenChannel {
    std::string name;
    VkExtent2D extent{1680, 1050};        ///< px
    double yaw = 0, pitch = 0, roll = 0;  ///< of its axis against the driver's: left, up, clockwise; in that order; rad
    double left = 0, right = 0, bottom = 0,
           top = 0;                          ///< edges of the picture, from the axis, rad; left and bottom negative
    std::optional<vision::Display> display;  ///< that shows it; none: that of the settings
    std::shared_ptr<const eye::Projection> projection;  ///< onto a projector's picture of the same size, or null
    std::optional<int> rank;                            ///< that shows it (ChannelRanks), 0 or more
    std::optional<int> monitor;                         ///< that its window fills there, 0 or more
};

struct Channels {
    std::vector<ScreenChannel> screens;  ///< from left to right, as they are put together
    size_t gaze = 0;                     ///< the one that the eye looks at (RenderSettings: tone.gaze)
};
/// Reads a file of channels (docs/channels.md). Throws Error, naming file, place and reason.
Channels read_channels(const std::filesystem::path&);

/// Throws Error where displays of channels do not go together, or with the one that all others have.
void check_displays(const Channels&, const vision::Display& usual);

/// What a channel of the driver's view sees.
gpu_scene::View channel_view(const ScreenChannel&, const gpu_scene::View& driver);

/// Channels of a moment, side by side, tops aligned; what lies below the shorter ones is black.
struct ChannelMosaic {
    render::ToneMapped shown;       ///< the picture of those of this process, and the eye of all; `scene`: before
                                    ///< anything is scattered in the eye
    std::vector<uint32_t> columns;  ///< where each begins; of channels that are not in it, where the next one does
    std::vector<render::Frame> channels;  ///< each with its codes, lamps and times, empty where others render it
};
/// Puts the pictures of those channels together that have any; with `scene` luminances, too.
void put_together(ChannelMosaic&, bool scene);

/// A channel of this process, with the eye, curve and times of the whole: what is logged of the one that is looked at.
render::Frame logged_frame(ChannelMosaic&, size_t channel);

/// Renders channels one after the other, scatters the light of all of them in the one eye, lets it adapt to all of them
/// and shows each with the same curve: one histogram, one eye, one tone curve, whatever processes render them.
class ChannelRenderer {
public:
    /// `link`: to the processes that render the other channels; without, all are rendered here.
    explicit ChannelRenderer(gpu::Device& device, ChannelLink* link = nullptr);
    /// Hears what is unheard.
    void leave() { turns_.forget(), glare_.forget(); }

    /// How many moments what the eye sees of each channel is late, 0 or 1, so that none waits for the others.
    void set_latency(unsigned moments) { late_ = moments > 0; }
    /// `outputs` are those of each channel, with `retina` that of its retina, too.
    ChannelMosaic render(render::Renderer&, const Channels&, const render::RenderSettings&,
                         const gpu_scene::View& driver, const gpu_scene::SceneFrame&, float seconds, render::Outputs);
    void reset_adaptation();
    void set_eye(const shared::EyeState& eye) { left_ = eye; }

private:
    /// A screen's picture on its way through the eye.
    struct Picture {
        render::StoredPicture light, retina;
    };
    std::vector<render::ViewStatistics> statistics_of_all(const std::vector<apps::Bytes>&, size_t channels) const;

    gpu::Device& device_;
    ChannelLink alone_;
    ChannelLink& link_;
    ChannelTurns turns_;
    ChannelGlare glare_;
    std::vector<Picture> pictures_;           // of each screen; empty where others render it
    std::unique_ptr<render::SharedEye> eye_;  // that keeps the scatter of so many
    std::optional<shared::EyeState> left_;    // by the last frame
    bool late_ = false;
};

}  // namespace vesper::drive
