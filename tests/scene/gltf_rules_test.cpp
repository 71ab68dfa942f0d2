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

/// A file with extensions that refer to what there is.
json extended() {
    json root = sound();
    for (const char* name : {"EXT_texture_webp", "KHR_draco_mesh_compression", "KHR_materials_anisotropy", "KHR_materials_clearcoat", "KHR_materials_diffuse_transmission", "KHR_materials_ior",
                             "KHR_materials_pbrSpecularGlossiness", "KHR_materials_variants", "KHR_materials_volume"})
        root["extensionsUsed"].push_back(name);
    root["images"] = {{{"uri", "data:image/webp;base64,UklGRgAAAABXRUJQ"}}};
    root["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
    root["materials"].push_back({{"extensions", {{"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}}},
                                                 {"KHR_materials_clearcoat", {{"clearcoatTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"texCoord", 1}}}}}}}}},
                                                 {"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 1}}},
                                                 {"KHR_materials_ior", {{"ior", 0}}},
                                                 {"KHR_materials_volume", {{"attenuationDistance", 2}}}}}});
    root["materials"].push_back({{"extensions", {{"KHR_materials_pbrSpecularGlossiness", {{"glossinessFactor", 1}}}}}});
    root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "red"}}, {{"name", "blue"}}};
    root["meshes"][0]["primitives"][0]["extensions"] = {{"KHR_draco_mesh_compression", {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}}},
                                                        {"KHR_materials_variants", {{"mappings", {{{"material", 0}, {"variants", {0}}}, {{"material", 0}, {"variants", {1}}}}}}}};
    return root;
}

TEST(GltfRules, ExtensionsHaveTheirRangesAndReferToWhatIsThere) {
    const std::string coat = "/materials/1/extensions/KHR_materials_clearcoat/clearcoatTexture", mappings = "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings";
    const std::string index = coat + "/index", one_more = mappings + "/2", variant = mappings + "/1/variants", material = mappings + "/0/material";
    const std::string coated = index + ": names none of the 1 textures", mapped = variant + ": names none of the 2 variants", again = variant + ": names a variant that another mapping names",
                      twice = variant + ": names something twice", painted = material + ": names none of the 3 materials", empty = variant + ": is empty", without = one_more + ": has no material";
    expect_broken(extended(), {
        {index.c_str(), 9, coated.c_str()},
        {variant.c_str(), {4}, mapped.c_str()},
        {variant.c_str(), {0}, again.c_str()},
        {variant.c_str(), {1, 1}, twice.c_str()},
        {variant.c_str(), json::array(), empty.c_str()},
        {material.c_str(), 55, painted.c_str()},
        {one_more.c_str(), {{"variants", json::array()}}, without.c_str()},
        {mappings.c_str(), nullptr, "/KHR_materials_variants: has no mappings"},
        {"/extensions/KHR_materials_variants/variants/0", json::object(), "/extensions/KHR_materials_variants/variants/0: has no name"},
        {"/textures/0/extensions/EXT_texture_webp/source", 77, "/textures/0/extensions/EXT_texture_webp/source: names none of the 1 images"},
        {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/bufferView", 88, "/KHR_draco_mesh_compression/bufferView: names none of the 1 bufferViews"},
        {"/materials/1/extensions/KHR_materials_ior/ior", 0.5, "/KHR_materials_ior/ior: is less than 1"},
        {"/materials/1/extensions/KHR_materials_ior/ior", -1, "/KHR_materials_ior/ior: is less than 1"},
        {"/materials/1/extensions/KHR_materials_anisotropy/anisotropyStrength", 1.5, "/anisotropyStrength: is more than 1"},
        {"/materials/1/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor", 2, "/diffuseTransmissionFactor: is more than 1"},
        {"/materials/2/extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor", 3, "/glossinessFactor: is more than 1"},
    }, 2);
    json root = extended();
    root["extensions"]["KHR_materials_variants"]["variants"] = json::array();
    EXPECT_TRUE(mentions(broken(root), "/extensions/KHR_materials_variants/variants: is empty"));
    root["extensions"]["KHR_materials_variants"] = json::object();
    EXPECT_TRUE(mentions(broken(root), "/extensions/KHR_materials_variants: has no variants"));
    root = extended();
    root["materials"][1]["extensions"]["KHR_materials_ior"]["ior"] = 1.5;
    EXPECT_EQ(broken(root), std::vector<std::string>{});
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
