// Tone mapper only: frames that another renderer made, in cd/m^2, to the display; what the eye remembers is kept and put back.
//     c++ -std=c++17 main.cpp -o tone_mapper $(pkg-config --cflags --libs vesper)
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <vector>

#include <vesper/vesper.h>

namespace {

void check(VesperResult result, const VesperError& error) {
    if (result != VESPER_OK) throw std::runtime_error(error.message);
}

template <auto Destroy>
struct Destroyer {
    template <class T>
    void operator()(T* object) const {
        Destroy(object);
    }
};
using Device = std::unique_ptr<VesperDevice, Destroyer<vesper_device_close>>;
using Mapper = std::unique_ptr<VesperToneMapper, Destroyer<vesper_tone_mapper_destroy>>;

constexpr uint32_t kWidth = 320, kHeight = 200;

// A road under a tunnel's lamps, then outside in the sun: luminance in cd/m^2.
std::vector<float> frame(bool outside) {
    std::vector<float> rgb;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const float l = (outside ? 3000.0f : 5.0f) * (0.2f + 0.8f * float(y) / kHeight);
            rgb.insert(rgb.end(), {l, l, l});
        }
    return rgb;
}

void run() {
    VesperError error;
    VesperDevice* opened = nullptr;
    check(vesper_device_open(nullptr, &opened, &error), error);
    const Device device(opened);
    VesperToneMapper* made = nullptr;
    check(vesper_tone_mapper_create(device.get(), &made, &error), error);
    const Mapper mapper(made);

    VesperToneSettings settings;
    vesper_tone_settings_defaults(&settings);
    std::vector<uint8_t> codes(size_t{kWidth} * kHeight * 4);
    VesperFrameReport report = VESPER_INIT(VesperFrameReport);
    VesperOutputs outputs = VESPER_INIT(VesperOutputs);
    outputs.codes = codes.data(), outputs.report = &report;
    const auto show = [&](bool outside, float seconds) {
        const std::vector<float> rgb = frame(outside);
        VesperPicture picture = VESPER_INIT(VesperPicture);
        picture.width = kWidth, picture.height = kHeight, picture.channels = 3, picture.values = rgb.data();
        picture.scale = 1, picture.vertical_fov = 0.7f;
        check(vesper_tone_map(mapper.get(), &settings, &picture, seconds, &outputs, &error), error);
        return codes[4 * (size_t{kWidth} * (kHeight / 2) + kWidth / 2)];
    };
    std::printf("in the tunnel: code %d in the middle\n", show(false, 0));
    std::vector<unsigned char> eye(vesper_eye_size());
    check(vesper_tone_mapper_eye(mapper.get(), eye.data(), &error), error);
    for (int i = 0; i < 5; ++i) std::printf("outside, %.1f s: code %d\n", 0.1 * (i + 1), show(true, 0.1f));
    check(vesper_tone_mapper_set_eye(mapper.get(), eye.data(), eye.size(), &error), error);
    std::printf("outside once more, as seen from the tunnel: code %d\n", show(true, 0.1f));
}

}  // namespace

int main() {
    try {
        run();
    } catch (const std::exception& failure) {
        std::fprintf(stderr, "tone_mapper: %s\n", failure.what());
        return 1;
    }
}
