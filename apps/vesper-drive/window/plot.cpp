#include "window/plot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "plots/canvas.h"

namespace vesper::drive {
namespace {

constexpr float kLeft = 44, kRight = 8, kBelow = 34;

double part(const PanelPlot::Axis& axis, double value) {
    if (axis.logarithmic) return value > 0 ? std::log(value / axis.low) / std::log(axis.high / axis.low) : 0;
    return (value - axis.low) / (axis.high - axis.low);
}

std::vector<double> ticks(const PanelPlot::Axis& axis, int count) {
    return axis.logarithmic ? apps::log_ticks(axis.low, axis.high) : apps::linear_ticks(axis.low, axis.high, count);
}

ImVec2 im(glm::vec2 v) { return {v.x, v.y}; }

}  // namespace

PanelPlot::PanelPlot(const char* id, glm::vec2 size, Axis x, Axis y) : x_(x), y_(y), list_(ImGui::GetWindowDrawList()) {
    const ImVec2 cursor = ImGui::GetCursorScreenPos();
    corner_ = {cursor.x + kLeft, cursor.y + 4};
    size_ = glm::max(size - glm::vec2(kLeft + kRight, kBelow + 4), glm::vec2(10));
    ImGui::InvisibleButton(id, im(size));  // takes the room
    list_->AddRectFilled(im(corner_), im(corner_ + size_), IM_COL32(0, 0, 0, 110));
    tick_labels();
}

glm::vec2 PanelPlot::at(double x, double y) const {
    return corner_ +
           size_ * glm::vec2(float(std::clamp(part(x_, x), 0.0, 1.0)), 1 - float(std::clamp(part(y_, y), 0.0, 1.0)));
}

void PanelPlot::tick_labels() const {
    float free = -1e9f;
    for (const double tick : ticks(x_, 6)) {
        const glm::vec2 foot = at(tick, y_.low);
        list_->AddLine(im(foot), im({foot.x, corner_.y}), colours::kGrid);
        const std::string label = apps::tick_label(tick);
        const float width = ImGui::CalcTextSize(label.c_str()).x;
        if (foot.x - width / 2 < free) continue;
        const float left = std::min(foot.x - width / 2, corner_.x + size_.x + kRight - width);
        list_->AddText({left, foot.y + 2}, colours::kFaint, label.c_str());
        free = left + width + 6;
    }
    float lowest = 1e9f;
    for (const double tick : ticks(y_, 5)) {
        const glm::vec2 side = at(x_.low, tick);
        list_->AddLine(im(side), im({side.x + size_.x, side.y}), colours::kGrid);
        const std::string label = apps::tick_label(tick);
        const ImVec2 room = ImGui::CalcTextSize(label.c_str());
        if (side.y + room.y / 2 > lowest) continue;
        list_->AddText({side.x - room.x - 4, side.y - room.y / 2}, colours::kFaint, label.c_str());
        lowest = side.y - room.y / 2;
    }
    const float width = ImGui::CalcTextSize(x_.name).x;
    list_->AddText({corner_.x + (size_.x - width) / 2, corner_.y + size_.y + 15}, colours::kFaint, x_.name);
    list_->AddText({corner_.x + 4, corner_.y + 1}, colours::kFaint, y_.name);
}

void PanelPlot::line(std::span<const glm::dvec2> points, ImU32 colour, float thickness) const {
    for (size_t i = 1; i < points.size(); ++i) {
        const glm::dvec2 a = points[i - 1], b = points[i];
        if (std::isfinite(a.y) && std::isfinite(b.y))
            list_->AddLine(im(at(a.x, a.y)), im(at(b.x, b.y)), colour, thickness);
    }
}

void PanelPlot::bar(double x0, double x1, double y, ImU32 colour) const {
    list_->AddRectFilled(im(at(x0, y)), im(at(x1, y_.low)), colour);
}

void PanelPlot::upright(double x, ImU32 colour, const char* label, int row) const {
    if (!(part(x_, x) >= 0 && part(x_, x) <= 1)) return;
    const glm::vec2 foot = at(x, y_.low);
    list_->AddLine(im(foot), im({foot.x, corner_.y}), colour, 1.5f);
    const float width = ImGui::CalcTextSize(label).x;
    const float left = foot.x + 3 + width > corner_.x + size_.x ? foot.x - 3 - width : foot.x + 3;
    list_->AddText({left, corner_.y + 14 + 13 * float(row)}, colour, label);
}

void PanelPlot::band(double x0, double x1, ImU32 colour) const {
    list_->AddRectFilled(im(at(x0, y_.high)), im(at(x1, y_.low)), colour);
}

void PanelPlot::level(double y, ImU32 colour) const { list_->AddLine(im(at(x_.low, y)), im(at(x_.high, y)), colour); }

}  // namespace vesper::drive
