// Tone mapping of pictures that nobody here rendered. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "gpu/memory.h"
#include "tone_chain.h"

namespace vesper {

/// A picture on the host.
struct HostPicture {
    VkExtent2D extent{};            ///< px
    std::span<const float> values;  ///< RGB (or RGBA, alpha ignored) in linear Rec. 709, rows from the top
    uint32_t channels = 3;          ///< 3 or 4
    float scale = 1;                ///< cd/m^2 per unit
    double vertical_fov = 0.7;      ///< rad, in (0, pi): what angle the picture covers in height
    std::vector<OutsideLamp> outside = {};  ///< lamps that scatter light into it; the picture is seen along -z, y up
};

/// Maps pictures of any size to the display, one after the other; the eye remembers from each to the next, also when the
/// size changes. Not thread-safe; several may share a device in one thread.
class ToneMapper {
public:
    explicit ToneMapper(Device& device);

    /// `seconds` have passed since the last picture. NaN and infinities are shown black and counted. Throws Error.
    ToneMapped map(const ToneChainSettings&, const HostPicture&, float seconds, Outputs outputs = {});

    /// Forgets what the eye was adapted to, as between pictures that have nothing to do with each other.
    void reset_adaptation() {
        executor_.reset(kEyeHistory);
        eye_.reset();
        last_eye_ = {};
    }
    /// The next picture goes on from this state, such as ToneMapped::eye of an earlier run.
    void set_eye(const shared::EyeState& eye) { eye_ = eye; }
    /// The plan of the last picture as text.
    const std::string& plan() const { return plan_; }

private:
    Device& device_;
    Kernels kernels_;
    Executor executor_;
    HostBuffer pixels_;
    ScatterCache scatter_;
    CoronaCache corona_;
    std::optional<shared::EyeState> eye_;  // set for the next picture
    shared::EyeState last_eye_{};          // what the last picture left
    std::string plan_;
};

}  // namespace vesper
