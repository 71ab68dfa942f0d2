// From luminance to what the display shows: one chain of passes for rendered frames and for pictures of other origin.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "graph/executor.h"
#include "render/stages.h"

namespace vesper::render {

class StoredPicture;

/// The results that are copied to the host.
struct Outputs {
    bool display = true;         ///< codes
    bool scene = false;          ///< luminance
    bool display_light = false;  ///< luminance of the display, without its limits
    /// Luminance on the retina, eye scatter included. The chain ends there: no adaptation, no display. Only `scene` may
    /// be requested as well.
    bool retina = false;
    /// If not null: the frame ends with its light, which is kept there on the device; only `scene` may be requested as
    /// well. For an eye that sees several pictures, or whose state comes later (SharedEye).
    StoredPicture* light = nullptr;
    /// An external image that gets the codes, too, in the order and with the bits of its format (shown_format).
    std::optional<graph::ExternalImage> shown = {};
    /// If not null: all codes, those of `shown` too, are of the picture of a projector, with its extent. It is read
    /// while the frame is declared. Its rendered picture must be of the frame's extent.
    const eye::Projection* projection = nullptr;
};

/// Readbacks of the chain. Those that were not asked for are none.
struct ToneChain {
    graph::Resource display, scene, retina, display_light, curve, histogram, eye;
    uint32_t foveal_level = 0;
    VkExtent2D shown_extent{};  ///< px, of the codes
    /// No readbacks: the luminance of the retina, and the last level of its pyramid; none where the chain ends before.
    graph::Resource retina_light, whole_retina;
};

/// The eye that looks at a frame.
struct ChainInputs {
    float seconds = 0;  ///< since the last frame
    EyeState eye = {};
    ScatterInputs scatter = {};                   ///< without a fit no light is scattered in the eye
    const eye::Corona* corona = nullptr;          ///< needles and halo of lamps; needs a fit of the scatter
    std::optional<shared::ToneCurve> curve = {};  ///< in place of what the eye adapts to
};

/// Declares glare, pyramid, histogram, adaptation and composite of `scene` (rgba32f, cd/m^2 RGB; with Operator::Ldr
/// values relative to white).
ToneChain add_tone_chain(const FrameContext& frame, graph::Resource scene, const ToneChainSettings& settings,
                         const ChainInputs& inputs, const Outputs& outputs);

/// One tone-mapped frame on the host.
struct ToneMapped {
    VkExtent2D extent{};        ///< px, of all but the codes
    VkExtent2D shown_extent{};  ///< px, of the codes: `extent`, or that of Outputs::projection
    /// Codes, row by row, 4 bytes a pixel: RGBA, or words of A2B10G10R10 where the display has 10 bits; empty unless
    /// asked for.
    std::vector<uint8_t> display;
    std::vector<float> scene;   ///< RGBA, cd/m^2 RGB; empty unless asked for
    std::vector<float> retina;  ///< the same with what the eye scatters; likewise
    std::vector<float>
        display_light;  ///< RGBA, cd/m^2 RGB: what the display would emit and reflect without its limits; likewise
    shared::ToneCurve curve{};
    shared::Histogram histogram{};
    shared::EyeState eye{};
    uint32_t foveal_level = 0;
    std::vector<graph::Timing> timings;
    graph::HostTimes host_times;
    double pupil = 0;                 ///< mm, whose glare is shown; 0: of a model without one
    double pattern_milliseconds = 0;  ///< of needles and halo, on the host
    double milliseconds = 0;          ///< from declaring the frame to the device being done, on the host's clock
};

/// Copies a resource to the host after the frame. If it is not wanted there is no readback.
graph::Resource add_readback(graph::FrameGraph& graph, const std::string& name, graph::Resource from, uint64_t bytes,
                             bool wanted = true);

/// The value that the last frame left in a readback.
template <class T>
T read_one(const graph::Executor& executor, graph::Resource readback) {
    T value;
    std::memcpy(&value, executor.read(readback).data(), sizeof value);
    return value;
}

/// Reads the results of a finished frame, except for times on the clock of the host.
void read_tone_chain(const graph::Executor& executor, const ToneChain& chain, VkExtent2D extent, ToneMapped& to);

}  // namespace vesper::render
