// How long a program takes from nothing to its first frame. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "result.h"

namespace vesper::bench {

/// Runs `work` in two fresh processes, one after the other, whose drivers keep their shaders in `folder`: empty for the
/// first (cold), as that left it for the second (warm). `work` calls what it is given as soon as its first frame is
/// there. To be called before this process opens a device or starts a thread. Throws Error.
std::vector<Start> time_starts(const std::string& folder,
                               const std::function<void(const std::function<void()>&)>& work);

}  // namespace vesper::bench
