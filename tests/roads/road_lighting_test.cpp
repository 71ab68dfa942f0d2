// Road lighting: closed forms, the rules of the grid, symmetry, and a worked example against independent numbers.
// SPDX-License-Identifier: MIT
#include "roads/road_lighting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "places.h"
#include "support/complaints.h"
#include "support/temp_folder.h"
#include "vision/glare.h"

namespace vesper::test {

using roads::Arrangement, roads::LoadedLayout, roads::RoadLighting, roads::calculate_lighting, roads::vector_of;

namespace {

/// The same intensity in all directions, cd.
photometry::Distribution isotropic(double candela) {
    return {.name = "isotropic", .horizontal = {0}, .vertical = {0, 180}, .candela = {candela, candela}};
}

/// r = q0 cos^3(gamma) at close nodes: straight lines between them keep q within 1e-5 of q0.
photometry::ReflectionTable matt_road(double q0) {
    photometry::ReflectionTable table{.name = "lambert", .beta = {0, 180}};
    for (int i = 0; i <= 500; ++i) {
        const double t = i < 400 ? i * 0.01 : 4 + (i - 400) * 0.09;
        table.tan_gamma.push_back(t);
        for (int b = 0; b < 2; ++b) table.r.push_back(q0 * std::pow(1 + t * t, -1.5));
    }
    return table;
}

/// The worked example of docs/road.md: 10 klm lamps on 8 m poles every 30 m along the right edge of 7 m of road.
LoadedLayout worked_example(const char* surface) {
    LoadedLayout layout{{.name = "example", .width = 7, .lanes = 2, .spacing = 30, .height = 8, .overhang = 0.5}};
    layout.distribution =
        photometry::read_distribution(std::filesystem::path(VESPER_SOURCE_DIR) / "data/road/luminaire.ldt");
    layout.surface = photometry::find_reflection_table(surface);
    return layout;
}

LoadedLayout isotropic_road() {
    LoadedLayout layout{{.name = "test"}};
    layout.distribution = isotropic(1000);
    layout.surface = matt_road(0.05);
    return layout;
}

TEST(RoadLighting, OneIsotropicLampOverLambert) {
    const LoadedLayout layout = isotropic_road();
    const roads::PlacedLuminaire lamp{{5, 2, 8}, glm::dmat3(1)};
    for (const glm::dvec2 p : {glm::dvec2(5, 2), glm::dvec2(0, 0), glm::dvec2(11, 5), glm::dvec2(-20, 6)}) {
        const double d2 = (p.x - 5) * (p.x - 5) + (p.y - 2) * (p.y - 2) + 64;
        const double e = 1000 * 8 / std::pow(d2, 1.5);  // I cos(gamma) / d^2
        EXPECT_NEAR(roads::horizontal_illuminance(layout, {&lamp, 1}, p), e, 1e-12);
        EXPECT_NEAR(roads::luminance_towards(layout, {&lamp, 1}, p, {-60, 1.75}) / (0.05 * e), 1, 2e-4);
    }
}

TEST(RoadLighting, LuminairesCountWithinTheirReach) {
    const LoadedLayout layout = isotropic_road();
    const roads::PlacedLuminaire lamp{{0, 0, 8}, glm::dmat3(1)};
    const auto e = [&](double x, double y) { return roads::horizontal_illuminance(layout, {&lamp, 1}, {x, y}); };
    const auto l = [&](double x, double y) {
        return roads::luminance_towards(layout, {&lamp, 1}, {x, y}, {x - 60, y});
    };
    EXPECT_GT(e(39.9, 0), 0);
    EXPECT_EQ(e(40.1, 0), 0);
    EXPECT_EQ(e(30, 30), 0);   // 5H in plan
    EXPECT_GT(l(39.9, 0), 0);  // the lamp 5H before the point
    EXPECT_EQ(l(40.1, 0), 0);
    EXPECT_GT(l(-95.9, 0), 0);  // 12H beyond it
    EXPECT_EQ(l(-96.1, 0), 0);
    EXPECT_GT(l(0, -39.9), 0);
    EXPECT_EQ(l(0, -40.1), 0);
}

TEST(RoadLighting, TheLampBeyondThePointIsTheSpecularOne) {
    LoadedLayout layout = isotropic_road();
    layout.surface = photometry::find_reflection_table("R3");
    const roads::PlacedLuminaire lamp{{0, 1.75, 8}, glm::dmat3(1)};
    const auto l = [&](double x) { return roads::luminance_towards(layout, {&lamp, 1}, {x, 1.75}, {-80, 1.75}); };
    EXPECT_NEAR(l(-16), 326e-4 * 1000 / 64, 1e-9);  // tan gamma 2, beta 0
    EXPECT_NEAR(l(16), 38e-4 * 1000 / 64, 1e-9);    // beta 180
    // A quarter turn: the observer looks along x, the lamp is across.
    EXPECT_NEAR(roads::luminance_towards(layout, {&lamp, 1}, {0, 1.75 - 16}, {-80, 1.75 - 16}), 34e-4 * 1000 / 64,
                1e-9);
}

TEST(RoadLighting, GridFollowsTheSpacing) {
    const struct {
        double spacing;
        size_t count;
    } cases[] = {{12, 10}, {30, 10}, {30.1, 11}, {33, 11}, {36, 12}, {45, 15}, {47, 16}, {60, 20}};
    for (const auto& c : cases) {
        LoadedLayout layout = isotropic_road();
        layout.spacing = c.spacing;
        layout.lanes = 3;
        layout.width = 10.5;
        const roads::CalculationField field = roads::calculation_field(layout);
        ASSERT_EQ(field.x.size(), c.count) << c.spacing;
        EXPECT_DOUBLE_EQ(field.step, c.spacing / static_cast<double>(c.count));
        EXPECT_DOUBLE_EQ(field.x.front(), field.step / 2);
        EXPECT_NEAR(field.x.back(), c.spacing - field.step / 2, 1e-12);
        ASSERT_EQ(field.y.size(), 9u);
        EXPECT_DOUBLE_EQ(field.y[0], 3.5 / 6);
        EXPECT_DOUBLE_EQ(field.y[4], 5.25);  // the middle of lane 2
    }
}

TEST(RoadLighting, ArrangementsStandWhereTheySay) {
    LoadedLayout layout = isotropic_road();
    layout.overhang = 1;
    layout.reservation = 4;
    const auto mounts = [&](Arrangement arrangement) {
        layout.arrangement = arrangement;
        return roads::luminaire_mounts(layout);
    };
    EXPECT_EQ(vector_of(mounts(Arrangement::Right)[0].position), glm::dvec3(0, 1, 8));
    EXPECT_EQ(vector_of(mounts(Arrangement::Left)[0].position), glm::dvec3(0, 6, 8));
    EXPECT_EQ(mounts(Arrangement::Left)[0].facing_deg, -90);
    EXPECT_EQ(vector_of(mounts(Arrangement::Opposite)[1].position), glm::dvec3(0, 6, 8));
    EXPECT_EQ(vector_of(mounts(Arrangement::Staggered)[1].position), glm::dvec3(15, 6, 8));
    EXPECT_EQ(vector_of(mounts(Arrangement::Central)[0].position), glm::dvec3(0, 6, 8));
    EXPECT_EQ(vector_of(mounts(Arrangement::Central)[1].position), glm::dvec3(0, 12, 8));
    EXPECT_EQ(mounts(Arrangement::Central)[1].facing_deg, 90);
    layout.left_hand_traffic = true;
    EXPECT_EQ(vector_of(mounts(Arrangement::Central)[0].position), glm::dvec3(0, 1, 8));
    EXPECT_EQ(vector_of(mounts(Arrangement::Central)[1].position), glm::dvec3(0, -5, 8));
    EXPECT_EQ(mounts(Arrangement::Central)[1].facing_deg, -90);
    EXPECT_EQ(roads::placed_luminaires(layout, -60, 60).size(), 10u);
}

TEST(RoadLighting, LuminairesFaceTheCarriageway) {
    LoadedLayout layout = isotropic_road();
    layout.arrangement = Arrangement::Opposite;
    const auto axes = [&](size_t i) { return roads::placed_luminaires(layout, 0, 0)[i].axes; };
    const auto near = [](glm::dvec3 a, glm::dvec3 b) { return glm::length(a - b) < 1e-12; };
    EXPECT_TRUE(near(axes(0)[0], {1, 0, 0}) && near(axes(0)[1], {0, 1, 0}) && near(axes(0)[2], {0, 0, 1}));
    EXPECT_TRUE(near(axes(1)[0], {-1, 0, 0}) && near(axes(1)[1], {0, -1, 0}) && near(axes(1)[2], {0, 0, 1}));
    layout.tilt_deg = 30;  // the street side goes up, on either side
    EXPECT_NEAR(axes(0)[1].z, 0.5, 1e-12);
    EXPECT_NEAR(axes(1)[1].z, 0.5, 1e-12);
    layout.tilt_deg = 0;
    layout.roll_deg = 30;
    EXPECT_NEAR(axes(0)[0].z, -0.5, 1e-12);
    layout.roll_deg = 0;
    layout.orientation_deg = 90;
    EXPECT_TRUE(near(axes(0)[0], {0, 1, 0}));
    layout.orientation_deg = 0;
    layout.c0_street_side = true;
    EXPECT_TRUE(near(axes(0)[0], {0, 1, 0}) && near(axes(0)[1], {-1, 0, 0}));
    EXPECT_TRUE(near(axes(1)[0], {0, -1, 0}));
}

TEST(RoadLighting, SymmetricRoadsGiveSymmetricFigures) {
    LoadedLayout layout = worked_example("R2");
    layout.arrangement = Arrangement::Opposite;
    const RoadLighting both = calculate_lighting(layout);
    EXPECT_NEAR(both.edge_ratio_left, both.edge_ratio_right, 1e-12);
    EXPECT_NEAR(both.observers[0].average_luminance, both.observers[1].average_luminance, 1e-9);
    EXPECT_NEAR(both.observers[0].threshold_increment_percent, both.observers[1].threshold_increment_percent, 1e-9);
    const size_t columns = both.field.x.size();
    for (size_t i = 0; i < columns; ++i)
        EXPECT_NEAR(both.points[i].luminance[0], both.points[5 * columns + i].luminance[1], 1e-9);
    EXPECT_GT(std::abs(both.points[0].luminance[0] - both.points[0].luminance[1]), 0.01);

    // The mirror image of a road has its figures, lane by lane.
    layout = worked_example("R3");
    const RoadLighting right = calculate_lighting(layout);
    layout.arrangement = Arrangement::Left;
    layout.left_hand_traffic = true;
    const RoadLighting left = calculate_lighting(layout);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(left.observers[i].average_luminance, right.observers[i].average_luminance, 1e-9);
        EXPECT_NEAR(left.observers[i].threshold_increment_percent, right.observers[i].threshold_increment_percent,
                    1e-9);
        EXPECT_EQ(left.observers[i].lane, static_cast<int>(i) + 1);
    }
    EXPECT_NEAR(left.edge_ratio_left, right.edge_ratio_right, 1e-12);
    EXPECT_GT(std::abs(right.observers[0].average_luminance - right.observers[1].average_luminance), 0.05);
}

TEST(RoadLighting, FluxAndMaintenanceScale) {
    LoadedLayout layout = worked_example("R3");
    const RoadLighting plain = calculate_lighting(layout);
    layout.maintenance_factor = 0.8;
    const RoadLighting kept = calculate_lighting(layout);
    EXPECT_NEAR(kept.average_luminance / plain.average_luminance, 0.8, 1e-12);
    EXPECT_NEAR(kept.minimum_illuminance / plain.minimum_illuminance, 0.8, 1e-12);
    EXPECT_NEAR(kept.threshold_increment_percent, plain.threshold_increment_percent, 1e-9);  // of the new installation
    EXPECT_NEAR(kept.overall_uniformity, plain.overall_uniformity, 1e-12);
    layout.maintenance_factor = 1;
    layout.flux_factor = 2;
    const RoadLighting twice = calculate_lighting(layout);
    EXPECT_NEAR(twice.average_luminance / plain.average_luminance, 2, 1e-12);
    EXPECT_NEAR(twice.threshold_increment_percent / plain.threshold_increment_percent, std::pow(2, 0.2), 1e-9);
    layout.flux_factor = 0;
    EXPECT_THROW(calculate_lighting(layout), Error);
}

TEST(RoadLighting, VeilOfOneLamp) {
    LoadedLayout layout = isotropic_road();
    // 10 degrees above the line of sight, itself 1 degree down.
    const auto lamp_at = [](double degrees, double distance) {
        const double a = (degrees - 1) * std::numbers::pi / 180;
        return roads::PlacedLuminaire{{distance * std::cos(a), 1, 1.5 + distance * std::sin(a)}, glm::dmat3(1)};
    };
    const auto veil = [&](const roads::PlacedLuminaire& lamp) {
        return roads::veiling_luminance(layout, {&lamp, 1}, {0, 1, 1.5});
    };
    const double cos10 = std::cos(10 * std::numbers::pi / 180);
    const double k = 9.86 * (1 + std::pow(23 / 66.4, 4));
    EXPECT_NEAR(k, 10, 0.005);
    EXPECT_NEAR(veil(lamp_at(10, 40)), k * 1000 * cos10 / 1600 / 100, 1e-9);
    const double e = 1000 * std::cos(std::numbers::pi / 180) / 1e4, near = 1 + std::pow(23 / 62.5, 4);
    EXPECT_NEAR(veil(lamp_at(1, 100)), e * (10 + 5 * near), 1e-9);
    EXPECT_EQ(veil(lamp_at(21.2, 40)), 0);  // behind the roof
    EXPECT_GT(veil(lamp_at(20.8, 40)), 0);
    EXPECT_EQ(veil(lamp_at(2, 501)), 0);
    EXPECT_EQ(veil(lamp_at(170, 20)), 0);
    layout.observer_age = 66.4;
    EXPECT_NEAR(veil(lamp_at(10, 40)), 2 * 9.86 * 1000 * cos10 / 1600 / 100, 1e-9);
    const roads::PlacedLuminaire aside{{10, 1 + 10 * std::sqrt(3.0) + 0.5, 1.5},
                                       glm::dmat3(1)};  // more than 60 degrees off
    EXPECT_EQ(veil(aside), 0);
    EXPECT_NEAR(vision::threshold_increment(0.3, 1), 19.5, 1e-12);
    EXPECT_NEAR(vision::threshold_increment(0.3, 10), 95 * 0.3 / std::pow(10, 1.05), 1e-12);
}

TEST(RoadLighting, ClassesHaveTheirLimits) {
    RoadLighting result;
    result.average_luminance = 1.0, result.overall_uniformity = 0.40, result.longitudinal_uniformity = 0.60;
    result.threshold_increment_percent = 15, result.edge_ratio = 0.30;
    ASSERT_TRUE(roads::reached_class(result));
    EXPECT_STREQ(roads::reached_class(result)->name, "M3");
    result.average_luminance = 0.99;
    EXPECT_STREQ(roads::reached_class(result)->name, "M4");
    result.threshold_increment_percent = 15.1;
    EXPECT_STREQ(roads::reached_class(result)->name, "M6");
    result.edge_ratio = 0.29;
    EXPECT_EQ(roads::reached_class(result), nullptr);
    EXPECT_EQ(roads::find_lighting_class("M7"), nullptr);
    EXPECT_EQ(roads::find_lighting_class("M1")->average_luminance, 2.0);
}

/// Independent calculation (another program, double precision; its luminances agree with a Radiance simulation to
/// 3e-6): Lav, Uo, Ul, TI %, average luminance of lanes 1 and 2.
TEST(RoadLighting, WorkedExampleAgrees) {
    const struct {
        const char* surface;
        double luminance, overall, longitudinal, increment, lane1, lane2;
    } expected[] = {
        {"R1", 1.4539, 0.6884, 0.7246, 12.522, 1.4539, 1.4794}, {"R2", 1.1389, 0.5413, 0.6590, 15.223, 1.1389, 1.1967},
        {"R3", 1.1637, 0.4450, 0.5442, 14.963, 1.1637, 1.2544}, {"R4", 1.3370, 0.3731, 0.5642, 13.390, 1.3370, 1.4642},
        {"C1", 1.5268, 0.6328, 0.7118, 12.041, 1.5268, 1.5626}, {"C2", 1.1765, 0.4670, 0.5627, 14.833, 1.1765, 1.2593}};
    for (const auto& e : expected) {
        SCOPED_TRACE(e.surface);
        const RoadLighting r = calculate_lighting(worked_example(e.surface));
        EXPECT_NEAR(r.average_luminance / e.luminance, 1, 1e-3);
        EXPECT_NEAR(r.overall_uniformity / e.overall, 1, 1e-3);
        EXPECT_NEAR(r.longitudinal_uniformity / e.longitudinal, 1, 1e-3);
        EXPECT_NEAR(r.threshold_increment_percent / e.increment, 1, 1e-3);
        EXPECT_NEAR(r.observers[0].average_luminance / e.lane1, 1, 1e-3);
        EXPECT_NEAR(r.observers[1].average_luminance / e.lane2, 1, 1e-3);
        EXPECT_NEAR(r.edge_ratio / 0.6979, 1, 1e-3);
        EXPECT_NEAR(r.average_illuminance / 14.055, 1, 1e-3);
        EXPECT_NEAR(r.minimum_illuminance / 10.654, 1, 1e-3);
        EXPECT_NEAR(r.observers[0].veil / 0.25989, 1, 1e-3);
        RecordProperty(e.surface, std::to_string(r.average_luminance));
    }
}

TEST(RoadLighting, WorkedExampleAgreesPointByPoint) {
    // x, y, E_h lx, luminance for the observers of lane 1 and lane 2; table R3. Same source.
    const struct {
        double x, y, illuminance, lane1, lane2;
    } expected[] = {{1.5, 0.5833, 22.32975, 1.421643, 1.132431},  {13.5, 0.5833, 13.28570, 2.576927, 2.342783},
                    {28.5, 0.5833, 22.32975, 1.405303, 1.246684}, {4.5, 1.75, 16.31600, 1.397954, 1.539806},
                    {22.5, 1.75, 12.29939, 1.320227, 1.394934},   {10.5, 2.9167, 12.36243, 1.402861, 1.798056},
                    {25.5, 4.0833, 15.14823, 0.819523, 0.922147}, {7.5, 5.25, 11.57585, 0.645537, 0.768367},
                    {1.5, 6.4167, 15.01482, 0.550920, 0.602004},  {19.5, 6.4167, 10.65355, 0.676092, 0.733749}};
    const RoadLighting r = calculate_lighting(worked_example("R3"));
    ASSERT_EQ(r.points.size(), 60u);
    for (const auto& e : expected) {
        const auto found = std::find_if(r.points.begin(), r.points.end(), [&](const roads::FieldPoint& p) {
            return std::abs(p.x - e.x) < 1e-3 && std::abs(p.y - e.y) < 1e-3;
        });
        ASSERT_NE(found, r.points.end()) << e.x << " " << e.y;
        EXPECT_NEAR(found->illuminance / e.illuminance, 1, 1e-4) << e.x << " " << e.y;
        EXPECT_NEAR(found->luminance[0] / e.lane1, 1, 1e-4) << e.x << " " << e.y;
        EXPECT_NEAR(found->luminance[1] / e.lane2, 1, 1e-4) << e.x << " " << e.y;
    }
}

TEST(RoadLighting, RefusesWhatIsNoRoad) {
    const auto refused = [](auto&& change) {
        LoadedLayout layout = isotropic_road();
        change(layout);
        try {
            calculate_lighting(layout);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    EXPECT_EQ(refused([](LoadedLayout&) {}), "accepted");
    EXPECT_TRUE(contains(refused([](LoadedLayout& r) { r.spacing = 0; }), "test: the spacing"));
    EXPECT_TRUE(contains(refused([](LoadedLayout& r) { r.height = std::nan(""); }), "test: the height"));
    EXPECT_TRUE(contains(refused([](LoadedLayout& r) { r.lanes = 0; }), "lanes"));
    EXPECT_TRUE(contains(refused([](LoadedLayout& r) { r.width = -7; }), "width"));
    EXPECT_TRUE(contains(refused([](LoadedLayout& r) { r.maintenance_factor = 0; }), "maintenance"));
    EXPECT_TRUE(contains(refused([](LoadedLayout& r) { r.arrangement = Arrangement::List; }), "list"));
    EXPECT_TRUE(contains(refused([](LoadedLayout& r) { r.distribution = {}; }), "distribution"));
    EXPECT_TRUE(contains(refused([](LoadedLayout& r) { r.surface = {}; }), "reflection table"));
    EXPECT_TRUE(contains(refused([](LoadedLayout& r) {
                             r.arrangement = Arrangement::List;
                             r.mounts = {{{0, 3, 1}, 90}};
                         }),
                         "out of reach"));
}

}  // namespace
}  // namespace vesper::test
