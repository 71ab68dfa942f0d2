// One row for every rendered frame of a drive, as a CSV file. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "io/growing_file.h"
#include "session/session.h"

namespace vesper::drive {

/// Where luminance is read: parts of the picture from its top left, and the column's name.
struct LogProbe {
    glm::dvec2 place{0.5, 0.5};
};

/// X,Y of every --probe. Throws Error.
std::vector<LogProbe> probes_of(const std::vector<std::string>& texts);

/// The rows of a log, one after the other. Throws Error.
class DriveRows {
public:
    explicit DriveRows(std::vector<LogProbe> probes) : probes_(std::move(probes)) {}

    /// Names of the columns, in a line that has no end yet.
    std::string heading() const;
    /// What the next row says was met.
    void add(const traffic::Contact&);
    /// The next row is made elsewhere.
    void skip() { ++rows_, contacts_.clear(); }
    /// The next row. `frame` must have its luminances; without them (the ldr operator) the columns that need them are
    /// empty.
    std::string next(const Session&, const gpu_scene::View&, const render::Frame& frame);

private:
    std::vector<LogProbe> probes_;
    unsigned rows_ = 0;
    std::string contacts_;  // since the last row, as the next has them
};

/// The next row, of the channel that is looked at; that must be one of this process.
std::string row_of(DriveRows&, const Session&, const Channels&, ChannelMosaic&);

/// The log, on disk row by row (GrowingFile). Throws Error.
class DriveLog {
public:
    /// `more`: names of columns behind those of the rows.
    DriveLog(const std::string& file, std::vector<LogProbe> probes, const std::string& more = "");

    DriveRows& rows() { return rows_; }
    /// A row, and values of the further columns.
    void append(const std::string& row, const std::string& more = "") { file_.append(row + more + "\n"); }
    void complete() { file_.complete(); }

private:
    io::GrowingFile file_;
    DriveRows rows_;
};

}  // namespace vesper::drive
