// Reflection tables of surfaces, through a conversion. SPDX-License-Identifier: MIT
#include "scene/reflection_json.h"

#include "scene/convert.h"
#include "scene/scene_files.h"

namespace vesper::test {
namespace {

using nlohmann::json;

class SurfaceTables : public testing::Test {
protected:
    SurfaceTables() {
        const size_t positions = street_.vec3(kTriangle);
        for (const char* name : {"asphalt", "kerb", "asphalt wet", "asphalt old"}) {
            street_.root["materials"].push_back({{"name", name}});
            street_.show(
                {{"attributes", {{"POSITION", positions}}}, {"material", street_.root["materials"].size() - 1}});
        }
        folder_.write("street.gltf", street_.text());
    }
    scene::PhotometryReport run(const json& surfaces) {
        return scene::convert(folder_ / "street.gltf",
                              folder_.write("p.json", json({{"version", 1}, {"surfaces", surfaces}}).dump()),
                              folder_ / "night.gltf");
    }
    std::string complaint(const json& surface) {
        return complaint_of([&] { run(json::array({surface})); });
    }
    GltfFile street_;
    TempFolder folder_;
};

TEST_F(SurfaceTables, TablesSurviveAConversion) {
    folder_.write("mine.csv", "t,0,90,180\n0,100,100,100\n1.5,50,20,\n");
    const scene::PhotometryReport report =
        run({{{"materials", "asphalt wet"}, {"reflection_table", "W3"}},
             {{"materials", "asphalt old"}, {"reflection_table", "mine.csv"}},
             {{"materials", {"asphalt", "kerb"}}, {"reflection_table", "R3"}, {"q0", 0.09}}});
    EXPECT_TRUE(mentions(report.changes, "reflection table R3 of Q0 0.09"));
    const scene::Scene scene = scene::read_scene(folder_ / "night.gltf").scene;
    ASSERT_EQ(scene.reflection_tables.size(), 3u);
    const auto table_of = [&](size_t m) { return scene.reflection_tables.at(scene.materials[m].reflection_table); };
    EXPECT_EQ(table_of(0), photometry::rescaled(photometry::find_reflection_table("R3"), 0.09));
    EXPECT_EQ(scene.materials[0].reflection_table, scene.materials[1].reflection_table);
    EXPECT_EQ(table_of(2), photometry::find_reflection_table("W3"));
    EXPECT_EQ(table_of(3), photometry::find_reflection_table("mine.csv", folder_.path()));
}

TEST_F(SurfaceTables, WithoutRulesThereAreNoTables) {
    run({{{"materials", "asphalt"}, {"roughness", 0.9}}});
    const scene::Scene scene = scene::read_scene(folder_ / "night.gltf").scene;
    EXPECT_TRUE(scene.reflection_tables.empty());
    EXPECT_EQ(scene.materials[0].reflection_table, scene::kNone);
    EXPECT_FALSE(json::parse(read_text(folder_ / "night.gltf"))["extras"]["vesper"].contains("roads"));
}

TEST_F(SurfaceTables, RefusesWhatIsNoTable) {
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
        const std::string refusal =
            complaint_of([&] { scene::read_scene(folder_.write("damaged.gltf", damaged.dump())); });
        EXPECT_TRUE(contains(refusal, "damaged.gltf: /extras/vesper/")) << c.pointer << " = " << c.value;
    }
}

}  // namespace
}  // namespace vesper::test
