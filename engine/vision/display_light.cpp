#include "vision/display_light.h"

#include <cstring>

#include "base/luminance.h"

namespace vesper::vision {

DisplayLight::DisplayLight(const Display& display) : display_(display) {
    const glm::dmat3 to709 = io::to_rec709(display.primaries);
    for (int c = 0; c < 3; ++c) weights_[c] = luminance(to709[c]);
}

std::vector<double> DisplayLight::light_of(uint32_t largest) const {
    const DisplayCurve curve(display_);
    std::vector<double> light;
    for (uint32_t code = 0; code <= largest; ++code) light.push_back(curve.emitted(double(code) / largest));
    return light;
}

std::vector<float> DisplayLight::of_wide(std::span<const uint16_t> rgba) const {
    const std::vector<double> light = light_of(UINT16_MAX);
    const double reflected = double(display_.low() - display_.black);
    std::vector<float> pixels;
    pixels.reserve(rgba.size() / 4);
    for (size_t i = 0; i + 4 <= rgba.size(); i += 4)
        pixels.push_back(
            float(reflected + glm::dot(weights_, {light[rgba[i]], light[rgba[i + 1]], light[rgba[i + 2]]})));
    return pixels;
}

std::vector<float> DisplayLight::of_words(std::span<const uint8_t> words) const {
    const std::vector<double> light = light_of(display_.largest_code());
    const double reflected = double(display_.low() - display_.black);
    std::vector<float> pixels;
    pixels.reserve(words.size() / 4);
    for (size_t i = 0; i + 4 <= words.size(); i += 4) {
        uint32_t word = 0;
        std::memcpy(&word, &words[i], sizeof word);
        const auto channel = [&](uint32_t c) { return light[word >> (c * display_.bits) & display_.largest_code()]; };
        pixels.push_back(float(reflected + glm::dot(weights_, {channel(0), channel(1), channel(2)})));
    }
    return pixels;
}

}  // namespace vesper::vision
