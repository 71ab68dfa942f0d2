// The settings of a frame, by member and by name. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eye/scatter.h"
#include "render/light_settings.h"
#include "render/setting.h"
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

/// A setting of the light of a frame.
using LightSetting = SettingOf<LightSettings>;
/// All rows, in the order of their declaration.
std::span<const LightSetting> light_rows();
/// By its name, with dashes or underscores. Throws Error if there is none.
const LightSetting& light_row(std::string_view name);

/// Throws Error where settings, each in its range, contradict each other.
void check_light(const LightSettings&);

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
    /// Writes all settings of light; others stay.
    void apply(RenderSettings&) const;

private:
    std::map<const LightSetting*, double> chosen_;
};
/// Settings of a set: chosen(Quality::Exact).
RenderSettings settings_of(Quality);

}  // namespace vesper::render
