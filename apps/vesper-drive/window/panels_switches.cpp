// Switches of the eye, the display and the lamps. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <imgui.h>
#include "print.h"

#include "arguments/tone_arguments.h"
#include "render/tone_rows.h"
#include "vision/display.h"
#include "window/instruments.h"

namespace vesper::drive {
namespace {

using apps::format;

/// Declares switches of the settings that somebody sees, and notes what is changed. Values are those of DriveSettings.
class Switches {
public:
    Switches(const DriveSettings& settings, std::vector<Change>& changes)
        : values_(settings.values()), changes_(changes) {}

    std::string text(const char* name, const std::string& fallback) const {
        const auto found = values_.find(name);
        return found == values_.end() ? fallback : found->second;
    }
    void change(const std::string& name, const std::string& value) { changes_.emplace_back(name, value); }

    template <class Texts>
    void choice(const char* label, const char* name, const std::string& now, const Texts& of) {
        if (!ImGui::BeginCombo(label, now.c_str())) return;
        for (const auto& text : of)
            if (const std::string one(text); ImGui::Selectable(one.c_str(), one == now) && one != now)
                change(name, one);
        ImGui::EndCombo();
    }
    /// The format says the unit.
    void slider(const char* label, const char* name, float now, float low, float high, const char* pattern,
                bool logarithmic = false) {
        if (ImGui::SliderFloat(label, &now, low, high, pattern,
                               ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0)))
            change(name, format("%.6g", double(now)));
    }

    /// A row of a table, by its kind. Numbers without a limit have no slider.
    void row(const render::Setting& row, double now) {
        const std::string name = row.option();
        std::string label(row.name);
        std::ranges::replace(label, '_', ' ');
        const std::string pattern =
            (row.kind == render::SettingKind::Count ? "%.0f " : "%.3g ") + std::string(row.unit);
        const bool is_wide = row.high > 100 * std::max(row.low, 1e-3);  // in decades
        auto slid = float(now);
        bool on = now != 0;
        if (row.kind == render::SettingKind::Choice) {
            choice(label.c_str(), name.c_str(), row.text(now), row.choices);
        } else if (row.kind == render::SettingKind::Switch) {
            if (ImGui::Checkbox(label.c_str(), &on)) change(name, row.text(on));
        } else if (std::isfinite(row.high)) {
            const int steps = ImGuiSliderFlags_AlwaysClamp | (is_wide ? ImGuiSliderFlags_Logarithmic : 0);
            if (ImGui::SliderFloat(label.c_str(), &slid, float(row.low), float(row.high), pattern.c_str(), steps)) {
                const double rounded = std::strtod(format("%.4g", double(slid)).c_str(), nullptr);
                change(name, row.text(std::clamp(rounded, row.low, row.high)));
            }
        } else {
            return;
        }
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(row.help).c_str());
    }

private:
    const DriveSettings::Values& values_;
    std::vector<Change>& changes_;
};

}  // namespace

void Instruments::draw_switches(const FrameState& now, std::vector<Change>& changes) {
    if (begin(kSwitches, "Switches (F6)", {-8, 8}, {430, 560})) {
        const DriveSettings& settings = now.session.settings();
        const render::RenderSettings& render = settings.render();
        const render::ToneSettings& tone = render.tone;
        Switches to(settings, changes);
        ImGui::PushItemWidth(210);

        const auto tone_row = [&](const char* name) {
            const render::ToneRow& row = render::tone_row(name);
            to.row(row, row.get(render));
        };
        tone_row("operator");
        ImGui::TextWrapped("%s", std::string(render::operator_info(render.tone_operator).summary).c_str());

        tone_row("glare");
        tone_row("age");

        std::vector<std::string> names;
        for (const vision::NamedDisplay& known : vision::known_displays())
            if (now.screen.shows(known.display)) names.emplace_back(known.name);
        to.choice("display", "display", to.text("display", vision::known_displays().front().name), names);
        if (render.display.eotf != vision::Eotf::Table) {
            to.slider("peak", "display-peak", render.display.peak, 1, 4000, "%.0f cd/m²", true);
            to.slider("black", "display-black", render.display.black, 0.001f, 2, "%.3f cd/m²", true);
        }
        to.slider("light on it", "display-ambient", render.display.ambient, 0, 1000, "%.0f lx", true);

        ImGui::Separator();
        to.slider("gaze, right", "gaze", tone.gaze.x, 0, 1, "%.2f of the width");
        if (!changes.empty() && changes.back().first == "gaze")
            changes.back().second += format(",%.4g", double(tone.gaze.y));
        float down = tone.gaze.y;
        if (ImGui::SliderFloat("gaze, down", &down, 0, 1, "%.2f of the height"))
            to.change("gaze", format("%.4g,%.4g", double(tone.gaze.x), double(down)));
        ImGui::Separator();
        bool day = settings.sun().has_value();
        if (ImGui::Checkbox("sun", &day)) to.change("sun", day ? "-4" : "");
        if (settings.sun()) {
            ImGui::SameLine();
            to.slider("##sun", "sun", float(*settings.sun()), -18, 60, "%.1f° above the horizon");
        }
        to.choice("quality", "quality", settings.quality(), render::kQualityNames);
        for (const render::LightSetting& row : render::light_rows())
            if (DriveSettings::knows(row.option())) to.row(row, row.get(render));
        std::string_view group;
        bool open = false;
        for (const render::ToneRow& row : render::tone_rows()) {
            if (row.group.empty()) continue;  // above
            if (std::exchange(group, row.group) != row.group)
                open = ImGui::CollapsingHeader(std::string(group).c_str());
            if (open) to.row(row, row.get(render));
        }
        ImGui::PopItemWidth();
    }
    ImGui::End();
}

void Instruments::draw_lamps(const FrameState& now, std::vector<Change>& changes) {
    if (begin(kLamps, "Lamps (F7)", {-446, 8}, {430, 360}, ImGuiWindowFlags_HorizontalScrollbar)) {
        const auto& factors = now.session.settings().lamps();
        for (const LampGroup& group : now.session.scenery().lamp_groups()) {
            const auto found = factors.find(group.name);
            float candela = float(group.candela * (found == factors.end() ? 1 : found->second));
            ImGui::SetNextItemWidth(190);
            const std::string label = format("%s (%zu)", group.name.c_str(), group.lamps);
            // Ten times as much at most; all the way to the left is off.
            if (ImGui::SliderFloat(label.c_str(), &candela, 0, float(10 * group.candela),
                                   group.candela < 100 ? "%.2f cd" : "%.0f cd",
                                   ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
                changes.emplace_back("lamp:" + group.name, format("%.6g", double(candela) / group.candela));
            if (ImGui::IsItemHovered())
                ImGui::SetTooltip("largest intensity of each, as the scene has it %.4g cd", group.candela);
        }
        if (ImGui::Button("All as the scene has them"))
            for (const auto& factor : factors) changes.emplace_back("lamp:" + factor.first, "");
    }
    ImGui::End();
}

}  // namespace vesper::drive
