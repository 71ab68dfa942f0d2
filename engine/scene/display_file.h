// Display profiles: files that describe a display (docs/display.md). SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "vision/display.h"

namespace vesper::scene {

/// Reads a display profile. Throws Error with file, place and reason.
vision::Display read_display(const std::filesystem::path& file);

/// A display by its name (known_displays) or the file of its profile. Throws Error.
vision::Display find_display(const std::string& name_or_file);

/// The same over and over: a file is read again only when its time or its size has changed.
class DisplayFinder {
public:
    const vision::Display& find(const std::string& name_or_file);

private:
    std::string name_;
    std::filesystem::file_time_type time_{};
    std::uintmax_t bytes_ = 0;
    std::optional<vision::Display> display_;
};

/// A profile as JSON text, to be read again without loss; `name` may be empty.
std::string display_json(const vision::Display&, const std::string& name);

}  // namespace vesper::scene
