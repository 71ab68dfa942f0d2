// Renders for as long as is asked, with sizes, operators, glare and lamps changing, and sees whether memory stays and
// validation is silent.
//     vesper-soak [FRAMES]
// SPDX-License-Identifier: MIT
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>

#include "base/error.h"
#include "render/renderer.h"
#include "render/tone_mapper.h"
#include "support/scene_geometry.h"

namespace vesper::test {
namespace {

using render::Glare;

constexpr VkExtent2D kSizes[]{{16, 8}, {33, 21}, {64, 40}, {1, 1}, {7, 50}};

struct Eye {
    Glare glare;
    eye::ScatterSettings::Model model;
};
constexpr Eye kEyes[]{{Glare::None, {}},
                      {Glare::Ldr, {}},
                      {Glare::Scatter, eye::ScatterSettings::Model::Cie},
                      {Glare::Scatter, eye::ScatterSettings::Model::Ward},
                      {Glare::Scatter, eye::ScatterSettings::Model::Spencer},
                      {Glare::Scatter, eye::ScatterSettings::Model::Temporal}};

constexpr uint64_t kQuickEyes = 3,
                   kSlowRounds = 10;  // the others take half a second a size, and are seen in every tenth round

constexpr uint32_t kLamps = 24;
constexpr uint64_t kRoundsOfARenderer = 10;
constexpr double kMostGrowth = 1.01;  // of memory, after the warm-up, which is a tenth of the run
constexpr uint64_t kJudgedRounds =
    100;  // of fewer, only the device's memory is judged: allocators and drivers are still settling

/// A floor, a wall, and lamps before it: spots, points and one that has an opening to look at.
scene::Scene lit_wall() {
    scene::Scene scene;
    scene.materials = {scene::Material{}};
    add_mesh(scene, rectangle({-5, -2, -10}, {10, 0, 0}, {0, 6, 0}), kRectangle, 0);
    add_mesh(scene, rectangle({-5, -2, 0}, {10, 0, 0}, {0, 0, -10}), kRectangle, 0);
    for (uint32_t i = 0; i < kLamps; ++i) {
        scene::Lamp lamp{.name = "lamp",
                         .kind = i % 2 ? scene::Lamp::Kind::Spot : scene::Lamp::Kind::Point,
                         .intensity = 50.0f + float(i)};
        lamp.outer_cone = 0.6f, lamp.inner_cone = 0.3f;
        if (i % 8 == 0) lamp.opening = {.length = 0.1, .width = 0.1, .height = 0, .round = true};
        scene::Node node;
        node.lamp = uint32_t(scene.lamps.size());
        node.translation = {float(i % 6) - 2.5f, float(i / 6) - 1.0f, -4};
        scene.lamps.push_back(lamp);
        scene.nodes.push_back(node);
    }
    return scene;
}

double resident_mib() {
    uint64_t size = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> size >> resident;
    return double(resident) * double(::sysconf(_SC_PAGESIZE)) / (1 << 20);
}

/// Allocated and not given back, by anybody in the process. Resident memory holds the gaps between that as well, and
/// the code of the programs.
double used_mib() {
    const struct mallinfo2 heap = ::mallinfo2();
    return double(heap.uordblks + heap.hblkhd) / (1 << 20);
}

struct Memory {
    double resident = 0, used = 0, device = 0;  // MiB
    static Memory now(const gpu::Device& d) { return {resident_mib(), used_mib(), double(d.use().bytes) / (1 << 20)}; }
    void see(const Memory& m) {
        resident = std::max(resident, m.resident), used = std::max(used, m.used), device = std::max(device, m.device);
    }
};

class Soak {
public:
    int run(uint64_t frames) {
        const uint64_t rounds = std::max<uint64_t>((frames + kRound - 1) / kRound, 2),
                       warm_up = std::max<uint64_t>(rounds / 10, 1);
        Memory warm, after;
        std::printf("%9s %14s %12s %12s %9s\n", "frames", "resident, MiB", "used, MiB", "device, MiB", "messages");
        for (uint64_t round = 0; round < rounds; ++round) {
            if (round % kRoundsOfARenderer == 0)
                renderer_.reset(), renderer_ = std::make_unique<render::Renderer>(device_, scene_);
            for (uint64_t i = 0; i < kRound; ++i) frame(round * kRound + i);
            const Memory now = Memory::now(device_);
            (round < warm_up ? warm : after).see(now);
            if (round + 1 == warm_up || (round + 1) % std::max<uint64_t>(rounds / 10, 1) == 0) {
                std::printf("%9llu %14.1f %12.2f %12.2f %9llu\n", static_cast<unsigned long long>((round + 1) * kRound),
                            now.resident, now.used, now.device, static_cast<unsigned long long>(messages_));
                std::fflush(stdout);
            }
        }
        const auto grown = [](double before, double then) { return 100 * (then / before - 1); };
        std::printf("after the warm-up: resident %+.2f %%, used %+.2f %%, device %+.2f %%\n",
                    grown(warm.resident, after.resident), grown(warm.used, after.used),
                    grown(warm.device, after.device));
        const bool host_stays = rounds < kJudgedRounds || after.used <= kMostGrowth * warm.used;
        return messages_ == 0 && host_stays && after.device <= kMostGrowth * warm.device ? 0 : 1;
    }

private:
    // Every operator at every size with every kind of glare.
    static inline const uint64_t kOperators = render::operators().size(),
                                 kRound = kOperators * std::size(kSizes) * std::size(kEyes);

    void frame(uint64_t i) {
        const VkExtent2D extent = kSizes[i / kOperators % std::size(kSizes)];
        const uint64_t round = i / kRound, which = i / kOperators / std::size(kSizes) % std::size(kEyes);
        const Eye& eye = kEyes[round % kSlowRounds == 0 ? which : which % kQuickEyes];
        render::RenderSettings settings;
        settings.tone_operator = render::operators()[i % kOperators].tone_operator;
        settings.glare = eye.glare, settings.scatter.model = eye.model,
        settings.scatter.eye.age = double(20 + round % 60);
        settings.histogram.bins = uint32_t(20 + i % 200);
        if (settings.tone_operator == render::Operator::Ldr && settings.glare == Glare::Scatter)
            settings.glare = Glare::None;
        if (i % 97 == 0) renderer_->reset_adaptation();

        gpu_scene::SceneFrame moment{scene::world_transforms(scene_, 0)};
        moment.dimming.assign(scene_.nodes.size(), 1);
        for (size_t node = 0; node < scene_.nodes.size(); ++node) {
            if (scene_.nodes[node].lamp == scene::kNone) continue;
            const float phase = float(i % 1000) * 0.02f * float(node);
            moment.dimming[node] = std::max(0.0f, std::sin(phase));  // half of them dark
            moment.world[node][3] += glm::vec4(std::cos(phase), 0, std::sin(phase), 0);
        }
        const gpu_scene::View view = gpu_scene::View::symmetric(extent, 0.8f, glm::mat4(1));
        const render::Frame shown = renderer_->render(
            settings, view, moment, 0.02f, {.display = true, .scene = i % 5 == 0, .display_light = i % 7 == 0});
        if (!shown.scene.empty() && settings.tone_operator != render::Operator::Ldr)
            mapper_.map(settings, {.extent = extent, .values = shown.scene, .channels = 4}, 0.02f);
    }

    uint64_t messages_ = 0;
    gpu::Device device_{{.select = "", .validation = true, .on_message = [this](const std::string& message) {
                             if (++messages_ <= 3) std::fprintf(stderr, "%s\n", message.c_str());
                         }}};
    scene::Scene scene_ = lit_wall();
    std::unique_ptr<render::Renderer> renderer_;
    render::ToneMapper mapper_{device_};
};

}  // namespace
}  // namespace vesper::test

int main(int argc, char** argv) {
    try {
        return vesper::test::Soak().run(argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 100'000);
    } catch (const vesper::Error& error) {
        std::fprintf(stderr, "vesper-soak: %s\n", error.what());
        return 2;
    }
}
