#include "compared_picture.h"

#include <cmath>

#include "analysis/display_light.h"
#include "analysis/visual_channels.h"
#include "arguments/tone_arguments.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/luminance.h"
#include "base/one_line.h"
#include "gpu_scene/view.h"
#include "io/file_gate.h"
#include "io/hdr_image.h"
#include "io/read_file.h"
#include "print.h"
#include "statistics.h"

namespace vesper::commands {
namespace {

constexpr uint64_t kMostBytes = uint64_t{1} << 30, kSignatureBytes = 16;  // of a PNG
io::HdrLimits limits() { return {.max_pixels = scaled_limit(analysis::kMostChannelPixels)}; }

// About the eye's axis; none without an angle, degrees in height.
std::optional<vision::ImageAngles> symmetric(VkExtent2D extent, double fov) {
    if (!(fov > 0)) return {};
    return gpu_scene::angles_of(gpu_scene::View::symmetric(extent, float(fov * kRadiansPerDegree), glm::mat4(1)));
}

ComparedPicture codes(const CompareSource& source, const std::string& file) {
    const vision::Display display = apps::display_of(source.display);
    const auto bytes = io::read_file(file, kMostBytes);
    const io::WideImage image = io::decode_wide_png(bytes, limits().max_side, limits().max_pixels);
    uint64_t clear = 0;  // pixels
    for (size_t i = 3; i < image.rgba.size(); i += 4) clear += image.rgba[i] < UINT16_MAX;
    if (clear > 0)
        apps::print_note(one_line(file) + ": " + std::to_string(clear) +
                         " pixels are not opaque: compared as if they were");
    if (const auto stated = io::stated_colour(bytes); stated && *stated != apps::png_colour_of(display))
        apps::print_note(one_line(file) +
                         ": its header says that its codes are not those of such a display (--display)");
    return {{image.width, image.height},
            analysis::DisplayLight(display).of_wide(image.rgba),
            symmetric({image.width, image.height}, source.fov),
            true,
            apps::format("codes of a display from %.4g to %.4g cd/m^2", double(display.low()), double(display.high()))};
}

ComparedPicture luminances(const CompareSource& source, const std::string& file) {
    io::HdrImage image = io::read_hdr_image(file, limits(), source.layer);
    apps::ScaleArguments scale = source.scale;
    if (image.white_luminance > 0 && scale.scale != "auto") {
        apps::print_note(one_line(file) + ": its header names a unit, so --unit does not hold for it");
        scale.scale = "auto";
    }
    const apps::PictureMeaning meaning = apps::meaning_of(image, {.scale = scale, .fov = source.fov});
    if (meaning.scale_source != "option" && !(image.white_luminance > 0))
        throw Error(one_line(file) + ": its header names no unit: --unit N says how many cd/m^2 its 1.0 is");
    for (const std::string& note : meaning.notes) apps::print_note(one_line(file) + ": " + note);
    for (float& value : image.rgb) value *= float(meaning.scale);
    const VkExtent2D extent{image.width, image.height};
    return {extent, std::move(image.rgb),
            meaning.angles ? meaning.angles : symmetric(extent, meaning.fov_known ? meaning.fov : 0), false,
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
        damaged += apps::is_damaged(l), bright += std::isfinite(l) && l > analysis::JndScale::kMost;
    }
    if (damaged > 0) apps::print_note(apps::damaged_text(file, damaged, "compared as black"));
    if (bright > 0)
        apps::print_note(one_line(file) + ": " + std::to_string(bright) +
                         apps::format(" pixels have more than %g cd/m^2, of which no eye sees differences",
                                      analysis::JndScale::kMost));
    return picture;
}

vision::ImageAngles angles_of(const ComparedPicture& a, const ComparedPicture& b) {
    if (!a.angles && !b.angles)
        throw Error("neither picture says which angle it covers: --fov DEGREES in height, as the observer sees it");
    if (!a.angles || !b.angles) return a.angles ? *a.angles : *b.angles;
    const auto differ = [&](glm::dvec2 edges, glm::dvec2 others) {
        const glm::dvec2 apart = glm::abs(edges - others) - 1e-3 * (a.angles->high - a.angles->low);
        return apart.x > 0 || apart.y > 0;
    };
    if (differ(a.angles->low, b.angles->low) || differ(a.angles->high, b.angles->high)) {
        const auto words = [](const vision::ImageAngles& angles) {
            const glm::dvec2 low = glm::atan(angles.low) / kRadiansPerDegree,
                             high = glm::atan(angles.high) / kRadiansPerDegree;
            return apps::format("%.4g to %.4g degrees across and %.4g to %.4g up", low.x, high.x, low.y, high.y);
        };
        throw Error("the pictures cover " + words(*a.angles) + ", and " + words(*b.angles));
    }
    return *a.angles;
}

}  // namespace vesper::commands
