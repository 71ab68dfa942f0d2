// Damaged and invalid files of others, given to the program: a result, or one line that names the file.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>

#include "places.h"
#include "support/program.h"
#include "support/shared_data.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;

class MalformedFiles : public ProgramTest {
protected:
    /// Runs the program with the arguments that `command` makes of each file below a folder of the shared set, "" for
    /// those to be passed by: how many files there were, and how many were refused.
    template <class Command>
    std::pair<size_t, size_t> give(const std::string& below, const Command& command) {
        size_t files = 0, refused = 0;
        if (!is_here(shared_data(below))) return {0, 0};
        for (const auto& entry : fs::recursive_directory_iterator(shared_data(below))) {
            const std::string file = "'" + entry.path().string() + "'";
            const std::string arguments = entry.is_regular_file() ? command(entry.path(), file) : "";
            if (arguments.empty()) continue;
            ++files;
            const int code = run(arguments);
            if (code == 0) continue;
            ++refused;
            EXPECT_EQ(code, 2) << file;
            EXPECT_TRUE(said.starts_with("vesper: ") && std::count(said.begin(), said.end(), '\n') == 1)
                << file << ": " << said;
            EXPECT_NE(said.find(entry.path().filename().string().substr(0, 40)), std::string::npos) << said;
            EXPECT_LT(said.size(), 1000u) << file;
        }
        return {files, refused};
    }
};

TEST_F(MalformedFiles, ScenesOfTheValidator) {
    const auto [files, refused] = give("gltf/validator", [](const fs::path& path, const std::string& file) {
        return path.extension() == ".gltf" || path.extension() == ".glb" ? "inspect " + file : "";
    });
    if (files == 0) GTEST_SKIP() << "the shared set is not here";
    EXPECT_GT(refused, 40u);
    RecordProperty("refused", std::to_string(refused) + " of " + std::to_string(files));
}

TEST_F(MalformedFiles, PicturesOfHighDynamicRange) {
    const auto [files, refused] = give("malformed", [](const fs::path& path, const std::string& file) {
        return path.extension() != ".md" ? "tonemap " + file + " -o x.png" : "";
    });
    if (files == 0) GTEST_SKIP() << "the shared set is not here";
    EXPECT_GT(refused, 80u);
    RecordProperty("refused", std::to_string(refused) + " of " + std::to_string(files));
}

TEST_F(MalformedFiles, Photographs) {
    const auto [files, refused] =
        give("malformed/image", [](const fs::path&, const std::string& file) { return "inspect " + file; });
    if (files == 0) GTEST_SKIP() << "the shared set is not here";
    EXPECT_EQ(refused, files);
}

TEST_F(MalformedFiles, LimitsFollowTheEnvironment) {
    const std::string inspect = "inspect " VESPER_SOURCE_DIR "/data/rivoli/rivoli.gltf";
    EXPECT_EQ(run(inspect, "VESPER_LIMITS=2.5"), 0) << said;
    expect_refused(inspect, {"rivoli.gltf", "more than 32000 values"}, "VESPER_LIMITS=0.001");
    for (const char* wrong : {"0", "17", "nan", "many", "2x"})
        expect_refused(inspect, {"VESPER_LIMITS", "0.001 to 16"}, "VESPER_LIMITS=" + std::string(wrong));
}

}  // namespace
}  // namespace vesper::test
