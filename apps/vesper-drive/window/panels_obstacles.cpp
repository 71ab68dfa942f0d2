// How visible obstacles are. SPDX-License-Identifier: MIT
#include <cmath>

#include <imgui.h>

#include "print.h"
#include "record/detection.h"
#include "window/instruments.h"

namespace vesper::drive {

void Instruments::draw_obstacles(const FrameState& now) {
    const std::vector<scene::Obstacle>& obstacles = now.session.obstacles();
    if (begin(kObstacles, "Obstacles (I)", {-8, 120}, {460, 300})) {
        const std::vector<render::SeenObstacle>& seen = now.frame.obstacles;
        const double age = now.session.settings().render().tone.observer.age;
        if (obstacles.empty())
            ImGui::TextDisabled("none is watched: see --obstacle");
        else if (seen.size() != obstacles.size())
            ImGui::TextDisabled("this picture has no luminances to measure");
        else if (ImGui::BeginTable("obstacles", 4, ImGuiTableFlags_ScrollY)) {
            ImGui::TableSetupColumn("obstacle", ImGuiTableColumnFlags_WidthStretch);
            for (const char* name : {"m", "level", "seen"})
                ImGui::TableSetupColumn(name, ImGuiTableColumnFlags_WidthFixed, name[0] == 's' ? 120.0f : 60.0f);
            ImGui::TableHeadersRow();
            for (size_t i = 0; i < seen.size(); ++i) {
                const std::optional<double> level = render::visibility_of(seen[i], age).level;
                const std::optional<bool> visible = is_visible(seen[i], age, now.visible_from);
                const char* why = render::words_of(seen[i].state);
                for (const std::string& cell :
                     {apps::format("%s", obstacles[i].name.c_str()), apps::format("%.1f", seen[i].distance),
                      level ? apps::format("%.3g", *level) : std::string(),
                      std::string(visible ? (*visible ? "seen" : "not seen")
                                  : *why  ? why
                                          : "not known")}) {
                    ImGui::TableNextColumn();
                    ImGui::TextUnformatted(cell.c_str());
                }
            }
            ImGui::EndTable();
        }
    }
    ImGui::End();
}

}  // namespace vesper::drive
