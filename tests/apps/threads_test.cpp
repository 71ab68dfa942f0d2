// How many threads programs use: what wins, and what ranks take. SPDX-License-Identifier: MIT
#include "arguments/thread_arguments.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "ranks/ranks.h"
#include "scene/scene_files.h"
#include "support/program.h"

namespace vesper::test {
namespace {

// Of a machine with 8 processors.
void expect_threads(unsigned asked, const char* host, const char* driver, unsigned ranks, unsigned host_wanted,
                    unsigned driver_wanted) {
    const apps::WantedThreads wanted = apps::wanted_threads(asked, host, driver, 8, ranks);
    EXPECT_EQ(wanted.host, host_wanted) << asked << " " << (host ? host : "-") << " " << (driver ? driver : "-");
    EXPECT_EQ(wanted.driver, driver_wanted) << asked << " " << (host ? host : "-") << " " << (driver ? driver : "-");
}

TEST(Threads, OfTheOptionWinThenEachVariableThenTheOther) {
    for (const unsigned ranks : {0u, 1u, 4u}) {  // what was given is not divided
        expect_threads(3, nullptr, nullptr, ranks, 3, 3);
        expect_threads(3, "5", "6", ranks, 3, 3);
        expect_threads(0, "5", nullptr, ranks, 0, 5);
        expect_threads(0, nullptr, "6", ranks, 6, 0);
        expect_threads(0, "5", "6", ranks, 0, 0);
        expect_threads(0, "many", "6", ranks, 6, 0);
    }
    expect_threads(0, "5", "many", 1, 0, 0);
    expect_threads(0, nullptr, "0", 4, 2, 0);  // the driver's own meaning of 0
}

TEST(Threads, OfProcessorsAreSharedOutAmongRanks) {
    expect_threads(0, nullptr, nullptr, 1, 8, 8);
    expect_threads(0, nullptr, nullptr, 3, 2, 2);
    expect_threads(0, nullptr, nullptr, 20, 1, 1);
    expect_threads(0, nullptr, nullptr, 0, 8, 0);  // how many is not known
}

TEST(Threads, SlurmSaysHowManyTasksANodeHas) {
    using apps::Ranks;
    for (const auto& [node, tasks] : {std::pair(0u, 2u), {2u, 2u}, {3u, 1u}, {4u, 0u}})
        EXPECT_EQ(Ranks::tasks_of_node("2(x3),1", node), tasks) << node;
    EXPECT_EQ(Ranks::tasks_of_node("16", 0), 16u);
    for (const char* none : {"", "x", "(x2)"}) EXPECT_EQ(Ranks::tasks_of_node(none, 0), 0u) << none;
}

class ThreadsProgram : public ProgramTest {};

TEST_F(ThreadsProgram, SayWhatWasSet) {
    GltfFile file;
    file.root["nodes"].push_back({{"name", "eye"}, {"camera", 0}});
    file.root["cameras"] = {
        {{"type", "perspective"}, {"name", "eye"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
    folder.write("a.gltf", file.text());
    for (const auto& [options, environment, threads] : {std::tuple("", "LP_NUM_THREADS=1", "1"),
                                                        {"", "VESPER_THREADS=3 LP_NUM_THREADS=1", "3"},
                                                        {"--threads 2", "VESPER_THREADS=3 LP_NUM_THREADS=1", "2"},
                                                        {"--threads=2", "", "2"}}) {
        ASSERT_EQ(run(std::string("render a.gltf --size 8x8 --indirect off --stats-json a.json ") + options,
                      std::string("env -u VESPER_THREADS -u LP_NUM_THREADS ") + environment),
                  0)
            << said;
        EXPECT_NE(read_text(folder / "a.json").find(std::string("\"threads\": ") + threads + ","), std::string::npos)
            << options << " " << environment << ": " << read_text(folder / "a.json");
    }
}

}  // namespace
}  // namespace vesper::test
