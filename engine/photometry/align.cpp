// Shifts between exposures from median threshold bitmaps: G. Ward, "Fast, Robust Image Registration for Compositing High
// Dynamic Range Photographs from Handheld Exposures", JGT 8(2), 2003. SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <numeric>

#include "photometry/merge.h"

namespace vesper {
namespace {

struct Grey {
    int64_t width = 0, height = 0;
    std::vector<uint8_t> codes;
};

/// Which pixels are above the threshold, and which are too close to it to count.
struct Bitmap {
    int64_t width = 0, height = 0;
    std::vector<uint8_t> above, sure;  // 0 or 1
};

Grey grey_of(const Image& image) {
    Grey grey{image.width, image.height, {}};
    grey.codes.resize(image.rgba.size() / 4);
    for (size_t i = 0; i < grey.codes.size(); ++i) {
        const uint8_t* p = image.rgba.data() + 4 * i;
        grey.codes[i] = static_cast<uint8_t>((54 * p[0] + 183 * p[1] + 19 * p[2]) / 256);  // Ward's weights
    }
    return grey;
}

Grey halved(const Grey& grey) {
    Grey half{grey.width / 2, grey.height / 2, {}};
    half.codes.resize(static_cast<size_t>(half.width * half.height));
    for (int64_t y = 0; y < half.height; ++y)
        for (int64_t x = 0; x < half.width; ++x) {
            const uint8_t* p = grey.codes.data() + 2 * y * grey.width + 2 * x;
            half.codes[static_cast<size_t>(y * half.width + x)] =
                static_cast<uint8_t>((p[0] + p[1] + p[grey.width] + p[grey.width + 1] + 2) / 4);
        }
    return half;
}

/// The code below which this part of all pixels lies.
int quantile(const Grey& grey, double part) {
    std::array<size_t, 256> counts{};
    for (const uint8_t code : grey.codes) ++counts[code];
    size_t below = 0;
    for (int code = 0; code < 256; ++code) {
        below += counts[static_cast<size_t>(code)];
        if (static_cast<double>(below) >= part * static_cast<double>(grey.codes.size())) return code;
    }
    return 255;
}

Bitmap bitmap_of(const Grey& grey, double part) {
    constexpr int kNoise = 4;  // codes
    const int threshold = quantile(grey, part);
    Bitmap made{grey.width, grey.height, std::vector<uint8_t>(grey.codes.size()), std::vector<uint8_t>(grey.codes.size())};
    for (size_t i = 0; i < grey.codes.size(); ++i) {
        made.above[i] = grey.codes[i] > threshold;
        made.sure[i] = std::abs(grey.codes[i] - threshold) > kNoise;
    }
    return made;
}

/// Where both are sure: the part of pixels that differ when pixel p of `a` lies on p + shift of `b`. 1 without overlap.
double difference(const Bitmap& a, const Bitmap& b, glm::i64vec2 shift) {
    const int64_t x0 = std::max<int64_t>(0, -shift.x), x1 = std::min(a.width, b.width - shift.x);
    const int64_t y0 = std::max<int64_t>(0, -shift.y), y1 = std::min(a.height, b.height - shift.y);
    if (x1 <= x0 || y1 <= y0) return 1;
    uint64_t differ = 0;
    for (int64_t y = y0; y < y1; ++y) {
        const int64_t at_a = y * a.width, at_b = (y + shift.y) * b.width + shift.x;
        uint32_t row = 0;
        for (int64_t x = x0; x < x1; ++x)
            row += static_cast<uint32_t>((a.above[at_a + x] ^ b.above[at_b + x]) & a.sure[at_a + x] & b.sure[at_b + x]);
        differ += row;
    }
    return static_cast<double>(differ) / static_cast<double>((x1 - x0) * (y1 - y0));
}

/// The same quantile of both pictures; the median, unless it is lost in the black or white of one of them.
double common_part(const Grey& a, const Grey& b) {
    const auto usable = [&](double part) {
        return std::min(quantile(a, part), quantile(b, part)) >= 8 && std::max(quantile(a, part), quantile(b, part)) <= 247;
    };
    for (const double part : {0.5, 0.7, 0.83, 0.92, 0.3, 0.17})
        if (usable(part)) return part;
    return 0.5;
}

/// Shift of `b` against `a`: found in the smallest pictures, doubled and improved by one pixel in each larger one.
glm::i64vec2 shift_between(const Grey& a, const Grey& b, double part, int levels) {
    glm::i64vec2 best{0};
    if (levels > 1 && std::min(a.width, a.height) >= 32) best = int64_t{2} * shift_between(halved(a), halved(b), part, levels - 1);
    const Bitmap bits_a = bitmap_of(a, part), bits_b = bitmap_of(b, part);
    const glm::i64vec2 start = best;
    double least = difference(bits_a, bits_b, start);
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const glm::i64vec2 tried = start + glm::i64vec2(dx, dy);
            const double found = difference(bits_a, bits_b, tried);
            if (found < least) {
                least = found;
                best = tried;
            }
        }
    return best;
}

}  // namespace

void estimate_shifts(std::span<Exposure> exposures, int levels) {
    std::vector<size_t> order(exposures.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return exposures[a].exposure < exposures[b].exposure; });
    if (order.empty()) return;
    exposures[order[0]].shift = glm::ivec2(0);
    Grey before = grey_of(exposures[order[0]].image);
    for (size_t i = 1; i < order.size(); ++i) {
        Grey next = grey_of(exposures[order[i]].image);
        const glm::i64vec2 step = shift_between(before, next, common_part(before, next), levels);
        exposures[order[i]].shift = exposures[order[i - 1]].shift + glm::ivec2(step);
        before = std::move(next);
    }
    const glm::ivec2 middle = exposures[order[order.size() / 2]].shift;
    for (Exposure& exposure : exposures) exposure.shift -= middle;
}

}  // namespace vesper
