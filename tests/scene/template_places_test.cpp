// Places of the lamps that a photometry template suggests, and their glass. SPDX-License-Identifier: MIT
#include <cmath>

#include "scene/named_parts.h"

namespace vesper::test {
namespace {

using nlohmann::json;
using scene::kNone;

// A pole of 8 m with an arm along +X, the head from 1.8 to 2 m: the lamp is at its lower edge, C0 along the road.
TEST(TemplatePlaces, TheHeadOfAStreetLamp) {
    NamedParts street;
    const uint32_t iron = street.material("iron");
    for (const char* name : {"streetlight_1", "streetlight_2"}) {
        const uint32_t node = street.node(name, kNone, {5, 0, 0});
        street.show(node, iron, {-0.1f, 0, 0}, {0, 8, 0}, {0.2f, 0, 0});
        street.show(node, iron, {0, 7.7f, 0}, {0, 0.3f, 0}, {1, 0, 0});
        street.show(node, iron, {1.8f, 7.6f, 0}, {0, 0.2f, 0}, {0.2f, 0, 0});
    }
    const json lamp = street.rules("lamps").at(0);
    EXPECT_EQ(lamp["nodes"], "streetlight_*");
    EXPECT_EQ(lamp["aim"], (json{0, -1, 0}));
    EXPECT_EQ(lamp["offset_m"], (json{1.9, 7.6, 0}));
    EXPECT_EQ(lamp["c0"], (json{0, 0, 1}));
    EXPECT_EQ(lamp["opening"], (json{{"width_m", 0.45}, {"height_m", 0.2}}));
    EXPECT_TRUE(contains(lamp["comment"].get<std::string>(), "2 nodes about 6.9, 7.6, 0 m"));
    street.expect_clean();
    // The same of a toy, ten times as small, with an arm to -X.
    NamedParts toy;
    const uint32_t node = toy.node("street_light");
    toy.show(node, toy.material("iron"), {0, 0, 0}, {0, 0.8f, 0}, {0.01f, 0, 0});
    toy.show(node, 0, {-0.3f, 0.79f, 0}, {0, 0.01f, 0}, {0.05f, 0, 0});
    EXPECT_EQ(toy.rules("lamps").at(0)["offset_m"], (json{-0.3, 0.8, 0}));
    // A lantern on a post has no arm.
    NamedParts post;
    post.show(post.node("lamp post"), post.material("iron"), {-0.1f, 0, 0}, {0, 4, 0}, {0.2f, 0, 0});
    EXPECT_EQ(post.rules("lamps").at(0)["offset_m"], (json{0, 4, 0}));
    EXPECT_FALSE(post.rules("lamps").at(0).contains("c0"));
    EXPECT_TRUE(contains(post.rules("lamps").at(0)["comment"].get<std::string>(), "no arm tells the road"));
    EXPECT_FALSE(contains(lamp["comment"].get<std::string>(), "no arm"));
}

// A lens of 0.2 m that faces +X: the lamp shines there.
TEST(TemplatePlaces, ALensFacesWhereItsLampShines) {
    NamedParts street;
    const uint32_t node = street.node("signal/red", kNone, {0, 3, 0});
    street.show(node, street.material("lens"), {0.3f, 0, 0}, {0, 0.2f, 0}, {0, 0, 0.2f});
    const json lamp = street.rules("lamps").at(0);
    EXPECT_EQ(lamp["aim"], (json{1, 0, 0}));
    EXPECT_EQ(lamp["offset_m"], (json{0.3, 0.1, 0.1}));
}

// A car of 4 m along Z: headlamps and tail lamps shine away from its middle, whatever their nodes say.
TEST(TemplatePlaces, LampsOfVehiclesShineOffThem) {
    NamedParts street;
    const uint32_t car = street.node("car", kNone, {10, 0, 20});
    street.show(street.node("body", car), street.material("paint"), {-0.9f, 0.3f, -2}, {1.8f, 0, 0}, {0, 0, 4});
    street.node("headlight_l", car, {-0.6, 0.6, 2}), street.node("headlight_r", car, {0.6, 0.6, 2});
    street.node("tail_l", car, {-0.6, 0.6, -2}), street.node("tail_r", car, {0.6, 0.6, -2});
    for (const json& lamp : street.rules("lamps"))
        if (lamp["name"].get<std::string>().starts_with("headlamp"))
            EXPECT_EQ(lamp["aim"], (json{0, 0, 1})) << lamp;
        else
            EXPECT_FALSE(lamp.contains("aim")) << lamp;
    EXPECT_EQ(street.made().lamps, 4u);
}

// Half a m^2 of glass before a lamp of 100 cd: 200 cd/m^2, in the lamp's colour, and no second opening.
TEST(TemplatePlaces, GlassHasTheLuminanceOfItsLamp) {
    NamedParts street;
    const uint32_t lamp = street.node("lamp", kNone, {0, 3, 0});
    street.show(street.node("cover", lamp), street.material("lamp_glass"), {0, 0, 0}, {0, 1, 0}, {0.5f, 0, 0});
    const json emitter = street.rules("emitters").at(0), rule = street.rules("lamps").at(0);
    EXPECT_EQ(emitter["luminance_cd_m2"], 200);
    EXPECT_EQ(emitter["colour_temperature_K"], 2700);
    EXPECT_TRUE(contains(emitter["comment"].get<std::string>(), "0.5 m^2")) << emitter;
    EXPECT_EQ(rule["opening"]["drawn"], false);
    street.expect_clean();
}

}  // namespace
}  // namespace vesper::test
