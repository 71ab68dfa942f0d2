// Road layouts from JSON, and as scenes. SPDX-License-Identifier: MIT
#include "roads/layout_file.h"

#include <cmath>
#include <numbers>

#include "io/named_file.h"
#include "places.h"
#include "roads/layout_scene.h"
#include "roads/occluders.h"
#include "roads/road_lighting.h"
#include "scene/colour.h"
#include "scene/gltf_save.h"
#include "scene/scene_files.h"
#include "support/occluders.h"

namespace vesper::test {
namespace {

using nlohmann::json;
const std::filesystem::path kRoads = std::filesystem::path(VESPER_SOURCE_DIR) / "data/road";

json layout_json() {
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

roads::LoadedLayout layout_of(const json& file, const roads::LayoutOverrides& overrides = {}) {
    const TempFolder folder;
    return roads::read_layout(folder.write("road.json", file.dump()), overrides);
}

TEST(LayoutFile, ReadsEverything) {
    const roads::LoadedLayout layout = layout_of(layout_json());
    EXPECT_EQ(layout.wanted_class, "M4");
    EXPECT_EQ(layout.name, "test road");
    EXPECT_EQ(layout.width, 7.5);
    EXPECT_EQ(layout.lanes, 3);
    EXPECT_TRUE(layout.left_hand_traffic && layout.c0_street_side);
    EXPECT_EQ(layout.arrangement, roads::Arrangement::Staggered);
    EXPECT_EQ((std::vector{layout.spacing, layout.height, layout.overhang, layout.tilt_deg, layout.orientation_deg,
                           layout.roll_deg}),
              (std::vector<double>{33, 9, -0.5, 5, 2, 1}));
    EXPECT_EQ(
        (std::vector{layout.flux_factor, layout.maintenance_factor, layout.observer_age, layout.colour_temperature}),
        (std::vector<double>{0.7, 0.8, 60, 2700}));
    EXPECT_EQ(layout.surface, photometry::rescaled(photometry::find_reflection_table("R2"), 0.09));
    EXPECT_NEAR(photometry::luminous_flux(layout.distribution), 8803, 1);
}

// A wall across the road, 10 m on and 5 m high.
scene::Scene wall_across() {
    OccluderScene made;
    made.plate({0, 2.5f, -10}, {100, 0, 0}, {0, 2.5f, 0});
    return made.scene();
}

TEST(LayoutFile, ReadsTheOccludersThatItNames) {
    const TempFolder folder, elsewhere;
    scene::save_gltf(wall_across(), "wall", folder / "wall.gltf");
    scene::save_gltf(wall_across(), "wall", elsewhere / "wall.gltf");
    json file = layout_json();
    EXPECT_FALSE(layout_of(file).hiding);
    file["occluders"] = "wall.gltf";
    const std::filesystem::path path = folder.write("road.json", file.dump());
    const roads::LoadedLayout layout = roads::read_layout(path);
    ASSERT_TRUE(layout.hiding);
    EXPECT_TRUE(layout.hiding->hide({20, 1, 9}, {0, 1, 0}));
    EXPECT_FALSE(layout.hiding->hide({20, 1, 11}, {0, 1, 0}));
    EXPECT_GT(roads::calculate_lighting(layout).hidden_pairs, 0u);
    EXPECT_GT(roads::calculate_lighting(roads::load_layout(layout)).hidden_pairs, 0u) << "as hosts do";
    EXPECT_FALSE(roads::read_layout(path, {.occlusion = false}).hiding);
    EXPECT_TRUE(roads::read_layout(path, {.occluders = (elsewhere / "wall.gltf").string()}).hiding);
    file["occluders"] = (elsewhere / "wall.gltf").string();
    EXPECT_THROW(roads::read_layout(folder.write("road.json", file.dump())), Error) << "in another folder";
    file["occluders"] = "none.gltf";
    EXPECT_THROW(roads::read_layout(folder.write("road.json", file.dump())), Error);
}

TEST(LayoutFile, OverridesTakeThePlaceOfTheFile) {
    const roads::LoadedLayout layout = layout_of(layout_json(), {.reflection_table = "C1",
                                                                 .q0 = 0.11,
                                                                 .spacing = 20,
                                                                 .height = 7,
                                                                 .overhang = 1,
                                                                 .tilt = 0,
                                                                 .maintenance_factor = 0.9});
    EXPECT_EQ(layout.surface, photometry::rescaled(photometry::find_reflection_table("C1"), 0.11));
    EXPECT_EQ(layout.spacing, 20);
    EXPECT_EQ(layout.height, 7);
    EXPECT_EQ(layout.overhang, 1);
    EXPECT_EQ(layout.tilt_deg, 0);
    EXPECT_EQ(layout.maintenance_factor, 0.9);
    // The file's Q0 belongs to the file's surface.
    EXPECT_EQ(layout_of(layout_json(), {.reflection_table = "C1"}).surface, photometry::find_reflection_table("C1"));
    EXPECT_THROW(layout_of(layout_json(), {.luminaire = "missing.ldt"}), Error);
    EXPECT_THROW(layout_of(layout_json(), {.spacing = -3}), Error);
}

TEST(LayoutFile, ListsOfPositions) {
    json file = layout_json();
    json& luminaires = file["luminaires"];
    luminaires.erase("overhang_m");
    luminaires["arrangement"] = "list";
    luminaires["positions"] = {
        {{"y_m", 1}}, {{"x_m", 4}, {"y_m", 7}, {"height_m", 6}}, {{"y_m", 7}, {"facing_deg", 45}}};
    const roads::LoadedLayout layout = layout_of(file);
    ASSERT_EQ(layout.mounts.size(), 3u);
    EXPECT_EQ(roads::vector_of(layout.mounts[0].position), glm::dvec3(0, 1, 9));
    EXPECT_EQ(layout.mounts[0].facing_deg, 90);
    EXPECT_EQ(roads::vector_of(layout.mounts[1].position), glm::dvec3(4, 7, 6));
    EXPECT_EQ(layout.mounts[1].facing_deg, -90);
    EXPECT_EQ(layout.mounts[2].facing_deg, 45);
}

TEST(LayoutFile, NamesThePlaceOfWhatIsWrong) {
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
        layout_json(), faults, [](const json& file) { return complaint_of([&] { layout_of(file); }); }, "road.json: ");
    for (const char* key : {"carriageway", "surface", "luminaires"}) {
        json file = layout_json();
        file.erase(key);
        EXPECT_THROW(layout_of(file), Error) << key;
    }
    const TempFolder folder;
    EXPECT_THROW(roads::read_layout(folder.write("road.json", "{\"version\": 1")), Error);
    json dark = layout_json();
    dark["luminaires"]["file"] =
        folder.write("dark.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n0 0\n").string();
    {
        const io::AllowedFolder allowed(folder.path());
        EXPECT_TRUE(contains(complaint_of([&] { layout_of(dark); }), "dark.ies: the luminaire gives no light"));
    }
    EXPECT_TRUE(contains(complaint_of([&] { layout_of(dark); }), "dark.ies: lies outside the folder"));
    roads::LayoutOverrides narrow;
    narrow.spacing = 1;
    EXPECT_TRUE(
        contains(complaint_of([&] { layout_of(layout_json(), narrow); }), "road.json: test road: the spacing must be"));
}

TEST(LayoutFile, EveryExampleIsCalculated) {
    size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kRoads)) {
        if (entry.path().extension() != ".json") continue;
        const roads::LoadedLayout layout = roads::read_layout(entry.path());
        const roads::LightingClass* wanted = roads::find_lighting_class(layout.wanted_class);
        const roads::RoadLighting result = roads::calculate_lighting(layout);
        EXPECT_GT(result.average_luminance, 0.3) << entry.path();
        EXPECT_TRUE(!wanted || result.average_luminance >= wanted->average_luminance) << entry.path();
        ++count;
    }
    EXPECT_GE(count, 2u);
}

/// What a renderer will do with the lamps of a scene, in its own frame.
double rendered_illuminance(const scene::Scene& scene, glm::dvec3 point, double reach) {
    const auto world = scene::world_transforms(scene, 0);
    double sum = 0;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].lamp == scene::kNone) continue;
        const scene::Lamp& lamp = scene.lamps[scene.nodes[i].lamp];
        const glm::dmat4 node = world[i];
        const glm::dvec3 away = point - glm::dvec3(node[3]);
        if (std::hypot(away.x, away.z) > reach) continue;
        const double d = glm::length(away);
        sum += lamp.intensity *
               photometry::intensity(scene.distributions[lamp.distribution], glm::transpose(glm::dmat3(node)) * away) *
               -away.y / (d * d * d);
    }
    return sum;
}

TEST(LayoutScene, HasTheLightOfTheCalculation) {
    roads::LoadedLayout layout = layout_of(layout_json());
    for (const bool street_side : {false, true}) {
        layout.c0_street_side = street_side;
        const scene::Scene scene = roads::layout_scene(layout);
        const roads::RoadLighting result = roads::calculate_lighting(layout);
        for (size_t i = 0; i < result.points.size(); i += 5) {
            const roads::FieldPoint& p = result.points[i];
            const double e = rendered_illuminance(scene, roads::layout_to_world({p.x, p.y, 0}), 5 * layout.height);
            EXPECT_NEAR(e / p.illuminance, 1, 1e-4) << p.x << " " << p.y;
        }
    }
}

TEST(LayoutScene, LooksAlongTheRoad) {
    const roads::LoadedLayout layout = roads::read_layout(kRoads / "worked-example.json");
    const scene::Scene scene = roads::layout_scene(layout);
    ASSERT_EQ(scene.reflection_tables.size(), 1u);
    EXPECT_EQ(scene.reflection_tables[0], layout.surface);
    EXPECT_EQ(scene.materials.at(0).reflection_table, 0u);
    EXPECT_NEAR(scene.materials[0].base_colour.r, 0.0543 * std::numbers::pi, 1e-4);
    EXPECT_NEAR(luminance(scene.lamps.at(0).colour), 1, 1e-6);
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[1].name, "observer lane 2");

    const auto world = scene::world_transforms(scene, 0);
    size_t lamps = 0, cameras = 0;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        lamps += scene.nodes[i].lamp != scene::kNone;
        if (scene.nodes[i].camera == scene::kNone) continue;
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
    const scene::Primitive& plane = scene.meshes.at(0).primitives.at(0);
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

}  // namespace
}  // namespace vesper::test
