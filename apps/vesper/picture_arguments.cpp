#include "picture_arguments.h"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "arguments.h"
#include "base/error.h"
#include "io/atomic_file.h"

namespace vesper {

VkExtent2D parse_size(const std::string& text, unsigned least, unsigned most) {
    unsigned width = 0, height = 0;
    char rest = 0;
    const auto fits = [&](unsigned side) { return side >= least && side <= most; };
    if (std::sscanf(text.c_str(), "%5ux%5u%c", &width, &height, &rest) != 2 || !fits(width) || !fits(height))
        throw Error("--size " + one_line(text) + format(": expected WIDTHxHEIGHT, %ux%u to %ux%u", least, least, most, most));
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

void note_unknown_unit(const std::string& file) {
    std::fprintf(stderr, "note: %s: its header names no unit: taken as cd/m^2 (--scale tells another)\n", one_line(file).c_str());
}

}  // namespace vesper
