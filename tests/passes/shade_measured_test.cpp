// Shading by measured lamps, and of roads with a table: against the reference. SPDX-License-Identifier: MIT
#include <filesystem>
#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "places.h"
#include "scene/scene.h"
#include "support/lamps.h"
#include "support/noise.h"
#include "support/shading.h"

namespace vesper::test::shade_measured_test {
namespace {

const std::filesystem::path kData = std::filesystem::path(VESPER_SOURCE_DIR) / "data/photometry";

/// A luminaire, two beams, a floodlight of type B, two lamps that are dark on their axis and one that shines here and
/// there, on nodes of every pose; and some lamps of other kinds.
struct Street {
    scene::Scene scene;
    gpu_scene::SceneFrame frame;
    gpu_scene::IntensityTables tables;
    gpu_scene::LampList list;
    std::vector<reference::MeasuredLamp> measured;
    std::vector<reference::RoadSurface> roads;

    /// `kinds` of the lamps: the seventh has edges too steep for lamps that all but touch a surface.
    explicit Street(VkExtent2D extent, uint32_t lamps, uint32_t seed, LampMix others = {}, uint32_t kinds = 6) {
        for (const char* file : {"street-lamp.ies", "low-beam.csv", "high-beam.csv"})
            scene.distributions.push_back(photometry::read_distribution(kData / file));
        photometry::Distribution flood;
        flood.goniometry = photometry::Goniometry::TypeB;
        flood.horizontal = {-60, -30, 0, 30, 60}, flood.vertical = {-90, -20, 5, 90};
        for (size_t i = 0; i < 20; ++i) flood.candela.push_back(double(100 + 37 * i % 400));
        scene.distributions.push_back(flood);
        // Dark where others are bright: about the axis, and before the lamp.
        photometry::Distribution ring, behind;
        ring.horizontal = {0}, ring.vertical = {0, 40, 60, 80, 180}, ring.candela = {0, 0, 900, 0, 0};
        behind.goniometry = photometry::Goniometry::TypeA;
        behind.horizontal = {100, 140, 180}, behind.vertical = {-40, 0, 40},
        behind.candela = {0, 0, 0, 0, 700, 0, 0, 0, 0};
        scene.distributions.push_back(ring), scene.distributions.push_back(behind);
        photometry::Distribution spots;
        for (int c = 0; c <= 360; c += 6) spots.horizontal.push_back(c);
        for (int gamma = 0; gamma <= 180; gamma += 3) spots.vertical.push_back(gamma);
        for (size_t i = 0; i < 61 * 61; ++i)
            spots.candela.push_back(i % 61 > 4 && i % 61 < 56 && i / 61 % 60 * 37 % 13 == 0 && i % 61 * 5 % 7 == 3 ? 900
                                                                                                                   : 0);
        scene.distributions.push_back(spots);
        scene.reflection_tables = {photometry::find_reflection_table("R3"), photometry::find_reflection_table("W4")};
        for (const photometry::ReflectionTable& table : scene.reflection_tables)
            roads.emplace_back(photometry::extended(table));

        std::mt19937 random(seed);
        std::uniform_real_distribution<float> unit(0, 1);
        std::normal_distribution<float> normal;
        for (uint32_t i = 0; i < lamps; ++i) {
            scene::Lamp lamp{
                .kind = scene::Lamp::Kind::Measured, .intensity = 0.2f + unit(random), .distribution = i % kinds};
            scene.lamps.push_back(lamp);
            scene::Node node;
            node.lamp = i;
            scene.nodes.push_back(node);
            glm::mat4 pose = glm::translate(
                glm::mat4(1), glm::vec3(40 * unit(random) - 20, 8 * unit(random) - 1, 10 - 300 * unit(random)));
            pose = glm::rotate(pose, 6.28f * unit(random),
                               glm::normalize(glm::vec3(normal(random), normal(random), normal(random))));
            if (i % 3 == 0) pose = glm::scale(pose, glm::vec3(-2, 2, 2));  // mirrored
            frame.world.push_back(pose);
        }
        tables = gpu_scene::intensity_tables(scene);
        const gpu_scene::View view = gpu_scene::View::symmetric(extent, 0.7f, glm::mat4(1));
        list = gpu_scene::lamp_list(gpu_scene::placed_lamps(scene), tables, frame, view);
        for (uint32_t i = 0; i < lamps; ++i) {
            glm::dmat3 axes(frame.world[i]);
            for (int c = 0; c < 3; ++c) axes[c] = glm::normalize(axes[c]);
            measured.push_back({&scene.distributions[i % kinds], axes, double(scene.lamps[i].intensity)});
        }
        // Tables come third in the list.
        const gpu_scene::LampList more = street_lamps(others, 300, seed);
        list.lamps.insert(list.lamps.begin(), more.lamps.begin(), more.lamps.begin() + others.cones + others.powers);
        list.lamps.insert(list.lamps.end(), more.lamps.end() - others.directional, more.lamps.end());
        list.counts.cones = others.cones, list.counts.powers = others.powers,
        list.counts.directional = others.directional;
    }
};

/// Every surface: roads seen flat and steep, matt and glossy ones, sky.
Surfaces noise(VkExtent2D extent, uint32_t seed) {
    Noise random(seed);
    Surfaces p{extent, {}, {}, {}};
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        const bool road = i % 3 != 0, sky = random.unit() < 0.05f;
        const float kind = road ? (i % 2 ? -1.0f : -2.0f) : i % 5 == 0 ? random.fine() : 0.0f;
        p.reflectance.emplace_back(random.fine(), random.fine(), random.fine(), kind);
        const glm::dvec3 up =
            glm::normalize(glm::dvec3(0.05 * random.normal(), 1, 0.02 + 0.3 * random.unit() * random.unit()));
        const glm::dvec3 wall = random.facing(0.1);
        p.surface.emplace_back(glm::vec2(reference::octahedral_encode(road ? up : wall)),
                               sky ? 0 : 2 * std::pow(60.0f, random.unit()),
                               road         ? -1.8f * random.unit()
                               : i % 4 == 0 ? 1.0f
                                            : 0.2f + 0.8f * random.unit());
        p.emission.emplace_back(0);
    }
    return p;
}

/// Ground 1.5 m under the eye, matt or a road, sky above: blocks of pixels that lie close together.
Surfaces ground(VkExtent2D extent, bool road = false) {
    const gpu_scene::View view = gpu_scene::View::symmetric(extent, 0.7f, glm::mat4(1));
    Surfaces p{extent, {}, {}, {}};
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        const double ray = double(view.ray_scale().y) * (double(p.pixel(i).y) + 0.5) + double(view.ray_offset().y);
        p.reflectance.emplace_back(0.5, 0.25, 0.75, road ? -1 : 0);
        p.surface.emplace_back(glm::vec2(reference::octahedral_encode(glm::dvec3(0, 1, 0))),
                               ray < -0.005 ? float(1.5 / -ray) : 0.0f, road ? -0.6f : 1.0f);
        p.emission.emplace_back(0);
    }
    return p;
}

// 2e-3 for the device's angles, which are polynomials, where edges are steep: at the cut-off of a low beam intensity
// changes by a factor of e within 0.12 degrees, 480 per rad, and directions are known to some 1e-6 rad.
void expect_reference(PassRig& rig, const Street& street, const Surfaces& s, const render::ShadeSettings& settings) {
    const Shot shot = shade(rig, s, street.list, {}, settings, street.tables);
    expect_reference(shot, s, street.list, settings, {street.measured, street.roads, {}}, {2e-3, 1e-7});
}

TEST(ShadeMeasured, MatchesTheReferenceAtEverySize) {
    PassRig rig;
    render::ShadeSettings settings;
    settings.ambient = {0.2f, 0.3f, 0.4f}, settings.sky = {0.01f, 0.02f, 0.03f};
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {33, 9}, {67, 65}}) {
        SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height));
        expect_reference(rig, Street(extent, 24, extent.height), noise(extent, extent.width), settings);
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(ShadeMeasured, MatchesTheReferenceBesideEveryOtherKind) {
    PassRig rig;
    const VkExtent2D extent{64, 40};
    for (LampMix others : {LampMix{20, 0, 0}, {0, 20, 0}, {10, 10, 2}})
        expect_reference(rig, Street(extent, 20, 5, others), noise(extent, 6), {});
    EXPECT_EQ(rig.complaints(), "");
}

// Blocks so small that light culling asks for a few rings and sectors of a table, and larger ones.
TEST(ShadeMeasured, NoLampIsLostInTheDarkOfItsAxis) {
    PassRig rig;
    for (const VkExtent2D extent : {VkExtent2D{160, 100}, {64, 40}, {32, 20}})
        for (const uint32_t seed : {1u, 2u})
            expect_reference(rig, Street(extent, 140, seed, {}, 7), ground(extent), {.merge_error = 0});
    EXPECT_EQ(rig.complaints(), "");
}

TEST(ShadeMeasured, AThousandLampsOnRoadsEqualTheReference) {
    PassRig rig;
    const VkExtent2D extent{48, 30};
    expect_reference(rig, Street(extent, 1000, 9), noise(extent, 10), {});
    EXPECT_EQ(rig.complaints(), "");
}

// Tables have kinks at every node, where a polynomial that meets four pixels may be wrong by 3.5 times the tolerance
// between them; hardly a pixel sees that of a lamp that gives most of its light.
TEST(ShadeMeasured, ShadingWithSumsIsShadingLampByLamp) {
    PassRig rig;
    const render::ShadeSettings settings;
    for (const auto& [extent, road] :
         {std::pair{VkExtent2D{320, 200}, false}, {{320, 200}, true}, {{840, 525}, false}}) {
        SCOPED_TRACE(road ? "road" : "matt");
        const Street street(extent, 60, extent.width);
        const Surfaces s = ground(extent, road);
        const auto luminance = [&](float tolerance) {
            return shade(rig, s, street.list, {.threshold = 1e-6f}, {.merge_error = tolerance}, street.tables).pixels;
        };
        const std::vector<glm::vec4> merged = luminance(settings.merge_error), one_by_one = luminance(0);
        size_t far_off = 0;
        for (size_t i = 0; i < merged.size(); ++i) {
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(merged[i][c], one_by_one[i][c], 3.5f * settings.merge_error * one_by_one[i][c] + 1e-7f)
                    << i;
            far_off += std::abs(merged[i].y - one_by_one[i].y) > settings.merge_error * one_by_one[i].y + 1e-7f ? 1 : 0;
        }
        EXPECT_LT(far_off, merged.size() / 1000);
        EXPECT_NE(merged, one_by_one) << "nothing was added up";
    }
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::shade_measured_test
