// Instruments that measure light. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/luminance.h"
#include "print.h"
#include "render/passes/operators.h"
#include "window/instruments.h"
#include "window/light_probe.h"
#include "window/panel_layout.h"
#include "window/plot.h"

namespace vesper::drive {

// Votes of luminances, and what the operator makes of each: both over the same axis, on which the range of the display
// lies too.
void Instruments::draw_light(const FrameState& now) {
    if (begin(kLight, "Light (F4)", {8, 8}, {520, 300})) {
        const render::RenderSettings& settings = now.session.settings().render();
        const render::HistogramSettings& bins = settings.histogram;
        const double low = double(bins.low), high = double(bins.high);
        const vision::Display& display = settings.display;
        const ImVec2 room = ImGui::GetContentRegionAvail();
        const std::string legend = apps::format("bars: votes; grey band: the display's own range, %.3g to %.4g cd/m²",
                                                double(display.low()), double(display.high()));
        const float below =
            ImGui::CalcTextSize(legend.c_str(), nullptr, false, room.x).y + ImGui::GetStyle().ItemSpacing.y;
        const PanelPlot plot("light", {room.x, std::max(room.y - below, 60.0f)}, {low, high, true, "scene, cd/m²"},
                             {double(display.low()), double(display.high()), true, "shown, cd/m² (curve)"});
        plot.band(double(display.low()), double(display.high()), colours::kDisplay);

        const uint32_t* const first = now.frame.histogram.count;
        const uint32_t most = std::max(1u, *std::max_element(first, first + bins.bins));
        const double range = double(display.high()) / double(display.low());
        const auto edge = [&](uint32_t bin) { return low * std::pow(high / low, double(bin) / bins.bins); };
        for (uint32_t i = 0; i < bins.bins; ++i)
            if (first[i])
                plot.bar(edge(i), edge(i + 1), double(display.low()) * std::pow(range, double(first[i]) / most),
                         colours::kBars);

        if (settings.tone_operator != render::Operator::Ldr) {
            std::vector<glm::dvec2> curve;
            for (int i = 0; i <= 200; ++i) {
                const double scene = low * std::pow(high / low, i / 200.0);
                curve.emplace_back(scene,
                                   render::shown_luminance(settings.tone_operator, now.frame.curve, scene, display));
            }
            plot.line(curve, colours::kCurve, 2);
        }
        plot.upright(double(now.frame.curve.adaptation), colours::kAdaptation, "adapted to");
        plot.upright(double(now.frame.curve.log_average), colours::kAverage, "log average", 1);
        plot.upright(double(now.frame.curve.maximum), colours::kFaint, "maximum", 2);
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled("%s", legend.c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::End();
}

void Instruments::draw_eye() {
    if (begin(kEye, "Eye (F5)", {8, 320}, {520, 260}) && !past_.empty()) {
        const double now = past_.back().seconds;
        const ImVec2 room = ImGui::GetContentRegionAvail();
        double low = 1e9, high = 1e-9;
        for (const Past& p : past_)
            for (const double value : {p.adaptation, p.average, p.cones})
                if (value > 0) low = std::min(low, value), high = std::max(high, value);
        low = std::pow(10, std::floor(std::log10(std::min(low, high)))),
        high = std::max(std::pow(10, std::ceil(std::log10(high))), 10 * low);
        const PanelPlot plot(
            "eye", {room.x, std::max(room.y - ImGui::GetTextLineHeightWithSpacing(), 60.0f)},
            {std::max(std::min(past_.front().seconds, now - 10), 0.0), std::max(now, 10.0), false, "time, s"},
            {low, high, true, "cd/m²"});
        const auto draw = [&](double Past::*what, ImU32 colour) {
            std::vector<glm::dvec2> points;
            for (const Past& p : past_) points.emplace_back(p.seconds, p.*what);
            plot.line(points, colour);
        };
        draw(&Past::average, colours::kAverage);
        draw(&Past::rods, colours::kRods);
        draw(&Past::cones, colours::kCones);
        draw(&Past::adaptation, colours::kAdaptation);
        const auto legend = [](ImU32 colour, const char* name) {
            ImGui::PushStyleColor(ImGuiCol_Text, colour);
            ImGui::TextUnformatted(name);
            ImGui::PopStyleColor();
            ImGui::SameLine();
        };
        legend(colours::kAdaptation, "looked at");
        legend(colours::kAverage, "log average");
        legend(colours::kCones, "half saturation: cones");
        legend(colours::kRods, "rods");
        ImGui::NewLine();
    }
    ImGui::End();
}

void Instruments::draw_probe(const FrameState& now) {
    if (begin(kProbe, "Probe (F8)", {-8, 440}, {380, 200}, ImGuiWindowFlags_HorizontalScrollbar)) {
        const render::Frame& frame = now.frame;
        if (!now.pixel) {
            ImGui::TextDisabled("point at something in the picture");
        } else if (now.session.settings().render().tone_operator == render::Operator::Ldr) {
            ImGui::TextDisabled("the ldr operator knows no luminance");
        } else if (!frame.scene.empty()) {
            const float* rgb = &frame.scene[(size_t(now.pixel->y) * frame.extent.width + now.pixel->x) * 4];
            const double here = luminance({rgb[0], rgb[1], rgb[2]});
            const render::RenderSettings& settings = now.session.settings().render();
            ImGui::Text("pixel %u, %u", now.pixel->x, now.pixel->y);
            ImGui::Text("luminance %.4g cd/m²", here);
            ImGui::Text("red, green, blue %.3g, %.3g, %.3g cd/m²", double(rgb[0]), double(rgb[1]), double(rgb[2]));
            ImGui::Text("shown as about %.4g cd/m²",
                        render::shown_luminance(settings.tone_operator, frame.curve, here, settings.display));
            const scene::Scene& scene = now.session.scenery().scene();
            const gpu_scene::SceneFrame moment = now.session.moment();
            if (const auto point =
                    now.view_pixel ? surface_at(scene, moment, now.view, *now.view_pixel) : std::nullopt) {
                const double lamps = lamp_illuminance(scene, moment, *point);
                const double ambient =
                    moment.ambient ? luminance(moment.ambient->illuminance) : double(scene.ambient_illuminance);
                ImGui::Text("illuminance %.4g lx: lamps %.4g, sky %.4g", lamps + ambient, lamps, ambient);
                ImGui::Text("%.1f m away: %s", point->distance, scene.nodes[point->node].name.c_str());
            } else {
                ImGui::TextDisabled("no surface there");
            }
        }
    }
    ImGui::End();
}

void Instruments::draw_scale() {
    const ImVec2 corner(window_.x - 8, std::max(window_.y - kStatusHeight, 0.0f));
    ImGui::SetNextWindowPos(corner, arrange_ ? ImGuiCond_Always : ImGuiCond_Appearing, {1, 1});
    ImGui::SetNextWindowSize({std::min(460.0f, window_.x - 16), 0}, ImGuiCond_Always);
    if (ImGui::Begin("Luminance, cd/m² (F)", nullptr,
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoFocusOnAppearing)) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float width = ImGui::GetContentRegionAvail().x;
        ImDrawList* list = ImGui::GetWindowDrawList();
        for (float x = 0; x < width; ++x) {
            const apps::CanvasColour c = apps::map_colour(double(x / (width - 1)));
            list->AddRectFilled({at.x + x, at.y}, {at.x + x + 1, at.y + 16},
                                ImGui::ColorConvertFloat4ToU32({float(c.r), float(c.g), float(c.b), 1}));
        }
        float free = -1;
        for (const double tick : apps::log_ticks(scale_.low, scale_.high)) {
            const float x = float(scale_.position(tick)) * width;
            const std::string label = apps::tick_label(tick);
            const float half = ImGui::CalcTextSize(label.c_str()).x / 2;
            list->AddLine({at.x + x, at.y + 16}, {at.x + x, at.y + 20}, colours::kText);
            const float left = std::clamp(x - half, 0.0f, width - 2 * half);
            if (left < free) continue;
            list->AddText({at.x + left, at.y + 20}, colours::kText, label.c_str());
            free = left + 2 * half + 8;
        }
        ImGui::Dummy({width, 36});
        float ends[] = {float(scale_.low), float(scale_.high)};
        ImGui::SetNextItemWidth(width - 90);
        if (ImGui::DragFloatRange2("##ends", &ends[0], &ends[1], 0.01f * ends[1], 1e-6f, 1e9f, "from %.3g cd/m²",
                                   "to %.4g cd/m²", ImGuiSliderFlags_Logarithmic) &&
            ends[1] > 1.01f * ends[0] && ends[0] > 0)
            scale_ = {double(ends[0]), double(ends[1])};
        ImGui::SameLine();
        if (ImGui::Button("Fit")) fit_scale_ = true;
    }
    ImGui::End();
}

}  // namespace vesper::drive
