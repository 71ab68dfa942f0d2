// Materials, textures and pictures of glTF files. SPDX-License-Identifier: MIT
#include <cmath>

#include "io/image_file.h"
#include "io/named_file.h"
#include "scene/scene_files.h"

namespace vesper::test {
namespace {

using nlohmann::json;

/// A picture of one colour as a data URI.
std::string png_uri(const std::vector<uint8_t>& rgba) {
    const TempFolder folder;
    io::write_png(folder / "x.png", static_cast<uint32_t>(rgba.size() / 4), 1, rgba);
    const std::string text = read_text(folder / "x.png");
    return scene::encode_data_uri("image/png", {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

/// A file with a triangle of one material.
GltfFile with_material(const json& material) {
    GltfFile file;
    file.root["materials"] = json::array({material});
    const size_t uv0 = file.vec2({0, 0, 1, 0, 0, 1}), uv1 = file.vec2({0.5f, 0.5f, 0.25f, 0.5f, 0, 0});
    file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}, {"TEXCOORD_0", uv0}, {"TEXCOORD_1", uv1}}},
               {"material", 0}});
    return file;
}

void add_texture(GltfFile& file, const std::string& uri, const json& sampler = json::object()) {
    file.root["images"].push_back({{"uri", uri}});
    file.root["samplers"].push_back(sampler);
    file.root["textures"].push_back(
        {{"source", file.root["images"].size() - 1}, {"sampler", file.root["samplers"].size() - 1}});
}

TEST(GltfMaterial, KeepsTheDefaultsOfTheFormat) {
    const scene::Scene scene = with_material({{"name", "plain"}}).read().scene;
    const scene::Material& m = scene.materials.at(0);
    EXPECT_EQ(m.base_colour, glm::vec4(1));
    EXPECT_EQ(m.metallic, 1);
    EXPECT_EQ(m.roughness, 1);
    EXPECT_EQ(m.emission, glm::vec3(0));
    EXPECT_EQ(m.alpha, scene::Material::Alpha::Opaque);
    EXPECT_EQ(scene.transfer.kind, scene::Transfer::Kind::Srgb);
}

TEST(GltfMaterial, ReadsFactorsAndEmission) {
    const json material = {
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0}, {"roughnessFactor", 0.8}}},
        {"emissiveFactor", {1, 0.5, 0}},
        {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 5000}}}}},
        {"alphaMode", "MASK"},
        {"alphaCutoff", 0.3},
        {"doubleSided", true}};
    const scene::Scene scene = with_material(material).read().scene;
    const scene::Material& m = scene.materials.at(0);
    EXPECT_EQ(m.base_colour, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(m.emission, glm::vec3(5000, 2500, 0));
    EXPECT_EQ(m.alpha, scene::Material::Alpha::Mask);
    EXPECT_FLOAT_EQ(m.alpha_cutoff, 0.3f);
    EXPECT_TRUE(m.double_sided);
}

TEST(GltfMaterial, KnowsGlass) {
    const auto clear = [](const json& material) { return with_material(material).read().scene.materials.at(0).clear; };
    const auto transmits = [](double factor) {
        return json{{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", factor}}}}}};
    };
    EXPECT_FALSE(clear(json::object()));
    EXPECT_FALSE(clear({{"alphaMode", "MASK"}}));
    EXPECT_TRUE(clear({{"alphaMode", "BLEND"}}));
    EXPECT_TRUE(clear({{"alphaMode", "BLEND"}, {"emissiveFactor", {1, 1, 1}}})) << "of a lamp, drawn opaque";
    EXPECT_TRUE(clear(transmits(0.9)));
    EXPECT_FALSE(clear(transmits(0)));
}

TEST(GltfMaterial, NotesWhatIsReadWithAChange) {
    const scene::LoadedScene blend = with_material({{"alphaMode", "BLEND"}}).read();
    EXPECT_EQ(blend.scene.materials[0].alpha, scene::Material::Alpha::Mask);
    EXPECT_TRUE(mentions(blend.notes, "BLEND"));
    const scene::LoadedScene unlit = with_material({{"extensions", {{"KHR_materials_unlit", json::object()}}}}).read();
    EXPECT_EQ(unlit.scene.materials[0].metallic, 0);
    EXPECT_TRUE(mentions(unlit.notes, "unlit"));
    json model = {
        {"diffuseFactor", {0.2, 0.3, 0.4, 1}}, {"specularFactor", {0.25, 0.5, 0}}, {"glossinessFactor", 0.25}};
    const scene::LoadedScene old =
        with_material({{"extensions", {{"KHR_materials_pbrSpecularGlossiness", model}}}}).read();
    EXPECT_EQ(old.scene.materials[0].base_colour, glm::vec4(0.1f, 0.15f, 0.2f, 1));  // half of it is reflected before
    EXPECT_EQ(old.scene.materials[0].metallic, 0);
    EXPECT_FLOAT_EQ(old.scene.materials[0].roughness, 0.75f);

    // The texture counts as its mean: codes of 188 are 0.5029, of sRGB; glossiness is linear.
    model.erase("specularFactor");
    EXPECT_EQ(glm::vec3(with_material({{"extensions", {{"KHR_materials_pbrSpecularGlossiness", model}}}})
                            .read()
                            .scene.materials[0]
                            .base_colour),
              glm::vec3(0));
    model["specularGlossinessTexture"] = {{"index", 0}};
    GltfFile varied = with_material({{"extensions", {{"KHR_materials_pbrSpecularGlossiness", model}}}});
    add_texture(varied, png_uri({188, 0, 0, 255, 0, 0, 0, 255}));
    const scene::LoadedScene mean = varied.read();
    EXPECT_NEAR(mean.scene.materials[0].base_colour.r, 0.2 * (1 - 0.5029 / 2), 1e-4);
    EXPECT_TRUE(mentions(mean.notes, "counts as its mean"));
}

TEST(GltfMaterial, SaysWhatIsNotRead) {
    GltfFile file = with_material(
        {{"occlusionTexture", {{"index", 0}}}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    const TempFolder folder;
    io::write_png_10bit(folder / "x.png", 1, 1, std::vector<uint32_t>{3u << 30 | 1000}, io::PngColour());
    const std::string text = read_text(folder / "x.png");
    add_texture(file,
                scene::encode_data_uri("image/png", {reinterpret_cast<const uint8_t*>(text.data()), text.size()}));
    file.root["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 2}}}});
    const std::vector<std::string> notes = file.read().notes;
    for (const char* said : {"an occlusion texture is not read", "a picture of 16 bits is read at 8",
                             "without material is shown matt grey, of reflectance 0.5"})
        EXPECT_TRUE(mentions(notes, said)) << said;
    const std::vector<std::string> others = with_material(json::object()).read().notes;
    for (const char* said : {"occlusion", "16 bits", "matt grey"}) EXPECT_FALSE(mentions(others, said)) << said;
}

TEST(GltfMaterial, TakesDefaultsForValuesItDoesNotKnow) {
    GltfFile file =
        with_material({{"alphaMode", "DITHER"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    add_texture(file, png_uri({10, 20, 30, 255}), {{"wrapS", 10496}, {"wrapT", 33071}});
    const scene::LoadedScene loaded = file.read();
    const scene::Material& m = loaded.scene.materials.at(0);
    EXPECT_EQ(m.alpha, scene::Material::Alpha::Opaque);
    EXPECT_EQ(m.base_colour_texture.wrap_u, scene::Wrap::Repeat);
    EXPECT_EQ(m.base_colour_texture.wrap_v, scene::Wrap::Clamp);
    EXPECT_TRUE(mentions(loaded.notes, "an alpha mode that glTF does not have is read as OPAQUE"));
    EXPECT_TRUE(mentions(loaded.notes, "a wrapping mode that glTF does not have is read as REPEAT"));
    file.root["materials"][0]["alphaMode"] = 1;
    EXPECT_TRUE(contains(file.complaint(), "/materials/0/alphaMode"));
}

TEST(GltfMaterial, ChoosesAndTransformsTextureCoordinates) {
    const json transform = {
        {"offset", {0.5, 0.25}}, {"scale", {2, 4}}, {"rotation", std::acos(-1) / 2}, {"texCoord", 1}};
    const json texture = {{"index", 0}, {"texCoord", 0}, {"extensions", {{"KHR_texture_transform", transform}}}};
    GltfFile file = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", texture}}}});
    add_texture(file, png_uri({10, 20, 30, 255}), {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
    const scene::Scene scene = file.read().scene;
    // TEXCOORD_1 of the second corner is (0.25, 0.5): scaled (0.5, 2), turned by a quarter, moved.
    const glm::vec2 uv = scene.meshes[0].primitives[0].vertices[1].uv;
    EXPECT_NEAR(uv.x, 0.5 + 2, 1e-6);
    EXPECT_NEAR(uv.y, 0.25 - 0.5, 1e-6);
    const scene::TextureUse& use = scene.materials[0].base_colour_texture;
    EXPECT_EQ(use.wrap_u, scene::Wrap::Clamp);
    EXPECT_EQ(use.wrap_v, scene::Wrap::Mirror);
    EXPECT_TRUE(use.nearest);
    EXPECT_EQ(scene.images.at(use.image).rgba, (std::vector<uint8_t>{10, 20, 30, 255}));
}

// Windows of an atlas over a tiled wall.
TEST(GltfMaterial, EmissionHasCoordinatesOfItsOwn) {
    const json transform = {{"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"scale", {2, 2}}}}}}};
    json turned = transform;
    turned["index"] = 0;
    // Sets alone, a transform alone, one that names a set, and one texture.
    turned["extensions"]["KHR_texture_transform"]["texCoord"] = 1;
    const json cases[] = {{{"index", 0}, {"texCoord", 1}},
                          {{"index", 0}, {"extensions", transform["extensions"]}},
                          turned,
                          {{"index", 0}}};
    const glm::vec2 want[] = {{0.25f, 0.5f}, {2.5f, 0}, {1, 1}, {1, 0}};
    for (size_t k = 0; k < 4; ++k) {
        SCOPED_TRACE(k);
        GltfFile file = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                                       {"emissiveFactor", {1, 1, 1}},
                                       {"emissiveTexture", cases[k]}});
        add_texture(file, png_uri({10, 20, 30, 255}));
        const scene::LoadedScene loaded = file.read();
        const scene::Vertex& second = loaded.scene.meshes[0].primitives[0].vertices[1];
        EXPECT_EQ(second.uv, glm::vec2(1, 0));
        EXPECT_EQ(second.emission_uv(), want[k]);
        EXPECT_FALSE(mentions(loaded.notes, "differently"));
    }
}

TEST(GltfMaterial, NotesARoughnessThatLiesDifferently) {
    json material = {
        {"pbrMetallicRoughness",
         {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 0}, {"texCoord", 1}}}}}};
    GltfFile file = with_material(material);
    add_texture(file, png_uri({10, 20, 30, 255}));
    EXPECT_TRUE(mentions(file.read().notes, "metallic-roughness texture that lies differently"));
    material["pbrMetallicRoughness"].erase("baseColorTexture");
    GltfFile alone = with_material(material);
    add_texture(alone, png_uri({10, 20, 30, 255}));
    const scene::LoadedScene loaded = alone.read();
    EXPECT_EQ(loaded.scene.meshes[0].primitives[0].vertices[1].uv, glm::vec2(0.25f, 0.5f));
    EXPECT_FALSE(mentions(loaded.notes, "differently"));
}

TEST(GltfMaterial, ReadsAPictureOnceAndOnlyWhenUsed) {
    GltfFile file = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                                   {"emissiveFactor", {1, 1, 1}},
                                   {"emissiveTexture", {{"index", 0}}},
                                   {"occlusionTexture", {{"index", 1}}}});
    add_texture(file, png_uri({1, 2, 3, 255}));
    add_texture(file, "missing.png");  // of the occlusion texture, which is not read
    const scene::LoadedScene loaded = file.read();
    EXPECT_EQ(loaded.scene.images.size(), 1u);
    EXPECT_EQ(loaded.scene.materials[0].emission_texture.image, 0u);
    EXPECT_TRUE(mentions(loaded.notes, "occlusion texture"));
}

TEST(GltfMaterial, ReadsReliefThatLiesAsTheColoursDo) {
    const nlohmann::json base{{"index", 0}, {"texCoord", 1}};
    const auto relief = [&](const nlohmann::json& normals) {
        GltfFile file =
            with_material({{"pbrMetallicRoughness", {{"baseColorTexture", base}}}, {"normalTexture", normals}});
        add_texture(file, png_uri({1, 2, 3, 255}));
        add_texture(file, png_uri({128, 128, 255, 255}));
        return file.read();
    };
    const scene::LoadedScene same = relief({{"index", 1}, {"texCoord", 1}, {"scale", 0.5}});
    EXPECT_EQ(same.scene.materials[0].normal_texture.image, 1u);
    EXPECT_EQ(same.scene.materials[0].normal_scale, 0.5f);
    EXPECT_FALSE(mentions(same.notes, "normal texture"));
    const scene::LoadedScene other = relief({{"index", 1}});
    EXPECT_EQ(other.scene.materials[0].normal_texture.image, scene::kNone);
    EXPECT_TRUE(
        mentions(other.notes, "a normal texture that lies differently from the colours of its surface is left"));
    EXPECT_EQ(relief({{"index", 1}, {"texCoord", 1}, {"scale", 0}}).scene.materials[0].normal_texture.image,
              scene::kNone);
    const scene::LoadedScene steep = relief({{"index", 1}, {"texCoord", 1}, {"scale", 1e20}});
    EXPECT_EQ(steep.scene.materials[0].normal_scale, 100);
    EXPECT_TRUE(mentions(steep.notes, "scale above 100"));
    GltfFile alone = with_material({{"normalTexture", {{"index", 0}, {"texCoord", 1}}}});
    add_texture(alone, png_uri({128, 128, 255, 255}));
    EXPECT_EQ(alone.read().scene.materials[0].normal_texture.image, 0u) << "its coordinates are those of the surface";
}

TEST(GltfMaterial, FallsBackFromFormatsItDoesNotRead) {
    GltfFile file = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    const std::vector<uint8_t> webp = {'R', 'I', 'F', 'F', 4, 0, 0, 0, 'W', 'E', 'B', 'P'};
    file.root["images"] = {{{"uri", scene::encode_data_uri("image/webp", webp)}}, {{"uri", png_uri({7, 7, 7, 255})}}};
    file.root["textures"] = {{{"source", 1}, {"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
    EXPECT_EQ(file.read().scene.images.at(0).rgba[0], 7);
    file.root["textures"][0].erase("source");
    EXPECT_EQ(file.read().scene.materials[0].base_colour_texture.image, scene::kNone);
    file.root["textures"][0]["source"] = 0;
    const scene::LoadedScene loaded = file.read();
    EXPECT_EQ(loaded.scene.materials[0].base_colour_texture.image, scene::kNone);
    EXPECT_TRUE(mentions(loaded.notes, io::reads_webp() ? "WebP: is damaged" : "image/webp"));
}

TEST(GltfMaterial, FindsPicturesByEncodedAndByPlainNames) {
    const TempFolder folder;
    std::filesystem::create_directory(folder / "sub");
    const std::vector<uint8_t> pixel = {9, 9, 9, 255};
    for (const char* name : {"a b ❤.png", "50%25.png"}) io::write_png(folder / name, 1, 1, pixel);
    for (const char* uri : {"a%20b%20%E2%9D%A4.png", "a b ❤.png", "50%25.png", "sub/../a b ❤.png"}) {
        GltfFile file = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
        add_texture(file, uri);
        EXPECT_EQ(scene::read_scene(folder.write("s.gltf", file.text())).scene.images.at(0).rgba[0], 9) << uri;
        // A database may keep its textures beside the folder of its models, where that is allowed.
        file.root["images"][0]["uri"] = "../" + std::string(uri);
        const std::filesystem::path beside = folder.write("sub/s.gltf", file.text());
        EXPECT_TRUE(contains(complaint_of([&] { scene::read_scene(beside); }), "lies outside the folder")) << uri;
        const io::AllowedFolder allowed(folder.path());
        EXPECT_EQ(scene::read_scene(folder.write("sub/s.gltf", file.text())).scene.images.size(), 1u) << uri;
    }
}

TEST(GltfMaterial, RefusesUrisThatLeadElsewhere) {
    for (const char* uri :
         {"/etc/hostname", "http://example.com/a.png", "file:///etc/hostname", "%2Fetc/hostname", "C:\\a.png", ""}) {
        GltfFile file = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
        add_texture(file, uri);
        EXPECT_TRUE(contains(file.complaint(), "/images/0/uri: ")) << uri;
    }
}

}  // namespace
}  // namespace vesper::test
