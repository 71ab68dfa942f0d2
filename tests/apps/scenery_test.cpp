// What goes with the car, and how it stands on it. SPDX-License-Identifier: MIT
#include "session/scenery.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/luminance.h"
#include "scene/scene_files.h"
#include "session/session.h"
#include "traffic/world.h"

namespace vesper::test {
namespace {

constexpr VkExtent2D kScenerySize{80, 50};

// A plain with a camera that looks west and slightly down from a lorry, two headlamps and a mount with a third below
// it, a lamp beside it.
GltfFile plain_with_headlamps() {
    GltfFile file;
    const std::vector<float> square = {-1e4f, 0, 1e4f, 1e4f, 0, 1e4f, 1e4f, 0, -1e4f, -1e4f, 0, -1e4f};
    file.show({{"attributes", {{"POSITION", file.vec3(square)}}}, {"indices", file.indices({0, 1, 2, 0, 2, 3})}},
              {{"name", "plain"}});
    const auto lamp = [](const char* name, double x, double y) {
        return nlohmann::json{
            {"name", name}, {"translation", {x, y, -0.5}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}};
    };
    const glm::dquat look = glm::angleAxis(glm::radians(90.0), glm::dvec3(0, 1, 0)) *
                            glm::angleAxis(glm::radians(-5.0), glm::dvec3(1, 0, 0));
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"intensity", 20000}, {"spot", {{"outerConeAngle", 0.3}}}}};
    file.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
    auto& nodes = file.root["nodes"];
    nodes.push_back({{"name", "eye"},
                     {"camera", 0},
                     {"translation", {30, 2.4, 7}},
                     {"rotation", {look.x, look.y, look.z, look.w}},
                     {"children", {2, 3, 4}}});
    nodes.push_back(lamp("left", -0.6, -1.5));
    nodes.push_back(lamp("right", 0.6, -1.5));
    nodes.push_back({{"name", "mount"}, {"translation", {0, 0.5, 0}}, {"children", {5}}});
    nodes.push_back(lamp("roof lamp", 0, 0));
    nodes.push_back(lamp("street lamp", 25, 6));
    file.root["scenes"] = {{{"nodes", {0, 1, 6}}}};
    file.root["scene"] = 0;
    return file;
}

uint32_t node_of(const scene::Scene& scene, const std::string& name) {
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].name == name) return i;
    ADD_FAILURE() << "no node " << name;
    return 0;
}

double largest_difference(const glm::dmat4& a, const glm::dmat4& b) {
    double most = 0;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) most = std::max(most, std::abs(a[c][r] - b[c][r]));
    return most;
}

TEST(Scenery, LampsBelowTheCameraOfASceneGoWithTheCar) {
    const TempFolder folder;
    const drive::Scenery scenery(folder.write("s.gltf", plain_with_headlamps().text()));
    const std::vector<glm::dmat4> rest = scene::world_transforms(scenery.scene(), 0);
    traffic::World world(scenery.world(), 1);
    const drive::DriveSettings settings;
    const auto eye = [&] {
        return glm::dmat4(scenery.view(scenery.frame(world.actors(), settings), world.actors(), settings, kScenerySize)
                              .world_to_view);
    };
    // To the driver's eye, which looks level, all that is below the camera stands as the file has it, at the start and
    // when the car has turned. The view is of floats: 30 m to 2e-6.
    const glm::dvec3 place(rest[node_of(scenery.scene(), "eye")][3]);
    const glm::dmat4 level =
        glm::inverse(glm::rotate(glm::translate(glm::dmat4(1), place), glm::radians(90.0), {0, 1, 0}));
    const auto expect_along = [&] {
        const gpu_scene::SceneFrame frame = scenery.frame(world.actors(), settings);
        for (const char* name : {"eye", "left", "right", "mount", "roof lamp"}) {
            const uint32_t node = node_of(scenery.scene(), name);
            EXPECT_LT(largest_difference(eye() * frame.world[node], level * rest[node]), 1e-4) << name;
        }
        return frame;
    };
    expect_along();
    for (int i = 0; i < 240; ++i) world.step({.steering = 0.2, .throttle = 0.6}, 1.0 / 60);
    ASSERT_GT(std::abs(world.driver().yaw - glm::radians(90.0)), 0.1) << "it has turned";
    const gpu_scene::SceneFrame after = expect_along();
    EXPECT_GT(glm::distance(glm::dvec3(after.world[node_of(scenery.scene(), "left")][3]), place), 5);
    for (const char* name : {"street lamp", "plain"})
        EXPECT_EQ(after.world[node_of(scenery.scene(), name)], rest[node_of(scenery.scene(), name)]) << name;
}

// The road before the car is lit after a minute as it was at the start: by nothing else, on this plain.
TEST(Scenery, HeadlampsOfASceneLightTheRoadAhead) {
    const TempFolder folder;
    gpu::Device device({.select = ""});
    drive::Session session(device, {.scene = folder.write("s.gltf", plain_with_headlamps().text()),
                                    .settings = {{"lamp:street lamp", "0"}}});
    const auto mean = [&] {
        const render::Frame frame = session.render(kScenerySize, {.display = false, .scene = true});
        double sum = 0;
        for (size_t i = 0; i < frame.scene.size(); i += 4)
            sum += luminance(glm::dvec3(frame.scene[i], frame.scene[i + 1], frame.scene[i + 2]));
        return sum / double(frame.scene.size() / 4);
    };
    const double start = mean();
    EXPECT_GT(start, 0.1);
    for (int i = 0; i < 3600; ++i) session.step({.autopilot = true});
    EXPECT_GT(session.world().driver().position.x, -2000);
    EXPECT_LT(session.world().driver().position.x, -500);
    EXPECT_NEAR(mean(), start, 0.05 * start);  // the car may still lean back a little
}

// A model of which any side is the front: that side leads, whatever way the lane goes, and what it carries turns with
// it.
TEST(Scenery, TheFrontOfANodeLeads) {
    const TempFolder folder;
    folder.write("s.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 2, 3]}], "nodes": [
        {"name": "me", "children": [1], "scale": [2, 2, 2], "translation": [5, 0, 5]}, {"name": "badge", "translation": [0.25, 0.5, 1]},
        {"name": "van"}, {"name": "walker"}]})");
    const auto world = [&](const std::string& front) {
        return folder.write("w.json", R"({"version": 1, "scene": "s.gltf", "driver": {"node": "me", "lane": "a")" +
                                          front + R"(}, "lanes": [{"name": "a", "points": [[0, 0, 0], [300, 0, 400]]}],
            "paths": [{"name": "p", "points": [[0, 0, 50], [9, 0, 50]]}], "cars": [{"node": "van", "lane": "a", "at_m": 30)" +
                                          front + R"(}], "walkers": [{"node": "walker", "path": "p")" + front + "}]}");
    };
    const glm::dvec3 lane(0.6, 0, 0.8), path(1, 0, 0);
    const std::map<std::string, glm::dvec3> sides{{"", {0, 0, -1}},
                                                  {R"(, "front": "-z")", {0, 0, -1}},
                                                  {R"(, "front": "+z")", {0, 0, 1}},
                                                  {R"(, "front": "+x")", {1, 0, 0}},
                                                  {R"(, "front": "-x")", {-1, 0, 0}}};
    for (const auto& [front, side] : sides) {
        const drive::Scenery scenery(world(front));
        const std::vector<traffic::Actor> actors = traffic::World(scenery.world(), 1).actors();
        const gpu_scene::SceneFrame frame = scenery.frame(actors, drive::DriveSettings());
        const auto leads = [&, side = side](const char* name) {
            return glm::normalize(glm::dvec3(frame.world[node_of(scenery.scene(), name)] * glm::dvec4(side, 0)));
        };
        EXPECT_LT(glm::distance(leads("me"), lane), 1e-9) << front;
        EXPECT_LT(glm::distance(leads("van"), lane), 1e-9) << front;
        EXPECT_LT(glm::distance(leads("walker"), path), 1e-9) << front;
        const glm::dmat4& me = frame.world[node_of(scenery.scene(), "me")];
        EXPECT_LT(glm::distance(glm::dvec3(me[3]), actors.front().position), 1e-9)
            << front << ": it turns about where it stands";
        EXPECT_LT(glm::distance(glm::dvec3(me * glm::dvec4(0.25, 0.5, 1, 1)),
                                glm::dvec3(frame.world[node_of(scenery.scene(), "badge")][3])),
                  1e-9)
            << front;
    }
    for (const char* wrong : {"\"+y\"", "\"z\"", "\"\"", "180", "null"})
        EXPECT_TRUE(contains(complaint_of([&] { drive::Scenery(world(R"(, "front": )" + std::string(wrong))); }),
                             "w.json: /cars/0/front: "))
            << wrong;
    EXPECT_TRUE(contains(complaint_of([&] { drive::Scenery(world(R"(, "front": "+y")")); }),
                         "w.json: /cars/0/front: is none of -z, +z, -x and +x"));
}

TEST(Scenery, AFrontIsThatOfANode) {
    const TempFolder folder;
    const auto file = folder.write("w.json",
                                   R"({"version": 1, "scene": "s.gltf", "driver": {"lane": "a", "front": "+z"},
            "lanes": [{"name": "a", "points": [[0, 0, 0], [0, 0, 9]]}]})");
    EXPECT_TRUE(contains(complaint_of([&] { drive::Scenery scenery(file); }), "w.json: /driver/front: of which node?"));
}

}  // namespace
}  // namespace vesper::test
