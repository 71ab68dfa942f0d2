#include "compared_picture.h"

#include <cmath>

#include "base/angle.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/luminance.h"
#include "base/one_line.h"
#include "io/file_gate.h"
#include "io/hdr_image.h"
#include "io/read_file.h"
#include "print.h"
#include "vision/display_light.h"
#include "vision/visual_channels.h"

namespace vesper::commands {
namespace {

constexpr uint64_t kMostBytes = uint64_t{1} << 30, kSignatureBytes = 16;  // of a PNG
io::HdrLimits limits() { return {.max_pixels = scaled_limit(vision::kMostChannelPixels)}; }

ComparedPicture codes(const CompareSource& source, const std::string& file) {
    const vision::Display display = apps::display_of(source.display);
    const io::WideImage image =
        io::decode_wide_png(io::read_file(file, kMostBytes), limits().max_side, limits().max_pixels);
    return {{image.width, image.height},
            vision::DisplayLight(display).of_wide(image.rgba),
            source.fov,
            apps::format("codes of a display from %.4g to %.4g cd/m^2", double(display.low()), double(display.high()))};
}

ComparedPicture luminances(const CompareSource& source, const std::string& file) {
    io::HdrImage image = io::read_hdr_image(file, limits(), source.layer);
    const apps::PictureMeaning meaning = apps::meaning_of(image, {.scale = source.scale, .fov = source.fov});
    if (meaning.scale_source != "option" && !(image.white_luminance > 0))
        throw Error(one_line(file) + ": its header names no unit: --scale N says how many cd/m^2 its 1.0 is");
    for (const std::string& note : meaning.notes) apps::print_note(one_line(file) + ": " + note);
    for (float& value : image.rgb) value *= float(meaning.scale);
    return {{image.width, image.height},
            std::move(image.rgb),
            meaning.fov_known ? meaning.fov : 0,
            apps::format("1.0 is %.6g cd/m^2 (%s)", meaning.scale, meaning.scale_source.c_str())};
}

}  // namespace

ComparedPicture read_compared(const CompareSource& source, const std::string& file) {
    io::announce_read(file);
    const bool png = io::media_type(io::read_start(file, kSignatureBytes)) == "image/png";
    ComparedPicture picture;
    try {
        picture = png ? codes(source, file) : luminances(source, file);
    } catch (const Error& error) {
        const std::string message = error.what();  // of a decoder, without the file's name
        throw Error(message.find(one_line(file)) == std::string::npos ? one_line(file) + ": " + message : message);
    }
    uint64_t damaged = 0, bright = 0;  // pixels
    for (size_t i = 0; i < picture.rgb.size(); i += 3) {
        const double l = luminance({picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]});
        damaged += !std::isfinite(l), bright += std::isfinite(l) && l > vision::JndScale::kMost;
    }
    if (damaged > 0)
        apps::print_note(one_line(file) + ": " + std::to_string(damaged) + " pixels are not finite: compared as black");
    if (bright > 0)
        apps::print_note(one_line(file) + ": " + std::to_string(bright) +
                         apps::format(" pixels have more than %g cd/m^2, of which no eye sees differences",
                                      vision::JndScale::kMost));
    return picture;
}

double angle_of(const ComparedPicture& a, const ComparedPicture& b) {
    if (a.fov > 0 && b.fov > 0 && std::abs(a.fov - b.fov) > 1e-3 * a.fov)
        throw Error(apps::format("the pictures cover %.4g and %.4g degrees in height", a.fov, b.fov));
    const double fov = a.fov > 0 ? a.fov : b.fov;
    if (!(fov > 0))
        throw Error("neither picture says which angle it covers: --fov DEGREES in height, as the observer sees it");
    return fov * kRadiansPerDegree;
}

}  // namespace vesper::commands
