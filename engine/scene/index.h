// Indices of elements of a scene. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace vesper::scene {

constexpr uint32_t kNone = ~0u;  ///< "no such element" wherever an index is kept

}  // namespace vesper::scene
