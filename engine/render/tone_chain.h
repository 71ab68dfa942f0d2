// From luminance to what the display shows: one chain of passes for rendered frames and for pictures of other origin.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "gpu_scene/eye_corona.h"
#include "graph/executor.h"
#include "render/passes/adapt.h"
#include "render/passes/bloom.h"
#include "render/passes/eye_scatter.h"

namespace vesper {

enum class Glare : uint8_t { None, Ldr, Scatter };

/// Everything between the luminance of a frame and its display codes.
struct ToneChainSettings {
    Operator tone_operator = Operator::Irawan;
    HistogramSettings histogram;
    std::optional<uint32_t> foveal_level;  ///< pyramid level of the histogram; default: 1 degree per texel
    ToneSettings tone;
    Display display;
    Glare glare = Glare::None;
    BloomSettings bloom;
    ScatterSettings scatter;     ///< of Glare::Scatter: light scattered in the eye, in cd/m^2
};

/// What to bring back to the host.
struct Outputs {
    bool display = true;  ///< codes
    bool scene = false;   ///< luminance
    bool display_light = false;   ///< luminance of the display, without its limits
    /// What falls on the retina, with what the eye scatters, and beside it at most `scene`: no eye adapts and nothing is shown. For
    /// several pictures of one eye.
    bool retina = false;
    /// An external image that gets the codes, too, in the order and with the bits of its format (shown_format).
    std::optional<ExternalImage> shown = {};
};

/// How codes lie in an image of a format.
struct ShownFormat {
    uint32_t bits;     ///< of a channel, 8 or 10
    bool blue_first;   ///< blue in the lowest bits of a word
};
/// Of formats that codes can be copied to as they are: RGBA and BGRA of 8 bits, UNORM or SRGB, and of 10 bits. Nothing for others.
std::optional<ShownFormat> shown_format(VkFormat);

/// What the chain leaves for the host. Resources that were not asked for are none.
struct ToneChain {
    Resource display, scene, retina, display_light, curve, histogram, eye;
    uint32_t foveal_level = 0;
};

/// What a frame brings besides its picture.
struct ChainInputs {
    float seconds = 0;                              ///< since the last frame
    const shared::EyeState* remembered = nullptr;   ///< stands for the last frame
    ScatterInputs scatter = {};      ///< without a fit no light is scattered in the eye
    const Corona* corona = nullptr;  ///< needles and halo of lamps; needs a fit of the scatter
};

/// Declares glare, pyramid, histogram, adaptation and composite of `scene` (rgba32f, cd/m^2 RGB; with Operator::Ldr values
/// relative to white). The eye (kEyeHistory) remembers from frame to frame, also when sizes change.
ToneChain add_tone_chain(const FrameContext& frame, Resource scene, const ToneChainSettings& settings,
                         const ChainInputs& inputs, const Outputs& outputs);

/// One tone-mapped frame on the host.
struct ToneMapped {
    VkExtent2D extent{};
    /// Codes, row by row, 4 bytes a pixel: RGBA, or words of A2B10G10R10 where the display has 10 bits; empty unless asked for.
    std::vector<uint8_t> display;
    std::vector<float> scene;       ///< RGBA, cd/m^2 RGB; empty unless asked for
    std::vector<float> retina;      ///< the same with what the eye scatters; likewise
    std::vector<float> display_light;       ///< RGBA, cd/m^2 RGB: what the display would emit and reflect without its limits; likewise
    shared::ToneCurve curve{};
    shared::Histogram histogram{};
    shared::EyeState eye{};
    uint32_t foveal_level = 0;
    std::vector<Timing> timings;
    HostTimes host_times;
    double pupil = 0;               ///< mm, whose glare is shown; 0: of a model without one
    double pattern_milliseconds = 0;  ///< of needles and halo, on the host
    double milliseconds = 0;        ///< from declaring the frame to the device being done, on the host's clock
};

/// Copies a resource to the host after the frame. If it is not wanted there is no readback.
Resource add_readback(FrameGraph& graph, const std::string& name, Resource from, uint64_t bytes, bool wanted = true);

/// The value that the last frame left in a readback.
template <class T>
T read_one(const Executor& executor, Resource readback) {
    T value;
    std::memcpy(&value, executor.read(readback).data(), sizeof value);
    return value;
}

/// Takes what the chain left, except for the time on the host's clock.
void read_tone_chain(const Executor&, const ToneChain&, VkExtent2D, ToneMapped& to);

/// What the host keeps of an eye from frame to frame: its glare, and what it remembers in place of the device.
class EyeKeeper {
public:
    /// The glare of `views` sizes or angles of pictures is kept.
    explicit EyeKeeper(const Device& device, size_t views = 1) : scatter_(device, views) {}

    /// What a frame of `view` brings, with light scattered if `settings` say so.
    ChainInputs inputs(Executor&, const ToneChainSettings& settings, const View& view, float seconds);
    /// Whether `settings` ask for what the frame before left, so that the host has to have read it.
    static bool looks_back(const ToneChainSettings& settings) { return settings.glare == Glare::Scatter && settings.scatter.has_corona(); }
    void submitted() { given_.reset(); }
    void read(const shared::EyeState& eye) { last_ = eye; }

    /// The next frame goes on from this state.
    void set(const shared::EyeState& eye) { given_ = eye; }
    /// The next frame is the first.
    void reset(Executor&);

private:
    ScatterCache scatter_;
    CoronaCache corona_;
    std::optional<shared::EyeState> given_;  // for the next frame
    shared::EyeState last_{};                // what the last frame left
};

}  // namespace vesper
