// Light between surfaces against closed forms and against paths of rays. SPDX-License-Identifier: MIT
#include "transport/radiosity.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include "support/gathered.h"
#include "support/made_cells.h"
#include "support/noise.h"
#include "support/rooms.h"
#include "transport/light_tracer.h"

namespace vesper::test::radiosity_test {
namespace {

using glm::dvec3, glm::vec3, transport::Radiosity, transport::RadiosityLight;

constexpr double kPi = std::numbers::pi;
const dvec3 kUp(0, 1, 0);

// The closed room that glows, an integrating sphere of any shape: E = pi L (1 + rho + rho^2 + ...), everywhere. Rays
// all meet the same light, so that only the looks at emitters are left to chance.
TEST(Radiosity, ARoomThatGlowsHasTheGeometricSeries) {
    constexpr double kEmission = 5, kReflectance = 0.6;
    scene::Scene scene;
    add_room(scene, add_material(scene, float(kReflectance), float(kEmission)), {4, 3, 6});
    const Radiosity radiosity = gathered(scene);
    for (const uint32_t reflections : {0u, 1u, 2u, 5u, 60u}) {
        const auto light = lux(radiosity.solve({.reflections = reflections}).other);
        const double want = kPi * kEmission * (1 - std::pow(kReflectance, reflections + 1)) / (1 - kReflectance);
        // 3 % of a look that 96 looks and rays of some 400 cells leave less than 0.4 % of.
        EXPECT_NEAR(mean_over_all(radiosity, light) / want, 1, 0.004) << reflections;
        // A cell: a twentieth of them lies in corners, with a few looks at near walls.
        for (size_t i = 0; i < light.size(); ++i)
            if (!radiosity.grid.is_air(radiosity.numbers[i])) {
                EXPECT_NEAR(light[i] / want, 1, 0.1) << i;
            }
    }
    // As many reflections as matter.
    const double all = kPi * kEmission / (1 - kReflectance);
    const auto most = lux(radiosity.solve({.reflections = 100, .reflection_error = 0.01}).other),
               few = lux(radiosity.solve({.reflections = 100, .reflection_error = 0.2}).other);
    EXPECT_NEAR(mean_over_all(radiosity, most), 0.99 * all, 0.009 * all);
    EXPECT_NEAR(mean_over_all(radiosity, few), 0.88 * all, 0.08 * all);
    EXPECT_EQ(luminance(dvec3(radiosity.solve({}).lamps[0])), 0);
}

// A lamp's light in a closed room: once reflected, the mean over the walls is Phi rho / A, and so on.
TEST(Radiosity, AClosedRoomKeepsTheLightOfALamp) {
    constexpr double kCandela = 500, kReflectance = 0.8;
    scene::Scene scene;
    add_room(scene, add_material(scene, float(kReflectance)), {4, 3, 6});
    add_lamp(scene, float(kCandela), {1.3, 0.4, -2.2});
    const Radiosity radiosity = gathered(scene);
    const double area = 2 * (8 * 6 + 8 * 12 + 6 * 12), first = 4 * kPi * kCandela / area;
    for (const uint32_t reflections : {0u, 1u, 3u, 80u}) {
        const Radiosity::Solution light = radiosity.solve({.reflections = reflections});
        // Four places stand for a square metre; and light that goes to and fro leaves by no gap.
        EXPECT_NEAR(mean_over_all(radiosity, lux(light.lamps)) / first, 1, 0.02);
        const double want = first * kReflectance * (1 - std::pow(kReflectance, reflections)) / (1 - kReflectance);
        EXPECT_NEAR(mean_over_all(radiosity, lux(light.other)), want, 0.03 * want + 1e-9) << reflections;
    }
}

TEST(Radiosity, AnOpenPlaneHasTheWholeSky) {
    scene::Scene scene;
    add_floor(scene, add_material(scene, 0.5f), 12);
    const Radiosity radiosity = gathered(scene);
    const auto light = radiosity.solve({.sky = {1, 2, 3}}).other;
    size_t floors = 0;
    for (size_t i = 0; i < light.size(); ++i) {
        if (radiosity.grid.is_air(radiosity.numbers[i])) continue;
        ++floors;
        EXPECT_NEAR(radiosity.sky[i], 1, 1e-6);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(light[i][c], kPi * (c + 1), 1e-5) << "in float";
    }
    EXPECT_EQ(floors, 25u * 25u) << "borders lie in the middle of cubes";
}

// A wall on nothing sees all directions before it; on a wide floor those above the horizon, beside what is beyond the
// floor's edge: (1 - z / sqrt(z^2 + R^2)) / 2 of the light is the floor's, a strip of width R, at the height z.
TEST(Radiosity, AWallHasItsPartOfTheSky) {
    constexpr double kFar = 30;
    for (const bool floor : {false, true}) {
        scene::Scene scene;
        add_rectangle(scene, add_material(scene, 0), {-20, 0, 0}, {40, 0, 0}, {0, 6, 0});
        if (floor) add_rectangle(scene, 0, {-100, 0, 0}, {0, 0, float(kFar)}, {200, 0, 0});
        const Radiosity radiosity = gathered(scene, {.rays = 128});
        const std::vector<double> sky(radiosity.sky.begin(), radiosity.sky.end());
        for (const double z : {1.0, 3.0, 5.0}) {
            const auto of_wall = [&](size_t i, dvec3 middle) {
                return radiosity.grid.facing(radiosity.numbers[i]) == 4 && std::abs(middle.y - z) < 0.1;
            };
            const double want = floor ? 0.5 + 0.5 * z / std::sqrt(z * z + kFar * kFar) : 1;
            // 128 rays of each of 41 cells: 0.7 % if they were not spread evenly.
            EXPECT_NEAR(mean_over(radiosity, sky, of_wall), want, floor ? 0.02 : 1e-6) << z;
        }
    }
}

TEST(Radiosity, NoSkyInAClosedRoom) {
    scene::Scene scene;
    add_room(scene, add_material(scene, 0.5f), {2.3f, 1.7f, 3.1f});
    const Radiosity radiosity = gathered(scene);
    EXPECT_EQ(*std::ranges::max_element(radiosity.sky), 0);
    for (const vec3& light : radiosity.solve({.sky = dvec3(1e4)}).other) EXPECT_EQ(light, vec3(0));
}

// A picture of the sky, E = 4 + 3 n.x, on two walls back to back.
TEST(Radiosity, ASkyWithAPictureLightsByDirection) {
    scene::Scene scene;
    const uint32_t grey = add_material(scene, 0.5f);
    add_rectangle(scene, grey, {0, 0, 0}, {0, 0, -8}, {0, 8, 0});   // faces +x
    add_rectangle(scene, grey, {-9, 0, 0}, {0, 8, 0}, {0, 0, -8});  // and -x
    photometry::Irradiance9 picture{};
    picture[0] = {4, 2, 8}, picture[3] = {3, 1, 5};
    const Radiosity radiosity = gathered(scene);
    const std::vector<vec3> light = radiosity.solve({.sky = dvec3(1e6), .sky_picture = &picture}).other;
    for (size_t i = 0; i < light.size(); ++i) {
        const vec3 want = radiosity.grid.facing(radiosity.numbers[i]) == 0 ? vec3(7, 3, 13) : vec3(1, 1, 3);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(light[i][c], want[c], 1e-5f * want[c]) << i;
    }
}

// Of a square of side 2 a at the height h, parallel, L = 1: sums of corners (Lambert 1760).
double under_a_square(double a, double h, double x, double z) {
    const auto corner = [h](double u, double v) {
        const double p = u / std::hypot(u, h), q = v / std::hypot(v, h);
        return 0.5 * (p * std::atan(v / std::hypot(u, h)) + q * std::atan(u / std::hypot(v, h)));
    };
    double sum = 0;
    for (const double u : {x + a, a - x})
        for (const double v : {z + a, a - z}) sum += corner(u, v);
    return sum;
}

TEST(Radiosity, AnEmittingSquareOverAPlane) {
    constexpr double kA = 1.5, kH = 2, kEmission = 100;
    const double s = kA / std::sqrt(kA * kA + kH * kH);
    ASSERT_NEAR(under_a_square(kA, kH, 0, 0), 4 * s * std::atan(s), 1e-12);
    scene::Scene scene;
    add_floor(scene, add_material(scene, 0), 8);
    add_rectangle(scene, add_material(scene, 0, float(kEmission)), {-1.5f, 2, -1.5f}, {3, 0, 0}, {0, 0, 3});
    const Radiosity radiosity = gathered(scene, {.cell_size = 0.5});
    const std::vector<vec3> light = radiosity.solve({}).other;
    double want = 0, got = 0;
    for (double x = -6; x < 6.1; x += 0.25)
        for (double z = -6; z < 6.1; z += 0.25) {
            const double here = kEmission * under_a_square(kA, kH, x, z);
            const double found = radiosity.at(light, {x, 0, z}, kUp).g;
            want += here, got += found;
            // A cell stands for 0.5 m by four places at random, and its neighbours' light takes part: where E falls by
            // 28 lx a metre, these leave a standard deviation of some 1.3 lx.
            EXPECT_NEAR(found, here, 0.1 * here + 4) << x << ", " << z;
        }
    EXPECT_NEAR(got / want, 1, 0.03) << "noise has no direction, but neighbours share it";
}

// Two wide plates, of which one glows: E of the other is pi L (1 + rho^2 + rho^4 + ...), by even numbers of
// reflections.
TEST(Radiosity, LightGoesToAndFroBetweenPlates) {
    constexpr double kEmission = 10, kReflectance = 0.7;
    constexpr float kHalf = 25;
    scene::Scene scene;
    add_floor(scene, add_material(scene, float(kReflectance)), kHalf);
    add_rectangle(scene, add_material(scene, float(kReflectance), float(kEmission)), {-kHalf, 1, -kHalf},
                  {2 * kHalf, 0, 0}, {0, 0, 2 * kHalf});
    const Radiosity radiosity = gathered(scene);
    for (const uint32_t reflections : {0u, 1u, 2u, 3u, 4u}) {
        const auto light = lux(radiosity.solve({.reflections = reflections}).other);
        const auto mean = [&](uint32_t side) {
            return mean_over(radiosity, light, [&](size_t i, dvec3 middle) {
                return radiosity.grid.facing(radiosity.numbers[i]) == side && std::hypot(middle.x, middle.z) < 10;
            });
        };
        const double q = kReflectance * kReflectance, direct = kPi * kEmission;
        const double below = direct * (1 - std::pow(q, reflections / 2 + 1)) / (1 - q);
        const double above = direct * kReflectance * (1 - std::pow(q, (reflections + 1) / 2)) / (1 - q);
        // 1 / (15^2 + 1) of the light leaves at most, at each turn; noise of 300 cells besides.
        EXPECT_NEAR(mean(2) / below, 1, 0.015) << reflections;
        EXPECT_NEAR(mean(3), above, 0.015 * above + 1e-9) << reflections;
    }
}

// A floor of cells, half of it twice as bright, each with noise of a twentieth.
struct TwoHalves {
    static constexpr int kSide = 40;
    Radiosity radiosity;

    explicit TwoHalves(bool with_steps) {
        MadeCells made{{.origin = {0, 0, 0}, .size = 1, .count = {kSide, 1, kSide}}, {}};
        for (int x = 0; x < kSide; ++x)
            for (int z = 0; z < kSide; ++z) made.add({x, 0, z}, 2, 0, vec3(1));
        radiosity = made.radiosity();
        radiosity.reflectances.resize(radiosity.cells(), vec3(0)), radiosity.areas.resize(radiosity.cells(), 1.0f);
        radiosity.first_source.resize(radiosity.cells() + 1), radiosity.first_met.resize(radiosity.cells() + 1);
        Noise random(3);
        for (const uint32_t number : radiosity.numbers)
            radiosity.sky.push_back(float((column(number) < kSide / 2 ? 0.4 : 0.8) * (1 + 0.05 * random.normal())));
        radiosity.connect([](uint32_t, uint32_t) { return true; });
        if (with_steps) radiosity.find_steps();
    }
    int column(uint32_t number) const { return int(radiosity.grid.middle(number).x); }

    /// Of the cells of a column: the mean, and the standard deviation, in parts of it.
    std::pair<double, double> spread(const std::vector<vec3>& light, int of) const {
        double sum = 0, squares = 0, count = 0;
        for (size_t i = 0; i < light.size(); ++i)
            if (column(radiosity.numbers[i]) == of)
                sum += double(light[i].g), squares += double(light[i].g) * double(light[i].g), ++count;
        const double mean = sum / count;
        return {mean, std::sqrt(squares / count - mean * mean) / mean};
    }
};

// Means of means leave a quarter of the noise, one mean three eighths. One alone blurs the edge by 0.1.
TEST(Radiosity, MeansTakeNoiseAndLeaveEdges) {
    const TwoHalves with(true), without(false);
    const auto light = with.radiosity.solve({.sky = dvec3(1 / kPi)}).other,
               blurred = without.radiosity.solve({.sky = dvec3(1 / kPi)}).other;
    for (int column = 5; column < 35; ++column) {
        const auto [mean, deviation] = with.spread(light, column);
        EXPECT_NEAR(mean, column < 20 ? 0.4 : 0.8, std::abs(column - 19.5) < 2 ? 0.07 : 0.02) << column;
        EXPECT_LT(deviation, 0.018) << column;
    }
    EXPECT_GT(without.spread(blurred, 19).first, 0.5);
    EXPECT_LT(without.spread(blurred, 20).first, 0.7);
}

// Two sources, each of which lights one half: beside an edge of 1 to 100 nothing is darker than the dark half, and with
// either of them the light is that of both without the other.
TEST(Radiosity, MeansOfTwoSourcesAreTheirSum) {
    Radiosity radiosity = TwoHalves(false).radiosity;
    for (size_t i = 0; i < radiosity.cells(); ++i) {
        const bool dark = radiosity.grid.middle(radiosity.numbers[i]).x < 20;
        radiosity.sources.push_back({dark ? 0u : 1u, glm::packF3x9_E1x5(vec3(dark ? 0.0625f : 6.25f))});
        radiosity.first_source[i + 1] = uint32_t(i + 1), radiosity.sky[i] = 0;
    }
    radiosity.find_steps();
    const auto with = [&](float first, float second) {
        return radiosity.solve({.factors = std::vector<float>{first, second}}).other;
    };
    const std::vector<vec3> both = with(1, 1), one = with(1, 0), other = with(0, 1);
    for (size_t i = 0; i < both.size(); ++i) {
        EXPECT_NEAR(both[i].g, one[i].g + other[i].g, 1e-5 * 100) << i;
        EXPECT_GT(both[i].g, 0.999f) << i;
        EXPECT_LT(both[i].g, 102) << i;
    }
}

// A wave of 12 cells: means take a quarter of its height away, and give back all but a twentieth.
TEST(Radiosity, MeansLeavePeaksTheirHeights) {
    TwoHalves floor(true);
    Radiosity& radiosity = floor.radiosity;
    for (size_t i = 0; i < radiosity.cells(); ++i)
        radiosity.sky[i] = float(1 + 0.1 * std::cos(kPi * floor.column(radiosity.numbers[i]) / 6.0));
    radiosity.find_steps();
    const auto light = radiosity.solve({.sky = dvec3(1 / kPi)}).other;
    for (const int column : {12, 18, 24}) {
        const double want = column == 18 ? 0.9 : 1.1;
        EXPECT_NEAR(floor.spread(light, column).first, want, 0.015) << column;
    }
}

// A lamp over a floor: what the floor sends to a wall, by paths of rays. The wall stands on a border of cubes, so that
// no cell of the floor lies on both sides of it.
TEST(Radiosity, AFloorSendsALampsLightToAWall) {
    scene::Scene scene;
    add_floor(scene, add_material(scene, 0.5f), 8);
    add_rectangle(scene, add_material(scene, 0), {-3.125f, 0, 8}, {0, 0, -16}, {0, 5, 0});  // faces +x
    add_lamp(scene, 1000, {0, 3, 0});
    const Radiosity radiosity = gathered(scene, {.cell_size = 0.25, .rays = 64});
    const Radiosity::Solution light = radiosity.solve({.reflections = 1});
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    const transport::LightTracer tracer(scene, world);
    const transport::TraceSettings settings{.paths = 2000, .most_reflections = 1};
    double got = 0, want = 0, variance = 0;
    for (double y = 0.75; y < 4.5; y += 0.5)
        for (double z = -4; z < 4.1; z += 1) {
            const transport::Illuminance traced = tracer.at({-3.125, y, z}, {1, 0, 0}, settings);
            const double error = traced.standard_error[size_t(transport::Origin::Once)];
            const double here = traced[transport::Origin::Once].g;
            const double found = radiosity.at(light.other, {-3.125, y, z}, {1, 0, 0}).g;
            got += found, want += here, variance += error * error;
            // 64 rays of each of about seven cells that a value is made of: some 5 %; five times that.
            EXPECT_NEAR(found, here, 0.25 * here + 4 * error) << y << ", " << z;
        }
    EXPECT_NEAR(got / want, 1, 0.03)
        << "of 72 places, some of them near the wall's foot, where a floor's cell is a mean";
    EXPECT_LT(std::sqrt(variance), 0.01 * want);
    // Directly, I h / d^3; four places at random in each cell.
    for (const double x : {0.0, 2.0, 5.0}) {
        const double direct = 3000 / std::pow(9 + x * x, 1.5);
        EXPECT_NEAR(radiosity.at(light.lamps, {x, 0, 0}, kUp).g, direct, 0.1 * direct) << x;
    }
}

/// A room with four lamps and two panels of light.
scene::Scene lit_room() {
    scene::Scene scene;
    add_room(scene, add_material(scene, 0.6f), {5, 2, 5});
    for (const double x : {-3.0, 3.0})
        for (const double z : {-3.0, 3.0}) add_lamp(scene, 200, {x, 1.2, z});
    const uint32_t panel = add_material(scene, 0, 300);
    add_rectangle(scene, panel, {-1, 1.9f, -3}, {1, 0, 0}, {0, 0, 1});
    add_rectangle(scene, panel, {1, 1.9f, 2}, {1, 0, 0}, {0, 0, 1});
    return scene;
}

TEST(Radiosity, DimmedLampsGiveWhatWeakerLampsWould) {
    scene::Scene scene = lit_room();
    const Radiosity radiosity = gathered(scene);
    std::vector<float> factors(scene.nodes.size(), 1);
    for (const uint32_t node : {6u, 8u}) factors[node] = 0.3f, scene.lamps[scene.nodes[node].lamp].intensity *= 0.3f;
    const Radiosity afresh = gathered(scene);
    const Radiosity::Solution dimmed = radiosity.solve({.factors = factors}), want = afresh.solve({});
    for (const auto part : {&Radiosity::Solution::lamps, &Radiosity::Solution::other}) {
        const double ratio = mean_over_all(radiosity, lux(dimmed.*part)) / mean_over_all(afresh, lux(want.*part));
        EXPECT_NEAR(ratio, 1, 0.01);  // shadow rays choose other lamps, and of each cell the faintest 0.5 % are dropped
    }
}

TEST(Radiosity, LightIsLinearInFactors) {
    const scene::Scene scene = lit_room();
    const Radiosity radiosity = gathered(scene);
    std::vector<float> a(scene.nodes.size()), b(scene.nodes.size()), sum(scene.nodes.size());
    for (size_t i = 0; i < a.size(); ++i) a[i] = float(i % 3), b[i] = float(i % 2) * 0.25f, sum[i] = a[i] + b[i];
    const auto of_a = radiosity.solve({.factors = a, .sky = dvec3(1)}),
               of_b = radiosity.solve({.factors = b, .sky = dvec3(2)}),
               of_sum = radiosity.solve({.factors = sum, .sky = dvec3(3)});
    for (size_t i = 0; i < radiosity.cells(); ++i) {
        const float lamps = of_a.lamps[i].g + of_b.lamps[i].g, other = of_a.other[i].g + of_b.other[i].g;
        EXPECT_NEAR(of_sum.lamps[i].g, lamps, 1e-5 * lamps);
        EXPECT_NEAR(of_sum.other[i].g, other, 1e-5 * other);
    }
}

// One panel, then the other, then none; lamps have factors of their own.
// In a room by a lamp and a plate; walls are nodes 0 to 5, and a second lamp moves.
TEST(Radiosity, KnowsTheNodesWhoseLightAnyCellGets) {
    scene::Scene scene;
    add_room(scene, add_material(scene, 0.5f), vec3(2));
    add_lamp(scene, 100, {0, 0, 0});
    add_lamp(scene, 100, {1, 0, 0});
    add_rectangle(scene, add_material(scene, 0, 10), {-1, 1, 1}, {2, 0, 0}, {0, 0, -2});
    std::vector<bool> moving(scene.nodes.size());
    moving[7] = true;
    EXPECT_EQ(gathered(scene, kMetreCells, moving).source_nodes(), (std::vector<uint32_t>{6, 8}));
    EXPECT_TRUE(Radiosity().source_nodes().empty());
}

TEST(Radiosity, ANodeThatIsOffGivesNothing) {
    const scene::Scene scene = lit_room();
    const Radiosity radiosity = gathered(scene);
    std::vector<float> factors(scene.nodes.size(), 0);
    const auto mean = [&] {
        const Radiosity::Solution light = radiosity.solve({.factors = factors});
        return glm::dvec2(mean_over_all(radiosity, lux(light.lamps)), mean_over_all(radiosity, lux(light.other)));
    };
    EXPECT_EQ(mean(), glm::dvec2(0));
    factors[6] = 1;
    const glm::dvec2 lamp = mean();
    EXPECT_GT(lamp.x, 1);
    EXPECT_GT(lamp.y, 1);
    factors[6] = 0, factors[10] = 1;
    const glm::dvec2 panel = mean();
    EXPECT_EQ(panel.x, 0);
    EXPECT_GT(panel.y, 1);
    factors[6] = 1;
    const glm::dvec2 both = mean();
    EXPECT_NEAR(both.x, lamp.x, 1e-9);
    EXPECT_NEAR(both.y, lamp.y + panel.y, 1e-5 * both.y);
}

}  // namespace
}  // namespace vesper::test::radiosity_test
