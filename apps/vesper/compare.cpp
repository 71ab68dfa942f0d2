// `vesper compare`: where an observer tells two pictures apart. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "analysis/picture_metrics.h"
#include "analysis/visible_differences.h"
#include "arguments/arguments.h"
#include "arguments/thread_arguments.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/one_line.h"
#include "commands.h"
#include "compared_picture.h"
#include "gpu/device.h"
#include "io/file_gate.h"
#include "plots/share_map.h"
#include "print.h"
#include "render/retina.h"

namespace vesper::commands {
namespace {

using apps::format;

// --glare, and what the report says of it.
const std::map<std::string, const char*> kOptics{
    {"cie", ""}, {"none", " that scatters no light"}, {"retina", ", as pictures on its retina"}};

struct CompareArguments {
    std::string first, second, picture, json, device, glare = "cie";
    CompareSource source;
    double age = analysis::ContrastEye{}.age, iris = vision::ScatteringEye{}.pigmentation;
    double fail_above = 1;
    unsigned threads = 0;
};

struct Comparison {
    analysis::VisibleDifferences seen;
    std::vector<float> first;  // luminances of the first picture, cd/m^2
    vision::ImageAngles angles;
    double pixels_per_degree = 0, log_rmse = 0, psnr = 0;
    std::optional<double> ssim;
};

Comparison compare(const CompareArguments& a, const ComparedPicture& first, const ComparedPicture& second) {
    const vision::ImageAngles angles = angles_of(first, second);
    gpu::Device device({.select = a.device});
    render::ToneMapper mapper(device);
    const vision::ScatteringEye scatters{a.age, a.iris};
    std::optional<eye::ScatterSettings> eye;
    if (a.glare == "cie") eye = {.eye = scatters};
    analysis::ContrastEye sees{.age = a.age};
    if (a.glare != "none") sees.scatters = scatters;
    const render::HostPicture host1{.extent = first.extent, .values = first.rgb, .angles = &angles},
        host2{.extent = second.extent, .values = second.rgb, .angles = &angles};
    const std::vector<float> retina1 = render::retinal_luminance(mapper, host1, eye),
                             retina2 = render::retinal_luminance(mapper, host2, eye);
    const auto [width, height] = first.extent;
    Comparison made;
    made.angles = angles;
    made.pixels_per_degree = render::pixels_per_degree(host1);
    made.seen = analysis::visible_differences({width, height, made.pixels_per_degree, retina1, retina2}, sees);
    made.first = render::retinal_luminance(mapper, host1, {});
    const std::vector<float> plain = render::retinal_luminance(mapper, host2, {});  // without an eye
    made.log_rmse = analysis::log_rmse(made.first, plain);
    made.psnr = analysis::pu21_psnr(made.first, plain);
    made.ssim = analysis::pu21_ssim(made.first, plain, width, height);
    return made;
}

void report(const CompareArguments& a, const ComparedPicture& first, const ComparedPicture& second,
            const Comparison& c) {
    const auto& seen = c.seen;
    // Degrees right and up of the axis of the eye.
    const glm::dvec2 at = glm::atan(c.angles.at(glm::dvec2(seen.x, seen.y) + 0.5)) * kDegreesPerRadian;
    apps::print("%s: %s\n%s: %s\n", a.first.c_str(), first.source.c_str(), a.second.c_str(), second.source.c_str());
    apps::print("%u x %u px, %.4g px/degree, an eye of %.4g years%s\n", first.extent.width, first.extent.height,
                c.pixels_per_degree, a.age, kOptics.at(a.glare));
    apps::print("largest probability of detection  %.4f\n", seen.largest);
    if (seen.largest > 0)
        apps::print("  at (%u, %u), %.2f degrees %s and %.2f %s of the axis of the eye\n", seen.x, seen.y,
                    std::abs(at.x), at.x < 0 ? "left" : "right", std::abs(at.y), at.y < 0 ? "below" : "above");
    apps::print("pixels above 50, 75 and 95 %%       %.4g, %.4g and %.4g %%\n", 100 * seen.above_half,
                100 * seen.above_75, 100 * seen.above_95);
    apps::print("RMSE of log10 luminance           %.4g\n", c.log_rmse);
    apps::print("PU21-PSNR                         %.4g dB\n", c.psnr);
    if (c.ssim) apps::print("PU21-SSIM                         %.5g\n", *c.ssim);
}

void write_json(const CompareArguments& a, const Comparison& c) {
    const auto& seen = c.seen;
    nlohmann::ordered_json json{{"first", a.first},
                                {"second", a.second},
                                {"pixels_per_degree", c.pixels_per_degree},
                                {"age_years", a.age},
                                {"glare", a.glare},
                                {"largest_probability", seen.largest},
                                {"share_above_0.5", seen.above_half},
                                {"share_above_0.75", seen.above_75},
                                {"share_above_0.95", seen.above_95},
                                {"log10_rmse", c.log_rmse}};
    for (const auto& [name, value] : {std::pair("x", seen.x), std::pair("y", seen.y)})
        json[name] = seen.largest > 0 ? nlohmann::ordered_json(value) : nullptr;  // of equal pictures: none
    json["pu21_psnr_db"] = std::isfinite(c.psnr) ? nlohmann::ordered_json(c.psnr) : nullptr;
    json["pu21_ssim"] = c.ssim ? nlohmann::ordered_json(*c.ssim) : nullptr;
    apps::write_text(a.json, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

void draw(const CompareArguments& a, VkExtent2D extent, const Comparison& c) {
    const auto [width, height] = extent;
    const apps::ValuePicture probability{width, height, c.seen.probability};
    if (a.picture.ends_with(".exr")) return apps::save_values(a.picture, probability, "probability of detection");
    apps::ShareMap map(one_line(a.first, 60) + " and " + one_line(a.second, 60) + ": probability of detection",
                       {width, height, c.first}, probability, "detected");
    if (c.seen.largest > 0) map.canvas().circle(map.at(c.seen.x, c.seen.y), 9, apps::CanvasColour(1), 1.5);
    map.canvas().save(a.picture);
}

void run(const CompareArguments& a) {
    if (!a.picture.empty() && !a.picture.ends_with(".png") && !a.picture.ends_with(".exr"))
        throw Error("-o " + one_line(a.picture) + ": a .png or .exr file is expected");
    const ComparedPicture first = read_compared(a.source, a.first), second = read_compared(a.source, a.second);
    if (first.codes && second.codes && (a.source.scale.scale != "auto" || a.source.scale.exposure != 0))
        throw Error("--unit and --exposure: PNG files have the luminance of their display");
    if (first.codes && second.codes && !a.source.layer.empty()) throw Error("--layer: PNG files have no layers");
    if (!first.codes && !second.codes && apps::is_given(a.source.display))
        throw Error("--display: neither picture is a PNG, whose codes it would show");
    io::announce_write("-o", a.picture);
    io::announce_write("--json", a.json);
    if (first.extent.width != second.extent.width || first.extent.height != second.extent.height)
        throw Error(format("%s has %u x %u px, and %s %u x %u px", a.first.c_str(), first.extent.width,
                           first.extent.height, a.second.c_str(), second.extent.width, second.extent.height));
    const Comparison made = compare(a, first, second);
    report(a, first, second, made);
    if (!a.json.empty()) write_json(a, made);
    if (!a.picture.empty()) draw(a, first.extent, made);
    if (made.seen.largest > a.fail_above) {
        apps::print("above --fail-above %g\n", a.fail_above);
        throw apps::Verdict{};
    }
}

}  // namespace

void add_compare(apps::Command program) {
    apps::Command command =
        program.add_command("compare", "Find where an observer tells two pictures apart (docs/compare.md)");
    const auto a = std::make_shared<CompareArguments>();
    command.add_option("first", a->first, "OpenEXR or Radiance picture in cd/m^2, or a PNG of display codes")
        .required();
    command.add_option("second", a->second, "The same, of the same size").required();
    command.add_option("--output,-o", a->picture,
                       "OUT.png or OUT.exr: probability that a difference is detected, by pixel");
    command.add_option("--json", a->json, "Write all figures to a JSON file");
    command
        .add_option("--fail-above", a->fail_above,
                    "Exit with code 1 if a difference is detected anywhere with a larger probability, such as 0.5")
        .check(apps::between(0.0, 1.0));
    command
        .add_option("--fov", a->source.fov,
                    "Angle that the pictures cover in height, degrees (default: as an HDR picture says)")
        .check(apps::between(0.1, 170.0));
    apps::add_scale_options(command, a->source.scale,
                            "cd/m^2 of 1.0, for HDR pictures whose header names no unit (auto: they are refused)");
    command.add_option("--layer", a->source.layer, apps::kLayerHelp);
    command.add_option("--age", a->age, "Of the observer, years").check(apps::between(1.0, 120.0)).shows_default();
    command
        .add_option("--glare", a->glare,
                    "Light scattered in the eye: cie, none, or retina, for pictures that have it already")
        .check(apps::one_of({"cie", "none", "retina"}))
        .shows_default();
    command.add_option("--iris", a->iris, "Pigmentation of the iris, from 0 very dark to 1.2 light blue")
        .check(apps::between(0.0, 1.5))
        .shows_default();
    apps::add_display_options(command, a->source.display);
    command.add_option("--device", a->device,
                       "Part of a name, cpu, or an index of vesper devices (also VESPER_DEVICE)");
    apps::add_thread_option(command, a->threads);
    command.footer(
        "Examples:\n  vesper compare before.exr after.exr -o seen.png\n"
        "  vesper compare a.png b.png --fov 40 --display projector --fail-above 0.5\n");
    command.callback([a] {
        apps::use_threads(a->threads);
        run(*a);
    });
}

}  // namespace vesper::commands
