#include "picture_arguments.h"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "base/error.h"

namespace vesper {

VkExtent2D parse_size(const std::string& text) {
    unsigned width = 0, height = 0;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%5ux%5u%c", &width, &height, &rest) != 2 || width < 1 || height < 1 || width > 16384 || height > 16384)
        throw Error("--size " + text + ": expected WIDTHxHEIGHT, 1x1 to 16384x16384");
    return {width, height};
}

double fov_of(const HdrImage& image, double given) {
    if (given > 0) return given;
    for (const auto& [key, value] : image.header) {
        double left = 0, bottom = 0, right = 0, top = 0;
        if (key == "vesper:tangents" && std::sscanf(value.c_str(), "%lf %lf %lf %lf", &left, &bottom, &right, &top) == 4) {
            const double degrees = (std::atan(top) - std::atan(bottom)) * 180 / std::numbers::pi;
            if (degrees >= 0.1 && degrees <= 170) return degrees;
        }
    }
    return 40;
}

double scale_of_picture(const HdrImage& image, double given) {
    return given > 0 ? given : image.white_luminance > 0 ? image.white_luminance : 1;
}

}  // namespace vesper
