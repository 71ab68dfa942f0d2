#include "window/instruments.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>

#include "arguments/tone_arguments.h"
#include "base/luminance.h"
#include "print.h"
#include "render/passes/operators.h"
#include "window/panel_layout.h"
#include "window/plot.h"

namespace vesper::drive {
namespace {

constexpr double kPastSeconds = 60;
constexpr ImGuiWindowFlags kPlainWindow = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                          ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize |
                                          ImGuiWindowFlags_NoFocusOnAppearing;

}  // namespace

bool Instruments::press(Action action) {
    const auto toggle = [&](Panel panel) {
        panels_ ^= panel;
        clean_ = false;
        return true;
    };
    switch (action) {
        case Action::Keys:
            return toggle(kKeys);
        case Action::Performance:
            return toggle(kPerformance);
        case Action::Light:
            return toggle(kLight);
        case Action::Eye:
            return toggle(kEye);
        case Action::Switches:
            return toggle(kSwitches);
        case Action::Lamps:
            return toggle(kLamps);
        case Action::Probe:
            return toggle(kProbe);
        case Action::Controllers:
            return toggle(kControllers);
        case Action::Obstacles:
            return toggle(kObstacles);
        case Action::Clean:
            clean_ = !clean_, focus_ = false;
            return true;
        case Action::FalseColour:
            false_colour_ = !false_colour_, fit_scale_ = true;
            return true;
        case Action::Focus:
            focus_ = !focus_, clean_ = false;
            if (focus_ && !panels_) panels_ = kSwitches;  // something to go to
            return true;
        case Action::Leave:
            return leave();
        default:
            return false;
    }
}

bool Instruments::leave() {
    if (clean_ || !(focus_ || panels_ || false_colour_)) return false;
    if (!std::exchange(focus_, false)) panels_ = 0, false_colour_ = false;
    return true;
}

void Instruments::remember(const render::Frame& frame) {
    const double now = double(frame.eye.seconds) + double(frame.eye.seconds_lost);
    while (!past_.empty() && past_.back().seconds >= now) past_.pop_back();
    past_.push_back({now, double(frame.curve.adaptation), double(frame.curve.log_average),
                     double(frame.curve.cone_sigma), double(frame.curve.rod_sigma)});
    while (past_.front().seconds < now - kPastSeconds) past_.pop_front();
}

std::span<const uint8_t> Instruments::coloured(const render::Frame& frame, uint64_t number) {
    if (frame.scene.empty()) return {};
    const bool same_scale = !fit_scale_ && coloured_scale_.low == scale_.low && coloured_scale_.high == scale_.high;
    if (number == coloured_number_ && same_scale) return coloured_;
    apps::ValuePicture picture{frame.extent.width, frame.extent.height, {}};
    picture.values.reserve(frame.scene.size() / 4);
    for (size_t i = 0; i < frame.scene.size(); i += 4)
        picture.values.push_back(float(luminance({frame.scene[i], frame.scene[i + 1], frame.scene[i + 2]})));
    if (std::exchange(fit_scale_, false)) scale_ = apps::scale_of(picture.values);
    coloured_ = apps::false_colours(picture, scale_);
    coloured_number_ = number, coloured_scale_ = scale_;
    return coloured_;
}

std::vector<Change> Instruments::draw(const FrameState& now) {
    std::vector<Change> changes;
    if (!now.message.empty() && (now.alarm || !clean_)) draw_message(now.message);
    if (clean_) return changes;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const glm::vec2 window(size.x, size.y);
    arrange_ = std::exchange(window_, window) != window;
    draw_status(now);
    if (false_colour_) draw_scale();
    if (shows(kKeys)) draw_keys();
    if (shows(kPerformance)) draw_performance(now);
    if (shows(kLight)) draw_light(now);
    if (shows(kEye)) draw_eye();
    if (shows(kSwitches)) draw_switches(now, changes);
    if (shows(kLamps)) draw_lamps(now, changes);
    if (shows(kProbe)) draw_probe(now);
    if (shows(kControllers)) draw_controllers(now);
    if (shows(kObstacles)) draw_obstacles(now);
    return changes;
}

bool Instruments::begin(Panel panel, const char* title, glm::vec2 place, glm::vec2 size, int flags) {
    const PanelPlace at = panel_place(place, size, window_);
    ImGui::SetNextWindowPos({at.corner.x, at.corner.y}, arrange_ ? ImGuiCond_Always : ImGuiCond_Appearing);
    ImGui::SetNextWindowSize({at.size.x, at.size.y}, arrange_ ? ImGuiCond_Always : ImGuiCond_Appearing);
    bool open = true;
    const bool drawn = ImGui::Begin(title, &open, ImGuiWindowFlags_NoCollapse | flags);
    if (!open) panels_ &= ~unsigned(panel);
    return drawn;
}

void Instruments::draw_status(const FrameState& now) const {
    const render::RenderSettings& settings = now.session.settings().render();
    const traffic::VehicleState& me = now.session.world().driver();
    const traffic::DriverInput& input = now.input_devices.last();
    const auto& values = now.session.settings().values();
    const auto value_or = [&](const char* name, const char* fallback) {
        const auto found = values.find(name);
        return found == values.end() ? std::string(fallback) : found->second;
    };
    ImGui::SetNextWindowPos({8, ImGui::GetIO().DisplaySize.y - 8}, ImGuiCond_Always, {0, 1});
    ImGui::SetNextWindowBgAlpha(0.55f);
    if (ImGui::Begin("status", nullptr, kPlainWindow)) {
        ImGui::PushTextWrapPos(ImGui::GetIO().DisplaySize.x - 32);
        const char* beam = input.beam == traffic::Beam::Low    ? "low beam"
                           : input.beam == traffic::Beam::High ? "high beam"
                                                               : "no lights";
        ImGui::Text("%3.0f km/h  %s%s%s", std::abs(me.speed) * 3.6, beam, input.reverse ? "  reverse" : "",
                    input.autopilot ? "  autopilot" : "");
        ImGui::TextUnformatted(
            apps::format("%s  |  glare %s  |  display %s  |  observer of %.0f  |  adapted to %.3g cd/m²  |  "
                         "quality %s, %.0f ms a picture, %.1f/s%s%s",
                         apps::name_of(settings.tone_operator).c_str(), value_or("glare", "none").c_str(),
                         value_or("display", vision::known_displays().front().name).c_str(), settings.tone.observer.age,
                         double(now.frame.curve.adaptation), now.session.settings().quality().c_str(),
                         1e3 / std::max(now.shown_per_second, 1e-3), now.shown_per_second,
                         now.paused ? "  |  paused" : "", has_keyboard() ? "  |  keys for instruments (Esc)" : "")
                .c_str());
        if (!now.offer.empty()) ImGui::TextColored({1, 0.8f, 0.3f, 1}, "%s", now.offer.c_str());
        if (!now.recording.empty()) ImGui::TextColored({1, 0.35f, 0.3f, 1}, "recording %s", now.recording.c_str());
        if (now.session.world().seconds() < 8 && !shows(kKeys)) ImGui::TextDisabled("F1: keys");
        ImGui::PopTextWrapPos();
    }
    ImGui::End();
}

void Instruments::draw_message(const std::string& message) const {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({window.x / 2, window.y / 3}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {window.x * 0.8f, window.y});
    if (ImGui::Begin("message", nullptr, kPlainWindow)) {
        ImGui::PushTextWrapPos(window.x * 0.75f);
        ImGui::TextUnformatted(message.c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::End();
}

void Instruments::draw_keys() {
    if (begin(kKeys, "Keys (F1)", {40, 20}, {620, 740}) && ImGui::BeginTable("keys", 2)) {
        ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthFixed, 150);
        ImGui::TableSetupColumn("does");
        const auto row = [](const char* key, const char* does) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(key);
            ImGui::TableNextColumn();
            ImGui::TextWrapped("%s", does);
        };
        const auto heading = [](const char* text) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::TextDisabled("%s", text);
        };
        const char* group = "Drive";
        heading(group);
        for (const HeldKeys& held : held_keys()) row(held.shown, held.does);
        for (const KeyBinding& binding : key_bindings()) {
            if (std::string_view(group) != binding.group) heading(group = binding.group);
            row(binding.shown, binding.does);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

void Instruments::draw_performance(const FrameState& now) {
    if (begin(kPerformance, "Performance (F3)", {-8, 8}, {380, 420})) {
        double total = 0;
        for (const graph::Timing& timing : now.frame.timings) total += timing.milliseconds;
        ImGui::TextWrapped("%.1f pictures/s shown, %s", now.shown_per_second, now.screen.describe().c_str());
        ImGui::TextWrapped("frame %.2f ms, passes %.2f ms, %u x %u px", now.frame.milliseconds, total,
                           now.frame.extent.width, now.frame.extent.height);
        ImGui::Text("%u lamps, %u seen, %u froxels overflowed", now.frame.lamps, now.frame.luminaires,
                    now.frame.clusters.overflowed);
        const render::ShadowReport& maps = now.frame.maps;
        if (now.session.settings().render().shadows)
            ImGui::TextWrapped("shadows: %u shadow maps drawn, bodies %u times; %.0f MiB", maps.maps, maps.bodies,
                               double(maps.bytes) / (1 << 20));
        ImGui::Separator();
        for (const graph::Timing& timing : now.frame.timings) {
            ImGui::ProgressBar(total > 0 ? float(timing.milliseconds / total) : 0, {60, 0}, "");
            ImGui::SameLine();
            ImGui::Text("%7.3f ms  %s", timing.milliseconds, timing.pass.c_str());
        }
        if (now.frame.timings.empty()) ImGui::TextDisabled("this device has no timestamps");
    }
    ImGui::End();
}

void Instruments::draw_controllers(const FrameState& now) {
    if (begin(kControllers, "Controllers (J)", {-8, -8}, {420, 300}, ImGuiWindowFlags_HorizontalScrollbar)) {
        if (now.input_devices.controllers().empty()) ImGui::TextDisabled("nothing is plugged in");
        for (const ControllerState& c : now.input_devices.controllers()) {
            const ControllerMapping* mapping = now.input_devices.mapping_of(c);
            ImGui::Text("%s: %s", c.name.c_str(), !mapping ? "no mapping" : mapping->gamepad ? "gamepad" : "mapped");
            for (size_t i = 0; i < c.axes.size(); ++i) ImGui::Text("  axis %zu  %+.3f", i, double(c.axes[i]));
            std::string pressed;
            for (size_t i = 0; i < c.buttons.size(); ++i)
                if (c.buttons[i]) pressed += " " + std::to_string(i);
            ImGui::Text("  buttons pressed:%s", pressed.empty() ? " none" : pressed.c_str());
        }
        const traffic::DriverInput& input = now.input_devices.last();
        ImGui::Text("steering %+.2f  throttle %.2f  brake %.2f", input.steering, input.throttle, input.brake);
    }
    ImGui::End();
}

}  // namespace vesper::drive
