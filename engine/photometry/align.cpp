// Shifts between exposures from median threshold bitmaps: G. Ward, "Fast, Robust Image Registration for Compositing
// High Dynamic Range Photographs from Handheld Exposures", JGT 8(2), 2003. SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>

#include "photometry/merge.h"

namespace vesper::photometry {
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

/// The code below which this part of the pixels lies, of those that the other picture shows too if it is moved by
/// `shift`.
int quantile(const Grey& grey, double part, glm::i64vec2 shift) {
    const int64_t x0 = std::clamp<int64_t>(-shift.x, 0, grey.width - 1),
                  x1 = std::clamp(grey.width - shift.x, x0 + 1, grey.width);
    const int64_t y0 = std::clamp<int64_t>(-shift.y, 0, grey.height - 1),
                  y1 = std::clamp(grey.height - shift.y, y0 + 1, grey.height);
    std::array<size_t, 256> counts{};
    for (int64_t y = y0; y < y1; ++y)
        for (int64_t x = x0; x < x1; ++x) ++counts[grey.codes[static_cast<size_t>(y * grey.width + x)]];
    const double wanted = part * static_cast<double>((x1 - x0) * (y1 - y0));
    size_t below = 0;
    for (int code = 0; code < 256; ++code) {
        below += counts[static_cast<size_t>(code)];
        if (static_cast<double>(below) >= wanted) return code;
    }
    return 255;
}

Bitmap bitmap_of(const Grey& grey, double part, glm::i64vec2 shift) {
    constexpr int kNoise = 4;  // codes
    const int threshold = quantile(grey, part, shift);
    Bitmap made{grey.width, grey.height, std::vector<uint8_t>(grey.codes.size()),
                std::vector<uint8_t>(grey.codes.size())};
    for (size_t i = 0; i < grey.codes.size(); ++i) {
        made.above[i] = grey.codes[i] > threshold;
        made.sure[i] = std::abs(grey.codes[i] - threshold) > kNoise;
    }
    return made;
}

/// The part of pixels that differ, of those where both are sure, when pixel p of `a` lies on p + shift of `b`. 1
/// without any.
double difference(const std::vector<Bitmap>& a, const std::vector<Bitmap>& b, glm::i64vec2 shift) {
    uint64_t differ = 0, sure = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const int64_t x0 = std::max<int64_t>(0, -shift.x), x1 = std::min(a[i].width, b[i].width - shift.x);
        const int64_t y0 = std::max<int64_t>(0, -shift.y), y1 = std::min(a[i].height, b[i].height - shift.y);
        for (int64_t y = y0; y < y1; ++y) {
            const int64_t at_a = y * a[i].width, at_b = (y + shift.y) * b[i].width + shift.x;
            uint32_t differ_in_row = 0, sure_in_row = 0;
            for (int64_t x = x0; x < x1; ++x) {
                const uint8_t both = a[i].sure[at_a + x] & b[i].sure[at_b + x];
                sure_in_row += both;
                differ_in_row += both & (a[i].above[at_a + x] ^ b[i].above[at_b + x]);
            }
            differ += differ_in_row;
            sure += sure_in_row;
        }
    }
    return sure == 0 ? 1.0 : static_cast<double>(differ) / static_cast<double>(sure);
}

/// Ward takes one threshold: the median, or another quantile in pictures that are too dark or bright. At night an edge
/// is rarely where the median is, so all of these are taken that lie inside the codes of both pictures.
std::vector<double> common_parts(const Grey& a, const Grey& b) {
    std::vector<double> parts;
    for (const double part : {0.17, 0.3, 0.5, 0.7, 0.83, 0.92, 0.97}) {
        const auto [low, high] = std::minmax({quantile(a, part, {0, 0}), quantile(b, part, {0, 0})});
        if (low >= 8 && high <= 247) parts.push_back(part);
    }
    return parts.empty() ? std::vector<double>{0.5} : parts;
}

/// The best shift within `reach` px of another one.
glm::i64vec2 improve(const Grey& a, const Grey& b, const std::vector<double>& parts, glm::i64vec2 start, int reach) {
    std::vector<Bitmap> bits_a, bits_b;
    for (const double part : parts) {
        bits_a.push_back(bitmap_of(a, part, start));
        bits_b.push_back(bitmap_of(b, part, -start));
    }
    glm::i64vec2 best = start;
    double least = difference(bits_a, bits_b, start);
    for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
            const glm::i64vec2 tried = start + glm::i64vec2(dx, dy);
            const double found = difference(bits_a, bits_b, tried);
            if (found < least) {
                least = found;
                best = tried;
            }
        }
    return best;
}

/// Shift of `b` against `a`: within 4 px in the smallest pictures, doubled and improved by a pixel or two in each
/// larger one. Done twice, because thresholds depend on what both pictures show, and that on the shift.
glm::i64vec2 shift_between(const Grey& a, const Grey& b, const std::vector<double>& parts, int levels) {
    const bool smallest = levels <= 1 || std::min(a.width, a.height) < 32;
    glm::i64vec2 shift{0};
    if (!smallest) shift = shift_between(halved(a), halved(b), parts, levels - 1) * int64_t{2};
    shift = improve(a, b, parts, shift, smallest ? 4 : 1);
    return improve(a, b, parts, shift, 1);
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
        const glm::i64vec2 step = shift_between(before, next, common_parts(before, next), levels);
        exposures[order[i]].shift = exposures[order[i - 1]].shift + glm::ivec2(step);
        before = std::move(next);
    }
    const glm::ivec2 middle = exposures[order[order.size() / 2]].shift;
    for (Exposure& exposure : exposures) exposure.shift -= middle;
}

}  // namespace vesper::photometry
