// When a device is gone. SPDX-License-Identifier: MIT
#pragma once

#include "base/error.h"

namespace vesper {

/// The device was lost (a driver that was reset, a card that was unplugged): nothing on it answers any more, but another device can
/// go on with what the program has in memory.
class DeviceLost : public Error {
public:
    using Error::Error;
};

}  // namespace vesper
