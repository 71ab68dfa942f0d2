// The public interface of the library: what a host calls, and what it catches. SPDX-License-Identifier: MIT
#include <vesper/roads.hpp>

#include "places.h"
#include "roads/layout_file.h"
#include "roads/road_lighting.h"
#include "roads/road_texts.h"
#include "scene/read_scene.h"
#include "scene/scene_files.h"

namespace vesper::test {

using roads::ConvertOptions, roads::RoadLayout;

namespace {

const std::filesystem::path kLayouts = std::filesystem::path(VESPER_SOURCE_DIR) / "data/road";

/// The worked example of docs/road.md.
RoadLayout plain_example() {
    RoadLayout layout;
    layout.overhang = 0.5;
    layout.luminaire = kLayouts / "luminaire.ldt";
    return layout;
}

struct Caught {
    VesperResult result = VESPER_OK;
    std::string message;
};

Caught caught(const std::function<void()>& call) {
    try {
        call();
    } catch (const cpp::Failure& failure) {
        return {failure.result, failure.what()};
    }
    return {};
}

TEST(RoadsInterface, CalculatesTheWorkedExample) {
    const roads::RoadLighting lighting = roads::calculate_road_lighting(plain_example());
    EXPECT_NEAR(lighting.average_luminance / 1.1637, 1, 1e-3);
    EXPECT_NEAR(lighting.threshold_increment_percent / 14.963, 1, 1e-3);
    EXPECT_EQ(lighting.points.size(), 60u);
    ASSERT_TRUE(roads::reached_class(lighting));
    EXPECT_STREQ(roads::reached_class(lighting)->name, "M5");

    RoadLayout layout = plain_example();
    layout.q0 = 0.14;  // R3 has 0.07
    const roads::RoadLighting lighter = roads::calculate_road_lighting(layout);
    EXPECT_NEAR(lighter.average_luminance / lighting.average_luminance, 2, 1e-9);
    EXPECT_NEAR(lighter.average_illuminance / lighting.average_illuminance, 1, 1e-12);
}

TEST(RoadsInterface, CalculatesSmallTargets) {
    const roads::SmallTargetVisibility found = roads::calculate_small_targets(plain_example());
    EXPECT_EQ(found.targets.size(), 60u);
    EXPECT_NEAR(found.stv.value(), 2.23, 0.005);
    EXPECT_LT(roads::calculate_small_targets(plain_example(), 0.2).targets[34].visibility_level.value(), 0);
    EXPECT_GT(found.targets[34].visibility_level.value(), 0);
    EXPECT_EQ(caught([] { roads::calculate_small_targets(plain_example(), 2); }).message,
              "the reflectance of targets must be from 0.01 to 1");
    EXPECT_EQ(caught([] { roads::calculate_small_targets(plain_example(), 0); }).result, VESPER_BAD_ARGUMENT);
}

// A layout of a file can be changed and calculated: it holds all that the file says.
TEST(RoadsInterface, LayoutsOfFilesAreWhole) {
    const TempFolder folder;
    std::filesystem::copy_file(kLayouts / "luminaire.ldt", folder / "luminaire.ldt");
    std::filesystem::copy_file(kLayouts / "R1.csv", folder / "mine.csv");
    nlohmann::json json = nlohmann::json::parse(read_text(kLayouts / "worked-example.json"));
    json["surface"] = {{"reflection_table", "mine.csv"}, {"q0", 0.08}};
    json["class"] = "M2";
    for (const auto& file :
         {kLayouts / "worked-example.json", kLayouts / "boulevard.json", folder.write("road.json", json.dump())}) {
        SCOPED_TRACE(file.string());
        const roads::RoadLighting expected = roads::calculate_lighting(roads::read_layout(file));
        const roads::RoadLighting lighting = roads::calculate_road_lighting(roads::read_road_layout(file));
        ASSERT_EQ(lighting.points.size(), expected.points.size());
        for (size_t i = 0; i < expected.points.size(); ++i)
            EXPECT_EQ(lighting.points[i].luminance, expected.points[i].luminance);
        EXPECT_EQ(lighting.threshold_increment_percent, expected.threshold_increment_percent);
    }
    EXPECT_EQ(roads::read_road_layout(folder / "road.json").wanted_class, "M2");
}

TEST(RoadsInterface, ValuesAndFilesFailEachInItsWay) {
    const auto failure_of = [](auto&& change) {
        RoadLayout layout = plain_example();
        layout.name = "mine";
        change(layout);
        return caught([&] { roads::calculate_road_lighting(layout); });
    };
    EXPECT_EQ(failure_of([](RoadLayout&) {}).result, VESPER_OK);
    const Caught narrow = failure_of([](RoadLayout& l) { l.spacing = 0; });
    EXPECT_EQ(narrow.result, VESPER_BAD_ARGUMENT);
    EXPECT_EQ(narrow.message, "mine: the spacing must be from 5 to 500 m");
    EXPECT_EQ(failure_of([](RoadLayout& l) { l.q0 = -1; }).result, VESPER_BAD_ARGUMENT);
    const Caught missing = failure_of([](RoadLayout& l) { l.luminaire = "none.ldt"; });
    EXPECT_EQ(missing.result, VESPER_FAILED);
    EXPECT_TRUE(contains(missing.message, "none.ldt: "));
    EXPECT_EQ(failure_of([](RoadLayout& l) { l.reflection_table = "R9"; }).result, VESPER_FAILED);
    const Caught dark = failure_of([](RoadLayout& l) { l.flux_factor = 0; });
    EXPECT_EQ(dark.result, VESPER_FAILED);
    EXPECT_TRUE(contains(dark.message, "mine: no light"));
    EXPECT_EQ(caught([] { roads::read_road_layout("none.json"); }).result, VESPER_FAILED);
}

TEST(RoadsInterface, ConvertsRoadsWithTheirOptions) {
    const TempFolder folder;
    const auto file =
        folder.write("a.xodr", opendrive(road("1", 90, geometry(0, 0, 0, 0, 90, "<line/>"), two_way_section(),
                                              "<objects><object id=\"1\" type=\"streetLamp\" s=\"40\" t=\"6\" "
                                              "height=\"8\"/></objects>")));
    const auto street_lamps = [&](const ConvertOptions& options) {
        const roads::RoadConversion made = roads::convert_opendrive(file, folder / "a.gltf", options);
        EXPECT_GT(made.parts.size(), 2u);
        const scene::Scene scene = scene::read_scene(folder / "a.gltf").scene;
        size_t count = 0;
        for (const scene::Node& node : scene.nodes)
            count += node.lamp != scene::kNone && node.name.starts_with("street_lamp_");
        return count;
    };
    ConvertOptions options;
    EXPECT_EQ(street_lamps(options), 1u) << "that of the file";
    options.lamps.side = roads::LampSide::Both;
    EXPECT_EQ(street_lamps(options), 1u);
    options.lamps.spacing = 30;
    EXPECT_EQ(street_lamps(options), 1u + 6u);
    options.lamps.spacing = 0;
    EXPECT_EQ(street_lamps(options), 1u);

    const auto failure_of = [&](auto&& change) {
        ConvertOptions changed;
        change(changed);
        return caught([&] { roads::convert_opendrive(file, folder / "b.gltf", changed); }).result;
    };
    EXPECT_EQ(failure_of([](ConvertOptions&) {}), VESPER_OK);
    EXPECT_EQ(failure_of([](ConvertOptions& o) { o.lamps.spacing = 1; }), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(failure_of([](ConvertOptions& o) { o.lamps.spacing = NAN; }), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(failure_of([](ConvertOptions& o) { o.lamps.height = 1; }), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(failure_of([](ConvertOptions& o) { o.lamps.overhang = 0; }), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(failure_of([](ConvertOptions& o) { o.luminaire = "none.ies"; }), VESPER_FAILED);
    const Caught missing = caught([&] { roads::convert_opendrive(folder / "none.xodr", folder / "c.gltf"); });
    EXPECT_EQ(missing.result, VESPER_FAILED);
    EXPECT_TRUE(contains(missing.message, "none.xodr: "));
    EXPECT_EQ(caught([&] { roads::convert_opendrive(file, folder / "c.obj"); }).result, VESPER_FAILED);
}

}  // namespace
}  // namespace vesper::test
