// Findings of saliency as a picture and as JSON. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "plots/false_colour.h"
#include "print.h"
#include "saliency.h"

namespace vesper::commands {
namespace {

const apps::ColourScale kShares{0.1, 1};  ///< of the saliency of the first place

/// The map at a point of the picture, px: linear between the middles of texels.
double map_at(const analysis::SaliencyMap& map, glm::dvec2 pixels) {
    const glm::dvec2 last(map.extent.width - 1, map.extent.height - 1);
    const glm::dvec2 at = glm::clamp(pixels / map.texel - 0.5, glm::dvec2(0), last), first = glm::floor(at);
    const glm::dvec2 next = glm::min(first + 1.0, last), part = at - first;
    const auto value = [&](double x, double y) { return double(map.values[size_t(y) * map.extent.width + size_t(x)]); };
    return glm::mix(glm::mix(value(first.x, first.y), value(next.x, first.y), part.x),
                    glm::mix(value(first.x, next.y), value(next.x, next.y), part.x), part.y);
}

/// Luminance in dim greys under the map in false colours.
std::vector<uint8_t> heat(const SaliencyFindings& found, uint32_t width, uint32_t height) {
    const StudyPicture& picture = *found.picture;
    apps::ValuePicture full{picture.extent.width, picture.extent.height, {}};
    for (size_t i = 0; i < size_t{full.width} * full.height; ++i) full.values.push_back(float(picture.luminance(i)));
    const double most = *std::ranges::max_element(found.scene.values);
    return apps::tinted(apps::resized(full, width, height), [&](size_t i) -> apps::Tint {
        const glm::dvec2 at = glm::dvec2(double(i % width), double(i / width)) + 0.5,
                         pixels = at * glm::dvec2(full.width, full.height) / glm::dvec2(width, height);
        const double place = kShares.position(most > 0 ? map_at(found.scene, pixels) / most : 0);
        return {apps::map_colour(place), 0.75 * place};
    });
}

}  // namespace

void save_saliency(const std::string& file, const SaliencyFindings& found) {
    const VkExtent2D extent = found.picture->extent;
    const double longest = std::max(extent.width, extent.height);
    const double zoom = longest > 1280 ? 1280 / longest : std::max(1.0, std::floor(640 / longest));
    const auto width = std::max(1u, uint32_t(extent.width * zoom)),
               height = std::max(1u, uint32_t(extent.height * zoom));
    const glm::dvec2 corner(16, 64);
    const double bar = std::max<double>(height - 24.0, 200);
    apps::Canvas canvas(std::max(width + 32 + uint32_t(apps::kBarWidth) + 10, 560u), uint32_t(bar) + 24 + 84);
    canvas.text({16, 20}, found.file, 14);
    canvas.text({16, 44},
                apps::format("saliency, with the first places and the %g\u00b0 about them; red: lost on the display",
                             found.radius) +
                    (found.rank_correlation ? apps::format(" (%s, rank correlation %.3f)", found.tone_operator.c_str(),
                                                           *found.rank_correlation)
                                            : ""),
                12);
    canvas.pixels(16, 64, width, height, heat(found, width, height));
    for (size_t i = 0; i < found.places.size(); ++i) {
        const SalientPlace& place = found.places[i];
        const double degree = kRadiansPerDegree / analysis::angle_between(found.angles, place.pixels - 0.5,
                                                                          place.pixels + glm::dvec2(0.5, -0.5));
        const glm::dvec2 at = corner + place.pixels * zoom;
        const apps::CanvasColour colour = place.on_display ? apps::CanvasColour(1) : apps::CanvasColour(1, 0.35, 0.3);
        canvas.circle(at, found.radius * degree * zoom, colour, 1.5);
        canvas.text(at, apps::format("%u", unsigned(i + 1)), 15, apps::Canvas::Align::Centre, colour, true);
    }
    apps::draw_colour_bar(canvas, {corner.x + width + 20, corner.y + 24}, bar, kShares, "of the first");
    canvas.save(file);
}

nlohmann::ordered_json json_of(const SaliencyFindings& found) {
    nlohmann::ordered_json places = nlohmann::ordered_json::array();
    for (const SalientPlace& p : found.places) {
        places.push_back({{"x_px", p.pixels.x},
                          {"y_px", p.pixels.y},
                          {"right_deg", p.degrees.x},
                          {"up_deg", p.degrees.y},
                          {"mean_luminance_cd_m2", p.mean_luminance},
                          {"brightest_cd_m2", p.brightest},
                          {"saliency", p.saliency}});
        places.back()["on_display"] = p.on_display ? nlohmann::ordered_json(*p.on_display) : nlohmann::ordered_json();
    }
    nlohmann::ordered_json made{{"width", found.picture->extent.width}, {"height", found.picture->extent.height},
                                {"texel_px", found.scene.texel},        {"pairs_of_levels", found.scene.pairs},
                                {"radius_deg", found.radius},           {"places", places},
                                {"operator", found.tone_operator},      {"places_on_display", found.display_places}};
    made["rank_correlation"] =
        found.rank_correlation ? nlohmann::ordered_json(*found.rank_correlation) : nlohmann::ordered_json();
    return made;
}

}  // namespace vesper::commands
