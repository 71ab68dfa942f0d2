// What in a scene cannot be right for a road at night. SPDX-License-Identifier: MIT
#include "scene/scene_warnings.h"

#include <algorithm>
#include <cmath>

#include "scene/apply_rules.h"

namespace vesper::scene {
namespace {

// Bounds are wide: what lies outside is a mistake of units, of scale, or of a decimal point, not a matter of taste.
constexpr double kPole = 3;                                  // m: a lamp as high as this is there to light the ground
constexpr double kFaintPole = 0.5, kBrightPole = 1000;       // lx under it: a lit path has 5 to 50
constexpr double kLowLamp = 0.1;                             // m: lower than any lamp of a car
constexpr double kSmallest = 10, kLargest = 20'000;          // m: a street
constexpr double kWhitest = 0.9;                             // fresh snow; plaster has 0.8
constexpr double kWhiteScene = 0.6, kBlackScene = 0.01;      // a street has 0.1 to 0.4
constexpr double kFaintEmission = 1, kBrightEmission = 1e8;  // cd/m^2: a lit window has 10, the arc of a xenon lamp 1e8
constexpr double kNightLight = 50;                           // lx: dusk; a full moon gives 0.25
constexpr double kNightSky = 10;                             // cd/m^2: a city's sky has 0.02

class Warnings {
public:
    Warnings(const Scene& scene, SceneReport& report) : scene_(scene), report_(report) {}

    void size() {
        const double longest = std::max({report_.extent.x, report_.extent.y, report_.extent.z});
        if (report_.triangles == 0) return add("nothing to be seen: no triangles");
        if (longest < kSmallest)
            add("the scene is " + decimal(longest) + " m long, as small as a toy: are its lengths in metres?");
        if (longest > kLargest) add("the scene is " + decimal(longest) + " m long: are its lengths in metres?");
    }
    void lamp(const LampReport& lamp) {
        const std::string name = "lamp " + in_quotes(lamp.name) + ": ";
        if (lamp.kind == Lamp::Kind::Directional) {
            if (lamp.candela > kNightLight) add(name + decimal(lamp.candela) + " lx from the sky are no night");
            return;
        }
        if (lamp.candela < kFaintestLamp || lamp.candela > kBrightestLamp)
            add(name + decimal(lamp.candela) + " cd is beyond the lamps of a street (0.1 to 1e6 cd)");
        if (lamp.highest && *lamp.highest >= kPole) {
            const double height = std::max(lamp.lowest.value_or(0), kPole), below = lamp.candela / (height * height);
            if (below < kFaintPole)
                add(name + decimal(lamp.candela) + " cd from " + decimal(height) + " m give " + decimal(below) +
                    " lx at most: lumens, watts or a relative number for candela?");
            if (below > kBrightPole)
                add(name + decimal(lamp.candela) + " cd from " + decimal(height) + " m give " + decimal(below) +
                    " lx: a lit road has 5 to 50");
        }
        if (lamp.lowest && *lamp.lowest < kLowLamp)
            add(name + "stands " + decimal(*lamp.lowest) + " m above what lies under it: are lengths in metres?");
        if (lamp.under_ground)
            add(name + std::to_string(lamp.under_ground) + " of " + std::to_string(lamp.number) + " below the ground");
        if (lamp.over_nothing > lamp.under_ground)
            add(name + std::to_string(lamp.over_nothing - lamp.under_ground) + " of " + std::to_string(lamp.number) +
                " with no surface under it");
    }
    void material(const MaterialReport& m) {
        const std::string name = "material " + in_quotes(m.name) + ": ";
        const bool shines = m.emission > 0;
        if (m.reflectance > kWhitest && m.metallic <= 0.5 && !shines)
            add(name + "a mean reflectance of " + decimal(m.reflectance) + " is more than real surfaces have");
        if (m.metallic > 0.99 && m.area > 0.2 * report_.area)
            add(name + "a fifth of the scene is metal, which scatters no light: metallic left at glTF's default of 1?");
        if (shines && m.emission <= kFaintEmission)
            add(name + "emits " + decimal(m.emission) +
                " cd/m^2 or less: a factor without KHR_materials_emissive_strength? A lit window has 10 to 100");
        if (m.emission > kBrightEmission)
            add(name + "emits " + decimal(m.emission) + " cd/m^2, more than the arc of a lamp (1e8)");
    }
    void whole() {
        if (report_.area > 0 && report_.mean_reflectance > kWhiteScene)
            add("surfaces reflect " + decimal(report_.mean_reflectance) +
                " on average: the scene is white (a street: 0.1 to 0.4)");
        if (report_.area > 0 && report_.mean_reflectance < kBlackScene)
            add("surfaces reflect " + decimal(report_.mean_reflectance) + " on average: the scene is black");
        const double ambient = static_cast<double>(scene_.ambient_illuminance),
                     sky = static_cast<double>(scene_.sky_luminance);
        if (ambient > kNightLight) add("an ambient illuminance of " + decimal(ambient) + " lx is no night");
        if (sky > kNightSky) add("a sky of " + decimal(sky) + " cd/m^2 is no night");
        const bool lit =
            std::any_of(report_.lamps.begin(), report_.lamps.end(), [](const LampReport& l) { return l.candela > 0; });
        if (!lit)
            add(ambient > 0 || sky > 0 ? "there are no lamps: vesper convert adds them"
                                       : "there are no lamps and no ambient light: vesper convert adds them");
    }

private:
    void add(const std::string& text) { report_.warnings.push_back(text); }

    const Scene& scene_;
    SceneReport& report_;
};

}  // namespace

void warn_of(const Scene& scene, SceneReport& report) {
    Warnings warnings(scene, report);
    warnings.size();
    for (const LampReport& lamp : report.lamps) warnings.lamp(lamp);
    for (const MaterialReport& material : report.materials) warnings.material(material);
    warnings.whole();
}

}  // namespace vesper::scene
