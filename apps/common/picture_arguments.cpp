#include "picture_arguments.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <sstream>

#include "arguments.h"
#include "base/error.h"
#include "io/atomic_file.h"

namespace vesper {
namespace {

/// Degrees from the bottom to the top of a picture plane at distance 1; 0 where that is no picture.
double degrees_between(double bottom, double top) {
    const double degrees = (std::atan(top) - std::atan(bottom)) * 180 / std::numbers::pi;
    return degrees >= 0.1 && degrees <= 170 ? degrees : 0;
}

/// The view of a Radiance picture: each VIEW of its header changes what those before said. Only perspectives (-vtv) have an angle of their
/// height, -vv degrees, moved up by -vl of it.
class RadianceView {
public:
    void add(const std::string& options) {
        std::istringstream words(options);
        for (std::string word; words >> word;) {
            if (word.starts_with("-vt")) perspective_ = word == "-vtv";
            if (word == "-vv" || word == "-vl") sound_ = sound_ && words >> (word == "-vv" ? degrees_ : lift_);
        }
    }
    double angle() const {
        if (!perspective_ || !sound_ || !(degrees_ > 0 && degrees_ < 180)) return 0;
        const double half = std::tan(degrees_ * std::numbers::pi / 360);
        return degrees_between((2 * lift_ - 1) * half, (2 * lift_ + 1) * half);
    }

private:
    double degrees_ = 45, lift_ = 0;  // Radiance's own
    bool perspective_ = true, sound_ = true;
};

/// Angle in height that a header tells, degrees, or 0.
double angle_of(const Header& header) {
    std::optional<RadianceView> view;
    for (const auto& [key, value] : header) {
        double left = 0, bottom = 0, right = 0, top = 0;
        if (key == "vesper:tangents" && std::sscanf(value.c_str(), "%lf %lf %lf %lf", &left, &bottom, &right, &top) == 4) return degrees_between(bottom, top);
        if (key != "VIEW") continue;
        if (!view) view.emplace();
        view->add(value);
    }
    return view ? view->angle() : 0;
}

/// Width of a pixel over its height (OpenEXR), or the inverse (Radiance): 1 if square.
double pixel_aspect_of(const Header& header) {
    double aspect = 1;
    for (const auto& [key, value] : header)
        if (double factor = 0; (key == "pixelAspectRatio" || key == "PIXASPECT") && std::sscanf(value.c_str(), "%lf", &factor) == 1) aspect *= factor;
    return aspect;
}

}  // namespace

VkExtent2D parse_size(const std::string& text, unsigned least, unsigned most) {
    unsigned width = 0, height = 0;
    char rest = 0;
    const auto fits = [&](unsigned side) { return side >= least && side <= most; };
    if (std::sscanf(text.c_str(), "%5ux%5u%c", &width, &height, &rest) != 2 || !fits(width) || !fits(height))
        throw Error("--size " + one_line(text) + format(": expected WIDTHxHEIGHT, %ux%u to %ux%u", least, least, most, most));
    return {width, height};
}

PictureMeaning meaning_of(const HdrImage& image, double scale, double fov, bool angle_matters) {
    PictureMeaning meaning;
    const double told = image.white_luminance;
    if (scale > 0)
        meaning.scale = scale;
    else if (told > 0)
        meaning.scale = told;
    else
        meaning.notes.emplace_back("its header names no unit: taken as cd/m^2 (--scale tells another)");
    if (scale > 0 && told > 0 && std::abs(scale - told) > 1e-6 * told) meaning.notes.push_back(format("its header says that 1.0 is %.6g cd/m^2: --scale %.6g is taken", told, scale));
    if (const double angle = fov > 0 ? fov : angle_of(image.header); angle > 0)
        meaning.fov = angle;
    else if (angle_matters)
        meaning.notes.push_back(format("its header names no angle of a perspective: taken as %g degrees high (--fov tells another)", meaning.fov));
    if (const double aspect = pixel_aspect_of(image.header); std::abs(aspect - 1) > 1e-3)
        meaning.notes.push_back(format("its pixels are not square (%.4g): shown and measured as if they were", aspect));
    return meaning;
}

}  // namespace vesper
