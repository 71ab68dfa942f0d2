// A window that shows channels of a drive that another rank leads. SPDX-License-Identifier: MIT
#pragma once

#include "channels/channels.h"
#include "run/drive.h"

namespace vesper::drive {

/// Shows the channels of this rank until the first rank ends the drive. Throws Error, also where the window is closed.
void show_channels(const DriveArguments&);

/// The monitor that a window of these channels fills: the one that any of them names. Throws Error where it is not
/// there, or where they name several.
std::optional<unsigned> monitor_of(const Channels&, const std::vector<size_t>& own);

}  // namespace vesper::drive
