// `vesper merge`: photographs to luminance. SPDX-License-Identifier: MIT
#include "photometry/merge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "arguments/command_line.h"

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "commands.h"
#include "io/file_gate.h"
#include "io/in_file.h"
#include "io/read_file.h"
#include "print.h"
#include "progress.h"

namespace vesper::commands {
namespace {

using apps::format;

struct MergeArguments {
    std::vector<std::string> images;
    std::string exposures, curve = "recover", response, luminance, output;
    double scale = 0, smoothness = 100;
    bool align = false;
};

/// Positive numbers between commas; each may be a fraction such as 1/60.
std::vector<double> numbers(const std::string& option, const std::string& text, bool zero_allowed) {
    std::vector<double> values;
    const char* at = text.c_str();
    for (;;) {
        char* end = nullptr;
        double value = std::strtod(at, &end);
        if (end != at && *end == '/') {
            at = end + 1;
            value /= std::strtod(at, &end);
        }
        if (end == at || (*end != 0 && *end != ',') || !std::isfinite(value) || value < 0 ||
            (value == 0 && !zero_allowed))
            throw Error(option + " " + one_line(text, 100) + ": expected " + (zero_allowed ? "" : "positive ") +
                        "numbers with commas between them");
        values.push_back(value);
        if (*end == 0) return values;
        at = end + 1;
    }
}

/// All pictures in a message.
std::string pictures_of(const MergeArguments& arguments) {
    return one_line(arguments.images.front()) + " to " + one_line(arguments.images.back());
}

/// Errors of what is done with all pictures name them.
template <class Call>
auto of_pictures(const MergeArguments& arguments, const Call& call) {
    return io::in_file(pictures_of(arguments), call);
}

struct KnownLuminance {
    photometry::Region region;
    double cd_m2 = 0;
};

KnownLuminance parse_luminance(const std::string& text) {
    const std::vector<double> v = numbers("--luminance", text, true);
    const bool whole =
        v.size() >= 3 && std::all_of(v.begin(), v.end() - 1, [](double x) { return x == std::floor(x) && x < 1e6; });
    if ((v.size() != 3 && v.size() != 5) || !whole || !(v.back() > 0))
        throw Error("--luminance " + one_line(text, 100) + ": expected X,Y,CD_M2 or X,Y,WIDTH,HEIGHT,CD_M2");
    KnownLuminance known{{int64_t(v[0]), int64_t(v[1])}, v.back()};
    if (v.size() == 5) {
        known.region.width = int64_t(v[2]);
        known.region.height = int64_t(v[3]);
    }
    return known;
}

std::vector<photometry::Exposure> read_exposures(const MergeArguments& arguments) {
    std::vector<double> given;
    if (!arguments.exposures.empty()) {
        given = numbers("--exposures", arguments.exposures, false);
        if (given.size() != arguments.images.size())
            throw Error("--exposures: " + std::to_string(given.size()) + " for " +
                        std::to_string(arguments.images.size()) + " pictures");
    }
    std::vector<photometry::Exposure> exposures;
    std::vector<std::pair<std::string, io::CameraExposure>> cameras;
    apps::Progress progress("reading", unsigned(arguments.images.size()));
    for (const std::string& file : arguments.images) {
        const std::vector<uint8_t> bytes = io::read_file(file, 1u << 30);
        photometry::Exposure exposure;
        try {
            exposure.image = io::decode_image(bytes, 32768, uint64_t{1} << 28);
        } catch (const Error& error) {
            throw Error(one_line(file) + ": " + error.what());
        }
        const Image& first = exposures.empty() ? exposure.image : exposures.front().image;
        if (exposure.image.width != first.width || exposure.image.height != first.height)
            throw Error(one_line(file) + ": is not of the size of " + one_line(arguments.images.front()) + ", " +
                        std::to_string(first.width) + " x " + std::to_string(first.height) + " px");
        cameras.emplace_back(one_line(file), io::read_exif(bytes));
        exposures.push_back(std::move(exposure));
        progress.step();
    }
    if (given.empty()) {
        try {
            given = photometry::relative_exposures(cameras);
        } catch (const Error& error) {
            throw Error(std::string(error.what()) + "; give --exposures");
        }
    }
    for (size_t i = 0; i < exposures.size(); ++i) exposures[i].exposure = given[i];
    return exposures;
}

void report_exposures(const MergeArguments& arguments, const std::vector<photometry::Exposure>& exposures) {
    std::vector<double> sorted;
    bool moved = false;
    apps::print("exposure (relative)   shift, px   picture\n");
    for (size_t i = 0; i < exposures.size(); ++i) {
        const glm::ivec2 shift = exposures[i].shift;
        apps::print("%19.6g %5d %5d   %s\n", exposures[i].exposure, shift.x, shift.y,
                    one_line(arguments.images[i]).c_str());
        sorted.push_back(exposures[i].exposure);
        moved |= shift != glm::ivec2(0);
    }
    std::sort(sorted.begin(), sorted.end());
    for (size_t i = 1; i < sorted.size(); ++i)
        if (sorted[i] > 4.5 * sorted[i - 1]) {
            apps::print_warning(
                format("exposures %.3g and %.3g are more than two stops apart: between them the response is "
                       "uncertain",
                       sorted[i - 1], sorted[i]));
            break;
        }
    if (moved && !arguments.align) apps::print_warning("the pictures seem shifted; --align undoes it");
}

photometry::Response response_of(const MergeArguments& arguments, const std::vector<photometry::Exposure>& exposures) {
    photometry::Response response;
    if (arguments.curve == "recover") {
        const photometry::RecoveredResponse recovered =
            of_pictures(arguments, [&] { return photometry::recover_response(exposures, arguments.smoothness); });
        for (size_t c = 0; c < 3; ++c)
            apps::print("response of %c: rms error %.1f %% of exposure, from %zu pixels\n", "RGB"[c],
                        100 * recovered.error[c], recovered.pixels[c]);
        for (size_t c = 0; c < 3; ++c)
            if (recovered.error[c] > 0.15)
                apps::print_warning(
                    format("the pictures do not agree on one response of %c: movement, changing light or "
                           "wrong exposures?",
                           "RGB"[c]));
        response = recovered.response;
    } else if (arguments.curve == "srgb") {
        response = photometry::srgb_response();
    } else if (arguments.curve == "linear" || arguments.curve == "gamma2.2") {
        response = photometry::gamma_response(arguments.curve == "linear" ? 1 : 2.2);
    } else {
        response = photometry::read_response(arguments.curve);
    }
    const std::array<int, 3> falls = photometry::count_falls(response);
    for (size_t c = 0; c < 3; ++c)
        if (falls[c] > 0)
            apps::print_warning(
                format("the response of %c falls at %d codes; more pictures or a larger --smoothness may help",
                       "RGB"[c], falls[c]));
    return response;
}

void report(const photometry::MergedImage& merged) {
    const double pixels = double(merged.held.size());
    const bool absolute = merged.image.white_luminance > 0;
    apps::print("luminance %.4g to %.4g %s: %.1f decades\n", merged.darkest, merged.brightest,
                absolute ? "cd/m^2" : "(relative)",
                merged.darkest > 0 ? std::log10(merged.brightest / merged.darkest) : 0.0);
    const uint64_t lost = merged.too_dark + merged.too_bright + merged.between;
    apps::print("never well exposed: %.2f %% of the pixels (%.2f %% too dark, %.2f %% too bright)\n",
                100 * double(lost) / pixels, 100 * double(merged.too_dark) / pixels,
                100 * double(merged.too_bright) / pixels);
    if (double(lost) > 0.05 * pixels) apps::print_warning("the exposures do not cover the scene");
}

void run(const MergeArguments& arguments) {
    if (arguments.images.size() < 2 || arguments.images.size() > photometry::kMaxExposures)
        throw Error(std::to_string(arguments.images.size()) + " picture(s): 2 to " +
                    std::to_string(photometry::kMaxExposures) + " can be merged");
    if (!arguments.luminance.empty() && arguments.scale > 0) throw Error("--luminance and --unit exclude one another");
    if (std::filesystem::path(arguments.output).extension() != ".exr")
        throw Error("-o " + one_line(arguments.output) + ": a .exr file is expected");
    for (const std::string& image : arguments.images) io::announce_read(image);
    io::announce_write("-o", arguments.output);
    io::announce_write("--response", arguments.response);
    const KnownLuminance known = arguments.luminance.empty() ? KnownLuminance{} : parse_luminance(arguments.luminance);

    const Budget budget("merging " + pictures_of(arguments));
    std::vector<photometry::Exposure> exposures = read_exposures(arguments);
    photometry::estimate_shifts(exposures);
    report_exposures(arguments, exposures);
    if (!arguments.align)
        for (photometry::Exposure& exposure : exposures) exposure.shift = glm::ivec2(0);
    const photometry::Response response = response_of(arguments, exposures);
    photometry::MergedImage merged =
        of_pictures(arguments, [&] { return photometry::merge_exposures(exposures, response); });
    if (known.cd_m2 > 0) {
        try {
            apps::print("scale %.6g\n", photometry::scale_to_luminance(merged, known.region, known.cd_m2));
        } catch (const Error& error) {
            throw Error("--luminance " + arguments.luminance + ": " + pictures_of(arguments) + ": " + error.what());
        }
    } else if (arguments.scale > 0) {
        photometry::scale(merged, arguments.scale);
    }
    report(merged);
    const bool absolute = merged.image.white_luminance > 0;
    merged.image.header = {
        {"vesper:version", VESPER_VERSION},
        {"vesper:unit", absolute ? "cd/m^2, linear Rec. 709 RGB" : "relative luminance, linear Rec. 709 RGB"},
        {"vesper:merged", std::to_string(exposures.size()) + " exposures, response " + arguments.curve}};
    if (!arguments.response.empty()) photometry::write_response(arguments.response, response);
    io::write_exr(arguments.output, merged.image);
    apps::print("wrote %s\n", arguments.output.c_str());
}

}  // namespace

void add_merge(apps::Command program) {
    apps::Command command =
        program.add_command("merge", "Merge photographs of different exposure into luminance (docs/merge.md)");
    const auto a = std::make_shared<MergeArguments>();
    command.add_option("images", a->images, "2 to 32 PNG or JPEG of equal size, from one tripod").required();
    command.add_option("--output,-o", a->output, "OUT.exr: cd/m^2 if scaled, relative otherwise").required();
    command.add_option("--exposures,-e", a->exposures,
                       "Exposure of each picture, such as 1/60,1/15 (default: Exif time * ISO / f-number^2)");
    command.add_flag("--align", a->align, "Undo the shifts between the pictures, whole pixels");
    command
        .add_option("--curve", a->curve,
                    "Response of the camera: recover, srgb, gamma2.2, linear or a file that --response wrote")
        .shows_default();
    command.add_option("--smoothness", a->smoothness, "Smoothness of a recovered response")
        .check(apps::range(0.1, 10000.0))
        .shows_default();
    command.add_option("--response", a->response, "Write the response to a CSV file");
    command.add_option("--luminance", a->luminance,
                       "A measured luminance: X,Y,CD_M2 or X,Y,WIDTH,HEIGHT,CD_M2 (px, from the top left)");
    command.add_option("--unit", a->scale, "cd/m^2 per unit, from an earlier --luminance")
        .check(apps::range(1e-12, 1e12));
    command.footer(
        "Example:\n  vesper merge street-1.jpg street-2.jpg street-3.jpg --align --luminance 812,440,9,9,3.2 -o "
        "street.exr\n");
    command.callback([a] { run(*a); });
}

}  // namespace vesper::commands
