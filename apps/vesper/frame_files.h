// Files that grow with each frame of vesper render. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "io/growing_file.h"
#include "ranks/packet.h"

namespace vesper::commands {

/// What a frame adds to them.
struct FrameRows {
    std::string log, sources;  ///< rows of --log and of --glare-sources, with their ends
    std::string eye;           ///< of the last frame: the row of --eye-out

    apps::Bytes packed() const;
};

/// The files: of the first rank. Throws Error.
class FrameFiles {
public:
    /// Names; empty: no such file. `more`: names of columns behind those of a log.
    void open(const std::string& log, const std::string& sources, const std::string& eye, const std::string& more);
    /// The rows of the next frame, packed.
    void add(const apps::Bytes& rows);
    void complete();

private:
    std::string eye_file_, heading_;
    std::optional<io::GrowingFile> log_, sources_;
};

}  // namespace vesper::commands
