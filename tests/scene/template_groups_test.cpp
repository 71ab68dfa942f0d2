// Rules of a photometry template for nodes that differ little, and for long names. SPDX-License-Identifier: MIT
#include "scene/named_parts.h"
#include "scene/template_patterns.h"

namespace vesper::test {
namespace {

using nlohmann::json;
using scene::kNone;
using scene::PhotometryTemplate;

/// Poles of 6 m with arms to +X or -X by turns, more than a rule lists; every fifth one is `taller` metres taller.
NamedParts street_of_poles(int count, float taller = 0) {
    NamedParts street;
    const uint32_t iron = street.material("iron");
    for (int i = 0; i < count; ++i) {
        const uint32_t node = street.node("street lamp " + std::to_string(i), kNone, {0, 0, 30 * i});
        const float arm = i % 2 == 0 ? 2 : -2, height = i % 5 == 4 ? 6 + taller : 6;
        street.show(node, iron, {-0.1f, 0, 0}, {0, height, 0}, {0.2f, 0, 0});
        street.show(node, iron, {0, height - 0.2f, 0}, {0, 0.2f, 0}, {arm, 0, 0});
    }
    return street;
}

// Lamps that no patterns tell apart share a rule rather than have none.
TEST(TemplateGroups, GroupsThatDifferByC0AloneAreMerged) {
    const auto comment = [](const json& rule) { return rule["comment"].get<std::string>(); };
    EXPECT_EQ(street_of_poles(40).rules("lamps").size(), 2u) << "the names tell the arms apart";
    for (const float taller : {0.0f, 2.0f}) {
        const NamedParts street = street_of_poles(400, taller);
        const PhotometryTemplate made = street.made();
        EXPECT_EQ(made.left_out_sources, 0u);
        ASSERT_EQ(made.lamps, 1u);
        const json rule = street.rules("lamps")[0];
        EXPECT_EQ(rule["nodes"], "street lamp *");
        EXPECT_FALSE(rule.contains("c0"));
        EXPECT_TRUE(rule.contains("offset_m"));
        EXPECT_TRUE(contains(comment(rule), "400 nodes about")) << rule;
        EXPECT_TRUE(contains(comment(rule), "arms differ: \"c0\" is its direction")) << rule;
        const std::string most = std::to_string(taller > 0 ? 160 : 200);
        EXPECT_TRUE(contains(comment(rule), "offsets differ: \"offset_m\" is that of " + most + " nodes")) << rule;
        street.expect_clean();
    }
    // 300 groups, more than there are rules: two for each of 150 names.
    NamedParts many;
    const uint32_t iron = many.material("iron");
    for (int i = 0; i < 150; ++i)
        for (const float arm : {2.0f, -2.0f}) {
            const std::string name = std::string("street lamp ") + char('a' + i / 15) + char('a' + i % 15) + "_";
            const uint32_t node = many.node(name + (arm > 0 ? "1" : "2"), kNone, {30 * i, 0, 0});
            many.show(node, iron, {-0.1f, 0, 0}, {0, 6, 0}, {0.2f, 0, 0});
            many.show(node, iron, {0, 5.8f, 0}, {0, 0.2f, 0}, {arm, 0, 0});
        }
    EXPECT_EQ(many.made().left_out_sources, 0u);
    EXPECT_LE(many.made().lamps, scene::kMostTemplateRules);
    many.expect_clean();
}

// A kind is told by the first 200 bytes of a part of a name: what a file writes beyond costs no time.
TEST(TemplateGroups, LongNamesAreLookedAtInPart) {
    const auto kind = [](const std::string& name) {
        NamedParts street;
        street.node(name);
        const json lamps = street.rules("lamps");
        return lamps.empty() ? "none" : lamps[0]["name"].get<std::string>();
    };
    std::string letters;
    for (int i = 0; i < 45; ++i) letters += "a b ";
    EXPECT_EQ(kind(letters + "streetlamp"), "street lamp") << "ends at 190";
    EXPECT_EQ(kind(letters + letters + "streetlamp"), "lamp");
    EXPECT_EQ(kind(letters + letters + "/streetlamp"), "street lamp");
    std::string huge;
    for (int i = 0; i < 150'000; ++i) huge += "a b ";
    EXPECT_EQ(kind(huge + "lamp"), "lamp");
    std::string sides;
    for (int i = 0; i < 100'000; ++i) sides += "left";
    EXPECT_EQ(scene::family_of(sides + "_Right.001"), std::string(100'000, '*') + "_*");
}

}  // namespace
}  // namespace vesper::test
