// HDR pictures: statistics, probes, false colours. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <vesper/road_lighting.hpp>
#include "base/error.h"
#include "base/one_line.h"
#include "inspect.h"
#include "io/hdr_image.h"
#include "plots/false_colour.h"
#include "print.h"
#include "scene/colour.h"
#include "statistics.h"

namespace vesper::commands {
namespace {

using apps::format;

struct Probe {
    uint32_t x = 0, y = 0;
    glm::dvec3 rgb{0};
};

std::vector<Probe> probes_of(const InspectArguments& arguments, const io::HdrImage& image) {
    std::vector<Probe> probes;
    for (const std::string& text : arguments.probes) {
        unsigned x = 0, y = 0;
        char rest = 0;
        if (std::sscanf(text.c_str(), "%6u,%6u%c", &x, &y, &rest) != 2)
            throw Error("--probe " + text + ": expected X,Y in pixels");
        if (x >= image.width || y >= image.height)
            throw Error("--probe " + text + ": outside the picture of " +
                        format("%u x %u px", image.width, image.height));
        const float* p = &image.rgb[3 * (size_t{y} * image.width + x)];
        probes.push_back({x, y, {p[0], p[1], p[2]}});
    }
    return probes;
}

apps::ValuePicture luminances_of(const io::HdrImage& image, double factor) {
    apps::ValuePicture made{image.width, image.height, {}};
    made.values.reserve(image.rgb.size() / 3);
    for (size_t i = 0; i < image.rgb.size(); i += 3)
        made.values.push_back(
            static_cast<float>(factor * luminance({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]})));
    return made;
}

void draw(const InspectArguments& arguments, const apps::ValuePicture& full, const std::vector<Probe>& probes,
          const std::string& unit) {
    // Large pictures are averaged down to fit 1280 x 1280 px, small ones repeat their pixels.
    const double longest = std::max(full.width, full.height);
    const double zoom = longest > 1280 ? 1280 / longest : std::max(1.0, std::floor(640 / longest));
    const auto width = std::max(1u, static_cast<uint32_t>(full.width * zoom)),
               height = std::max(1u, static_cast<uint32_t>(full.height * zoom));
    apps::ColourScale scale = apps::scale_of(full.values);
    if (arguments.low > 0) scale.low = arguments.low;
    if (arguments.high > 0) scale.high = arguments.high;
    if (!(scale.high > scale.low)) throw Error(format("--low %g must be less than --high %g", scale.low, scale.high));
    const apps::ValuePicture shown = apps::resized(full, width, height);
    const glm::dvec2 corner(16, 40);
    const double bar = std::max<double>(height - 24.0, 200);
    apps::Canvas canvas(width + 32 + static_cast<uint32_t>(apps::kBarWidth) + 10, static_cast<uint32_t>(bar) + 24 + 60);
    canvas.text({16, 20}, arguments.file, 14);
    canvas.pixels(16, 40, width, height, apps::false_colours(shown, scale));
    if (arguments.contours) {
        std::vector<double> levels;
        for (const roads::LightingClass& c : roads::lighting_classes()) levels.push_back(c.average_luminance);
        apps::draw_contours(canvas, shown, levels, corner);
    }
    for (const Probe& p : probes) {
        const glm::dvec2 at = corner + (glm::dvec2(p.x, p.y) + 0.5) * zoom;
        canvas.circle(at, 6, apps::CanvasColour(0), 3.5);
        canvas.circle(at, 6, apps::CanvasColour(1), 1.5);
        const bool left = p.x > 0.8 * full.width;
        canvas.text(at + glm::dvec2(left ? -11 : 11, 0), format("%.4g", full.values[size_t{p.y} * full.width + p.x]),
                    13, left ? apps::Canvas::Align::Right : apps::Canvas::Align::Left, apps::CanvasColour(1), true);
    }
    apps::draw_colour_bar(canvas, {corner.x + width + 20, corner.y + 24}, bar, scale, unit);
    canvas.save(arguments.picture);
}

}  // namespace

Inspection inspect_picture(const InspectArguments& arguments) {
    const io::HdrImage image = io::read_hdr_image(arguments.file, {}, arguments.layer);
    const bool absolute = image.white_luminance > 0;
    const double factor = absolute ? image.white_luminance : 1;
    const std::string unit = absolute ? "cd/m\u00b2" : "relative";
    const std::vector<Probe> probes = probes_of(arguments, image);
    std::vector<float> scaled;
    if (factor != 1) {
        scaled = image.rgb;
        for (float& value : scaled) value *= static_cast<float>(factor);
    }
    const apps::LuminanceStatistics statistics = apps::luminance_statistics(factor == 1 ? image.rgb : scaled, 3);
    Inspection made;
    made.text = arguments.file + format("\n  %u x %u px\n", image.width, image.height);
    for (const auto& [key, value] : image.header)
        made.text += "  " + one_line(key, 60) + ": " + one_line(value, 120) + "\n";  // whole in JSON
    made.text +=
        apps::text_of(statistics, absolute ? "luminance, cd/m^2" : "luminance, relative (the header names no unit)");
    made.json = {{"kind", "picture"},
                 {"width", image.width},
                 {"height", image.height},
                 {"white_luminance_cd_m2", image.white_luminance}};
    made.json["absolute"] = absolute;
    made.json["luminance"] = nlohmann::ordered_json::parse(apps::json_of(statistics));
    for (const auto& [key, value] : image.header) made.json["header"].push_back({key, value});
    made.json["notes"] = image.notes;
    if (!probes.empty())
        made.text += "probes\n       x      y   luminance           R          G          B       x      y\n";
    for (const Probe& p : probes) {
        const glm::dvec3 rgb = factor * p.rgb;
        const glm::dvec2 xy = scene::chromaticity(rgb);
        made.text += format("  %6u %6u  %10.5g  %10.5g %10.5g %10.5g  %.4f %.4f\n", p.x, p.y, luminance(rgb), rgb.r,
                            rgb.g, rgb.b, xy.x, xy.y);
        made.json["probes"].push_back({{"x", p.x},
                                       {"y", p.y},
                                       {"luminance", luminance(rgb)},
                                       {"rgb", {rgb.r, rgb.g, rgb.b}},
                                       {"chromaticity", {xy.x, xy.y}}});
    }
    made.text += notes_text(image.notes);
    if (!arguments.picture.empty()) draw(arguments, luminances_of(image, factor), probes, unit);
    return made;
}

}  // namespace vesper::commands
