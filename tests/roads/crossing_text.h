// A crossing of four roads with traffic lights on mast arms, as editors write them. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>

#include "roads/road_texts.h"

namespace vesper::test {

/// Roads W, E, S and N of 80 m lead from 15 m about the origin outwards, with one lane of 3.5 m each way, and two heads
/// each ("W1", "W2") over the lane inwards, on a mast arm. Ways lead straight on and, if asked for, to the left.
inline std::string crossing_text(bool left_turns) {
    constexpr double kHalf = 15, kLong = 80, kPi = 3.14159265358979323846;
    constexpr std::array<const char*, 4> kNames{"E", "N", "W", "S"};
    const auto link = [](const char* end, const std::string& type, const std::string& id) {
        return "<" + std::string(end) + " elementType=\"" + type + "\" elementId=\"" + id + "\"" +
               (type == "road" ? " contactPoint=\"start\"" : "") + "/>";
    };
    std::string text, connections;
    int number = 0;
    for (int i = 0; i < 4; ++i) {
        const double heading = i * kPi / 2, x = kHalf * std::cos(heading), y = kHalf * std::sin(heading);
        std::string signals;
        for (int k = 1; k <= 2; ++k)
            signals +=
                "<signal id=\"" + std::string(kNames[size_t(i)]) + std::to_string(k) +
                "\" name=\"Signal_3Light_Post01\" s=\"2.2\"" + quantity("t", k) +
                " zOffset=\"5.3\" hOffset=\"0\" roll=\"0\" pitch=\"0\" orientation=\"-\" dynamic=\"yes\" "
                "country=\"OpenDRIVE\" type=\"1000001\" subtype=\"-1\" value=\"-1\" height=\"1\" width=\"0.4\"/>";
        text += road(kNames[size_t(i)], kLong, geometry(0, x, y, heading, kLong, "<line/>"), two_way_section(),
                     "<link>" + link("predecessor", "junction", "J") + "</link><objects><object id=\"m" +
                         std::to_string(i) +
                         "\" name=\"Signal_Post\" type=\"pole\" s=\"2\" t=\"6.5\" zOffset=\"0\" "
                         "height=\"6.6\" radius=\"0.12\"/></objects><signals>" +
                         signals + "</signals>");
        // Lane 1 of the road leads into the junction, lane -1 of the connecting road over it.
        for (const bool left : {false, true}) {
            if (left && !left_turns) continue;
            const std::string id = "c" + std::to_string(number++);
            const int to = left ? (i + 3) % 4 : (i + 2) % 4;
            const double inward = heading + kPi, length = left ? kHalf * kPi / 2 : 2 * kHalf;
            text += road(
                id, length,
                geometry(0, x, y, inward, length, left ? "<arc" + quantity("curvature", 1 / kHalf) + "/>" : "<line/>"),
                "<laneSection s=\"0\"><center><lane id=\"0\"/></center><right>" +
                    lane(-1, 3.5, "driving", "<link><predecessor id=\"1\"/><successor id=\"-1\"/></link>") +
                    "</right></laneSection>",
                "<link>" + link("predecessor", "road", kNames[size_t(i)]) +
                    link("successor", "road", kNames[size_t(to)]) + "</link>",
                "junction=\"J\"");
            connections += "<connection id=\"" + id + "\" incomingRoad=\"" + kNames[size_t(i)] +
                           "\" connectingRoad=\"" + id +
                           "\" contactPoint=\"start\"><laneLink from=\"1\" to=\"-1\"/>"
                           "</connection>";
        }
    }
    return text + "<junction id=\"J\" name=\"J\">" + connections + "</junction>\n";
}

}  // namespace vesper::test
