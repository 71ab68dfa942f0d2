#include "eye/encoding.h"

#include <algorithm>
#include <bit>

namespace vesper::eye {
namespace {

constexpr uint32_t kMantissaBits = 23;
constexpr float kNever = 2;                      // no light is
constexpr uint32_t kMinBits = 4, kMaxBits = 12;  // of the mantissa that tell cells apart

/// Displayed light from which on the code is i + 1 or more, ascending: that of a code half a step below it.
std::vector<float> thresholds_of(const vision::Display& display) {
    const vision::DisplayCurve curve(display);
    const double black = double(display.black), peak = double(display.peak), largest = display.largest_code();
    std::vector<float> thresholds;
    for (double code = 0.5; code < largest; ++code) {
        const double luminance = curve.emitted(code / largest);
        // Nothing the display shows needs a code that stands for more than its peak (PQ).
        if (luminance >= peak) break;
        thresholds.push_back(float((luminance - black) / (peak - black)));
    }
    return thresholds;
}

/// Cells with so many bits of the mantissa, down to the last that begins below the second positive threshold.
Encoding cells_of(const std::vector<float>& thresholds, uint32_t mantissa, bool& exact) {
    const auto positive = std::upper_bound(thresholds.begin(), thresholds.end(), 0.0f);
    const float second = thresholds.end() - positive >= 2 ? positive[1] : 1.0f;
    Encoding made;
    shared::EncodePush& push = made.push;
    push.shift = kMantissaBits - mantissa;
    push.last = std::bit_cast<uint32_t>(1.0f) >> push.shift;
    push.first = std::min(std::bit_cast<uint32_t>(std::max(second, 1e-12f)) >> push.shift, push.last) - 1;
    exact = true;
    auto begin = thresholds.begin();
    for (uint32_t cell = push.first; cell <= push.last; ++cell) {
        const float low = cell == push.first ? 0 : std::bit_cast<float>(cell << push.shift);
        const float high = std::bit_cast<float>((cell + 1) << push.shift);
        while (begin != thresholds.end() && *begin <= low) ++begin;
        auto end = begin;
        while (end != thresholds.end() && *end < high) ++end;
        const auto code = [&](auto at) { return float(at - thresholds.begin()); };
        exact &= end - begin <= 1;
        made.cells.emplace_back(begin == end ? kNever : begin[(end - begin) / 2], code(begin), code(end), 0);
    }
    return made;
}

}  // namespace

Encoding make_encoding(const vision::Display& display) {
    const std::vector<float> thresholds = thresholds_of(display);
    Encoding made;
    bool exact = false;
    for (uint32_t mantissa = kMinBits; mantissa <= kMaxBits && !exact; ++mantissa)
        made = cells_of(thresholds, mantissa, exact);
    made.push.bits = display.bits;
    return made;
}

}  // namespace vesper::eye
