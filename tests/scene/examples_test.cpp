// The photometry files of this repository, and the example street made of shared models. SPDX-License-Identifier: MIT
#include <cstdlib>

#include "places.h"
#include "scene/convert.h"
#include "scene/photometry.h"
#include "scene/scene_files.h"
#include "support/shared_data.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;
const fs::path kData = fs::path(VESPER_SOURCE_DIR) / "data";

TEST(Examples, EveryPhotometryFileIsValid) {
    size_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(kData)) {
        const std::string name = entry.path().filename().string();
        if (!name.ends_with(".photometry.json")) continue;
        EXPECT_NO_THROW(scene::read_photometry(entry.path())) << name;
        ++count;
    }
    EXPECT_GE(count, 1u);
}

TEST(Examples, TheStreetOfFreeModelsIsAssembledAndConverted) {
    const fs::path example = kData / "examples/kaykit-street", assets = shared_data("gltf");
    if (!is_here(assets / "kaykit-city")) GTEST_SKIP() << "the shared set is not here";
    if (std::system("python3 --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "there is no python3";
    const TempFolder folder;
    const std::string command = "python3 '" + (example / "assemble.py").string() + "' '" + assets.string() + "' -o '" +
                                (folder / "street.gltf").string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    const scene::PhotometryReport report =
        scene::convert(folder / "street.gltf", example / "kaykit-street.photometry.json", folder / "night.glb");
    for (const char* miss : {"no node matches", "no material matches", "earlier rules"})
        EXPECT_FALSE(mentions(report.warnings, miss));
    const scene::Scene scene = scene::read_scene(folder / "night.glb").scene;
    EXPECT_EQ(scene.cameras.size(), 3u);
    size_t lamps = 0;
    for (const scene::Node& node : scene.nodes) lamps += node.lamp != scene::kNone;
    EXPECT_EQ(lamps, 50u);  // 14 street lamps, 9 cars with two lamps at either end
}

}  // namespace
}  // namespace vesper::test
