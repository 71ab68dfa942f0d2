// Nodes that a photometry template takes for lamps, or for parts of them. SPDX-License-Identifier: MIT
#include <set>

#include "scene/named_parts.h"

namespace vesper::test {
namespace {

using nlohmann::json;
using scene::kNone;

/// The patterns of all rules for lamps, without the names above.
std::set<std::string> patterns(const NamedParts& street) {
    std::set<std::string> all;
    for (const json& rule : street.rules("lamps"))
        for (const json& nodes : rule["nodes"].is_string() ? json::array({rule["nodes"]}) : rule["nodes"]) {
            const std::string path = nodes;
            all.insert(path.substr(path.rfind('/') + 1));
        }
    return all;
}

/// Triangles of 1 m on nodes that stand `step` metres apart along X, from 100 m on, at 5 m.
NamedParts row_of(const std::vector<const char*>& names, const char* root, double step = 40) {
    NamedParts street;
    const uint32_t iron = street.material("iron");
    const uint32_t above = root ? street.node(root) : kNone;
    double x = 100;
    for (const char* name : names) {
        street.show(street.node(name, above, {x, 5, 0}), iron, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        x += step;
    }
    return street;
}

// Exporters put all nodes below one root, or below none: these are no parts of one lamp.
TEST(TemplateCandidates, LampsBelowARootAreNoPartsOfEachOther) {
    using Patterns = std::set<std::string>;
    const std::vector<const char*> kinds{"street lamp 1", "street lamp 2", "desk lamp 1", "desk lamp 2"};
    const std::vector<const char*> posts{"lamp_post_01", "lamp_post_02", "lamp_wall_01"};
    for (const char* root : {"Scene", "Lights", "street_lamp_library", static_cast<const char*>(nullptr)}) {
        EXPECT_EQ(patterns(row_of(kinds, root)), (Patterns{"street lamp *", "desk lamp *"})) << (root ? root : "none");
        EXPECT_EQ(patterns(row_of(posts, root)), (Patterns{"lamp_post_*", "lamp_wall_01"})) << (root ? root : "none");
        EXPECT_EQ(row_of(posts, root).made().parts, 0u);
        row_of(posts, root).expect_clean();
    }
    // Near each other, as on one wall, a post is a lamp still.
    EXPECT_EQ(patterns(row_of(posts, nullptr, 2)), (Patterns{"lamp_post_*", "lamp_wall_01"}));
    // Lights without meshes tell how wide a root is.
    NamedParts yard;
    const uint32_t root = yard.node("Scene");
    for (const double x : {0.0, 50.0}) yard.node("lamp_head_" + std::to_string(int(x)), root, {x, 5, 0});
    yard.show(yard.node("lamp_post_09", root, {90, 0, 0}), yard.material("iron"), {0, 0, 0}, {0, 4, 0}, {0.1f, 0, 0});
    EXPECT_EQ(patterns(yard), (Patterns{"lamp_head_*", "lamp_post_09"}));
    // Exporters that apply transforms leave all nodes at the origin.
    NamedParts flat;
    for (int i = 0; i < 3; ++i)
        flat.show(flat.node(posts[size_t(i)]), flat.material("iron"), {40 * i, 5, 0}, {1, 0, 0}, {0, 1, 0});
    EXPECT_EQ(patterns(flat), (Patterns{"lamp_post_01", "lamp_post_02", "lamp_wall_01"})) << "their offsets differ";
}

// A head of 1 m on a pole of 6 m: one lamp, whether the node above is named so or not; the pole is counted.
TEST(TemplateCandidates, PartsOfOneLampAreCounted) {
    for (const char* above : {"object_1", "lamps"}) {
        NamedParts street;
        for (const double x : {0.0, 50.0}) {
            const uint32_t whole = street.node(above, kNone, {x, 0, 0});
            street.show(street.node("lamp_pole", whole), street.material("iron"), {0, 0, 0}, {0, 6, 0}, {0.2f, 0, 0});
            street.show(street.node("lamp_head", whole), street.material("iron"), {0, 6, 0}, {1, 0, 0}, {0, 0.1f, 0});
        }
        const scene::PhotometryTemplate made = street.made();
        EXPECT_EQ(made.parts, 2u) << above;
        EXPECT_EQ(made.sources[size_t(scene::SourceReason::Name)], 2u) << above;
    }
    NamedParts body;
    const uint32_t lamp = body.node("street_lamp_01");
    body.show(body.node("street_lamp_01_mesh", lamp), body.material("iron"), {0, 0, 0}, {0, 6, 0}, {0.2f, 0, 0});
    EXPECT_EQ(body.made().parts, 1u);
    EXPECT_EQ(patterns(body), std::set<std::string>{"street_lamp_01"});
    // A shade at its lamp is a part of it below any root; one that stands alone is not.
    NamedParts room;
    const uint32_t root = room.node("Scene");
    room.node("lamp_01", root, {0, 2, 0}), room.node("lamp_02", root, {30, 2, 0});
    room.node("lamp_shade_02", root, {30, 1.8, 0});
    EXPECT_EQ(room.made().parts, 1u);
    room.node("lamp_shade_03", root, {15, 1.8, 0});
    EXPECT_EQ(room.made().parts, 1u);
    EXPECT_TRUE(patterns(room).contains("lamp_shade_03"));
}

// "lamps" of a car of 4 m are the glass of its lamps, whose kinds are known; a desk lamp beside a lantern is none.
TEST(TemplateCandidates, GlassBesideLampsOfKnownKinds) {
    NamedParts street;
    const uint32_t car = street.node("car_1", kNone, {10, 0, 20});
    street.show(street.node("body", car), street.material("paint"), {-0.9f, 0.3f, -2}, {1.8f, 0, 0}, {0, 0, 4});
    street.show(street.node("car_1_lamps", car), street.material("glass"), {-0.6f, 0.6f, 2}, {1.2f, 0, 0},
                {0, 0.1f, 0});
    street.node("headlight_l", car, {-0.6, 0.6, 2}), street.node("headlight_r", car, {0.6, 0.6, 2});
    EXPECT_EQ(street.made().sources[size_t(scene::SourceReason::Name)], 2u);
    EXPECT_EQ(street.made().parts, 1u);
    EXPECT_EQ(patterns(row_of({"lantern", "desk lamp"}, "shelf", 1)), (std::set<std::string>{"lantern", "desk lamp"}));
    EXPECT_EQ(patterns(row_of({"lantern", "lamp glass"}, "shelf", 1)), (std::set<std::string>{"lantern"}));
}

// Lamps within lamps, as deep as files go: the outermost is the lamp, and looking for it takes no time for each of
// them.
TEST(TemplateCandidates, AChainOfLamps) {
    NamedParts street;
    uint32_t last = kNone;
    for (int i = 0; i < 20'000; ++i) last = street.node("lamp", last);
    const scene::PhotometryTemplate made = street.made();
    EXPECT_EQ(made.lamps, 1u);
    EXPECT_EQ(made.parts, 19'999u);
}

}  // namespace
}  // namespace vesper::test
