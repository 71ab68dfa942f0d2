// A card before a wall, both of their own light. SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "support/luminous_square.h"

namespace vesper::test {

/// A glTF file: a card of 2 m by 3 m and 3 cd/m^2, `away` m before the camera "eye" in the origin (1 rad high), and
/// 10 m behind it a wall of 2 cd/m^2.
inline std::string luminous_card(float away) {
    GltfFile file;
    const float far = -away - 10, low = -1.2f, high = 1.8f;
    add_luminous_square(file, "wall", {-100, -100, far, 100, -100, far, 100, 100, far, -100, 100, far}, 2);
    add_luminous_square(file, "card", {-1, low, -away, 1, low, -away, 1, high, -away, -1, high, -away}, 3);
    add_eye(file);
    return file.text();
}

}  // namespace vesper::test
