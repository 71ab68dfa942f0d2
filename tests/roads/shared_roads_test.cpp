// Every OpenDRIVE file of the shared set loads, or says why not. SPDX-License-Identifier: MIT
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "base/error.h"
#include "roads/lanes.h"
#include "roads/opendrive.h"
#include "support/shared_data.h"

namespace vesper::test {
namespace {

std::vector<std::filesystem::path> shared_roads() {
    std::vector<std::filesystem::path> files;
    const auto folder = shared_data("scenario");
    if (!is_here(folder)) return files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".xodr") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

TEST(SharedRoads, LoadOrSayWhyNot) {
    const auto files = shared_roads();
    if (files.empty()) GTEST_SKIP() << "no shared data";
    // These have nothing to load: a root that is no OpenDRIVE, roads without geometry, XML that ends early.
    const std::set<std::string> hopeless{"root_tag_is_opendrive/negative.xodr", "valid_schema/negative16.xodr",
                                         "valid_schema/negative17.xodr", "valid_schema/negative18.xodr",
                                         "valid_xml_document/xml.valid_xml_document.negative.xodr"};
    for (const auto& file : files) {
        SCOPED_TRACE(file.string());
        const std::string name = file.parent_path().filename().string() + "/" + file.filename().string();
        try {
            const roads::RoadNetwork network = roads::read_opendrive(file);
            EXPECT_FALSE(hopeless.contains(name));
            const roads::LaneGraph graph(network);
            EXPECT_FALSE(graph.lanes().empty());
        } catch (const Error& error) {
            EXPECT_TRUE(hopeless.contains(name)) << error.what();
            EXPECT_NE(std::string(error.what()).find(".xodr:"), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace vesper::test
