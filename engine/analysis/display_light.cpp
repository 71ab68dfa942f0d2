#include "analysis/display_light.h"

#include <cstring>

namespace vesper::analysis {

DisplayLight::DisplayLight(const vision::Display& display)
    : display_(display),
      to_rec709_(io::to_rec709(display.primaries)),
      reflected_(double(display.low()) - double(display.black)) {}

std::vector<double> DisplayLight::light_of(uint32_t largest) const {
    const vision::DisplayCurve curve(display_);
    std::vector<double> light;
    for (uint32_t code = 0; code <= largest; ++code) light.push_back(curve.emitted(double(code) / largest));
    return light;
}

void DisplayLight::add(std::vector<float>& pixels, const glm::dvec3& emitted) const {
    const glm::dvec3 rgb = to_rec709_ * emitted + reflected_;
    for (int c = 0; c < 3; ++c) pixels.push_back(float(rgb[c]));
}

std::vector<float> DisplayLight::of_wide(std::span<const uint16_t> rgba) const {
    const std::vector<double> light = light_of(UINT16_MAX);
    std::vector<float> pixels;
    pixels.reserve(rgba.size() / 4 * 3);
    for (size_t i = 0; i + 4 <= rgba.size(); i += 4)
        add(pixels, {light[rgba[i]], light[rgba[i + 1]], light[rgba[i + 2]]});
    return pixels;
}

std::vector<float> DisplayLight::of_words(std::span<const uint8_t> words) const {
    const std::vector<double> light = light_of(display_.largest_code());
    std::vector<float> pixels;
    pixels.reserve(words.size() / 4 * 3);
    for (size_t i = 0; i + 4 <= words.size(); i += 4) {
        uint32_t word = 0;
        std::memcpy(&word, &words[i], sizeof word);
        const auto channel = [&](uint32_t c) { return light[word >> (c * display_.bits) & display_.largest_code()]; };
        add(pixels, {channel(0), channel(1), channel(2)});
    }
    return pixels;
}

}  // namespace vesper::analysis
