// Diagrams among the instruments. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include <imgui.h>
#include <glm/glm.hpp>

namespace vesper::drive {

/// A diagram in the window of Dear ImGui that is being declared, with room for labels on its left and below.
class PanelPlot {
public:
    struct Axis {
        double low = 0, high = 1;
        bool logarithmic = false;
        const char* name = "";
    };
    PanelPlot(const char* id, glm::vec2 size, Axis x, Axis y);

    glm::vec2 at(double x, double y) const;  ///< px; beyond the axes at their ends
    void line(std::span<const glm::dvec2> points, ImU32 colour, float thickness = 1.5f) const;
    void bar(double x0, double x1, double y, ImU32 colour) const;  ///< from the foot
    void upright(double x, ImU32 colour, const char* label, int row = 0) const;
    void band(double x0, double x1, ImU32 colour) const;  ///< from foot to top
    void level(double y, ImU32 colour) const;

private:
    void tick_labels() const;
    Axis x_, y_;
    glm::vec2 corner_, size_;
    ImDrawList* list_;
};

/// Of the instruments, where they mean the same in several places.
namespace colours {
constexpr ImU32 kText = IM_COL32(220, 220, 220, 255), kFaint = IM_COL32(150, 150, 150, 255),
                kGrid = IM_COL32(255, 255, 255, 28);
constexpr ImU32 kBars = IM_COL32(110, 150, 200, 160), kCurve = IM_COL32(255, 200, 80, 255);
constexpr ImU32 kAdaptation = IM_COL32(120, 230, 130, 255), kAverage = IM_COL32(200, 140, 255, 255),
                kRods = IM_COL32(90, 170, 255, 255), kCones = IM_COL32(255, 140, 90, 255);
constexpr ImU32 kDisplay = IM_COL32(255, 255, 255, 26), kAlarm = IM_COL32(255, 90, 80, 255);
}  // namespace colours

}  // namespace vesper::drive
