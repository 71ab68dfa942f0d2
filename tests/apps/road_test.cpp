// `vesper road` as people run it; needs no device. SPDX-License-Identifier: MIT
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

class Road : public testing::Test {
protected:
    fs::path folder = fs::temp_directory_path() /
                      ("vesper-road-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    void SetUp() override {
        fs::remove_all(folder);
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }

    std::string text_of(const std::string& file) const {
        std::ifstream in(folder / file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    int run(const std::string& arguments) {
        const std::string command = "cd '" + folder.string() +
                                    "' && '" VESPER_PROGRAM "' road '" VESPER_SOURCE_DIR
                                    "/data/road/worked-example.json' " +
                                    arguments + " >out.txt 2>err.txt";
        const int status = std::system(command.c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
};

TEST_F(Road, PrintsFiguresAndWritesPoints) {
    ASSERT_EQ(run("--csv points.csv --json road.json --grid"), 0) << text_of("err.txt");
    const std::string out = text_of("out.txt"), csv = text_of("points.csv"), json = text_of("road.json");
    for (const char* part :
         {"1.164   >= 1     ok", "0.544   >= 0.6   missed", "reached (EN 13201-2:2015, dry): M5", "observer of lane 2"})
        EXPECT_NE(out.find(part), std::string::npos) << part << out;
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 62);
    EXPECT_NE(csv.find("\n10.5000,0.5833,12.2136,2.19201,1.91229\n"), std::string::npos) << csv.substr(0, 300);
    EXPECT_NE(json.find("\"class_reached\": \"M5\""), std::string::npos);
    ASSERT_EQ(run("--r-table R2 --class M4"), 0);
    EXPECT_NE(text_of("out.txt").find("1.139   >= 0.75  ok"), std::string::npos) << text_of("out.txt");
}

TEST_F(Road, RefusesInOneLine) {
    for (const char* arguments : {"--r-table R9", "--q0 0", "--spacing 1", "--class P1", "--luminaire none.ies",
                                  "--csv none/a.csv", "--height x"}) {
        EXPECT_EQ(run(arguments), 2) << arguments;
        const std::string said = text_of("err.txt");
        EXPECT_TRUE(said.starts_with("vesper: ")) << said;
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    }
}

}  // namespace
