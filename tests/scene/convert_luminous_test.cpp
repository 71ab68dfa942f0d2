// Pictures of light sources, from the photometry file to the scene that is read. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "io/hdr_image.h"
#include "io/read_file.h"
#include "scene/colour.h"
#include "scene/scene_report.h"
#include "support/conversion.h"

namespace vesper::test {
namespace {

using nlohmann::json;

/// Three shop windows: with a base colour texture, with an emission texture moved by a transform, with neither.
class ConvertLuminous : public ConversionTest {
protected:
    ConvertLuminous() {
        add_wall_picture();
        street_.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
        street_.root["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 0}}};
        const json moved = {{"index", 1},
                            {"texCoord", 0},
                            {"extensions", {{"KHR_texture_transform", {{"texCoord", 1}, {"scale", {2, 2}}}}}}};
        street_.root["extensionsUsed"] = {"KHR_texture_transform"};
        street_.root["materials"] = {
            {{"name", "window"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}},
            {{"name", "sign"}, {"emissiveTexture", moved}},
            {{"name", "bare"}}};
        const size_t position = street_.vec3({0, 0, 0, 20, 0, 0, 0, 20, 0}), uv = street_.vec2({0, 0, 1, 0, 0, 1}),
                     second = street_.vec2({0.5, 0.5, 0, 0.5, 0.5, 0});
        const json attributes = {{"POSITION", position}, {"TEXCOORD_0", uv}, {"TEXCOORD_1", second}};
        for (int material : {0, 1, 2}) street_.show({{"attributes", attributes}, {"material", material}});
        write("lit.exr", 1);
    }
    /// 3 x 2 texels: 0, 1, 2 with more red, 0.01, 50000, 1e8.
    io::HdrImage picture(double white) const {
        io::HdrImage image{.width = 3, .height = 2, .white_luminance = white};
        for (const float value : {0.0f, 1.0f, 2.0f, 0.01f, 5e4f, 1e8f}) image.rgb.insert(image.rgb.end(), 3, value);
        image.rgb[6] = 4;
        return image;
    }
    void write(const std::string& name, double white) const { io::write_exr(folder_ / name, picture(white)); }

    scene::PhotometryReport convert_with(json emitter, const std::string& output = "out.gltf") {
        return ConversionTest::convert_with({{"emitters", emitter.is_array() ? emitter : json::array({emitter})}},
                                            output);
    }
    std::string complaint_with(const json& emitter) {
        return complaint_of([&] { convert_with(emitter); });
    }
};

TEST_F(ConvertLuminous, APictureGoesIntoTheFile) {
    const std::vector<uint8_t> bytes = io::read_file(folder_ / "lit.exr", 1 << 20);
    for (const char* output : {"out.gltf", "out.glb"}) {
        SCOPED_TRACE(output);
        const scene::PhotometryReport report =
            convert_with({{"name", "shop"}, {"materials", "window"}, {"image", "lit.exr"}}, output);
        EXPECT_TRUE(mentions(
            report.changes,
            "emitter 'shop': 1 material, picture 'lit.exr' of 3 x 2 px, 1.668e+07 cd/m^2 in the mean, 1e+08 at most"));
        EXPECT_FALSE(mentions(report.warnings, "picture"));
        const TempFolder elsewhere;  // nothing beside it
        std::filesystem::copy(folder_ / output, elsewhere / output);
        const scene::Scene scene = scene::read_scene(elsewhere / output).scene;
        ASSERT_EQ(scene.luminance_pictures.size(), 1u);
        EXPECT_EQ(scene.luminance_pictures[0].name, "lit.exr");
        EXPECT_EQ(scene.luminance_pictures[0].rgb, picture(1).rgb) << "every number as it was";
        const scene::Material& window = scene.materials[0];
        EXPECT_EQ(window.emission, glm::vec3(1));
        EXPECT_EQ(window.emission_picture, (scene::TextureUse{0, scene::Wrap::Clamp, scene::Wrap::Mirror, true}))
            << "as the base colour's";
        EXPECT_EQ(window.emission_texture.image, scene::kNone);
        for (int other : {1, 2}) EXPECT_EQ(scene.materials[size_t(other)].emission_picture.image, scene::kNone);
        const std::string file = read_text(folder_ / output);
        const std::string found(bytes.begin(), bytes.end());
        EXPECT_NE(
            file.find(std::string(output) == "out.glb" ? found
                                                       : scene::encode_data_uri("application/octet-stream", bytes)),
            std::string::npos)
            << "the file, byte for byte";
    }
    // Other viewers see the mean.
    const json material = json::parse(read_text(folder_ / "out.gltf"))["materials"][0];
    const double strength = material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"];
    EXPECT_NEAR(strength * material["emissiveFactor"][1].get<double>(), (1 + 2 + 0.01 + 5e4 + 1e8) / 6, 10);
    EXPECT_FALSE(material.contains("emissiveTexture"));
}

TEST_F(ConvertLuminous, IsAbsoluteOrScaled) {
    const auto factor = [&](json emitter) {
        emitter["materials"] = "window";
        convert_with(emitter);
        return double(converted().materials[0].emission.g);
    };
    EXPECT_EQ(factor({{"image", "lit.exr"}}), 1);
    EXPECT_EQ(factor({{"image", "lit.exr"}, {"scale", 0.25}}), 0.25);
    EXPECT_NEAR(factor({{"image", "lit.exr"}, {"luminance_cd_m2", 3000}}), 3e-5, 1e-11);
    EXPECT_EQ(factor({{"image", "lit.exr"}, {"scale", 0}}), 0);
    write("white.exr", 2.5);
    EXPECT_EQ(factor({{"image", "white.exr"}}), 2.5) << "whiteLuminance";
    EXPECT_EQ(factor({{"image", "white.exr"}, {"scale", 4}}), 4) << "the rule says what the value 1 is";
    EXPECT_NEAR(factor({{"image", "white.exr"}, {"luminance_cd_m2", 3000}}), 3e-5, 1e-11);
    write("relative.exr", 0);
    const json rule = {{"materials", "window"}, {"image", "relative.exr"}};
    EXPECT_TRUE(mentions(convert_with(rule).warnings, "picture 'relative.exr': does not say how much its value 1 is"));
    EXPECT_EQ(converted().materials[0].emission.g, 1);
    // Radiance: 2 x 1 px, 1.0 and 0.5 (mantissas count half a step more).
    folder_.write("a.hdr", std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n") + "\x80\x80\x80\x81" +
                               "\x80\x80\x80\x80");
    EXPECT_EQ(factor({{"image", "a.hdr"}, {"scale", 20}}), 20);
    EXPECT_NEAR(converted().luminance_pictures[0].rgb[0], 1, 0.005);
}

TEST_F(ConvertLuminous, LiesAsTheTextureBefore) {
    convert_with(
        json::array({{{"materials", "sign"}, {"image", "lit.exr"}}, {{"materials", "bare"}, {"image", "lit.exr"}}}));
    const scene::Scene scene = converted();
    EXPECT_EQ(scene.luminance_pictures.size(), 1u) << "stored once";
    const auto uv = [&](size_t mesh, size_t vertex) {
        return scene.meshes[mesh].primitives[0].vertices[vertex].emission_uv();
    };
    EXPECT_EQ(uv(1, 0), glm::vec2(1, 1)) << "the second set, doubled";
    EXPECT_EQ(uv(1, 1), glm::vec2(0, 1));
    EXPECT_EQ(uv(2, 1), glm::vec2(1, 0)) << "TEXCOORD_0";
    EXPECT_EQ(scene.materials[2].emission_picture,
              (scene::TextureUse{0, scene::Wrap::Repeat, scene::Wrap::Repeat, false}));
}

TEST_F(ConvertLuminous, NegativeColoursAreSaid) {
    io::HdrImage image = picture(1);
    image.rgb[4] = -0.1f;
    io::write_exr(folder_ / "wide.exr", image);
    const json rule = {{"materials", "bare"}, {"image", "wide.exr"}};
    EXPECT_TRUE(mentions(convert_with(rule).warnings, "picture 'wide.exr': 1 pixels with negative components"));
    const scene::Scene scene = converted();
    for (const float value : scene.luminance_pictures.at(0).rgb) EXPECT_GE(value, 0);
}

TEST_F(ConvertLuminous, RefusesWithPlaceAndReason) {
    const auto rule = [&](json more) {
        more["materials"] = "bare";
        return complaint_with(more);
    };
    const std::string place = "p.json: /emitters/0/image: ";
    EXPECT_TRUE(contains(rule({{"image", "none.exr"}}), place));
    EXPECT_TRUE(contains(rule({{"image", "none.exr"}}), "none.exr: "));
    EXPECT_TRUE(contains(rule({{"image", "wall.png"}}), "is neither OpenEXR nor Radiance (.hdr), but image/png"));
    EXPECT_TRUE(contains(rule({{"image", (folder_ / "lit.exr").string()}}), "is an absolute path"));
    EXPECT_TRUE(contains(rule({{"image", "https://a/b.exr"}}), "not a relative path"));
    EXPECT_TRUE(contains(rule({{"image", ""}}), place + "empty URI"));
    EXPECT_TRUE(contains(rule({{"image", 3}}), place + "must be a string"));
    const std::string whole = read_text(folder_ / "lit.exr");
    folder_.write("cut.exr", whole.substr(0, whole.size() - 20));
    EXPECT_TRUE(contains(rule({{"image", "cut.exr"}}), place));
    io::HdrImage odd = picture(1);
    odd.rgb[3 * 4 + 2] = std::numeric_limits<float>::quiet_NaN();
    io::write_exr(folder_ / "nan.exr", odd);
    EXPECT_TRUE(contains(rule({{"image", "nan.exr"}}), "nan.exr: pixel (1, 1) is not finite"));
    folder_.write("huge.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 20000 +X 20000\n");
    EXPECT_TRUE(contains(rule({{"image", "huge.hdr"}}), "20000 x 20000 px is larger than the limit"));
    folder_.write("large.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 9000 +X 9000\n");
    EXPECT_TRUE(contains(rule({{"image", "large.hdr"}}), "9000 x 9000 px has more pixels than the limit"));
    EXPECT_TRUE(contains(rule({{"image", "lit.exr"}, {"scale", 1}, {"luminance_cd_m2", 5}}),
                         "/luminance_cd_m2: is given beside scale"));
    EXPECT_TRUE(contains(rule({{"image", "lit.exr"}, {"scale", 1e4}}), "more than 1e10 cd/m^2"));
    EXPECT_TRUE(contains(rule({{"image", "lit.exr"}, {"scale", -1}}), "/emitters/0/scale: must be from 0"));
    for (const char* key : {"modulate", "colour_rgb", "colour_temperature_K", "lamp"})
        EXPECT_TRUE(contains(rule({{"image", "lit.exr"}, {key, true}}),
                             std::string("/emitters/0/") + key + ": is given beside image"));
    EXPECT_TRUE(contains(rule({{"scale", 2}, {"luminance_cd_m2", 5}}),
                         "/emitters/0/scale: has a meaning only beside an image"));
    io::HdrImage black = picture(1);
    std::fill(black.rgb.begin(), black.rgb.end(), 0.0f);
    io::write_exr(folder_ / "black.exr", black);
    EXPECT_TRUE(
        contains(rule({{"image", "black.exr"}, {"luminance_cd_m2", 5}}), "cannot scale a picture that is black"));
    EXPECT_EQ(rule({{"image", "black.exr"}}), "");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.glb"));
}

TEST_F(ConvertLuminous, NeedsTextureCoordinates) {
    street_.root["meshes"][2]["primitives"][0]["attributes"].erase("TEXCOORD_0");
    const json rule = {{"materials", "bare"}, {"image", "lit.exr"}};
    EXPECT_TRUE(
        contains(complaint_with(rule),
                 "in.gltf: /meshes/2/primitives/0/attributes: has no TEXCOORD_0, by which the luminance picture "
                 "'lit.exr' of material 'bare' would lie"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.gltf"));
    street_.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 4;
    EXPECT_TRUE(contains(complaint_with({{"materials", "window"}, {"image", "lit.exr"}}), "has no TEXCOORD_4"));
}

TEST_F(ConvertLuminous, TheReaderChecks) {
    convert_with({{"materials", "bare"}, {"image", "lit.exr"}});
    const json good = json::parse(read_text(folder_ / "out.gltf"));
    const auto complaint = [&](const char* pointer, const json& value, const scene::SceneLimits& limits = {}) {
        json bad = good;
        bad[json::json_pointer(std::string("/extras/vesper/") + pointer)] = value;
        return complaint_of([&] { scene::read_scene(folder_.write("bad.gltf", bad.dump()), limits); });
    };
    EXPECT_EQ(complaint("luminous/0/scale", 2), "");
    EXPECT_TRUE(contains(complaint("luminance_pictures/0/bufferView", 99), "luminance_pictures/0/bufferView"));
    EXPECT_TRUE(contains(complaint("luminance_pictures/0/bufferView", 0), "is neither OpenEXR nor Radiance"));
    EXPECT_TRUE(contains(complaint("luminance_pictures/0/uri", "/etc/passwd"), "unknown key"));
    EXPECT_TRUE(
        contains(complaint("luminance_pictures", json(std::vector<json>(1025, json::object()))), "more than 1024"));
    EXPECT_TRUE(contains(complaint("luminous/0/material", 3), "luminous/0/material"));
    EXPECT_TRUE(contains(complaint("luminous/0/picture", 1), "luminous/0/picture"));
    EXPECT_TRUE(contains(complaint("luminous/0/scale", -1), "luminous/0/scale"));
    EXPECT_TRUE(contains(complaint("luminous/0/scale", 1e35), "not finite"));
    EXPECT_TRUE(contains(complaint("luminous/0/sampler", 7), "luminous/0/sampler"));
    EXPECT_TRUE(contains(complaint("luminous/0/texCoord", 1.5), "luminous/0/texCoord"));
    EXPECT_TRUE(
        contains(complaint("luminous/1", good["extras"]["vesper"]["luminous"][0]), "a luminance picture already"));
    scene::SceneLimits small;
    small.texels = 20;  // 2 of a PNG, and 6 that count four times
    EXPECT_TRUE(contains(complaint("luminous/0/scale", 1, small), "more pixels than the limit"));
    small.image_side = 2, small.texels = 1000;
    EXPECT_TRUE(contains(complaint("luminous/0/scale", 1, small), "limit for one side"));
}

TEST_F(ConvertLuminous, IsReported) {
    convert_with({{"materials", "bare"}, {"image", "lit.exr"}, {"luminance_cd_m2", 6000}});
    const scene::SceneReport report = scene::report_scene(converted());
    const scene::MaterialReport& bare = report.materials.at(2);
    EXPECT_EQ(bare.picture, "lit.exr");
    EXPECT_NEAR(bare.emission, 6000, 0.1);
    EXPECT_NEAR(bare.mean_emission, 6000 / 1e8 * (1e8 + 5e4 + 3.4352) / 6, 0.1);
    EXPECT_EQ(report.materials.at(0).picture, "");
}

}  // namespace
}  // namespace vesper::test
