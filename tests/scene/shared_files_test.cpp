// Every glTF file and picture of the shared set gives a scene or an Error. SPDX-License-Identifier: MIT
#include <algorithm>

#include "io/image_file.h"
#include "io/read_file.h"
#include "scene/scene_files.h"
#include "support/shared_data.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;

/// Files below a folder of the shared set, sorted; empty where the set is missing.
std::vector<fs::path> files_below(const std::string& folder) {
    std::vector<fs::path> files;
    const fs::path root = shared_data(folder);
    if (!is_here(root)) return files;
    for (const auto& entry : fs::recursive_directory_iterator(root))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

bool is_gltf(const fs::path& file) { return file.extension() == ".gltf" || file.extension() == ".glb"; }

TEST(SharedFiles, EveryGltfGivesASceneOrAnError) {
    size_t scenes = 0, errors = 0;
    for (const char* folder : {"gltf", "malformed"}) {
        for (const fs::path& file : files_below(folder)) {
            if (!is_gltf(file)) continue;
            try {
                scene::read_scene(file);
                ++scenes;
            } catch (const Error& error) {
                ++errors;
                EXPECT_TRUE(contains(error.what(), file.filename().string()));
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            }
        }
    }
    if (scenes + errors == 0) GTEST_SKIP() << "the shared set is not here";
    EXPECT_GT(scenes, 100u);
    EXPECT_GT(errors, 20u);
}

TEST(SharedFiles, EveryDamagedPictureGivesPixelsOrAnError) {
    const auto files = files_below("malformed");
    if (files.empty()) GTEST_SKIP() << "the shared set is not here";
    for (const fs::path& file : files) {
        try {
            const Image image = io::decode_image(io::read_file(file, 1u << 28), 4096);
            EXPECT_EQ(image.rgba.size(), size_t{4} * image.width * image.height);
        } catch (const Error&) {
        }
    }
}

TEST(SharedFiles, WholeSetsAreRead) {
    const auto files = files_below("gltf/kaykit-city");
    if (files.empty()) GTEST_SKIP() << "the shared set is not here";
    for (const fs::path& file : files) {
        if (!is_gltf(file)) continue;
        EXPECT_NO_THROW(scene::read_scene(file)) << file;
    }
    // An inked (YCCK) picture.
    const fs::path inked = shared_data("malformed/image/jpeg/YCbCrK.jpg");
    const Image image = io::decode_image(io::read_file(inked, 1u << 20), 4096);
    EXPECT_GT(image.rgba[0] + image.rgba[1] + image.rgba[2], 0);
}

}  // namespace
}  // namespace vesper::test
