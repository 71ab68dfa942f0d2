// Tone mapper only: frames that another renderer made, in cd/m^2, to the display; what the eye remembers is kept and
// put back.
//     c++ -std=c++17 main.cpp -o tone_mapper $(pkg-config --cflags --libs vesper)
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

#include <vesper/vesper.hpp>

using namespace vesper::cpp;

namespace {

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
    const auto device = make<Device>(vesper_device_open, nullptr);
    const auto mapper = make<ToneMapper>(vesper_tone_mapper_create, device.get());
    VesperToneSettings settings = default_tone_settings();
    std::vector<uint8_t> codes(size_t{kWidth} * kHeight * 4);
    auto report = sized<VesperFrameReport>();
    auto outputs = sized<VesperOutputs>();
    outputs.codes = codes.data(), outputs.report = &report;
    const auto show = [&](bool outside, float seconds) {
        const std::vector<float> rgb = frame(outside);
        auto picture = sized<VesperPicture>();
        picture.width = kWidth, picture.height = kHeight, picture.channels = 3, picture.values = rgb.data();
        picture.scale = 1, picture.vertical_fov = 0.7f;
        call(vesper_tone_map, mapper.get(), &settings, &picture, seconds, &outputs);
        return codes[4 * (size_t{kWidth} * (kHeight / 2) + kWidth / 2)];
    };
    std::printf("in the tunnel: code %d in the middle\n", show(false, 0));
    std::vector<unsigned char> eye(vesper_eye_size());
    call(vesper_tone_mapper_eye, mapper.get(), eye.data());
    for (int i = 0; i < 5; ++i) std::printf("outside, %.1f s: code %d\n", 0.1 * (i + 1), show(true, 0.1f));
    call(vesper_tone_mapper_set_eye, mapper.get(), eye.data(), eye.size());
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
