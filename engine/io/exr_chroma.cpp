// SPDX-License-Identifier: MIT
#include "io/exr_chroma.h"

#include <algorithm>

namespace vesper::io::hdr {
namespace {

/// The value between i and i + 1 of n: the filter of OpenEXR's reader (reconstructChromaHoriz of its ImfRgbaYca.cpp),
/// with the ends repeated.
template <typename Value>
float between(int64_t i, int64_t n, const Value& value) {
    constexpr double kWeights[] = {0.627123, -0.186077, 0.087929, -0.043159, 0.019597, -0.007540, 0.002128};
    double sum = 0;
    for (int64_t k = 0; k < 7; ++k)
        sum += kWeights[k] * (static_cast<double>(value(std::max<int64_t>(i - k, 0))) +
                              static_cast<double>(value(std::min(i + 1 + k, n - 1))));
    return static_cast<float>(sum);
}

}  // namespace

void ChromaPlane::resize(int64_t columns, int64_t rows) {
    width = (columns + step.x - 1) / step.x;
    height = (rows + step.y - 1) / step.y;
    values.assign(static_cast<size_t>(width * height), 0.0f);
}

void ChromaPlane::line(int64_t row, int64_t columns, std::vector<float>& out) const {
    out.resize(static_cast<size_t>(columns));
    const int64_t y = row / step.y;
    const auto at = [&](int64_t i, int64_t j) { return values[static_cast<size_t>(j * width + i)]; };
    const bool stored = row % step.y == 0;
    for (int64_t i = 0; i < width; ++i)
        out[static_cast<size_t>(i * step.x)] =
            stored ? at(i, y) : between(y, height, [&](int64_t j) { return at(i, j); });
    for (int64_t x = 1; step.x == 2 && x < columns; x += 2)
        out[static_cast<size_t>(x)] = between(x / 2, width, [&](int64_t i) { return out[static_cast<size_t>(2 * i)]; });
}

}  // namespace vesper::io::hdr
