// A progress bar for a terminal. SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

namespace vesper::apps {

/// Draws on standard error while it is a terminal; silent otherwise.
class Progress {
public:
    Progress(std::string what, unsigned total);
    ~Progress();  ///< ends the line
    void step();  ///< one more of the total is done

private:
    std::string what_;
    unsigned total_, done_ = 0;
    bool visible_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace vesper::apps
