// `vesper inspect` as people run it; needs no device. SPDX-License-Identifier: MIT
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>

#include <nlohmann/json.hpp>

#include "io/hdr_image.h"
#include "io/image_file.h"
#include "io/read_file.h"
#include "places.h"
#include "scene/scene_files.h"

namespace vesper::test {
namespace {

const std::string kOwnData = VESPER_SOURCE_DIR "/data/";

class Inspect : public testing::Test {
protected:
    TempFolder folder;
    std::string printed, said;

    int inspect(const std::string& arguments, const std::string& environment = "") {
        const std::string command = "cd " + folder.path().string() + " && " + environment +
                                    " " VESPER_PROGRAM " inspect " + arguments + " >out.txt 2>err.txt";
        const int status = std::system(command.c_str());
        printed = read_text(folder / "out.txt");
        said = read_text(folder / "err.txt");
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    nlohmann::json json(const std::string& file) const { return nlohmann::json::parse(read_text(folder / file)); }
    Image picture(const std::string& file) const {
        return io::decode_image(io::read_file(folder / file, 1u << 26), 8192);
    }
    bool prints(const std::string& part) const { return printed.find(part) != std::string::npos; }

    /// 40 x 20 px, luminance 2 on the left and 8 on the right, a dark, a negative and a missing pixel in the first row.
    void write_picture(double white) {
        io::HdrImage image{.width = 40, .height = 20, .white_luminance = white};
        for (uint32_t i = 0; i < 800; ++i) image.rgb.insert(image.rgb.end(), 3, i % 40 < 20 ? 2.0f : 8.0f);
        const float odd[] = {0, -1, std::numeric_limits<float>::quiet_NaN()};
        for (size_t i = 0; i < 3; ++i) std::fill_n(image.rgb.begin() + static_cast<ptrdiff_t>(3 * i), 3, odd[i]);
        image.rgb[3 * 45] = 4, image.rgb[3 * 45 + 1] = 1, image.rgb[3 * 45 + 2] = 0;
        io::write_exr(folder / "a.exr", image);
    }
};

// Rules of photometry go by names: of a kind some are printed, in order, and how many there are.
TEST_F(Inspect, NamesOfAScene) {
    nlohmann::json file = {{"asset", {{"version", "2.0"}}}};
    for (int i = 39; i >= 0; --i)
        file["nodes"].push_back({{"name", "pole " + std::string(1, char('0' + i / 10)) + char('0' + i % 10)}});
    file["nodes"].push_back({{"name", "pole 07"}});
    file["nodes"].push_back(nlohmann::json::object());
    file["materials"] = {{{"name", "wall"}}, {{"name", "asphalt"}}};
    folder.write("s.gltf", file.dump());
    ASSERT_EQ(inspect("s.gltf --json a.json"), 0) << said;
    EXPECT_TRUE(prints("nodes: 42, of 40 names: pole 00, pole 01, ")) << printed;
    EXPECT_TRUE(prints("pole 07 (2), ")) << printed;
    EXPECT_TRUE(prints("pole 29, ... and 10 more (--json has the first 40)")) << printed;
    EXPECT_TRUE(prints("materials: 2, of 2 names: asphalt, wall\n")) << printed;
    EXPECT_TRUE(prints("pictures: 0, of 0 names\n")) << printed;
    const auto names = json("a.json")["names"];
    EXPECT_EQ(names["nodes"].size(), 40u);
    EXPECT_EQ(names["nodes"][7], (nlohmann::json{{"name", "pole 07"}, {"number", 2}}));
    EXPECT_EQ(names["materials"][0]["name"], "asphalt");
    EXPECT_EQ(names["left_out"], 0);
}

TEST_F(Inspect, Roads) {
    ASSERT_EQ(inspect(kOwnData + "rivoli/rivoli.xodr --json a.json"), 0) << said;
    EXPECT_TRUE(prints("rivoli.xodr\n  roads: 1, 440 m, ")) << printed;
    EXPECT_TRUE(prints("\nstreet lamp  ")) << printed;
    EXPECT_EQ(json("a.json")["lamps"][0]["number"], 30);
    EXPECT_EQ(json("a.json")["parts"][1], "street lamps: 30, every 30 m");
    EXPECT_EQ(inspect(kOwnData + "rivoli/rivoli.xodr -o a.png"), 2);
    EXPECT_EQ(inspect(kOwnData + "rivoli/rivoli.xodr --balance"), 2);
}

TEST_F(Inspect, AScene) {
    ASSERT_EQ(inspect(kOwnData + "rivoli/rivoli.gltf --json a.json"), 0) << said;
    EXPECT_TRUE(prints("lx from the sky are no night")) << printed;
    const auto day = json("a.json");
    EXPECT_EQ(day["kind"], "scene");
    EXPECT_GT(day["triangles"].get<int>(), 100000);
    EXPECT_FALSE(day["implausible"].empty());
    folder.write("p.json",
                 R"({"version": 1, "lamps": [{"name": "lantern", "nodes": "street_lamp_*/light", "type": "point",
        "intensity_cd": 1000, "colour_temperature_K": 2700}]})");
    ASSERT_EQ(std::system((std::string(VESPER_PROGRAM) + " convert " + kOwnData + "rivoli/rivoli.gltf -p " +
                           (folder / "p.json").string() + " -o " + (folder / "n.gltf").string() + " >/dev/null 2>&1")
                              .c_str()),
              0);
    ASSERT_EQ(inspect("n.gltf --json b.json"), 0) << said;
    const auto night = json("b.json");
    const auto lamp = night["lamps"].at(0);
    EXPECT_EQ(lamp["name"], "lantern");
    EXPECT_NEAR(lamp["intensity_cd"].get<double>(), 1000, 0.1);
    EXPECT_NEAR(lamp["luminous_flux_lm"].get<double>(), 12566, 2);
    EXPECT_NEAR(lamp["colour_temperature_K"].get<double>(), 2700, 60);
    EXPECT_NEAR(lamp["height_m"].at(0).get<double>(), 6.54, 0.1);
    EXPECT_EQ(lamp["fixture"]["rule"], "own");
    EXPECT_GE(lamp["fixture"]["meshes"].at(0).get<int>(), 1);
    EXPECT_NEAR(night["luminous_flux_lm"].get<double>(), 12566 * lamp["number"].get<double>(), 200);
}

// Names of others in a table: no control characters, and one line for each.
TEST_F(Inspect, NamesAreShownAsText) {
    const std::string name = "a\x1b[31m\nb";
    GltfFile file;
    file.root["materials"] = {{{"name", name}}};
    file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}}}, {"material", 0}},
              {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
    file.root["nodes"].push_back({{"camera", 0}});
    file.root["cameras"] = {{{"type", "perspective"}, {"name", name}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"name", name}},
                                                                {{"type", "directional"}, {"name", name}}};
    folder.write("a.gltf", file.text());
    ASSERT_EQ(inspect("a.gltf --json a.json"), 0) << said;
    EXPECT_EQ(printed.find('\x1b'), std::string::npos) << printed;
    EXPECT_EQ(printed.find("\nb"), std::string::npos) << printed;
    EXPECT_EQ(json("a.json")["materials"][0]["name"], name);
    EXPECT_EQ(json("a.json")["cameras"][0], name);
}

/// A scene of three kinds of names, a light of the file, and what no rule is for.
std::string scene_of_names() {
    GltfFile file;
    for (int i = 1; i <= 40; ++i)
        file.root["nodes"].push_back({{"name", "street_lamp_" + std::to_string(i)}, {"translation", {i, 6, 0}}});
    file.root["nodes"].push_back({{"name", "Scheinwerfer.L"}});
    file.root["nodes"].push_back({{"name", "signal_1/green"}});
    file.root["nodes"].push_back({{"name", "wall"}});
    const nlohmann::json light = {{"KHR_lights_punctual", {{"light", 0}}}};
    file.root["nodes"].push_back({{"name", "Empty"}, {"extensions", light}});
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 70}}};
    file.root["materials"] = {{{"name", "panel"}, {"emissiveFactor", {1, 1, 1}}}};
    file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}}}, {"material", 0}}, {{"name", "board"}});
    return file.text();
}

TEST_F(Inspect, APhotometryTemplate) {
    folder.write("a.gltf", scene_of_names());
    ASSERT_EQ(inspect("a.gltf --photometry-template p.json --json a.json"), 0) << said;
    EXPECT_TRUE(prints("a.gltf: rules for lamps: 4, for emitters: 1\n")) << printed;
    EXPECT_TRUE(prints("by light of the file  rules: 1, nodes or materials: 1\n")) << printed;
    EXPECT_TRUE(prints("by name               rules: 3, nodes or materials: 42\n")) << printed;
    EXPECT_TRUE(prints("wrote p.json\n")) << printed;
    const auto report = json("a.json"), rules = json("p.json");
    EXPECT_EQ(report["kind"], "photometry template");
    EXPECT_EQ(report["lamp_rules"], 4);
    EXPECT_EQ(report["reasons"][1], (nlohmann::json{{"reason", "emission"}, {"rules", 1}, {"sources", 1}}));
    EXPECT_EQ(report["left_out"], (nlohmann::json{{"rules", 0}, {"sources", 0}}));
    EXPECT_EQ(rules["lamps"][0]["nodes"], "street_lamp_*");
    std::set<std::string> names;
    for (const auto& rule : rules["lamps"]) names.insert(rule["name"]);
    EXPECT_EQ(names, (std::set<std::string>{"street lamp", "headlamp", "green signal", "lamp"}));

    const std::string convert = std::string(VESPER_PROGRAM) + " convert a.gltf -p p.json -o n.gltf >convert.txt 2>&1";
    ASSERT_EQ(std::system(("cd " + folder.path().string() + " && " + convert).c_str()), 0);
    const std::string applied = read_text(folder / "convert.txt");
    EXPECT_TRUE(contains(applied, "lamp 'street lamp': 40 nodes, 'street-lamp', 5168 cd at most")) << applied;
    EXPECT_FALSE(contains(applied, "matches")) << applied;
    EXPECT_FALSE(contains(applied, "warning")) << applied;
}

// Lamps below a common root all get rules; what gets none is counted.
TEST_F(Inspect, ATemplateCountsWhatItLeavesOut) {
    GltfFile file;
    const nlohmann::json off = {{"KHR_lights_punctual", {{"light", 0}}}};
    file.root["nodes"] = {{{"name", "Scene"}, {"children", {1, 2, 3, 4, 5}}},
                          {{"name", "lamp_post_01"}, {"translation", {100, 5, 0}}},
                          {{"name", "lamp_post_02"}, {"translation", {140, 5, 0}}},
                          {{"name", "lamp_wall_01"}, {"translation", {180, 5, 0}}},
                          {{"name", "lamp_shade_01"}, {"translation", {180, 5, 0}}},
                          {{"name", "off"}, {"extensions", off}}};
    file.root["scenes"] = {{{"nodes", {0}}}};
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 70}, {"color", {0, 0, 0}}}};
    folder.write("a.gltf", file.text());
    ASSERT_EQ(inspect("a.gltf --photometry-template p.json --json a.json"), 0) << said;
    EXPECT_TRUE(prints("by name               rules: 2, nodes or materials: 3\n")) << printed;
    EXPECT_TRUE(prints("lights that are black or of 0 cd, without a rule: 1\n")) << printed;
    EXPECT_TRUE(prints("parts of lamps, which have the rule of their lamp: 1\n")) << printed;
    EXPECT_EQ(json("a.json")["parts_of_lamps"], 1);
    EXPECT_EQ(json("a.json")["dark_lights"], 1);
}

TEST_F(Inspect, ATemplateReplacesNothing) {
    folder.write("a.gltf", scene_of_names());
    folder.write("p.json", "mine");
    const auto refuses = [&](const std::string& arguments, const std::string& reason) {
        EXPECT_EQ(inspect(arguments), 2) << arguments;
        EXPECT_TRUE(contains(said, reason)) << said;
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    };
    refuses("a.gltf --photometry-template p.json", "--photometry-template p.json: is there already");
    EXPECT_EQ(read_text(folder / "p.json"), "mine");
    refuses("a.gltf --photometry-template a.gltf", "would replace what is read");
    refuses("a.gltf --photometry-template b.json --json b.json", "would be written twice");
    refuses("a.gltf --photometry-template none/b.json", "there is no folder none");
    refuses("a.gltf --photometry-template b.json --balance", "ask for one of them");
    refuses(kOwnData + "rivoli/rivoli.xodr --photometry-template b.json", "--photometry-template is for scenes");
    folder.write("bad.gltf", "{");
    refuses("bad.gltf --photometry-template b.json", "bad.gltf");
    folder.write("q.json", R"({"version": 1})");
    ASSERT_EQ(std::system(("cd " + folder.path().string() +
                           " && " VESPER_PROGRAM " convert a.gltf -p q.json -o n.gltf >convert.txt 2>&1")
                              .c_str()),
              0);
    refuses("n.gltf --photometry-template b.json", "n.gltf: has its photometry already");
    EXPECT_FALSE(std::filesystem::exists(folder / "b.json"));
}

// The scenes that are here light up with their templates as they are, without a word about their rules.
TEST_F(Inspect, TemplatesOfOwnScenes) {
    for (const auto& [scene, lamps, emitters] : {std::tuple{"rivoli/rivoli", 10, 13}, {"photometry/yard", 3, 0}}) {
        const std::string file = kOwnData + scene + ".gltf";
        ASSERT_EQ(inspect(file + " --json a.json --photometry-template " + std::to_string(emitters) + ".json"), 0)
            << said;
        EXPECT_EQ(json("a.json")["lamp_rules"], lamps);
        EXPECT_EQ(json("a.json")["emitter_rules"], emitters);
        const std::string convert =
            " convert " + file + " -p " + std::to_string(emitters) + ".json -o n.glb >c.txt 2>&1";
        ASSERT_EQ(std::system(("cd " + folder.path().string() + " && " VESPER_PROGRAM + convert).c_str()), 0);
        const std::string applied = read_text(folder / "c.txt");
        EXPECT_FALSE(contains(applied, "warning: lamp")) << applied;
        EXPECT_FALSE(contains(applied, "warning: emitter")) << applied;
        EXPECT_FALSE(contains(applied, "sounds like")) << applied;
    }
}

/// A lamp 3 m over a plate of 2 m, 1 m above a wide floor; and one that shines to all sides.
struct LampOverPlate {
    GltfFile file;
    LampOverPlate() {
        const auto square = [&](float half) {
            return nlohmann::json{
                {"attributes",
                 {{"POSITION", file.vec3({-half, 0, -half, half, 0, -half, half, 0, half, -half, 0, half})}}},
                {"indices", file.indices({0, 2, 1, 0, 3, 2})}};
        };
        file.show(square(1), {{"name", "plate"}, {"translation", {0, 1, 0}}});
        file.show(square(40), {{"name", "floor"}});
        const nlohmann::json down = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
        const auto light = [](int index) { return nlohmann::json{{"KHR_lights_punctual", {{"light", index}}}}; };
        file.root["nodes"].push_back(
            {{"name", "spot"}, {"translation", {0, 4, 0}}, {"rotation", down}, {"extensions", light(0)}});
        file.root["nodes"].push_back({{"name", "all"}, {"translation", {10, 2, 0}}, {"extensions", light(1)}});
        file.root["nodes"].push_back({{"name", "sun"}, {"extensions", light(2)}});
        file.root["extensionsUsed"] = {"KHR_lights_punctual"};
        file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
            {{"type", "spot"}, {"name", "lamp 1"}, {"intensity", 100}, {"spot", {{"outerConeAngle", 1.2}}}},
            {{"type", "point"}, {"name", "lamp 2"}, {"intensity", 100}},
            {{"type", "directional"}, {"name", "sun"}, {"intensity", 1}}};
    }
};

TEST_F(Inspect, WhatALampSees) {
    folder.write("a.gltf", LampOverPlate().file.text());
    ASSERT_EQ(inspect("a.gltf --lamp spot -o spot.png --json a.json"), 0) << said;
    EXPECT_TRUE(prints("lamp 'lamp 1' at node 'spot' (1 of 1 of this name)")) << printed;
    EXPECT_TRUE(prints("512 x 512 texels, one hemisphere")) << printed;
    const auto spot = json("a.json");
    EXPECT_EQ(spot["kind"], "shadow map");
    const auto axis = spot["directions"].at(0);
    EXPECT_NEAR(axis["distance_m"].get<double>(), 3, 0.01);
    EXPECT_NEAR(axis["world"].at(1).get<double>(), -1, 1e-6);
    EXPECT_NEAR(spot["surfaces_m"].at(0).get<double>(), 3, 0.01);
    EXPECT_EQ(spot["fixture_meshes"], 0);
    // Beside the plate the floor; the cone of 1.2 rad sees it 4 m below, everywhere.
    const auto corner = spot["directions"].at(1);
    EXPECT_NEAR(corner["distance_m"].get<double>(), 4 / -corner["world"].at(1).get<double>(), 0.3);
    EXPECT_LT(corner["world"].at(2).get<double>(), -0.5) << "+Y of the lamp is -Z of the world";
    const Image one = picture("spot.png");
    EXPECT_GT(one.width, 512u + 90);
    EXPECT_GT(one.height, 512u);

    ASSERT_EQ(inspect("a.gltf --lamp 'lamp ?' --lamp-number 2 -o all.png --json b.json"), 0) << said;
    EXPECT_TRUE(prints("at node 'all' (2 of 2 of this name)")) << printed;
    const auto all = json("b.json");
    EXPECT_EQ(all["hemispheres"], 2);
    EXPECT_TRUE(all["directions"].at(0)["distance_m"].is_null()) << "nothing along the axis, which is level";
    EXPECT_NEAR(all["nothing"].get<double>(), 0.5, 0.06) << "the floor ends";
    EXPECT_EQ(picture("all.png").width, one.width + 512 + 16);
    EXPECT_EQ(picture("all.png").height, one.height);
}

TEST_F(Inspect, LightByItsOrigin) {
    folder.write("a.gltf", LampOverPlate().file.text());
    ASSERT_EQ(inspect("a.gltf --at 0,1,0 --at 0,0,0 --paths 4096 --json a.json"), 0) << said;
    EXPECT_TRUE(prints("at (0, 1, 0) m, facing (0, 1, 0)") && prints("lamps, directly")) << printed;
    const auto points = json("a.json")["light"];
    ASSERT_EQ(points.size(), 2u);
    const auto &over = points[0]["illuminance_lx"], &under = points[1]["illuminance_lx"];
    EXPECT_NEAR(over["lamps"].get<double>(), 100 / 9.0 + 100 / std::pow(101, 1.5), 1e-3);
    EXPECT_NEAR(under["lamps"].get<double>(), 200 / std::pow(104, 1.5), 1e-3) << "under the plate the other lamp alone";
    EXPECT_GT(under["reflected_more_often"].get<double>(), 0.1) << "between plate and floor";
    EXPECT_EQ(over["emitters"].get<double>() + over["sky"].get<double>(), 0);
    double sum = 0;
    for (const char* origin : {"lamps", "emitters", "sky", "reflected_once", "reflected_more_often"})
        sum += under[origin].get<double>();
    EXPECT_NEAR(under["sum"].get<double>(), sum, 1e-9);

    ASSERT_EQ(inspect("a.gltf --at 5,3,0 --normal=-2,0,0 --json b.json"), 0) << said;
    const auto wall = json("b.json")["light"][0];
    EXPECT_EQ(wall["normal"], (nlohmann::json{-1, 0, 0}));
    EXPECT_NEAR(wall["illuminance_lx"]["lamps"].get<double>(), 0, 1e-9) << "beyond the cone, and behind";
}

// Lamps over a floor: what surfaces absorb and the sky gets is what they emit. 5 %: noise of some cells.
TEST_F(Inspect, TheBalanceOfAScene) {
    folder.write("a.gltf", LampOverPlate().file.text());
    ASSERT_EQ(inspect("a.gltf --balance --json a.json"), 0) << said;
    EXPECT_TRUE(prints("emitted by lamps")) << printed;
    const auto flux = json("a.json")["flux_lm"];
    EXPECT_GT(flux["lamps"], 0);
    EXPECT_NEAR(flux["found"].get<double>() / flux["emitted"].get<double>(), 1, 0.05) << flux;
}

TEST_F(Inspect, RefusesPointsThatAreNone) {
    folder.write("a.gltf", LampOverPlate().file.text());
    const auto refuses = [&](const std::string& arguments, const std::string& reason) {
        EXPECT_EQ(inspect(arguments), 2) << arguments;
        EXPECT_TRUE(contains(said, reason)) << said;
    };
    for (const char* point : {"1,2", "1,2,3,4", "1,2,x", "nan,0,0", "1e300,0,0", "1;2;3"})
        refuses(std::string("a.gltf --at '") + point + "'", "expected X,Y,Z");
    refuses("a.gltf --at 0,0,0 --normal 0,0,0", "has no direction");
    refuses("a.gltf --normal 0,1,0", "only beside --at");
    refuses("a.gltf --paths 100", "only beside --at");
    refuses("a.gltf --at 0,0,0 --paths 1", "--paths");
    refuses("a.gltf --at 0,0,0 --lamp spot", "ask for one of them");
    refuses("a.gltf --at 0,0,0 --balance", "ask for one of them");
    refuses(kOwnData + "road/luminaire.ldt --balance", "--balance is for scenes");
    refuses("a.gltf --at 0,0,0 -o a.png", "-o a.png");
    refuses(kOwnData + "road/luminaire.ldt --at 0,0,0", "--at is for scenes");
}

TEST_F(Inspect, RefusesLampsThatHaveNoMap) {
    folder.write("a.gltf", LampOverPlate().file.text());
    const auto refuses = [&](const std::string& arguments, const std::string& reason) {
        EXPECT_EQ(inspect(arguments), 2) << arguments;
        EXPECT_TRUE(contains(said, reason)) << said;
    };
    refuses("a.gltf --lamp lantern", "no lamp, and no node with a lamp, is named 'lantern'");
    refuses("a.gltf --lamp spot --lamp-number 2", "--lamp-number 2: 1 lamp is named 'spot'");
    refuses("a.gltf --lamp sun", "lamp 'sun' has no shadow map: it is directional");
    refuses("a.gltf -o a.png", "with --lamp");
    refuses("a.gltf --lamp-number 2", "only beside --lamp");
    refuses("a.gltf --device cpu", "only beside --lamp");
    refuses(kOwnData + "road/luminaire.ldt --lamp x", "--lamp is for scenes");
}

TEST_F(Inspect, ASourceThatIsAPicture) {
    io::HdrImage image{.width = 2, .height = 1, .rgb = {100, 100, 100, 700, 700, 700}, .white_luminance = 1};
    io::write_exr(folder / "sign.exr", image);
    GltfFile file;
    file.root["materials"] = {{{"name", "sign"}}};
    file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}, {"TEXCOORD_0", file.vec2({0, 0, 1, 0, 0, 1})}}},
               {"material", 0}});
    folder.write("a.gltf", file.text());
    folder.write("p.json", R"({"version": 1, "emitters": [{"materials": "sign", "image": "sign.exr", "scale": 2}]})");
    const std::string convert = std::string(VESPER_PROGRAM) + " convert a.gltf -p p.json -o n.glb >convert.txt 2>&1";
    ASSERT_EQ(std::system(("cd " + folder.path().string() + " && " + convert).c_str()), 0);
    EXPECT_TRUE(contains(read_text(folder / "convert.txt"),
                         "picture 'sign.exr' of 2 x 1 px, 800 cd/m^2 in the mean, 1400 at most"));
    ASSERT_EQ(inspect("n.glb --json a.json"), 0) << said;
    EXPECT_TRUE(prints("1400  sign.exr, mean 800")) << printed;
    const auto sign = json("a.json")["materials"].at(0);
    EXPECT_NEAR(sign["emission_cd_m2"].get<double>(), 1400, 1e-3);
    EXPECT_EQ(sign["emission_picture"]["name"], "sign.exr");
    EXPECT_NEAR(sign["emission_picture"]["mean_cd_m2"].get<double>(), 800, 1e-3);
}

TEST_F(Inspect, ALuminaire) {
    ASSERT_EQ(inspect(kOwnData + "road/luminaire.ldt -o a.png --json a.json"), 0) << said;
    EXPECT_TRUE(prints("8803.1 lm, 88.0 % of the lamps' 10000 lm") && prints("4255 cd at C 15, gamma 65") &&
                prints("G*2"))
        << printed;
    EXPECT_NEAR(json("a.json")["output_ratio"].get<double>(), 0.8803, 1e-4);
    const Image drawn = picture("a.png");
    EXPECT_EQ(drawn.width, 1360u);
    std::set<uint32_t> colours;
    for (size_t i = 0; i < drawn.rgba.size(); i += 4)
        colours.insert(drawn.rgba[i] << 16 | drawn.rgba[i + 1] << 8 | drawn.rgba[i + 2]);
    EXPECT_GT(colours.size(), 500u);
}

TEST_F(Inspect, AHeadlampAndAnRTable) {
    ASSERT_EQ(inspect(kOwnData + "photometry/low-beam.csv -o a.png"), 0) << said;
    EXPECT_TRUE(prints("type A") && prints("B50L") && !prints("missed")) << printed;
    ASSERT_EQ(inspect(kOwnData + "photometry/high-beam.csv"), 0);
    EXPECT_TRUE(prints("missed")) << printed;
    ASSERT_EQ(inspect(kOwnData + "road/R3.csv"), 0);
    EXPECT_TRUE(prints("0.07 stated") && prints("S1 1.109")) << printed;
}

TEST_F(Inspect, APicture) {
    write_picture(1);
    ASSERT_EQ(inspect("a.exr --probe 5,1 --probe 39,19 -o a.png --json a.json --contours"), 0) << said;
    EXPECT_TRUE(prints("luminance, cd/m^2")) << printed;
    auto found = json("a.json");
    EXPECT_TRUE(found["absolute"].get<bool>());
    EXPECT_EQ(found["luminance"]["non_finite_pixels"], 1);
    EXPECT_EQ(found["luminance"]["negative_pixels"], 1);
    EXPECT_EQ(found["luminance"]["zero_pixels"], 1);
    EXPECT_NEAR(found["probes"][0]["luminance"].get<double>(), 4 * 0.212639 + 0.715169, 1e-5);
    EXPECT_NEAR(found["probes"][1]["chromaticity"][0].get<double>(), 0.3127, 1e-3);  // D65
    EXPECT_NEAR(found["probes"][1]["chromaticity"][1].get<double>(), 0.3290, 1e-3);
    // Twice the unit is twice the luminance.
    write_picture(2);
    ASSERT_EQ(inspect("a.exr --probe 39,19 --json a.json"), 0);
    EXPECT_NEAR(json("a.json")["probes"][0]["luminance"].get<double>(), 16, 1e-4);
    write_picture(0);
    ASSERT_EQ(inspect("a.exr"), 0);
    EXPECT_TRUE(prints("relative (the header names no unit)")) << printed;
    // The two halves have two colours, in the order of the map.
    ASSERT_EQ(inspect("a.exr --low 1 --high 10 -o b.png"), 0) << said;
    const Image drawn = picture("b.png");
    const auto pixel = [&](uint32_t x, uint32_t y) { return &drawn.rgba[4 * (size_t{y} * drawn.width + x)]; };
    EXPECT_GT(pixel(16 + 480, 200)[1], pixel(16 + 160, 200)[1] + 50);
    EXPECT_TRUE(pixel(20, 44)[0] == 0 && pixel(20, 44)[1] == 0);                // a pixel of 0
    EXPECT_TRUE(pixel(16 + 40, 44)[0] == 255 && pixel(16 + 40, 44)[2] == 255);  // one that is no number
}

TEST_F(Inspect, DrawsWithoutFonts) {
    write_picture(1);
    folder.write("fonts.conf",
                 "<?xml version=\"1.0\"?><!DOCTYPE fontconfig SYSTEM \"fonts.dtd\"><fontconfig></fontconfig>");
    ASSERT_EQ(inspect("a.exr -o a.png", "FONTCONFIG_FILE=" + (folder / "fonts.conf").string()), 0) << said;
    EXPECT_GT(picture("a.png").width, 600u);
}

TEST_F(Inspect, RefusesInOneLine) {
    write_picture(1);
    folder.write("bad.exr", "\x76\x2f\x31\x01 not really");
    folder.write("bad.gltf", "{");
    folder.write("a.txt", "text");
    for (const char* arguments :
         {"", "none.gltf", "none.exr", "none.csv", "bad.exr", "bad.gltf", "a.txt", "a.exr --probe 40,0",
          "a.exr --probe 1,2,3", "a.exr --probe x", "a.exr --probe=-1,0", "a.exr -o a.jpg", "a.exr -o none/a.png",
          "a.exr --json none/a.json", "a.exr --low 5 --high 1 -o a.png", "a.exr --low nan -o a.png",
          "'" VESPER_SOURCE_DIR "/data/road/R3.csv' -o a.png",
          "'" VESPER_SOURCE_DIR "/data/road/luminaire.ldt' --probe 1,1",
          "'" VESPER_SOURCE_DIR "/data/road/luminaire.ldt' --contours"}) {
        EXPECT_EQ(inspect(arguments), 2) << arguments;
        EXPECT_TRUE(said.starts_with("vesper: ")) << arguments << ": " << said;
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << arguments << ": " << said;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
    EXPECT_EQ(inspect("--help"), 0);
    EXPECT_TRUE(prints("Examples"));
}

}  // namespace
}  // namespace vesper::test
