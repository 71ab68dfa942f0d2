// From luminance to what the display shows: one chain of passes for rendered frames and for pictures of other origin.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "graph/executor.h"
#include "passes/passes.h"
#include "resident/kernels.h"

namespace vesper {

enum class Glare : uint8_t { None, Ldr };

/// Everything between the luminance of a frame and its display codes.
struct ToneChainSettings {
    Operator tone_operator = Operator::Irawan;
    HistogramSettings histogram;
    std::optional<uint32_t> foveal_level;  ///< pyramid level of the histogram; default: 1 degree per texel
    ToneSettings tone;
    Display display;
    Glare glare = Glare::None;
    LdrGlareSettings ldr_glare;
};

/// What to bring back to the host.
struct Outputs {
    bool display = true;  ///< codes
    bool scene = false;   ///< luminance
    bool light = false;   ///< luminance of the display, without its limits
};

/// What the chain leaves for the host. Resources that were not asked for are none.
struct ToneChain {
    Resource display, scene, light, curve, histogram, eye;
    uint32_t foveal_level = 0;
};

/// Declares pyramid, histogram, adaptation, glare and composite of `scene` (rgba32f, cd/m^2 RGB; with Operator::Ldr values
/// relative to white), `seconds` after the last frame.
/// The eye (kEyeHistory) remembers from frame to frame, also when sizes change; `remembered` stands for the last frame.
ToneChain add_tone_chain(FrameGraph&, const Kernels&, Resource scene, const View&, const ToneChainSettings&, float seconds,
                         Outputs, const shared::EyeState* remembered = nullptr);

/// One tone-mapped frame on the host.
struct ToneMapped {
    VkExtent2D extent{};
    /// Codes, row by row, 4 bytes a pixel: RGBA, or words of A2B10G10R10 where the display has 10 bits; empty unless asked for.
    std::vector<uint8_t> display;
    std::vector<float> scene;       ///< RGBA, cd/m^2 RGB; empty unless asked for
    std::vector<float> light;       ///< RGBA, cd/m^2 RGB: what the display would emit and reflect without its limits; likewise
    shared::ToneCurve curve{};
    shared::Histogram histogram{};
    shared::EyeState eye{};
    uint32_t foveal_level = 0;
    std::vector<Timing> timings;
    HostTimes host_times;
    double milliseconds = 0;        ///< from declaring the frame to the device being done, on the host's clock
};

/// A readback of a resource, to be kept: what passes are run for.
Resource bring_back(FrameGraph&, const std::string& name, Resource from, uint64_t bytes);

/// The value that the last frame left in a readback.
template <class T>
T read_one(const Executor& executor, Resource readback) {
    T value;
    std::memcpy(&value, executor.read(readback).data(), sizeof value);
    return value;
}

/// Takes what the chain left, except for the time on the host's clock.
void read_tone_chain(const Executor&, const ToneChain&, VkExtent2D, ToneMapped& to);

}  // namespace vesper
