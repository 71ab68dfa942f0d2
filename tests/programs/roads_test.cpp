// `vesper convert` of OpenDRIVE files as people run it, and a picture of the result. SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "io/image_file.h"
#include "io/read_file.h"
#include "places.h"
#include "roads/crossing_text.h"
#include "scene/read_scene.h"
#include "support/program.h"

namespace vesper::test {
namespace {

const std::string kStreet = VESPER_SOURCE_DIR "/data/rivoli/rivoli.xodr";

class Roads : public ProgramTest {};

TEST_F(Roads, BecomeALitSceneThatRenders) {
    ASSERT_EQ(run("convert " + kStreet), 0) << said;
    EXPECT_NE(printed.find("wrote rivoli.gltf"), std::string::npos) << printed;
    EXPECT_NE(printed.find("street lamps: "), std::string::npos) << printed;
    const scene::Scene scene = scene::read_scene(folder / "rivoli.gltf").scene;
    EXPECT_EQ(scene.cameras.size(), 3u);
    ASSERT_EQ(run("render rivoli.gltf --camera driver --size 97x61 --stats-json stats.json -o out.png"), 0) << said;
    const Image picture = io::decode_image(io::read_file(folder / "out.png", 1 << 20), 1000);
    const auto luminance_at = [&](uint32_t x, uint32_t y) { return picture.rgba[4 * (size_t(y) * picture.width + x)]; };
    EXPECT_GT(luminance_at(48, 50), luminance_at(48, 5)) << "the road is brighter than the sky";
}

TEST_F(Roads, TrafficLightsAreChosen) {
    folder.write("a.xodr", opendrive(crossing_text(false)));
    const auto lit = [&](const std::string& options) {
        EXPECT_EQ(run("convert a.xodr -o a.glb " + options), 0) << said;
        std::string colours;
        for (const scene::Node& node : scene::read_scene(folder / "a.glb").scene.nodes)
            if (node.lamp != scene::kNone && node.name.starts_with("signal_W1/")) colours += node.name.substr(10);
        return colours;
    };
    EXPECT_EQ(lit("--signals off"), "");
    EXPECT_EQ(lit("--signals amber"), "yellow");
    EXPECT_EQ(lit("--signals green"), "green");
    EXPECT_EQ(lit("--signal-time 24"), "red") << "between two stages";
    EXPECT_EQ(run("convert a.xodr --signals blue"), 2);
    EXPECT_EQ(run("convert " VESPER_SOURCE_DIR "/data/rivoli/rivoli.gltf --signals red -o b.glb"), 2);
}

TEST_F(Roads, LampsAreChosen) {
    ASSERT_EQ(run("convert " + kStreet + " --lamp-spacing 0 -o none.glb"), 0) << said;
    ASSERT_EQ(run("convert " + kStreet + " --lamp-spacing 20 --lamp-side both --lamp-height 7 -o many.glb"), 0) << said;
    const auto lamps = [&](const char* file) {
        const scene::Scene scene = scene::read_scene(folder / file).scene;
        size_t count = 0;
        for (const scene::Node& node : scene.nodes)
            count += node.lamp != scene::kNone && node.name.starts_with("street_lamp_");
        return count;
    };
    EXPECT_EQ(lamps("none.glb"), 0u);
    EXPECT_GT(lamps("many.glb"), 36u);
    // Where the file has its own, only those who ask for a spacing get more.
    std::ofstream(folder / "own.xodr") << "<OpenDRIVE><road id=\"1\" length=\"200\"><planView><geometry s=\"0\" "
                                          "x=\"0\" y=\"0\" hdg=\"0\" length=\"200\"><line/></geometry>"
                                          "</planView><lanes><laneSection s=\"0\"><right><lane id=\"-1\" "
                                          "type=\"driving\"><width sOffset=\"0\" a=\"4\"/></lane></right></laneSection>"
                                          "</lanes><objects><object id=\"1\" type=\"streetLamp\" s=\"40\" t=\"3\" "
                                          "height=\"8\"/></objects></road></OpenDRIVE>";
    ASSERT_EQ(run("convert own.xodr --luminaire " VESPER_SOURCE_DIR
                  "/data/photometry/street-lamp.ies --lamp-overhang 2 -o own.glb"),
              0)
        << said;
    ASSERT_EQ(run("convert own.xodr --lamp-spacing 40 -o rows.glb"), 0) << said;
    EXPECT_EQ(lamps("own.glb"), 1u);
    EXPECT_EQ(lamps("rows.glb"), 6u);
}

TEST_F(Roads, BadInputEndsInOneLine) {
    std::ofstream(folder / "bad.xodr") << "<OpenDRIVE>\n<road id=\"1\" length=\"5\"/>\n</OpenDRIVE>";
    expect_refused("convert bad.xodr", {"bad.xodr:2: road: road '1' has no planView"});
    EXPECT_FALSE(exists("bad.gltf"));
    std::ofstream(folder / "long.xodr")
        << "<OpenDRIVE><road id=\"1\" length=\"301000\"><planView><geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" "
           "length=\"301000\"><line/></geometry>"
           "</planView><lanes><laneSection s=\"0\"><right><lane id=\"-1\" type=\"driving\"><width sOffset=\"0\" "
           "a=\"4\"/></lane></right></laneSection>"
           "</lanes></road></OpenDRIVE>";
    expect_refused("convert long.xodr", {"long.xodr: the network has 301 km of roads"});
    expect_refused("convert none.xodr", {"none.xodr"});
    expect_refused("convert " + kStreet + " -p a.json", {"--photometry has no meaning"});
    expect_refused("convert " + kStreet + " -o a.obj", {".gltf or .glb"});
    expect_refused("convert " + kStreet + " --luminaire none.ies", {"none.ies"});
    expect_refused("convert a.gltf --lamp-spacing 3", {"--lamp-spacing has a meaning only"});
    expect_refused("convert a.gltf", {"--photometry is required"});
}

}  // namespace
}  // namespace vesper::test
