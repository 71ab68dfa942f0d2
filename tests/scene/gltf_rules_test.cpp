// Rules of glTF that a file breaks without harm: read, and noted with the place. SPDX-License-Identifier: MIT
#include "scene/broken_rules.h"

namespace vesper::test {
namespace {

using nlohmann::json;

/// A file that keeps all rules: a picture, a spot, data beside the JSON, extensions where they may be.
json sound() {
    GltfFile file;
    file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}}}, {"material", 0}}, {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.text();
    json root = file.root;
    root["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_unlit", "KHR_texture_transform"};
    root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}}};
    root["accessors"][0]["min"] = {0, 0, 0}, root["accessors"][0]["max"] = {1, 1, 0};
    root["materials"] = {{{"extensions", {{"KHR_materials_unlit", json::object()}}}, {"extras", {1, 2}}}};
    root["extras"] = {1, 2};
    root["buffers"].push_back({{"byteLength", 1}, {"uri", "data:application/octet-stream;charset=utf-8;base64,AA=="}});
    return root;
}

TEST(GltfRules, SoundFilesHaveNoNotes) { EXPECT_EQ(broken(sound()), std::vector<std::string>{}); }

TEST(GltfRules, WhatIsBrokenIsNotedWithItsPlace) {
    const json unlit{{"KHR_materials_unlit", json::object()}};
    const auto pictures = [](const char* uri) { return json::array({json{{"uri", uri}}}); };
    const std::vector<Fault> faults{
        {"/images", json::array({json::array({"uri", "x.png"})}), "/images/0: is no object"},
        {"/images", pictures(":"), "/images/0/uri: is no relative URI"},
        {"/images", pictures("nowhere.png"), "nowhere.png"},
        {"/images", pictures("data:image/png;base64,iVBORw0KGgoAAAANSUhEUg=="), "/images/0: PNG: is cut off"},
        {"/images", pictures("data:image/jpeg;base64,/9j/4AAQ"), "/images/0: JPEG: "},
        {"/buffers/1/uri", "data:application/octet-stream;;base64,AA==", "/buffers/1/uri: has a type with a parameter"},
        {"/buffers/1/uri", "data:application/octet-stream;base64;a=b,AA==", "/buffers/1/uri: has a type with a parameter"},
        {"/nodes/0/extensions/KHR_materials_unlit", json::object(), "/nodes/0/extensions/KHR_materials_unlit: is an extension that has no place there"},
        {"/samplers", json::array({json{{"extensions", unlit}}}), "/samplers/0/extensions/KHR_materials_unlit: is an extension that has no place"},
        {"/materials/0/pbrMetallicRoughness", {{"extensions", unlit}}, "/materials/0/pbrMetallicRoughness/extensions/KHR_materials_unlit: is an ext"},
        {"/materials/0/extensions/KHR_texture_transform", json::object(), "/materials/0/extensions/KHR_texture_transform: is an ext"},
        {"/nodes/0/extensions/EXT_unheard_of", json::object(), "/nodes/0/extensions/EXT_unheard_of: is not listed in extensionsUsed"},
        {"/extensionsRequired", json::array({"EXT_lights_ies"}), "/extensionsRequired/0: is not listed in extensionsUsed"},
        {"/extensions/KHR_lights_punctual/lights/0", {{"type", "spot"}}, "/extensions/KHR_lights_punctual/lights/0: has no spot to its type"},
        {"/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle", 0.2, "/extensions/KHR_lights_punctual/lights/0/spot: has an outer cone"},
    };
    for (const Fault& fault : faults) {
        json root = sound();
        root[json::json_pointer(fault.pointer)] = fault.value;
        const std::vector<std::string> rules = broken(root);
        EXPECT_TRUE(mentions(rules, fault.place)) << fault.pointer << " = " << fault.value << ": " << json(rules);
        EXPECT_LE(rules.size(), 2u) << json(rules);  // an odd URI names no file, either
    }
    json dark = sound();
    dark["nodes"][0].erase("extensions");
    dark["extensions"]["KHR_lights_punctual"]["lights"] = json::array();
    EXPECT_EQ(broken(dark), std::vector<std::string>{"/extensions/KHR_lights_punctual/lights: is empty"});
    dark["extensions"]["KHR_lights_punctual"] = json::object();
    EXPECT_EQ(broken(dark), std::vector<std::string>{"/extensions/KHR_lights_punctual: has no lights"});
}

// Where an extension brings other kinds of pictures, they are not for us to judge.
TEST(GltfRules, PicturesOfExtensionsArePassedOver) {
    json root = sound();
    root["images"] = json::array({json{{"uri", "data:image/webp;base64,UklGRgAAAABXRUJQ"}}});
    EXPECT_EQ(broken(root).size(), 2u);  // its type, and what it is
    root["extensionsUsed"].push_back("EXT_texture_webp");
    EXPECT_EQ(broken(root), std::vector<std::string>{});
}

}  // namespace
}  // namespace vesper::test
