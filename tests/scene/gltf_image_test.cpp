// Pictures of glTF files that are missing, damaged or of other formats. SPDX-License-Identifier: MIT
#include "base/budget.h"
#include "io/image_file.h"
#include "scene/scene_files.h"

namespace vesper::test {
namespace {

using nlohmann::json;

/// Lossless WebP of 2 x 1 px: (10, 20, 30, 255), (200, 100, 50, 128); made by libwebp 1.2.4.
constexpr const char* kWebp = "data:image/webp;base64,UklGRiQAAABXRUJQVlA4TBcAAAAvAQAAEA9wCqgr+J7C44H/wYMKRPQ/AAA=";

/// A triangle whose base colour is a picture times `factor` (none where that is null).
GltfFile with_picture(const std::string& uri, const json& factor) {
    GltfFile file;
    json pbr = {{"baseColorTexture", {{"index", 0}}}};
    if (!factor.is_null()) pbr["baseColorFactor"] = factor;
    file.root["materials"] = {{{"name", "wall"}, {"pbrMetallicRoughness", pbr}}};
    file.root["images"] = {{{"uri", uri}}};
    file.root["textures"] = {{{"source", 0}}};
    file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}}}, {"material", 0}});
    return file;
}

TEST(GltfImage, APictureThatCannotBeReadIsTheFactorAndNamed) {
    const std::string ktx = scene::encode_data_uri(
        "image/ktx2", std::vector<uint8_t>{0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, 13, 10, 26, 10});
    const std::string cut = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUg==";
    for (const auto& [uri, said] : {std::pair<std::string, std::string>{"gone/wall.png", "picture gone/wall.png"},
                                    {ktx, "image/ktx2"},
                                    {cut, "picture image 0 cannot be read (PNG: "},
                                    {"data:image/png;base64,AAA*", "base64 data"},
                                    {"data:image/png;base64,AAAA", "neither PNG nor JPEG"}}) {
        const scene::LoadedScene loaded = with_picture(uri, {0.2, 0.4, 0.6, 1}).read();
        const scene::Material& m = loaded.scene.materials.at(0);
        EXPECT_EQ(m.base_colour, glm::vec4(0.2f, 0.4f, 0.6f, 1)) << uri;
        EXPECT_EQ(m.base_colour_texture.image, scene::kNone) << uri;
        EXPECT_TRUE(mentions(loaded.notes, said.c_str())) << uri;
        EXPECT_TRUE(mentions(loaded.notes, "its material shows its factors instead")) << uri;
        // A white factor is no colour of its own: the surface is as one without material.
        for (const json& white : {json(), json({1, 1, 1, 1})})
            EXPECT_EQ(with_picture(uri, white).read().scene.materials[0].base_colour, glm::vec4(0.5f, 0.5f, 0.5f, 1));
    }
}

TEST(GltfImage, AMissingRoughnessMakesNoMetal) {
    for (const double metallic : {1.0, 0.25}) {
        GltfFile file = with_picture("gone.png", {1, 1, 1, 1});
        file.root["materials"][0]["pbrMetallicRoughness"] = {{"metallicRoughnessTexture", {{"index", 0}}},
                                                             {"metallicFactor", metallic}};
        EXPECT_EQ(file.read().scene.materials.at(0).metallic, metallic == 1 ? 0.0f : 0.25f);
    }
}

// A lit window must not become a wall of light.
TEST(GltfImage, AMissingPictureOfEmissionEmitsNothing) {
    GltfFile file = with_picture("gone.png", {1, 1, 1, 1});
    json& material = file.root["materials"][0];
    material["emissiveFactor"] = {1, 0.5, 0}, material["emissiveTexture"] = {{"index", 0}};
    const scene::LoadedScene loaded = file.read();
    EXPECT_EQ(loaded.scene.materials.at(0).emission, glm::vec3(0));
    EXPECT_TRUE(mentions(loaded.notes, "emits nothing"));
    material.erase("emissiveTexture");
    EXPECT_EQ(file.read().scene.materials.at(0).emission, glm::vec3(1, 0.5f, 0));
}

TEST(GltfImage, RequiredFormatsOfPicturesRefuseNoScene) {
    for (const char* extension : {"KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds"}) {
        GltfFile file = with_picture("gone.ktx2", {0.3, 0.3, 0.3, 1});
        file.root["extensionsRequired"] = file.root["extensionsUsed"] = {extension};
        file.root["textures"] = {{{"extensions", {{extension, {{"source", 0}}}}}}};
        const scene::LoadedScene loaded = file.read();
        EXPECT_EQ(loaded.scene.materials.at(0).base_colour.r, 0.3f) << extension;
        EXPECT_TRUE(mentions(loaded.notes, "gone.ktx2")) << extension;
        // With a fallback that can be read.
        file.root["images"].push_back({{"uri", "data:image/png;base64,iVBORw0KGgo="}});
        file.root["textures"][0]["source"] = 1;
        EXPECT_TRUE(mentions(file.read().notes, "picture image 1 cannot be read")) << extension;
        file.root["textures"][0]["extensions"][extension]["source"] = 7;
        EXPECT_TRUE(contains(file.complaint(), "/source")) << extension;
    }
}

TEST(GltfImage, ReadsWebpOrSaysThatItDoesNot) {
    const scene::LoadedScene loaded = with_picture(kWebp, {0.2, 0.4, 0.6, 1}).read();
    if (!io::reads_webp()) {
        EXPECT_TRUE(mentions(loaded.notes, "image/webp"));
        return;
    }
    EXPECT_TRUE(loaded.notes.empty());
    const Image& image = loaded.scene.images.at(0);
    EXPECT_EQ(image.width, 2u);
    EXPECT_EQ(image.height, 1u);
    EXPECT_EQ(image.rgba, (std::vector<uint8_t>{10, 20, 30, 255, 200, 100, 50, 128}));
    std::vector<uint8_t> bytes = scene::decode_data_uri(kWebp);
    EXPECT_THROW(io::decode_image(bytes, 1), OverLimit);
    EXPECT_THROW(io::decode_image(bytes, 100, 1), OverLimit);
    for (size_t size = 0; size < bytes.size() - 2; ++size)
        EXPECT_THROW(io::decode_image(std::span(bytes).first(size), 100), Error) << size;
    for (size_t i = 0; i < bytes.size(); ++i)
        for (const int change : {1, 0x10, 0x80}) {
            std::vector<uint8_t> changed = bytes;
            changed[i] = static_cast<uint8_t>(changed[i] ^ change);
            try {
                EXPECT_LE(io::decode_image(changed, 4096).rgba.size(), size_t{4} * 4096 * 4096);
            } catch (const Error&) {
            }
        }
}

// Limits that can be raised still refuse, and so do names of files elsewhere.
TEST(GltfImage, PicturesOverALimitAreRefused) {
    scene::SceneLimits small;
    small.texels = 1;
    const TempFolder folder;
    io::write_png(folder / "two.png", 2, 1, std::vector<uint8_t>(8, 255));
    const auto file = folder.write("s.gltf", with_picture("two.png", json()).text());
    EXPECT_TRUE(contains(complaint_of([&] { scene::read_scene(file, small); }), "over the limit of texels"));
    EXPECT_TRUE(contains(with_picture("/etc/hostname", json()).complaint(), "absolute path"));
}

TEST(GltfImage, NotesNameSomePictures) {
    GltfFile file = with_picture("gone0.png", json());
    for (int i = 1; i < 40; ++i) {
        file.root["images"].push_back({{"uri", "gone" + std::to_string(i) + ".png"}});
        file.root["textures"].push_back({{"source", i}});
        file.root["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
    }
    const std::vector<std::string> notes = file.read().notes;
    EXPECT_EQ(notes.size(), 17u);
    EXPECT_TRUE(mentions(notes, "a further picture cannot be read: its material shows its factors instead (24 times)"));
}

}  // namespace
}  // namespace vesper::test
