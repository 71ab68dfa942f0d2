// Scenes far from the origin, as maps have them, are seen as those beside it. SPDX-License-Identifier: MIT
#include <cmath>

#include "io/hdr_image.h"
#include "scene/scene_files.h"
#include "support/program.h"

namespace vesper::test {
namespace {

class FarScene : public ProgramTest {
protected:
    /// A spot 0.65 m above a road, seen from behind, all of it `away` from the origin.
    std::vector<float> render(glm::dvec3 away) {
        GltfFile scene;
        const auto at = [&](double x, double y, double z) {
            return nlohmann::json{away.x + x, away.y + y, away.z + z};
        };
        scene.show({{"attributes", {{"POSITION", scene.vec3({-30, 0, 30, 30, 0, 30, 30, 0, -30, -30, 0, -30})}}},
                    {"indices", scene.indices({0, 1, 2, 0, 2, 3})},
                    {"material", 0}});
        scene.root["materials"] = {
            {{"pbrMetallicRoughness",
              {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}}}};
        scene.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
        scene.root["extensions"]["KHR_lights_punctual"]["lights"] = {
            {{"type", "spot"}, {"intensity", 1000}, {"spot", {{"outerConeAngle", 0.6}}}}};
        scene.root["extensionsUsed"] = nlohmann::json::array({"KHR_lights_punctual"});
        for (nlohmann::json& node : scene.root["nodes"]) node["translation"] = at(0, 0, 0);
        scene.root["nodes"].push_back(
            {{"translation", at(0, 1.2, 5)}, {"camera", 0}, {"rotation", {-0.0998334, 0, 0, 0.9950042}}});
        scene.root["nodes"].push_back({{"translation", at(0.31, 0.6512, -0.123)},
                                       {"rotation", {-0.0499792, 0, 0, 0.9987503}},
                                       {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        folder.write("s.gltf", scene.text());
        EXPECT_EQ(run("render s.gltf --size 60x60 -o s.exr"), 0) << said;
        return io::read_exr(folder / "s.exr").rgb;
    }
};

TEST_F(FarScene, IsSeenAsNearby) {
    const std::vector<float> near = render({0, 0, 0});
    for (const glm::dvec3 away :
         {glm::dvec3(1e4, 0, 1e4), glm::dvec3(3e4, 50, -4e4), glm::dvec3(447912.3, 35.2, -5411838.7)}) {
        const std::vector<float> far = render(away);
        ASSERT_EQ(far.size(), near.size());
        double lit = 0;
        for (size_t i = 0; i < near.size(); ++i) {
            // A double has 1e-9 m left of 5000 km; what remains are roundings in the view's frame, those of a lamp near
            // the road among them.
            ASSERT_NEAR(far[i], near[i], 2e-4 * double(near[i]) + 1e-5) << i << " of " << away.x;
            lit += double(near[i]);
        }
        EXPECT_GT(lit, 100);
    }
}

}  // namespace
}  // namespace vesper::test
