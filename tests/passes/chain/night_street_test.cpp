// The night street of data/rivoli, every operator on the device against the references. SPDX-License-Identifier: MIT
#include <unistd.h>

#include <filesystem>

#include <gtest/gtest.h>

#include "gpu_scene/cameras.h"
#include "places.h"
#include "render/renderer.h"
#include "scene/convert.h"
#include "scene/read_scene.h"
#include "support/reference_chain.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;

scene::Scene night_street() {
    const fs::path folder = fs::temp_directory_path() / ("vesper-street-" + std::to_string(getpid()));
    fs::create_directories(folder);
    const fs::path rivoli = fs::path(VESPER_SOURCE_DIR) / "data/rivoli";
    scene::convert(rivoli / "rivoli.gltf", rivoli / "rivoli.photometry.json", folder / "night.gltf", {});
    scene::Scene scene = scene::read_scene(folder / "night.gltf").scene;
    fs::remove_all(folder);
    return scene;
}

// Two frames half a second apart: operators that remember go on from the first. One pixel of ten thousand may be more
// than a code off, where float and double fall on either side of a bin's edge.
TEST(NightStreet, EveryOperatorEqualsTheReference) {
    const scene::Scene scene = night_street();
    const VkExtent2D extent{1680, 1050};
    std::string complaints;
    gpu::Device device(
        {.select = "", .validation = true, .on_message = [&](const std::string& m) { complaints += m + "\n"; }});
    render::Renderer renderer(device, scene);
    for (const render::OperatorInfo& op : render::operators()) {
        if (op.tone_operator == render::Operator::Ldr) continue;  // shows no luminance
        render::RenderSettings settings;
        settings.tone_operator = op.tone_operator;
        renderer.reset_adaptation();
        shared::EyeState eye{};
        for (const float seconds : {0.0f, 0.5f}) {
            const gpu_scene::SceneFrame moment{scene::world_transforms(scene, double(seconds))};
            const render::Frame got = renderer.render(settings, gpu_scene::camera_view(scene, moment, "driver", extent),
                                                      moment, seconds, {.display = true, .scene = true});
            const auto* texels = reinterpret_cast<const glm::vec4*>(got.scene.data());
            const auto want = reference_codes({texels, got.scene.size() / 4}, extent, settings, op.form,
                                              got.foveal_level, seconds, eye);
            EXPECT_LE(pixels_off(got.display, want), want.size() / 10000) << op.name << " after " << seconds << " s";
            eye = got.eye;
            if (!op.remembers) break;
        }
    }
    EXPECT_EQ(complaints, "");
}

}  // namespace
}  // namespace vesper::test
