// The centre line and the outer border of every lane against those that esmini samples of the same files.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "roads/lanes.h"
#include "roads/opendrive.h"
#include "roads/road_surface.h"
#include "support/shared_data.h"

namespace vesper::test {
namespace {

// esmini works in double too and writes six digits: what is left is its table of arc lengths along polynomials.
constexpr double kTolerance = 0.01;  // m

struct Sampled {
    std::string road;
    size_t section = 0;
    int lane = 0;
    std::vector<glm::dvec4> points{};  ///< x, y, z, heading
};

std::vector<Sampled> read_samples(const std::filesystem::path& file) {
    std::vector<Sampled> samples;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        for (char& c : line)
            if (c == ',') c = ' ';
        std::istringstream words(line);
        std::string word;
        if (line.starts_with("lane")) {
            Sampled each;
            words >> word >> each.road >> each.section >> each.lane >> word;

            samples.push_back(each);
        } else if (glm::dvec4 p; words >> p.x >> p.y >> p.z >> p.w) {
            samples.back().points.push_back(p);
        }
    }
    return samples;
}

class EsminiSamples : public testing::TestWithParam<const char*> {};

TEST_P(EsminiSamples, AreMetWithinACentimetre) {
    const std::string name = GetParam();
    const auto csv = shared_data("scenario/esmini-output/" + name + ".track.csv");
    if (!is_here(csv)) GTEST_SKIP() << "no shared data";
    const roads::RoadNetwork network = roads::read_opendrive(shared_data("scenario/esmini/xodr/" + name + ".xodr"));
    const auto samples = read_samples(csv);
    ASSERT_FALSE(samples.empty());
    size_t points = 0;
    for (const Sampled& each : samples) {
        const auto road = std::find_if(network.roads.begin(), network.roads.end(),
                                       [&](const roads::Road& r) { return r.id == each.road; });
        ASSERT_NE(road, network.roads.end());
        const roads::LaneSection& section = road->sections.at(each.section);
        ASSERT_TRUE(section.find(each.lane)) << each.lane;
        for (size_t k = 0; k < each.points.size(); ++k) {
            const double s = section.s + (section.end - section.s) * static_cast<double>(k) /
                                             static_cast<double>(each.points.size() - 1);
            const roads::RoadPoint got = roads::lane_point(*road, section, each.lane, s, 1);
            const double off = glm::distance(got.position, glm::dvec3(each.points[k]));
            ASSERT_LT(off, kTolerance) << "road " << each.road << " lane " << each.lane << " s " << s << ": "
                                       << got.position.x << " " << got.position.y << " " << got.position.z << " for "
                                       << each.points[k].x << " " << each.points[k].y << " " << each.points[k].z;
            ASSERT_NEAR(std::remainder(got.heading - each.points[k].w, 2 * M_PI), 0, 1e-4);
            ++points;
        }
    }
    EXPECT_GT(points, 500u);
}

INSTANTIATE_TEST_SUITE_P(Files, EsminiSamples, testing::Values("fabriksgatan", "e6mini", "curves_elevation"));

}  // namespace
}  // namespace vesper::test
