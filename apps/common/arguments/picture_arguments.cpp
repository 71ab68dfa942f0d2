#include "arguments/picture_arguments.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <sstream>

#include "analysis/relative_picture.h"
#include "base/error.h"
#include "base/one_line.h"
#include "print.h"

namespace vesper::apps {
namespace {

/// Degrees from the bottom to the top of a picture plane at distance 1; 0 where that is no picture.
double degrees_between(double bottom, double top) {
    const double degrees = (std::atan(top) - std::atan(bottom)) * 180 / std::numbers::pi;
    return degrees >= 0.1 && degrees <= 170 ? degrees : 0;
}

/// The view of a Radiance picture: each VIEW of its header changes what those before said. Only perspectives (-vtv)
/// have an angle of their height, -vv degrees, moved up by -vl of it.
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

/// The edges of a picture by Vesper, if its header tells them.
std::optional<vision::ImageAngles> edges_of(const io::HdrImage& image) {
    for (const auto& [key, value] : image.header) {
        vision::ImageAngles angles{int(image.width), int(image.height)};
        if (key == "vesper:tangents" && std::sscanf(value.c_str(), "%lf %lf %lf %lf", &angles.low.x, &angles.low.y,
                                                    &angles.high.x, &angles.high.y) == 4)
            return degrees_between(angles.low.x, angles.high.x) > 0 && degrees_between(angles.low.y, angles.high.y) > 0
                       ? std::optional(angles)
                       : std::nullopt;
    }
    return {};
}

/// Angle in height that a header of Radiance tells, degrees, or 0.
double angle_of(const io::Header& header) {
    std::optional<RadianceView> view;
    for (const auto& [key, value] : header) {
        if (key != "VIEW") continue;
        if (!view) view.emplace();
        view->add(value);
    }
    return view ? view->angle() : 0;
}

/// Width of a pixel over its height (OpenEXR), or the inverse (Radiance): 1 if square.
double pixel_aspect_of(const io::Header& header) {
    double aspect = 1;
    for (const auto& [key, value] : header)
        if (double factor = 0;
            (key == "pixelAspectRatio" || key == "PIXASPECT") && std::sscanf(value.c_str(), "%lf", &factor) == 1)
            aspect *= factor;
    return aspect;
}

/// Unit, source and notes of a picture for which no option gives a scale.
void find_unit(PictureMeaning& meaning, const io::HdrImage& image, const PictureRequest& request) {
    if (image.white_luminance > 0) {
        meaning.unit = image.white_luminance, meaning.scale_source = "header";
    } else if (request.to_white) {
        meaning.scale_source = "none";
    } else if (image.exposure != 1) {
        meaning.scale_source = "header";
        meaning.notes.emplace_back(
            "its header has an EXPOSURE, but no unit: taken as cd/m^2 (--unit 179 if these are Radiance's watts)");
    } else if (request.held > 0) {
        meaning.unit = request.held, meaning.scale_source = "sequence";
    } else if (const analysis::RelativeLuminance found = analysis::relative_luminance(image.rgb);
               found.log_average > 0) {
        meaning.unit = analysis::plausible_scale(found), meaning.scale_source = "auto";
        meaning.scale_note = format(
            "its header names no unit: 1.0 is taken as %.6g cd/m^2, so that its log average is %.3g cd/m^2 "
            "(--unit tells another)",
            meaning.unit, meaning.unit * found.log_average);
    } else {
        meaning.unit = 0, meaning.scale_source = "none";
        meaning.notes.emplace_back("its header names no unit, and it has no light");
    }
}

}  // namespace

void add_scale_options(Command command, ScaleArguments& a, const char* help) {
    constexpr double kLeast = 1e-12, kMost = 1e12, kStops = 40;
    const Check scale(
        [=](const std::string& given) {
            char* end = nullptr;
            const double value = std::strtod(given.c_str(), &end);
            const bool sound = given == "auto" || (*end == 0 && value >= kLeast && value <= kMost);
            return sound ? std::string() : given + format(" is neither auto nor a number from %g to %g", kLeast, kMost);
        },
        "auto|N");
    command.add_option("--unit", a.scale, help).check(scale).shows_default();
    command
        .add_option("--exposure", a.exposure,
                    "Stops by which pictures are brighter than by --unit: luminance times 2^EV")
        .check(between(-kStops, kStops))
        .shows_default();
}

VkExtent2D parse_size(const std::string& text, unsigned least, unsigned most) {
    unsigned width = 0, height = 0;
    char rest = 0;
    const auto fits = [&](unsigned side) { return side >= least && side <= most; };
    if (std::sscanf(text.c_str(), "%5ux%5u%c", &width, &height, &rest) != 2 || !fits(width) || !fits(height))
        throw Error("--size " + one_line(text) +
                    format(": expected WIDTHxHEIGHT, %ux%u to %ux%u", least, least, most, most));
    return {width, height};
}

PictureMeaning meaning_of(const io::HdrImage& image, const PictureRequest& request) {
    PictureMeaning meaning;
    meaning.notes = image.notes;
    if (const std::string& scale = request.scale.scale; scale == "auto") {
        find_unit(meaning, image, request);
    } else {
        const double told = image.white_luminance;
        meaning.unit = std::strtod(scale.c_str(), nullptr), meaning.scale_source = "option";
        if (told > 0 && std::abs(meaning.unit - told) > 1e-6 * told)
            meaning.notes.push_back(
                format("its header says that 1.0 is %.6g cd/m^2: --unit %.6g is taken", told, meaning.unit));
    }
    meaning.scale = (meaning.unit > 0 ? meaning.unit : 1) * std::exp2(request.scale.exposure);
    if (request.fov == 0) meaning.angles = edges_of(image);
    const double angle = request.fov > 0  ? request.fov
                         : meaning.angles ? degrees_between(meaning.angles->low.y, meaning.angles->high.y)
                                          : angle_of(image.header);
    if (angle > 0)
        meaning.fov = angle, meaning.fov_known = true;
    else if (request.angle_matters)
        meaning.notes.push_back(format(
            "its header names no angle of a perspective: taken as %g degrees high (--fov tells another)", meaning.fov));
    if (const double aspect = pixel_aspect_of(image.header); std::abs(aspect - 1) > 1e-3)
        meaning.notes.push_back(format("its pixels are not square (%.4g): shown and measured as if they were", aspect));
    return meaning;
}

}  // namespace vesper::apps
