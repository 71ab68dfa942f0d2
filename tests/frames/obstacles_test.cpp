// Obstacles in whole frames. SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "base/luminance.h"
#include "render/renderer.h"
#include "support/rooms.h"
#include "vision/visibility.h"

namespace vesper::test::obstacles_test {
namespace {

using State = render::SeenObstacle::State;

constexpr VkExtent2D kExtent{241, 181};
constexpr float kCard = 3, kWall = 2, kAway = 40;  // cd/m^2, m

/// A card of 2 m by 3 m stands before a wall, both of their own light; the eye is at the origin.
struct Street {
    scene::Scene scene;
    uint32_t card;

    explicit Street(float light = kCard, float wall = kWall) {
        add_rectangle(scene, add_material(scene, 0, wall), {-60, -60, -kAway - 1}, {120, 0, 0}, {0, 120, 0});
        card = add("card", light, {-1, -1.5f, -kAway}, {2, 0, 0}, {0, 3, 0});
    }
    uint32_t add(const char* name, float light, glm::vec3 corner, glm::vec3 along, glm::vec3 up) {
        add_rectangle(scene, add_material(scene, 0, light), corner, along, up);
        scene.nodes.back().name = name;
        return uint32_t(scene.nodes.size() - 1);
    }
};

gpu_scene::View ahead() { return gpu_scene::View::symmetric(kExtent, 0.4f, glm::dmat4(1)); }

class ObstaclesOfFrames : public testing::Test {
protected:
    render::Frame look(const scene::Scene& scene, const std::vector<std::string>& patterns,
                       render::RenderSettings settings = {}, const render::Outputs& outputs = {},
                       std::vector<glm::dmat4> world = {}) {
        settings.indirect = false;
        settings.obstacles = scene::find_obstacles(scene, patterns, "obstacle");
        render::Renderer renderer(device_, scene);
        if (world.empty()) world = scene::world_transforms(scene, 0);
        return renderer.render(settings, ahead(), {world}, 0, outputs);
    }
    render::SeenObstacle look_at(const scene::Scene& scene, const std::string& pattern = "card") {
        const auto seen = look(scene, {pattern}).obstacles;
        EXPECT_EQ(seen.size(), 1u);
        return seen.at(0);
    }
    void TearDown() override { EXPECT_EQ(complaints_, ""); }

    std::string complaints_;
    gpu::Device device_{
        {.select = "", .validation = true, .on_message = [this](const std::string& m) { complaints_ += m + "\n"; }}};
};

// Pixels at the card's edges are means of card and wall, and do not count.
TEST_F(ObstaclesOfFrames, AUniformCardBeforeAUniformWall) {
    const Street street;
    const render::SeenObstacle seen = look_at(street.scene);
    EXPECT_EQ(seen.state, State::Measured);
    EXPECT_DOUBLE_EQ(seen.distance, double(kAway));
    EXPECT_NEAR(seen.luminance, double(kCard), 1e-5);  // of means of floats
    EXPECT_NEAR(seen.around, double(kWall), 1e-5);
    EXPECT_EQ(seen.veil, 0);
    // The solid angle of a rectangle seen along its axis: 4 arcsin(a b / sqrt((1 + a^2) (1 + b^2))), a and b tangents
    // of half its sides. 3 %: its pixels are whole, 22 by 33 of them.
    const double a = 1.0 / 40, b = 1.5 / 40, want = 4 * std::asin(a * b / std::sqrt((1 + a * a) * (1 + b * b)));
    EXPECT_NEAR(seen.steradians, want, 0.03 * want);
    EXPECT_NEAR(glm::length(seen.centre - glm::dvec2(kExtent.width, kExtent.height) / 2.0), 0, 0.5);

    // A disc of so many steradians has 2 sqrt(w / pi) rad; it is larger than 60', which the formula takes for it.
    const render::ObstacleVisibility visible = render::visibility_of(seen, 23);
    EXPECT_NEAR(visible.size, 2 * std::sqrt(seen.steradians / 3.14159265358979) * 10800 / 3.14159265358979, 1e-6);
    EXPECT_GT(visible.size, 60);
    ASSERT_TRUE(visible.level && visible.without_veil);
    EXPECT_NEAR(*visible.level, vision::visibility_level(3, 2, {.size = 60}), 1e-3);
    EXPECT_EQ(*visible.level, *visible.without_veil);
    EXPECT_LT(*render::visibility_of(seen, 70).level, *visible.level);
}

TEST_F(ObstaclesOfFrames, SamplesAndBareEdgesGiveTheSame) {
    const Street street;
    for (const bool edges : {false, true}) {
        render::RenderSettings settings;
        settings.anti_aliasing = edges, settings.samples = edges ? 1 : 5;
        const render::SeenObstacle seen = look(street.scene, {"card"}, settings).obstacles.at(0);
        EXPECT_NEAR(seen.luminance, double(kCard), 1e-5);
        EXPECT_NEAR(seen.around, double(kWall), 1e-5);
    }
}

TEST_F(ObstaclesOfFrames, HiddenPartsDoNotCount) {
    Street street;
    const double whole = look_at(street.scene).steradians;
    // As bright as the wall, before the left half of the card.
    street.add("hoarding", kWall, {-3, -2, -kAway / 2}, {3, 0, 0}, {0, 4, 0});
    const render::SeenObstacle half = look_at(street.scene);
    EXPECT_NEAR(half.steradians, whole / 2, 0.05 * whole);
    EXPECT_NEAR(half.luminance, double(kCard), 1e-5);
    EXPECT_NEAR(half.around, double(kWall), 1e-5);
    street.add("lorry", kWall, {-3, -2, -kAway / 2}, {6, 0, 0}, {0, 4, 0});
    EXPECT_EQ(look_at(street.scene).state, State::Hidden);
    EXPECT_DOUBLE_EQ(look_at(street.scene).distance, double(kAway));
}

// A lamp of 10,000 cd/m^2, drawn over pixels of the card and beside it.
TEST_F(ObstaclesOfFrames, LampsBeforeThemDoNotCount) {
    Street street;
    for (const double x : {0.03, 0.7}) {
        add_lamp(street.scene, 100, {x, 0.02, -kAway / 2});
        street.scene.lamps.back().opening = {.length = 0.1, .width = 0.1};
    }
    const render::SeenObstacle seen = look_at(street.scene);
    EXPECT_EQ(seen.state, State::Measured);
    EXPECT_NEAR(seen.luminance, double(kCard), 1e-5);
    EXPECT_NEAR(seen.around, double(kWall), 1e-5);
}

// What headlamps light on a road without a moon, and a pedestrian before a shop window: no glare sources.
TEST_F(ObstaclesOfFrames, HoweverDarkTheRestIsTheyCount) {
    for (const float wall : {0.0f, 0.002f}) {
        const render::SeenObstacle seen = look_at(Street(1.8f, wall).scene);
        EXPECT_EQ(seen.state, State::Measured);
        EXPECT_NEAR(seen.luminance, 1.8, 1e-5);
        EXPECT_NEAR(seen.around, double(wall), 1e-6);
        EXPECT_EQ(render::visibility_of(seen, 23).level.value_or(0) > 7, wall > 0);
    }
    Street dark(0.5f, 0.002f);
    dark.add("shop", 250, {-3, -4, -kAway - 0.5f}, {6, 0, 0}, {0, 8, 0});
    const render::SeenObstacle seen = look_at(dark.scene);
    EXPECT_EQ(seen.state, State::Measured);
    EXPECT_NEAR(seen.luminance, 0.5, 1e-5);
    EXPECT_NEAR(seen.around, 250, 1e-3);
    Street sign(0.5f, 0.002f);
    sign.add("sign", 450, {1.2f, 0.5f, -kAway - 0.5f}, {0.4f, 0, 0}, {0, 0.4f, 0});
    EXPECT_LT(look_at(sign.scene).around, 0.1) << "a bright sign is a source, but for mixtures at its corners";
}

TEST_F(ObstaclesOfFrames, SurroundingsAreNoOtherObstacles) {
    Street street;
    street.add("neighbour", 50, {1.1f, -2, -kAway + 0.1f}, {2, 0, 0}, {0, 4, 0});
    EXPECT_GT(look_at(street.scene).around, 3);
    const auto seen = look(street.scene, {"card", "neighbour"}).obstacles;
    ASSERT_EQ(seen.size(), 2u);
    EXPECT_NEAR(seen[0].around, double(kWall), 1e-5);
    EXPECT_NEAR(seen[1].around, double(kWall), 1e-5);
    EXPECT_NEAR(seen[1].luminance, 50, 1e-4);
}

TEST_F(ObstaclesOfFrames, WhereNothingCanBeSaidNothingIs) {
    Street street;
    const auto moved = [&](glm::dvec3 by) {
        std::vector<glm::dmat4> world = scene::world_transforms(street.scene, 0);
        world[street.card][3] += glm::dvec4(by, 0);
        const render::SeenObstacle seen = look(street.scene, {"card"}, {}, {}, world).obstacles.at(0);
        const render::ObstacleVisibility visible = render::visibility_of(seen, 23);
        EXPECT_EQ(visible.level.has_value(), seen.state == State::Measured);
        return seen.state;
    };
    EXPECT_EQ(moved({0, 0, 0}), State::Measured);
    EXPECT_EQ(moved({100, 0, 0}), State::OutOfPicture);
    EXPECT_EQ(moved({0, 0, 90}), State::OutOfPicture) << "behind the eye";
    EXPECT_EQ(moved({0, 0, -5}), State::Hidden) << "behind the wall";
    EXPECT_EQ(moved({std::nan(""), 0, 0}), State::OutOfPicture);
    // A floor below the eye.
    street.add("floor", 1, {-5, -2, 5}, {10, 0, 0}, {0, 0, -30});
    EXPECT_EQ(look_at(street.scene, "floor").state, State::TooNear);
    // Three pixels wide and high there is one that no edge crosses.
    street.add("sign", 1, {3, 3, -kAway}, {0.25f, 0, 0}, {0, 0.25f, 0});
    EXPECT_EQ(look_at(street.scene, "sign").state, State::TooFewPixels);
}

TEST_F(ObstaclesOfFrames, AVeilIsTheLightThatTheEyeScattersThere) {
    Street street;
    street.add("lamp", 1e6f, {8, 5, -kAway + 0.1f}, {0.5f, 0, 0}, {0, 0.5f, 0});
    render::RenderSettings settings{{.glare = render::Glare::Scatter}};
    const render::SeenObstacle seen = look(street.scene, {"card"}, settings).obstacles.at(0);
    const render::Frame retina = look(street.scene, {"card"}, settings, {.scene = true, .retina = true});
    EXPECT_TRUE(retina.obstacles.empty());
    const auto at = [&](const std::vector<float>& image, size_t x, size_t y) {
        const float* p = &image[4 * (y * kExtent.width + x)];
        return luminance(glm::dvec3(p[0], p[1], p[2]));
    };
    // Above the card, and below: about as far from the lamp as its surroundings are, which are 2 m from its middle; the
    // lamp is 9.4 m from there.
    const double veil = 0.5 * (at(retina.retina, 120, 70) - at(retina.scene, 120, 70) + at(retina.retina, 120, 110) -
                               at(retina.scene, 120, 110));
    EXPECT_GT(veil, 1);
    EXPECT_NEAR(seen.veil, veil, 0.1 * veil);
    EXPECT_NEAR(seen.luminance, double(kCard), 1e-5);
    const render::ObstacleVisibility visible = render::visibility_of(seen, 23);
    EXPECT_LT(*visible.level, *visible.without_veil);
    EXPECT_NEAR(*visible.level, vision::visibility_level(3 + seen.veil, 2 + seen.veil, {.size = 60}), 1e-3);
}

TEST_F(ObstaclesOfFrames, PixelsBelongToWhatTheirMiddleSees) {
    Street street;
    street.add("neighbour", 50, {1.5f, -2, -kAway + 0.1f}, {2, 0, 0}, {0, 4, 0});
    render::RenderSettings settings;
    settings.obstacle_pixels = true;
    const render::Frame frame = look(street.scene, {"neighbour", "card"}, settings);
    ASSERT_EQ(frame.obstacle_pixels.size(), size_t(kExtent.width) * kExtent.height);
    const auto at = [&](glm::dvec2 m) {  // on the plane of the card
        const glm::uvec2 px(glm::dvec2(kExtent.width, kExtent.height) / 2.0 +
                            glm::dvec2(m.x, -m.y) / double(kAway) * (kExtent.height / 2.0 / std::tan(0.2)));
        return int(frame.obstacle_pixels[px.y * kExtent.width + px.x]);
    };
    EXPECT_EQ(at({0, 0}), 1);
    EXPECT_EQ(at({0.9, 1.4}), 1);
    EXPECT_EQ(at({-1.2, 0}), 0);
    EXPECT_EQ(at({2, 0}), 2);
    EXPECT_EQ(at({1.25, 0}), 0) << "between them";
    EXPECT_TRUE(look(street.scene, {"card"}).obstacle_pixels.empty());
    EXPECT_TRUE(look(street.scene, {}, settings).obstacle_pixels.empty());
}

TEST_F(ObstaclesOfFrames, TheBaselineHasNoLuminances) {
    const Street street;
    render::RenderSettings ldr;
    ldr.tone_operator = render::Operator::Ldr;
    EXPECT_TRUE(look(street.scene, {"card"}, ldr).obstacles.empty());
    EXPECT_TRUE(look(street.scene, {}).obstacles.empty());
}

}  // namespace
}  // namespace vesper::test::obstacles_test
