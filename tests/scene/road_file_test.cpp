// Road layouts from JSON, the scene of a road, reflection tables through a conversion. SPDX-License-Identifier: MIT
#include "scene/road_file.h"

#include <cmath>
#include <numbers>

#include "places.h"
#include "scene/colour.h"
#include "scene/convert.h"
#include "scene/road_scene.h"
#include "scene/scene_files.h"

namespace vesper::test {
namespace {

using nlohmann::json;
const std::filesystem::path kRoads = std::filesystem::path(VESPER_SOURCE_DIR) / "data/road";

json layout() {
    return {{"version", 1},
            {"name", "test road"},
            {"class", "M4"},
            {"carriageway", {{"width_m", 7.5}, {"lanes", 3}, {"traffic", "left"}}},
            {"surface", {{"reflection_table", "R2"}, {"q0", 0.09}}},
            {"observer_age", 60},
            {"luminaires",
             {{"file", (kRoads / "luminaire.ldt").string()},
              {"c0", "street side"},
              {"arrangement", "staggered"},
              {"spacing_m", 33},
              {"height_m", 9},
              {"overhang_m", -0.5},
              {"tilt_deg", 5},
              {"orientation_deg", 2},
              {"roll_deg", 1},
              {"flux_factor", 0.7},
              {"colour_temperature_K", 2700},
              {"maintenance_factor", 0.8}}}};
}

RoadFile read_layout(const json& file, const RoadOverrides& overrides = {}) {
    const TempFolder folder;
    return read_road(folder.write("road.json", file.dump()), overrides);
}

TEST(RoadFile, ReadsEverything) {
    const RoadFile file = read_layout(layout());
    const RoadLayout& road = file.layout;
    EXPECT_EQ(file.wanted_class, "M4");
    EXPECT_EQ(road.name, "test road");
    EXPECT_EQ(road.width, 7.5);
    EXPECT_EQ(road.lanes, 3);
    EXPECT_TRUE(road.left_hand_traffic && road.c0_street_side);
    EXPECT_EQ(road.arrangement, Arrangement::Staggered);
    EXPECT_EQ((std::vector{road.spacing, road.height, road.overhang, road.tilt, road.orientation, road.roll}),
              (std::vector<double>{33, 9, -0.5, 5, 2, 1}));
    EXPECT_EQ((std::vector{road.flux_factor, road.maintenance_factor, road.age, road.colour_temperature}),
              (std::vector<double>{0.7, 0.8, 60, 2700}));
    EXPECT_EQ(road.surface, rescaled(find_reflection_table("R2"), 0.09));
    EXPECT_NEAR(luminous_flux(road.distribution), 8803, 1);
}

TEST(RoadFile, OverridesTakeThePlaceOfTheFile) {
    const RoadFile file = read_layout(layout(), {.reflection_table = "C1",
                                                 .q0 = 0.11,
                                                 .spacing = 20,
                                                 .height = 7,
                                                 .overhang = 1,
                                                 .tilt = 0,
                                                 .maintenance_factor = 0.9});
    EXPECT_EQ(file.layout.surface, rescaled(find_reflection_table("C1"), 0.11));
    EXPECT_EQ(file.layout.spacing, 20);
    EXPECT_EQ(file.layout.height, 7);
    EXPECT_EQ(file.layout.overhang, 1);
    EXPECT_EQ(file.layout.tilt, 0);
    EXPECT_EQ(file.layout.maintenance_factor, 0.9);
    // The file's Q0 belongs to the file's surface.
    EXPECT_EQ(read_layout(layout(), {.reflection_table = "C1"}).layout.surface, find_reflection_table("C1"));
    EXPECT_THROW(read_layout(layout(), {.luminaire = "missing.ldt"}), Error);
    EXPECT_THROW(read_layout(layout(), {.spacing = -3}), Error);
}

TEST(RoadFile, ListsOfPositions) {
    json file = layout();
    json& luminaires = file["luminaires"];
    luminaires.erase("overhang_m");
    luminaires["arrangement"] = "list";
    luminaires["positions"] = {
        {{"y_m", 1}}, {{"x_m", 4}, {"y_m", 7}, {"height_m", 6}}, {{"y_m", 7}, {"facing_deg", 45}}};
    const RoadLayout road = read_layout(file).layout;
    ASSERT_EQ(road.list.size(), 3u);
    EXPECT_EQ(road.list[0].position, glm::dvec3(0, 1, 9));
    EXPECT_EQ(road.list[0].facing, 90);
    EXPECT_EQ(road.list[1].position, glm::dvec3(4, 7, 6));
    EXPECT_EQ(road.list[1].facing, -90);
    EXPECT_EQ(road.list[2].facing, 45);
}

TEST(RoadFile, NamesThePlaceOfWhatIsWrong) {
    const std::vector<Fault> faults{
        {"/version", 2, "/version"},
        {"/lamps", 1, "/lamps: unknown key"},
        {"/class", "M9", "/class"},
        {"/carriageway/lanes", 0, "/carriageway/lanes"},
        {"/carriageway/lanes", 2.5, "/carriageway/lanes"},
        {"/carriageway/traffic", "both", "/carriageway/traffic"},
        {"/carriageway/width", 7, "/carriageway/width: unknown key"},
        {"/surface/reflection_table", "R9", "/surface/reflection_table: 'R9'"},
        {"/surface/reflection_table", "../none.csv", "/surface/reflection_table"},
        {"/surface/q0", 0, "/surface/q0"},
        {"/luminaires/arrangement", "round", "/luminaires/arrangement"},
        {"/luminaires/spacing_m", 0, "/luminaires/spacing_m"},
        {"/luminaires/height_m", "8", "/luminaires/height_m"},
        {"/luminaires/reservation_m", 4, "/luminaires/reservation_m"},
        {"/luminaires/positions", json::array(), "/luminaires/positions"},
        {"/luminaires/c0", "left", "/luminaires/c0"},
        {"/luminaires/maintenance_factor", 1.2, "/luminaires/maintenance_factor"},
        {"/luminaires/height", 8, "/luminaires/height: unknown key"},
        {"/observer_age", 200, "/observer_age"},
    };
    expect_places(
        layout(), faults, [](const json& file) { return complaint_of([&] { read_layout(file); }); }, "road.json: ");
    for (const char* key : {"carriageway", "surface", "luminaires"}) {
        json file = layout();
        file.erase(key);
        EXPECT_THROW(read_layout(file), Error) << key;
    }
    const TempFolder folder;
    EXPECT_THROW(read_road(folder.write("road.json", "{\"version\": 1")), Error);
    json dark = layout();
    dark["luminaires"]["file"] =
        folder.write("dark.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n0 0\n").string();
    EXPECT_TRUE(contains(complaint_of([&] { read_layout(dark); }), "dark.ies: the luminaire gives no light"));
    RoadOverrides narrow;
    narrow.spacing = 1;
    EXPECT_TRUE(
        contains(complaint_of([&] { read_layout(layout(), narrow); }), "road.json: test road: the spacing must be"));
}

TEST(RoadFile, EveryExampleIsCalculated) {
    size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kRoads)) {
        if (entry.path().extension() != ".json") continue;
        const RoadFile file = read_road(entry.path());
        const LightingClass* wanted = find_lighting_class(file.wanted_class);
        const RoadResult result = calculate_road(file.layout);
        EXPECT_GT(result.average_luminance, 0.3) << entry.path();
        EXPECT_TRUE(!wanted || result.average_luminance >= wanted->luminance) << entry.path();
        ++count;
    }
    EXPECT_GE(count, 2u);
}

/// What a renderer will do with the lamps of a scene, in its own frame.
double rendered_illuminance(const Scene& scene, glm::dvec3 point, double reach) {
    const auto world = world_transforms(scene, 0);
    double sum = 0;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].lamp == kNone) continue;
        const Lamp& lamp = scene.lamps[scene.nodes[i].lamp];
        const glm::dmat4 node = world[i];
        const glm::dvec3 away = point - glm::dvec3(node[3]);
        if (std::hypot(away.x, away.z) > reach) continue;
        const double d = glm::length(away);
        sum += lamp.intensity *
               intensity(scene.distributions[lamp.distribution], glm::transpose(glm::dmat3(node)) * away) * -away.y /
               (d * d * d);
    }
    return sum;
}

TEST(RoadScene, HasTheLightOfTheCalculation) {
    RoadLayout road = read_layout(layout()).layout;
    for (const bool street_side : {false, true}) {
        road.c0_street_side = street_side;
        const Scene scene = road_scene(road);
        const RoadResult result = calculate_road(road);
        for (size_t i = 0; i < result.points.size(); i += 5) {
            const FieldPoint& p = result.points[i];
            const double e = rendered_illuminance(scene, road_to_world({p.x, p.y, 0}), 5 * road.height);
            EXPECT_NEAR(e / p.illuminance, 1, 1e-4) << p.x << " " << p.y;
        }
    }
}

TEST(RoadScene, LooksAlongTheRoad) {
    const RoadLayout road = read_road(kRoads / "worked-example.json").layout;
    const Scene scene = road_scene(road);
    ASSERT_EQ(scene.reflection_tables.size(), 1u);
    EXPECT_EQ(scene.reflection_tables[0], road.surface);
    EXPECT_EQ(scene.materials.at(0).reflection_table, 0u);
    EXPECT_NEAR(scene.materials[0].base_colour.r, 0.0543 * std::numbers::pi, 1e-4);
    EXPECT_NEAR(luminance(scene.lamps.at(0).colour), 1, 1e-6);
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[1].name, "observer lane 2");

    const auto world = world_transforms(scene, 0);
    size_t lamps = 0, cameras = 0;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        lamps += scene.nodes[i].lamp != kNone;
        if (scene.nodes[i].camera == kNone) continue;
        const glm::vec3 eye = world[i][3], sight = -glm::normalize(glm::vec3(world[i][2]));
        const glm::vec3 expected(-1.75f - 3.5f * static_cast<float>(scene.nodes[i].camera), 1.5f, 60.0f);
        EXPECT_LT(glm::length(eye - expected), 1e-5f);
        EXPECT_NEAR(sight.y, -std::sin(std::numbers::pi / 180), 1e-6);
        EXPECT_NEAR(sight.z, -std::cos(std::numbers::pi / 180), 1e-6);
        ++cameras;
    }
    EXPECT_EQ(cameras, 2u);
    EXPECT_EQ(lamps, 8u);  // x = -90, -60, ..., 120: from -60 - 5H to S + 12H = 126 m
    // The surface faces up, wherever the observers look at it.
    const Primitive& plane = scene.meshes.at(0).primitives.at(0);
    for (size_t i = 0; i < plane.indices.size(); i += 3) {
        const glm::vec3 a = plane.vertices[plane.indices[i]].position,
                        b = plane.vertices[plane.indices[i + 1]].position,
                        c = plane.vertices[plane.indices[i + 2]].position;
        EXPECT_GT(glm::cross(b - a, c - a).y, 0);
    }
    EXPECT_FLOAT_EQ(plane.bounds.low.x, -7);
    EXPECT_FLOAT_EQ(plane.bounds.high.x, 0);
    EXPECT_LT(plane.bounds.low.z, -126 + 1e-3);
    EXPECT_GT(plane.bounds.high.z, 60);
}

class RoadSurface : public testing::Test {
protected:
    RoadSurface() {
        const size_t positions = street_.vec3(kTriangle);
        for (const char* name : {"asphalt", "kerb", "asphalt wet", "asphalt old"}) {
            street_.root["materials"].push_back({{"name", name}});
            street_.show(
                {{"attributes", {{"POSITION", positions}}}, {"material", street_.root["materials"].size() - 1}});
        }
        folder_.write("street.gltf", street_.text());
    }
    ConversionReport run(const json& surfaces) {
        return convert(folder_ / "street.gltf",
                       folder_.write("p.json", json({{"version", 1}, {"surfaces", surfaces}}).dump()),
                       folder_ / "night.gltf");
    }
    std::string complaint(const json& surface) {
        return complaint_of([&] { run(json::array({surface})); });
    }
    GltfFile street_;
    TempFolder folder_;
};

TEST_F(RoadSurface, TablesSurviveAConversion) {
    folder_.write("mine.csv", "t,0,90,180\n0,100,100,100\n1.5,50,20,\n");
    const ConversionReport report =
        run({{{"materials", "asphalt wet"}, {"reflection_table", "W3"}},
             {{"materials", "asphalt old"}, {"reflection_table", "mine.csv"}},
             {{"materials", {"asphalt", "kerb"}}, {"reflection_table", "R3"}, {"q0", 0.09}}});
    EXPECT_TRUE(mentions(report.changes, "reflection table R3 of Q0 0.09"));
    const Scene scene = read_gltf(folder_ / "night.gltf").scene;
    ASSERT_EQ(scene.reflection_tables.size(), 3u);
    const auto table_of = [&](size_t m) { return scene.reflection_tables.at(scene.materials[m].reflection_table); };
    EXPECT_EQ(table_of(0), rescaled(find_reflection_table("R3"), 0.09));
    EXPECT_EQ(scene.materials[0].reflection_table, scene.materials[1].reflection_table);
    EXPECT_EQ(table_of(2), find_reflection_table("W3"));
    EXPECT_EQ(table_of(3), find_reflection_table("mine.csv", folder_.path()));
}

TEST_F(RoadSurface, WithoutRulesThereAreNoTables) {
    run({{{"materials", "asphalt"}, {"roughness", 0.9}}});
    const Scene scene = read_gltf(folder_ / "night.gltf").scene;
    EXPECT_TRUE(scene.reflection_tables.empty());
    EXPECT_EQ(scene.materials[0].reflection_table, kNone);
    EXPECT_FALSE(json::parse(read_text(folder_ / "night.gltf"))["extras"]["vesper"].contains("roads"));
}

TEST_F(RoadSurface, RefusesWhatIsNoTable) {
    EXPECT_TRUE(contains(complaint({{"materials", "a"}, {"q0", 0.07}}), "p.json: /surfaces/0/q0"));
    EXPECT_TRUE(contains(complaint({{"materials", "a"}, {"reflection_table", "R7"}}),
                         "p.json: /surfaces/0/reflection_table: 'R7'"));
    EXPECT_TRUE(contains(complaint({{"materials", "a"}, {"reflection_table", 3}}), "/surfaces/0/reflection_table"));
    folder_.write("bad.csv", "t,0,180\n0,1\n");
    EXPECT_TRUE(contains(complaint({{"materials", "a"}, {"reflection_table", "bad.csv"}}), "bad.csv: line 2"));

    run({{{"materials", "asphalt"}, {"reflection_table", "R1"}}});
    const json good = json::parse(read_text(folder_ / "night.gltf"));
    const struct {
        const char* pointer;
        json value;
    } cases[] = {{"/roads/0/material", 4},
                 {"/roads/0/table", 1},
                 {"/roads/0/colour", 1},
                 {"/reflection_tables/0/r", json::array({1, 2})},
                 {"/reflection_tables/0/r/5", -1},
                 {"/reflection_tables/0/r/5", "x"},
                 {"/reflection_tables/0/beta_deg/3", 2},
                 {"/reflection_tables/0/tan_gamma/0", 1},
                 {"/reflection_tables/0/tables", 1},
                 {"/reflection_tables", 1}};
    for (const auto& c : cases) {
        json damaged = good;
        damaged["extras"]["vesper"][json::json_pointer(c.pointer)] = c.value;
        const std::string refusal = complaint_of([&] { read_gltf(folder_.write("damaged.gltf", damaged.dump())); });
        EXPECT_TRUE(contains(refusal, "damaged.gltf: /extras/vesper/")) << c.pointer << " = " << c.value;
    }
}

}  // namespace
}  // namespace vesper::test
