// Several engines in one process, on threads of their own: each gives what it gives alone. SPDX-License-Identifier: MIT
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "io/hdr_image.h"
#include "io/image_file.h"
#include "io/named_file.h"
#include "io/read_file.h"
#include "photometry/distribution.h"
#include "photometry/standard_lamps.h"
#include "places.h"
#include "render/renderer.h"
#include "render/tone_mapper.h"
#include "roads/opendrive.h"
#include "scene/display_file.h"
#include "scene/photometry.h"
#include "scene/read_scene.h"
#include "scene/scene_files.h"
#include "support/scene_geometry.h"

namespace vesper::test {
namespace {

constexpr size_t kThreads = 4;

/// Runs `work(i)` on so many threads at once.
template <class Work>
void at_once(const Work& work) {
    std::vector<std::thread> threads;
    for (size_t i = 0; i < kThreads; ++i) threads.emplace_back([&work, i] { work(i); });
    for (std::thread& thread : threads) thread.join();
}

/// What an engine of its own shows of a scene that others read too, after some frames; each of the threads in another
/// way.
std::vector<uint8_t> shown(const scene::Scene& scene, size_t which) {
    gpu::Device device;
    render::Renderer renderer(device, scene);
    render::ToneMapper mapper(device);
    render::RenderSettings settings;
    settings.tone_operator = render::operators()[which].tone_operator;
    settings.glare = render::Glare::Scatter;
    const VkExtent2D extent{uint32_t(16 + 8 * which), 12};
    std::vector<uint8_t> all;
    for (int i = 0; i < 3; ++i) {
        const render::Frame frame =
            renderer.render(settings, gpu_scene::View::symmetric(extent, 0.4f, glm::mat4(1)),
                            {scene::world_transforms(scene, 0)}, 0.1f, {.display = true, .scene = true});
        const render::ToneMapped mapped =
            mapper.map(settings, {.extent = extent, .values = frame.scene, .channels = 4}, 0.1f);
        all.insert(all.end(), frame.display.begin(), frame.display.end());
        all.insert(all.end(), mapped.display.begin(), mapped.display.end());
    }
    return all;
}

TEST(Threads, EnginesShowWhatEachShowsAlone) {
    const scene::Scene scene = wall_with_a_lamp();
    std::vector<uint8_t> alone[kThreads], together[kThreads];
    for (size_t i = 0; i < kThreads; ++i) alone[i] = shown(scene, i);
    at_once([&](size_t i) { together[i] = shown(scene, i); });
    for (size_t i = 0; i < kThreads; ++i) EXPECT_EQ(together[i], alone[i]) << "engine " << i;
    EXPECT_NE(alone[0].size(), alone[1].size());
}

// An engine belongs to one thread at a time, not to the one that made it.
TEST(Threads, AnEngineMayGoFromThreadToThread) {
    const scene::Scene scene = wall_with_a_lamp();
    std::unique_ptr<gpu::Device> device;
    std::unique_ptr<render::Renderer> renderer;
    const auto elsewhere = [](const auto& work) { std::thread(work).join(); };
    const gpu_scene::View view = gpu_scene::View::symmetric({16, 8}, 0.4f, glm::mat4(1));
    const gpu_scene::SceneFrame moment{scene::world_transforms(scene, 0)};
    std::vector<uint8_t> first, second;
    elsewhere([&] {
        device = std::make_unique<gpu::Device>(), renderer = std::make_unique<render::Renderer>(*device, scene);
    });
    elsewhere([&] { first = renderer->render({}, view, moment, 0, {.display = true}).display; });
    elsewhere([&] {
        renderer->reset_adaptation(), second = renderer->render({}, view, moment, 0, {.display = true}).display;
    });
    elsewhere([&] { renderer.reset(), device.reset(); });
    EXPECT_EQ(first, second);
    EXPECT_FALSE(first.empty());
}

TEST(Threads, ReadersReadTheSameFiles) {
    const std::filesystem::path data = std::filesystem::path(VESPER_SOURCE_DIR) / "data";
    const TempFolder folder;
    io::write_png(folder / "x.png", 7, 5, std::vector<uint8_t>(7 * 5 * 4, 99));
    const auto read = [&](size_t i) {
        const io::AllowedFolder allowed(data);  // of this thread
        std::vector<double> seen;
        seen.push_back(double(scene::read_scene(data / "glare/headlamps.gltf").scene.nodes.size()));
        seen.push_back(double(io::read_hdr_image(data / "rivoli/signs.exr").rgb[1]));
        seen.push_back(photometry::luminous_flux(photometry::read_distribution(data / "photometry/street-lamp.ies")));
        seen.push_back(photometry::luminous_flux(photometry::read_distribution(data / "road/luminaire.ldt")));
        seen.push_back(photometry::luminous_flux(photometry::read_distribution(data / "photometry/high-beam.csv")));
        seen.push_back(double(roads::read_opendrive(data / "rivoli/rivoli.xodr").roads.size()));
        seen.push_back(double(io::decode_image(io::read_file(folder / "x.png", 1 << 20), 100).rgba[3]));
        seen.push_back(double(scene::find_display("lcd").peak));
        scene::read_photometry(data / "rivoli/rivoli.measured.photometry.json");
        io::write_png(folder / ("y" + std::to_string(i) + ".png"), 7, 5, std::vector<uint8_t>(7 * 5 * 4, 99));
        return seen;
    };
    const std::vector<double> alone = read(0);
    std::vector<double> together[kThreads];
    at_once([&](size_t i) {
        for (int round = 0; round < 3; ++round) together[i] = read(i);
    });
    for (const auto& seen : together) EXPECT_EQ(seen, alone);
}

}  // namespace
}  // namespace vesper::test
