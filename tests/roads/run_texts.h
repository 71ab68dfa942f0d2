// Tables and scenarios of small runs for tests. SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "roads/esmini_run.h"
#include "scene/scene_files.h"
#include "support/shared_data.h"

namespace vesper::test {
class RunFiles : public testing::Test {
protected:
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    std::string complaint(const std::string& table, const std::string& scenario = "") const {
        const auto csv = write("run.csv", table);
        try {
            roads::read_esmini_run(csv, scenario.empty() ? std::nullopt : std::optional(write("run.xosc", scenario)));
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }
    TempFolder folder_;
};

inline const std::string kHeader = "time, id, name, x, y, z, h, p, r, speed, wheel_angle, wheel_rot\n";

/// A car that goes 10 m/s along x for 10 s, brakes with 2 m/s^2 from 4 s on to 9 s, then reverses.
inline std::string braking_run() {
    std::string text = kHeader;
    double x = 0;
    for (int i = 0; i <= 200; ++i) {
        const double t = i * 0.05, v = t < 4 ? 10 : t < 9 ? 10 - 2 * (t - 4) : t < 9.5 ? 0 : -1;
        char line[200];
        std::snprintf(line, sizeof line, "%.3f, 0, Ego, %.3f, 0.000, 0.000, 0.000, 0.000, 0.000, %.3f, 0.000, 0.000\n",
                      t, x, v);
        text += line;
        x += v * 0.05;
    }
    return text;
}

inline std::string lamp(const char* type, const char* mode, const std::string& more = "",
                        const std::string& of_action = "") {
    return std::string("<PrivateAction><AppearanceAction><LightStateAction ") + of_action +
           "><LightType><VehicleLight vehicleLightType=\"" + type + "\"/></LightType><LightState mode=\"" + mode +
           "\" " + more + "/></LightStateAction></AppearanceAction></PrivateAction>";
}

inline std::string event(const std::string& name, const std::string& actions, const std::string& condition,
                         const std::string& of_condition = "delay=\"0\" conditionEdge=\"none\"") {
    return "<Event name=\"" + name + "\" priority=\"parallel\"><Action name=\"" + name + "Action\">" + actions +
           "</Action><StartTrigger><ConditionGroup><Condition name=\"c\" " + of_condition + ">" + condition +
           "</Condition></ConditionGroup></StartTrigger></Event>";
}

inline std::string at_time(const std::string& value) {
    return "<ByValueCondition><SimulationTimeCondition value=\"" + value +
           "\" rule=\"greaterOrEqual\"/></ByValueCondition>";
}

inline std::string scenario(const std::string& events, const std::string& parameters = "") {
    return "<OpenSCENARIO><ParameterDeclarations>" + parameters +
           "</ParameterDeclarations><RoadNetwork><LogicFile "
           "filepath=\"a.xodr\"/></RoadNetwork><Entities><ScenarioObject name=\"Ego\"><Vehicle name=\"v\" "
           "vehicleCategory=\"truck\"><BoundingBox><Center x=\"1.5\" y=\"0\" "
           "z=\"0.9\"/><Dimensions length=\"8\" width=\"2.5\" "
           "height=\"3\"/></BoundingBox></Vehicle></ScenarioObject></Entities><Storyboard><Init><Actions/></"
           "Init><Story><Act name=\"act\"><ManeuverGroup "
           "name=\"g\"><Actors><EntityRef entityRef=\"Ego\"/></Actors><Maneuver name=\"m\">" +
           events + "</Maneuver></ManeuverGroup></Act></Story></Storyboard></OpenSCENARIO>";
}

inline const std::vector<roads::LampEvent>& events_of(const roads::EsminiRun& run, roads::RunLamp lamp,
                                                      size_t entity = 0) {
    return run.entities[entity].lamps[static_cast<size_t>(lamp)];
}

}  // namespace vesper::test
