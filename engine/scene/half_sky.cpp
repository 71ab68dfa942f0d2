#include "scene/half_sky.h"

#include <algorithm>

#include <glm/gtc/packing.hpp>

namespace vesper::scene {

HalfSky half_floats_of(const photometry::Environment& e) {
    const float brightest = *std::max_element(e.rgb.begin(), e.rgb.end());
    HalfSky made;
    if (brightest > 0) made.scale = double(brightest) / 60000;
    made.bytes.reserve(e.rgb.size() * 2);
    for (const float value : e.rgb) {
        const uint16_t half = glm::packHalf1x16(static_cast<float>(value / made.scale));
        made.bytes.push_back(static_cast<uint8_t>(half & 255)), made.bytes.push_back(static_cast<uint8_t>(half >> 8));
    }
    return made;
}

float half_luminance(const uint8_t* bytes, double scale) {
    const auto half = static_cast<uint16_t>(bytes[0] | bytes[1] << 8);
    return static_cast<float>(scale * double(glm::unpackHalf1x16(half)));
}

photometry::Environment as_half_floats(photometry::Environment e) {
    const HalfSky halves = half_floats_of(e);
    for (size_t i = 0; i < e.rgb.size(); ++i) e.rgb[i] = half_luminance(&halves.bytes[2 * i], halves.scale);
    return e;
}

}  // namespace vesper::scene
