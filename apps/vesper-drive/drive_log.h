// One row for every rendered frame of a drive, as a CSV file. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "session.h"

namespace vesper {

/// Where luminance is read: parts of the picture from its top left, and the column's name.
struct LogProbe {
    glm::dvec2 place{0.5, 0.5};
};

std::string drive_log_heading(const std::vector<LogProbe>&);
/// `frame` must have its luminances; without them (the ldr operator) the columns that need them are empty.
std::string drive_log_row(unsigned index, const Session&, const View&, const Frame& frame, const std::vector<LogProbe>&);

}  // namespace vesper
