// The lamps of data/photometry, built in. SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "photometry/distribution.h"

namespace vesper::photometry {

/// "street-lamp" (type C), "low-beam", "high-beam", "front-fog" (type A, right-hand traffic). Throws Error for other
/// names.
Distribution standard_lamp(const std::string& name);

}  // namespace vesper::photometry
