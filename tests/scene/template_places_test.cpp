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

/// C0 of the rule for two lamps without meshes at (3, 6, 0) m below a parent; null without one.
json c0_below(const std::string& parent, bool second, float wall = 0) {
    NamedParts street;
    const uint32_t above = parent.empty() ? kNone : street.node(parent);
    street.node("street lamp 1", above, {3, 6, 0});
    if (second) street.node("street lamp 2", above, {0, 6, 9});
    if (wall > 0) street.show(street.node("wall", above), street.material("brick"), {0, 0, 0}, {wall, 0, 0}, {0, 2, 0});
    return street.rules("lamps").at(0).value("c0", json());
}

// The origin of the node above is the foot of a pole only where that node is one, or has no other lamp.
TEST(TemplatePlaces, ACommonRootIsNoFoot) {
    EXPECT_EQ(c0_below("Scene", true), json());
    EXPECT_EQ(c0_below("Lights", true), json());
    EXPECT_EQ(c0_below("", false), json());
    EXPECT_EQ(c0_below("Scene", false, 50), json()) << "a root with a street";
    EXPECT_EQ(c0_below("object_1", false, 1), (json{0, 0, 1}));
    EXPECT_EQ(c0_below("pole_17", false), (json{0, 0, 1}));
    EXPECT_EQ(c0_below("lantern_7", false), (json{0, 0, 1}));
    // Equal lamps below one root have one rule.
    NamedParts street;
    const uint32_t root = street.node("root");
    for (int i = 0; i < 300; ++i) street.node("street lamp " + std::to_string(i), root, {i % 30, 5.1, i / 30});
    ASSERT_EQ(street.made().lamps, 1u);
    EXPECT_EQ(street.rules("lamps")[0]["nodes"], "street lamp *");
    EXPECT_TRUE(contains(street.rules("lamps")[0]["comment"].get<std::string>(), "no arm tells the road"));
    // Nor is the origin of a scene whose transforms are applied a foot: heads 0.4 m wide, a few metres off it.
    NamedParts flat;
    flat.show(flat.node("street lamp"), flat.material("iron"), {4, 6, 2}, {0.4f, 0, 0}, {0, 0, 0.4f});
    EXPECT_FALSE(flat.rules("lamps").at(0).contains("c0"));
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
