// Chroma of OpenEXR that is stored for one pixel in two. Not for others. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::io::hdr {

/// Some rows of a chroma channel, from one that the file has values of.
struct ChromaPlane {
    static constexpr int64_t kReach = 13;  ///< px on either side that a value between two of the file is made of

    glm::ivec2 step{1};             ///< the file has the value of one pixel in so many
    int64_t width = 0, height = 0;  ///< values
    std::vector<float> values;

    bool is_sound() const { return step.x >= 1 && step.x <= 2 && step.y >= 1 && step.y <= 2; }
    /// Room for the values of so many pixels.
    void resize(int64_t columns, int64_t rows);
    /// Values of all `columns` pixels of a row (of pixels), filtered in between as OpenEXR's own reader does.
    void line(int64_t row, int64_t columns, std::vector<float>& out) const;
};

}  // namespace vesper::io::hdr
