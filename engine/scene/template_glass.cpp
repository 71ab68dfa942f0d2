// Emitters of a template that are the glass of its lamps. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "base/decimal.h"
#include "photometry/standard_lamps.h"
#include "scene/template_rules.h"

namespace vesper::scene {
namespace {

constexpr size_t kMostPairs = 2000, kMostVisits = 200'000'000;  // of rules that are compared; nodes for all of them
constexpr double kFaintest = 10, kBrightest = 1'000'000;  // cd/m^2, of glass: beyond, the surface is something else

double three_digits(double value) {
    const double step = std::pow(10, std::floor(std::log10(value)) - 2);
    return std::round(value / step) * step;
}

/// On the axis, cd.
double intensity_of(const TemplateRule& rule) {
    if (rule.json.contains("intensity_cd")) return rule.json["intensity_cd"].get<double>();
    const photometry::Distribution lamp = photometry::standard_lamp(rule.json["standard"].get<std::string>());
    Lamp measured;
    measured.kind = Lamp::Kind::Measured, measured.intensity = 1, measured.distribution = 0;
    return luminous_intensity(measured, {&lamp, 1}, {0, 0, -1});
}

/// The median area of the glass of the rule's lamps that have any, as seen along their axes, m^2; 0 if none has. `lit`:
/// how many have.
double area_of(const Scene& scene, const std::vector<glm::dmat4>& world, const TemplateRule& emitter,
               const TemplateRule& rule, size_t& lit) {
    std::vector<GlassLamp> lamps = rule.lamps;
    add_glass(scene, world, emitter.members, EmitterRule{.name = {}, .materials = {}, .luminance = 1}, nullptr, lamps);
    std::vector<double> areas;
    for (const GlassLamp& lamp : lamps)
        if (lamp.seen().area > 0) areas.push_back(lamp.seen().area);
    lit = areas.size();
    if (areas.empty()) return 0;
    std::nth_element(areas.begin(), areas.begin() + std::ptrdiff_t(areas.size() / 2), areas.end());
    return areas[areas.size() / 2];
}

}  // namespace

void match_glass(const Scene& scene, std::vector<TemplateRule>& emitters, const std::vector<TemplateRule>& lamps) {
    const std::vector<glm::dmat4> world = world_transforms(scene, 0);
    const size_t most_pairs = std::min(kMostPairs, kMostVisits / std::max<size_t>(scene.nodes.size(), 1));
    size_t pairs = 0;
    for (TemplateRule& emitter : emitters) {
        if (emitter.json.contains("modulate")) continue;  // the mean of a picture is another figure
        const TemplateRule* best = nullptr;
        double area = 0;
        size_t most = 0;
        for (const TemplateRule& rule : lamps) {
            if (++pairs > most_pairs) return;
            size_t lit = 0;
            const double its = area_of(scene, world, emitter, rule, lit);
            if (lit > most) most = lit, best = &rule, area = its;
        }
        if (!best) continue;
        const double luminance = intensity_of(*best) / area;
        if (luminance < kFaintest || luminance > kBrightest) continue;
        emitter.kind = best->kind;
        emitter.json["luminance_cd_m2"] = rounded(three_digits(luminance));
        for (const char* key : {"colour_temperature_K", "colour_rgb"}) {
            emitter.json.erase(key);
            if (best->json.contains(key)) emitter.json[key] = best->json[key];
        }
        emitter.comment += ", of lamps that have " + decimal(area, 3) + " m^2 of it each: I / A";
    }
}

}  // namespace vesper::scene
