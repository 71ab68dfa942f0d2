// Options of the display that codes are for. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "arguments/command_line.h"

#include "vision/display.h"

namespace vesper::apps {

struct DisplayArguments {
    std::string display;                                           ///< name, or file
    std::optional<float> peak, black, gamma, ambient, reflection;  ///< in place of the display's
};
void add_display_options(Command, DisplayArguments&);
/// Whether one of them is.
bool is_given(const DisplayArguments&);
/// Throws Error if they contradict each other.
vision::Display display_of(const DisplayArguments&);

}  // namespace vesper::apps
