// Light of what a camera of a scene sees, by its origin: a picture of each. SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "arguments/picture_arguments.h"
#include "base/error.h"
#include "base/luminance.h"
#include "base/one_line.h"
#include "gpu/device.h"
#include "gpu_scene/cameras.h"
#include "inspect.h"
#include "io/file_gate.h"
#include "io/hdr_image.h"
#include "plots/false_colour.h"
#include "print.h"
#include "progress.h"
#include "scene/read_scene.h"
#include "traced_light.h"

namespace vesper::commands {
namespace {

using apps::format;

// Of each origin, in files.
constexpr std::array<const char*, transport::kOrigins> kLayers{"lamps", "emitters", "sky", "once", "more"};
constexpr unsigned kPathsOfPicture = 32, kSteps = 200;

std::string file_of_layer(const std::string& prefix, const char* layer) { return prefix + "-" + layer + ".png"; }

float lux_of(glm::vec3 rgb) { return float(luminance(glm::dvec3(rgb))); }

// Means over surfaces, and how exact.
void report(const TracedPicture& picture, Inspection& made) {
    std::array<double, transport::kOrigins> means{};
    std::vector<float> errors;  // relative
    double pixels = 0, sum = 0;
    for (size_t i = 0; i < picture.light.size(); ++i) {
        if (picture.points[i].normal == glm::dvec3(0)) continue;
        for (size_t k = 0; k < means.size(); ++k) means[k] += double(lux_of(picture.light[i].lux[k]));
        if (const float other = lux_of(picture.light[i].other()); other > 0)
            errors.push_back(picture.light[i].standard_error / other);
        ++pixels;
    }
    for (double& mean : means) sum += mean /= std::max(pixels, 1.0);
    made.text += "  illuminance, mean                    lx   share\n";
    for (size_t k = 0; k < means.size(); ++k) {
        made.text +=
            format("  %-28s %10.4g   %5.1f %%\n", kOriginTexts[k], means[k], sum > 0 ? 100 * means[k] / sum : 0);
        made.json["mean_illuminance_lx"][kLayers[k]] = means[k];
    }
    made.text += format("  %-28s %10.4g\n", "sum", sum);
    made.json["mean_illuminance_lx"]["sum"] = sum;
    made.json["pixels_with_surface"] = uint64_t(pixels);
    if (errors.empty()) return;
    const auto middle = errors.begin() + ptrdiff_t(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    made.text += format("\n  standard error of a pixel, of all but lamps directly: %.2g %% in the median\n",
                        100 * double(*middle));
    made.json["median_relative_standard_error"] = *middle;
}

// One scale for all, so that pictures can be compared.
void draw(const InspectArguments& a, VkExtent2D extent, const TracedPicture& picture, const std::string& title) {
    std::array<std::vector<float>, transport::kOrigins> values;
    std::vector<float> all;
    for (size_t k = 0; k < values.size(); ++k) {
        for (const transport::PointLight& light : picture.light) values[k].push_back(lux_of(light.lux[k]));
        all.insert(all.end(), values[k].begin(), values[k].end());
    }
    apps::ColourScale scale = apps::scale_of(all);
    if (a.low > 0) scale.low = a.low;
    if (a.high > 0) scale.high = a.high;
    if (!(scale.high > scale.low)) throw Error(format("--low %g must be less than --high %g", scale.low, scale.high));
    const double longest = std::max(extent.width, extent.height);
    const double zoom = longest > 1280 ? 1280 / longest : std::max(1.0, std::floor(640 / longest));
    const auto width = std::max(1u, uint32_t(extent.width * zoom)),
               height = std::max(1u, uint32_t(extent.height * zoom));
    const double bar = std::max(height - 24.0, 200.0);
    for (size_t k = 0; k < values.size(); ++k) {
        const apps::ValuePicture shown =
            apps::resized({extent.width, extent.height, std::move(values[k])}, width, height);
        apps::Canvas canvas(width + 32 + uint32_t(apps::kBarWidth) + 10, uint32_t(bar) + 84);
        canvas.text({16, 20}, std::string(kOriginTexts[k]) + title, 14);
        canvas.pixels(16, 40, width, height, apps::false_colours(shown, scale));
        apps::draw_colour_bar(canvas, {width + 36.0, 64}, bar, scale, "lx");
        canvas.save(file_of_layer(a.light, kLayers[k]));
    }
}

void write_layers(const InspectArguments& a, VkExtent2D extent, const TracedPicture& picture,
                  const io::Header& header) {
    std::array<std::vector<float>, transport::kOrigins + 1> rgb;  // the last: the sum
    for (const transport::PointLight& light : picture.light) {
        const glm::vec3 sum = light[transport::Origin::Lamps] + light.other();
        for (size_t k = 0; k < rgb.size(); ++k)
            for (int c = 0; c < 3; ++c) rgb[k].push_back(k < light.lux.size() ? light.lux[k][c] : sum[c]);
    }
    std::vector<io::ExrLayerPixels> layers{{"", rgb.back()}};
    for (size_t k = 0; k < kLayers.size(); ++k) layers.push_back({kLayers[k], rgb[k]});
    io::write_exr_layers(a.light + ".exr", extent.width, extent.height, layers, header);
}

}  // namespace

void announce_light_picture(const InspectArguments& a) {
    io::announce_write("--light", a.light + ".exr");
    for (const char* layer : kLayers) io::announce_write("--light", file_of_layer(a.light, layer));
}

Inspection inspect_light_picture(const InspectArguments& a) {
    const VkExtent2D extent = apps::parse_size(a.size.empty() ? "640x400" : a.size);
    const transport::TraceSettings settings{.paths = a.paths > 0 ? a.paths : kPathsOfPicture, .lamp_rays = kLampRays};
    const scene::Scene scene = scene::read_scene(a.file).scene;
    const gpu_scene::SceneFrame poses{scene::world_transforms(scene, 0), {}, {}, {}, {}};
    const gpu_scene::View view = gpu_scene::camera_view(scene, poses, a.camera, extent);
    const std::vector<std::string> cameras = gpu_scene::camera_names(scene);
    const std::string camera = !a.camera.empty() ? a.camera : cameras.empty() ? "" : cameras.front();
    gpu::Device device({.select = a.device});
    const gpu_scene::GpuScene resident(device, scene);
    apps::Progress progress("tracing light", kSteps);
    unsigned steps = 0;
    const TracedPicture picture = traced_light(device, scene, resident, poses, view, settings, [&](double share) {
        for (; steps < unsigned(share * kSteps); ++steps) progress.step();
    });
    const std::string seen = (camera.empty() ? "the whole scene" : "camera '" + one_line(camera) + "'") +
                             format(", %u x %u px, %u paths a pixel", extent.width, extent.height, settings.paths);
    Inspection made;
    made.text = one_line(a.file) + ": light on surfaces, " + seen + "\n\n";
    made.json = {{"kind", "light picture"},
                 {"camera", camera},
                 {"width", extent.width},
                 {"height", extent.height},
                 {"paths", settings.paths}};
    report(picture, made);
    write_layers(a, extent, picture,
                 {{"vesper:version", VESPER_VERSION},
                  {"vesper:scene", a.file},
                  {"vesper:camera", camera},
                  {"vesper:unit", "lx, linear Rec. 709 RGB, on the surface that each pixel sees"},
                  {"vesper:paths", std::to_string(settings.paths)}});
    draw(a, extent, picture, ": " + seen);
    return made;
}

}  // namespace vesper::commands
