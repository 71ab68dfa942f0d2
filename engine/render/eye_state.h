// The state of an eye between two frames. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "shared/tone.h"

namespace vesper::render {

/// A frame takes the state of the eye and leaves another one. While a frame is under way the host does not know what it
/// leaves, but the next one can take it on the device, without a copy to the host and back.
struct EyeState {
    shared::EyeState value{};  ///< as the host knows it; zero: the eye has seen nothing yet
    bool on_device = false;    ///< the next frame takes what the last one left on the device: `value`, or a later state

    /// After a frame was submitted.
    EyeState submitted() const { return {value, true}; }
    /// After that frame was finished and its state read.
    EyeState finished(const shared::EyeState& left) const { return on_device ? EyeState{left, true} : *this; }
};

/// A value that no eye has after a frame.
struct EyeFault {
    size_t index;        ///< of the float in shared::EyeState
    std::string reason;  ///< the value, and the values that there are, with units
};
/// The first one, if any. An eye that has seen nothing yet, all zeroes, is sound.
std::optional<EyeFault> fault_of(const shared::EyeState& eye);

}  // namespace vesper::render
