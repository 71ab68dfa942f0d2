// What keys, gamepads and wheels do, without any of them. SPDX-License-Identifier: MIT
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "support/complaints.h"
#include "support/temp_folder.h"
#include "window/input_devices.h"
#include "window/panel_layout.h"

namespace vesper::test {
namespace {

using drive::Action;

TEST(Keys, AreOnePerActionAndNoneTwice) {
    std::set<std::pair<int, int>> keys;
    std::set<std::string_view> names;
    for (const drive::KeyBinding& b : drive::key_bindings()) {
        EXPECT_TRUE(keys.emplace(b.key, b.modifiers).second) << b.shown;
        EXPECT_TRUE(names.insert(b.name).second) << b.name;
        EXPECT_EQ(drive::action_of(b.key, b.modifiers), b.action);
        EXPECT_EQ(drive::action_named(b.name), b.action);
    }
    EXPECT_EQ(drive::key_bindings().size(), size_t(Action::Quit) + 1);  // every action has a key
    EXPECT_FALSE(drive::action_named("fly"));
}

TEST(Controllers, AxesRunFromRestToFull) {
    const std::vector<float> axes{0.5f, -1, 1, NAN};
    EXPECT_DOUBLE_EQ((drive::PedalAxis{.axis = 0, .rest = -1, .full = 1}).value(axes), 0.75);
    EXPECT_DOUBLE_EQ((drive::PedalAxis{.axis = 0, .rest = 1, .full = -1}).value(axes),
                     0.25);  // pedals of many wheels rest at 1
    EXPECT_DOUBLE_EQ((drive::PedalAxis{.axis = 2, .rest = 0, .full = 0.5}).value(axes), 1);
    EXPECT_DOUBLE_EQ((drive::PedalAxis{.axis = 3}).value(axes), 0);     // not a number
    EXPECT_DOUBLE_EQ((drive::PedalAxis{.axis = 99}).value(axes), 0);    // no such axis
    EXPECT_DOUBLE_EQ((drive::SteeringAxis{.axis = 1}).value(axes), 1);  // left is positive
    EXPECT_DOUBLE_EQ((drive::SteeringAxis{.axis = 2}).value(axes), -1);
    EXPECT_DOUBLE_EQ((drive::SteeringAxis{.axis = 0, .dead = 0.25, .exponent = 2}).value(axes), -1.0 / 9);
    EXPECT_DOUBLE_EQ((drive::SteeringAxis{.axis = 0, .dead = 0.5}).value(axes), 0);
    EXPECT_DOUBLE_EQ((drive::SteeringAxis{.axis = 99}).value(axes), 0);
}

class ControllerFile : public testing::Test {
protected:
    TempFolder folder;
    std::string refused(const std::string& text) {
        folder.write("c.json", text);
        return complaint_of([&] { drive::read_controllers(folder / "c.json"); });
    }
};

TEST_F(ControllerFile, SaysWhatAxesAndButtonsMean) {
    folder.write(
        "c.json",
        R"({"controllers": [{"match": "g29", "steering": {"axis": 0, "dead": 0.01}, "throttle": {"axis": 2, "rest": 1, "full": -1},
        "brake": {"axis": 3, "rest": 1, "full": -1}, "buttons": [{"button": 4, "does": "indicate-right"}, {"button": 5, "does": "indicate-left"}]}]})");
    const auto mappings = drive::read_controllers(folder / "c.json");
    ASSERT_EQ(mappings.size(), 1u);
    EXPECT_EQ(mappings[0].buttons.at(5), Action::IndicateLeft);
    EXPECT_EQ(drive::find_mapping(mappings, "Logitech G29 Driving Force", false), &mappings[0]);
    EXPECT_EQ(drive::find_mapping(mappings, "some pad", true), &drive::gamepad_mapping());
    EXPECT_EQ(drive::find_mapping(mappings, "some stick", false), nullptr);
}

TEST_F(ControllerFile, IsRefusedWithPlaceAndReason) {
    const auto expect = [&](const std::string& text, const std::string& place, const std::string& reason) {
        const std::string said = refused(text);
        EXPECT_TRUE(contains(said, place)) << text;
        EXPECT_TRUE(contains(said, reason)) << text;
        EXPECT_EQ(said.find('\n'), said.npos);
    };
    expect("{", "c.json", "");
    expect("{}", "c.json", "controllers");
    expect(R"({"controllers": [{"match": "x", "colour": 1}]})", "/controllers/0", "colour");
    expect(R"({"controllers": [{"steering": {"axis": 0}}]})", "/controllers/0", "match");
    expect(R"({"controllers": [{"match": "x", "brake": {"axis": 1, "rest": 1}}]})", "/controllers/0/brake",
           "rest and full must differ");
    expect(R"({"controllers": [{"match": "x", "brake": {"axis": 1, "rest": 2}}]})", "/controllers/0/brake/rest", "");
    expect(R"({"controllers": [{"match": "x", "steering": {"axis": 64}}]})", "/controllers/0/steering/axis", "");
    expect(R"({"controllers": [{"match": "x", "steering": {"axis": 0, "dead": 1}}]})", "/controllers/0/steering/dead",
           "");
    expect(R"({"controllers": [{"match": "x", "buttons": [{"button": 0, "does": "fly"}]}]})",
           "/controllers/0/buttons/0/does", "autopilot");
    expect(
        R"({"controllers": [{"match": "x", "buttons": [{"button": 0, "does": "pause"}, {"button": 0, "does": "beam"}]}]})",
        "/controllers/0/buttons/1", "already");
    EXPECT_TRUE(contains(complaint_of([&] { drive::read_controllers(folder / "none.json"); }), "none.json"));
}

drive::ControllerState wheel(float turned, float throttle, bool button) {
    return {.name = "G29", .axes = {turned, 0, throttle}, .buttons = {button}, .pad_axes = {}, .pad_buttons = {}};
}

std::vector<drive::ControllerMapping> wheel_mapping() {
    return {{.match = "G29",
             .gamepad = false,
             .steering = drive::SteeringAxis{},
             .throttle = drive::PedalAxis{.axis = 2, .rest = 1, .full = -1},
             .brake = {},
             .buttons = {{0, Action::Pause}}}};
}

TEST(InputDevices, TakeTheWheelThatIsTurnedFurtherAndThePedalThatIsPressedHarder) {
    drive::InputDevices devices(wheel_mapping());
    devices.look({wheel(-0.5f, 0, false)});
    traffic::DriverInput input = devices.next({}, 0, 1.0 / 60);
    EXPECT_DOUBLE_EQ(input.steering, 0.5);
    EXPECT_DOUBLE_EQ(input.throttle, 0.5);
    EXPECT_DOUBLE_EQ(input.brake, 0);
    input = devices.next({.accelerate = true, .brake = true}, 0, 1.0 / 60);
    EXPECT_DOUBLE_EQ(input.throttle, 1);
    EXPECT_DOUBLE_EQ(input.brake, 1);
}

TEST(InputDevices, NoticePlugsAndPressesOfButtonsOnce) {
    drive::InputDevices devices(wheel_mapping());
    EXPECT_TRUE(devices.look({wheel(0, 1, true)}).empty());  // held when it was plugged in: no press
    EXPECT_TRUE(contains(devices.take_notice(), "G29 is ready"));
    EXPECT_TRUE(devices.look({wheel(0, 1, false)}).empty());
    EXPECT_EQ(devices.look({wheel(0, 1, true)}), std::vector{Action::Pause});
    EXPECT_TRUE(devices.look({wheel(0, 1, true)}).empty());
    EXPECT_EQ(devices.take_notice(), "");
    devices.look({});
    EXPECT_TRUE(contains(devices.take_notice(), "G29 was unplugged"));
    EXPECT_DOUBLE_EQ(devices.next({}, 0, 1.0 / 60).throttle, 0);  // nothing stays pressed
}

TEST(InputDevices, SwitchesStayAsTheyWereSet) {
    drive::InputDevices devices;
    EXPECT_TRUE(devices.press(Action::IndicateLeft));
    EXPECT_EQ(devices.next({}, 0, 0.1).indicator, traffic::Indicator::Left);
    devices.press(Action::IndicateRight);
    EXPECT_EQ(devices.next({}, 0, 0.1).indicator, traffic::Indicator::Right);
    devices.press(Action::IndicateRight);
    EXPECT_EQ(devices.next({}, 0, 0.1).indicator, traffic::Indicator::None);
    devices.press(Action::Beam);
    EXPECT_EQ(devices.next({}, 0, 0.1).beam, traffic::Beam::High);
    devices.press(Action::Autopilot), devices.press(Action::Reverse);
    EXPECT_TRUE(devices.next({}, 0, 0.1).autopilot && devices.next({}, 0, 0.1).reverse);
    EXPECT_FALSE(devices.press(Action::Pause));
    devices.release();
    EXPECT_EQ(devices.next({}, 0, 0.1), traffic::DriverInput());
}

TEST(KeyboardWheel, TurnsWhileHeldReturnsAndTurnsLessAtSpeed) {
    drive::KeyboardWheel wheel;
    double before = 0;
    for (int i = 0; i < 120; ++i) {
        const double now = wheel.turn({.left = true}, 0, 1.0 / 60);
        EXPECT_GE(now, before);
        before = now;
    }
    EXPECT_DOUBLE_EQ(before, 1);
    for (int i = 0; i < 60; ++i) before = wheel.turn({}, 0, 1.0 / 60);
    EXPECT_DOUBLE_EQ(before, 0);
    for (int i = 0; i < 120; ++i) before = wheel.turn({.right = true}, 30, 1.0 / 60);
    EXPECT_LT(before, -0.1);
    EXPECT_GT(before, -0.2);
}

// Panels of any place and size lie within any window, above the line of state where there is room for both; in a large
// one they are as they are meant.
TEST(Panels, StayInTheWindow) {
    const glm::vec2 large(1280, 800);
    const drive::PanelPlace left = drive::panel_place({8, 320}, {520, 260}, large),
                            right = drive::panel_place({-8, -8}, {420, 300}, large);
    EXPECT_EQ(left.corner, glm::vec2(8, 320));
    EXPECT_EQ(left.size, glm::vec2(520, 260));
    EXPECT_EQ(right.corner, glm::vec2(1280 - 8 - 420, 800 - drive::kStatusHeight - 8 - 300));
    EXPECT_EQ(right.size, glm::vec2(420, 300));
    using V = glm::vec2;
    for (const V window : {V(840, 525), V(1024, 600), V(400, 900), V(120, 80), V(3840, 2160)})
        for (const V size : {V(520, 260), V(430, 560), V(620, 740), V(5000, 5000)})
            for (const V place : {V(8, 8), V(8, 320), V(-8, 440), V(-446, 8), V(-8, -8)}) {
                const drive::PanelPlace at = drive::panel_place(place, size, window);
                const float low = std::max(window.y - drive::kStatusHeight, window.y / 2);
                EXPECT_GE(std::min(at.corner.x, at.corner.y), 0);
                EXPECT_LE(at.corner.x + at.size.x, window.x + 0.01f);  // px, of floats
                EXPECT_LE(at.corner.y + at.size.y, low + 0.01f);
                EXPECT_GE(at.size.x, std::min({size.x, 200.0f, window.x - 16}));
                EXPECT_GE(at.size.y, std::min({size.y, 120.0f, low - 16}));
            }
    // The two columns of panels do not hide each other in the smallest window that they are meant for.
    const V small(840, 525);
    const drive::PanelPlace light = drive::panel_place({8, 8}, {520, 300}, small),
                            eye = drive::panel_place({8, 320}, {520, 260}, small),
                            passes = drive::panel_place({-8, 8}, {380, 420}, small);
    EXPECT_GE(eye.corner.y, light.corner.y + light.size.y);
    EXPECT_GE(passes.corner.x, light.corner.x + light.size.x);
}

}  // namespace
}  // namespace vesper::test
