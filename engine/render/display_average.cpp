#include "render/display_average.h"

#include <algorithm>
#include <cstring>

#include "base/budget.h"

namespace vesper::render {

DisplayAverage::DisplayAverage(const vision::Display& display, size_t pixels) : bits_(display.bits) {
    const vision::DisplayCurve curve(display);
    const double largest = display.largest_code();
    for (uint32_t code = 0; code <= display.largest_code(); ++code) {
        luminance_.push_back(curve.emitted(code / largest));
        borders_.push_back(curve.emitted((code + 0.5) / largest));
    }
    borders_.pop_back();
    const Budget budget("averaging what the display shows");
    spend(3 * pixels * sizeof(double));
    sums_.resize(3 * pixels);
}

void DisplayAverage::add(std::span<const uint8_t> codes) {
    const uint32_t mask = (1u << bits_) - 1;
    for (size_t i = 0; 4 * i + 4 <= codes.size() && 3 * i + 3 <= sums_.size(); ++i) {
        uint32_t word = 0;
        std::memcpy(&word, codes.data() + 4 * i, sizeof word);
        for (uint32_t c = 0; c < 3; ++c) sums_[3 * i + c] += luminance_[word >> (c * bits_) & mask];
    }
    ++pictures_;
}

uint32_t DisplayAverage::code_of(double luminance) const {
    const auto first = std::ranges::lower_bound(luminance_, luminance);  // that is as bright
    const auto code = uint32_t(std::min(first, luminance_.end() - 1) - luminance_.begin());
    return code > 0 && luminance < borders_[code - 1] ? code - 1 : code;
}

std::vector<uint8_t> DisplayAverage::codes() const {
    std::vector<uint8_t> codes(sums_.size() / 3 * 4);
    for (size_t i = 0; i < sums_.size() / 3; ++i) {
        uint32_t word = bits_ == 8 ? 0xffu << 24u : 3u << 30u;
        for (uint32_t c = 0; c < 3; ++c) {
            word |= code_of(sums_[3 * i + c] / pictures_) << (c * bits_);
        }
        std::memcpy(codes.data() + 4 * i, &word, sizeof word);
    }
    return codes;
}

}  // namespace vesper::render
