// A window that shows channels of a drive that another rank leads. SPDX-License-Identifier: MIT
#pragma once

#include "drive.h"

namespace vesper::drive {

/// Shows the channels of this rank until the first rank ends the drive. Throws Error, also where the window is closed.
void show_channels(const DriveArguments&);

}  // namespace vesper::drive
