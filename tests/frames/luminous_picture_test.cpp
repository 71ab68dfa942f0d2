// A picture of a light source, from its file through conversion to the rendered pixel. SPDX-License-Identifier: MIT
#include <cmath>

#include "io/hdr_image.h"
#include "render/renderer.h"
#include "scene/convert.h"
#include "scene/scene_files.h"

namespace vesper::test {
namespace {

constexpr uint32_t kTexels = 16, kZoom = 3;  // texels; pixels per texel

/// 1e-3 to 1e8 cd/m^2.
io::HdrImage picture() {
    io::HdrImage image{.width = kTexels, .height = kTexels, .white_luminance = 1};
    for (uint32_t i = 0; i < kTexels * kTexels; ++i)
        for (int c = 0; c < 3; ++c)
            image.rgb.push_back(std::pow(10.0f, -3 + 11.0f * float(i * 77 % 256) / 255 - 0.1f * float(c)));
    return image;
}

/// A black square of 2 m, 1 m in front of a camera that sees just that.
GltfFile square() {
    GltfFile file;
    file.root["samplers"] = {{{"magFilter", 9728}}};
    file.root["textures"] = {{{"sampler", 0}}};
    file.root["materials"] = {{{"name", "sign"},
                               {"emissiveTexture", {{"index", 0}}},
                               {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}}}}};
    file.show({{"attributes",
                {{"POSITION", file.vec3({-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1})},
                 {"TEXCOORD_0", file.vec2({0, 1, 1, 1, 1, 0, 0, 0})}}},
               {"indices", file.indices({0, 1, 2, 0, 2, 3})},
               {"material", 0}});
    return file;
}

std::vector<float> rendered(const std::filesystem::path& file, VkExtent2D extent) {
    gpu::Device device(gpu::DeviceOptions{});
    const scene::Scene scene = scene::read_scene(file).scene;
    render::Renderer renderer(device, scene);
    const gpu_scene::View view = gpu_scene::View::symmetric(extent, float(2 * std::atan(1.0)), glm::mat4(1));
    return renderer.render({}, view, {scene::world_transforms(scene, 0)}, 0, {.display = false, .scene = true}).scene;
}

TEST(LuminousPicture, APixelShowsTheLuminanceOfThePicture) {
    const TempFolder folder;
    const io::HdrImage image = picture();
    io::write_exr(folder / "sign.exr", image);
    const auto input = folder.write("in.gltf", square().text());
    for (const double scale : {1.0, 0.5}) {
        const nlohmann::json photometry = {
            {"version", 1}, {"emitters", {{{"materials", "sign"}, {"image", "sign.exr"}, {"scale", scale}}}}};
        scene::convert(input, folder.write("p.json", photometry.dump()), folder / "out.glb");
        const std::vector<float> scene = rendered(folder / "out.glb", {kTexels * kZoom, kTexels * kZoom});
        for (uint32_t y = 0; y < kTexels * kZoom; ++y)
            for (uint32_t x = 0; x < kTexels * kZoom; ++x)
                for (size_t c = 0; c < 3; ++c) {
                    const double want = scale * double(image.rgb[3 * size_t(y / kZoom * kTexels + x / kZoom) + c]);
                    ASSERT_NEAR(double(scene[4 * (size_t(y) * kTexels * kZoom + x) + c]), want, 1e-6 * want)
                        << x << ", " << y;
                }
        // From far away the mean is seen: one pixel for every 4 x 4 texels.
        const std::vector<float> small = rendered(folder / "out.glb", {kTexels / 4, kTexels / 4});
        double seen = 0, shown = 0;
        for (size_t i = 0; i < small.size(); i += 4) seen += double(small[i + 1]) / (kTexels / 4) / (kTexels / 4);
        for (size_t i = 0; i < image.rgb.size(); i += 3) shown += scale * double(image.rgb[i + 1]) / kTexels / kTexels;
        EXPECT_NEAR(seen / shown, 1, 1e-3);
    }
}

}  // namespace
}  // namespace vesper::test
