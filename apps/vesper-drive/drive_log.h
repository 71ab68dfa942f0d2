// One row for every rendered frame of a drive, as a CSV file. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "io/growing_file.h"
#include "session.h"

namespace vesper::drive {

/// Where luminance is read: parts of the picture from its top left, and the column's name.
struct LogProbe {
    glm::dvec2 place{0.5, 0.5};
};

/// X,Y of every --probe. Throws Error.
std::vector<LogProbe> probes_of(const std::vector<std::string>& texts);

/// The log, on disk row by row (GrowingFile). Throws Error.
class DriveLog {
public:
    DriveLog(const std::string& file, std::vector<LogProbe> probes);

    /// What the next row says was met.
    void add(const traffic::Contact&);
    /// `frame` must have its luminances; without them (the ldr operator) the columns that need them are empty.
    void add(const Session&, const gpu_scene::View&, const render::Frame& frame);
    void complete() { file_.complete(); }

private:
    io::GrowingFile file_;
    std::vector<LogProbe> probes_;
    unsigned rows_ = 0;
    std::string contacts_;  // since the last row, as the next has them
};

}  // namespace vesper::drive
