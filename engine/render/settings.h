// The settings of a frame, by member and by name. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eye/scatter.h"
#include "render/light_settings.h"
#include "render/tone_chain.h"
#include "scene/obstacles.h"

namespace vesper::render {

struct RenderSettings : ToneChainSettings, LightSettings {
    std::vector<eye::OffscreenLamp>
        offscreen_lamps;  ///< on other screens: scattered in the eye, not drawn; directions in the view frame
    float ldr_reference_distance = 6.5f;  ///< m: where an LDR lamp of 1.0 gives 1.0; the paper's lamp height
    bool unit_lamps = false;  ///< lamps and luminaires of 1.0 instead of their candela, emission of at most 1.0
    bool lamps_alone =
        false;  ///< without ambient light, daylight, sky, retroreflection and light from outside the picture
    std::vector<scene::Obstacle> obstacles;  ///< of the scene, to be measured in the picture (Frame::obstacles)
    bool obstacle_pixels = false;            ///< Frame::obstacle_pixels, too
};

/// Named sets of values for all settings, from the fastest to the most exact.
enum class Quality : uint8_t { Draft, Standard, Exact };
constexpr std::array<std::string_view, 3> kQualityNames{"draft", "standard", "exact"};
/// Throws Error, which lists the names.
Quality quality_named(std::string_view name);

enum class SettingKind : uint8_t { Switch, Count, Float, Double };

/// A row of the table.
struct Setting {
    std::string_view name;  ///< of the member: "shadow_error"
    std::string_view unit, help;
    SettingKind kind;
    double low, high;              ///< infinity: unlimited
    std::array<double, 3> values;  ///< by Quality; switches are 0 and 1
    double (*get)(const RenderSettings&);
    void (*set)(RenderSettings&, double);  ///< without a check

    double value(Quality quality) const { return values[size_t(quality)]; }
    std::string option() const;      ///< "shadow-error"
    bool differs() const;            ///< among the sets
    bool accepts(double) const;      ///< in range, and whole if it is a count or switch
    std::string range() const;       ///< "on or off", "0.001 to 1000 lx"
    std::string text(double) const;  ///< "on", "all", "0.005": the shortest text that reads back to the same value
    double rounded(double) const;    ///< to a float, if the setting is one
    /// The value of a text. Throws Error that names setting, value, range and unit.
    double parse(std::string_view) const;
};

/// All rows, in the order of their declaration.
std::span<const Setting> settings();
/// By its name, with dashes or underscores. Throws Error if there is none.
const Setting& setting(std::string_view name);

/// A set of values, and single values that replace values of the set.
class ChosenSettings {
public:
    Quality quality = Quality::Standard;

    /// Throws Error if there is no such setting or the value is out of its range.
    void set(std::string_view name, double value);
    void set(std::string_view name, std::string_view text);
    /// Back to the value of the set.
    void unset(std::string_view name);
    /// Throws Error if there is no such setting.
    double get(std::string_view name) const;
    bool is_chosen(std::string_view name) const;
    /// Writes all settings of the table; others stay.
    void apply(RenderSettings&) const;

private:
    std::map<const Setting*, double> chosen_;
};
/// Settings of a set: chosen(Quality::Exact).
RenderSettings settings_of(Quality);

}  // namespace vesper::render
