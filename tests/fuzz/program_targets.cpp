#include <vesper/vision.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "arguments/glare_arguments.h"
#include "channels/channels.h"
#include "fuzz/targets.h"
#include "result.h"
#include "session/drive_file.h"
#include "tone_log.h"
#include "window/controllers.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;
using Bytes = std::span<const uint8_t>;

// Takes values from the front of some bytes; zeroes where they end.
class Giver {
public:
    explicit Giver(Bytes bytes) : bytes_(bytes) {}
    template <class T>
    T next() {
        T value{};
        const size_t count = std::min(sizeof value, bytes_.size());
        std::memcpy(&value, bytes_.data(), count);
        bytes_ = bytes_.subspan(count);
        return value;
    }
    Bytes rest() const { return bytes_; }

private:
    Bytes bytes_;
};

// Open to the end of the program: drivers lose some memory when they are unloaded, which is not ours to be found.
struct Opened {
    VesperDevice* device = nullptr;
    VesperToneMapper* mapper = nullptr;
    VesperVision* vision = nullptr;
    Opened() {
        if (vesper_device_open(nullptr, &device, nullptr) != VESPER_OK) return;
        vesper_tone_mapper_create(device, &mapper, nullptr);
        vesper_vision_create(device, &vision, nullptr);
    }
};
const Opened& opened() {
    static const Opened& open = *new Opened;
    return open;
}

void expect_message(VesperResult result, const VesperError& error) {
    if (result != VESPER_OK && !*error.message) throw std::runtime_error("an error without a message");
}

// What a host could hand over: sound settings and a picture with some numbers that may be anything, behind pointers
// that point to enough. Without a device there is no mapper, which is an answer.
void call_c_interface(Bytes bytes) {
    const Opened& open = opened();
    constexpr uint32_t kMostSide = 24;
    Giver from(bytes);
    const auto odd = from.next<uint32_t>();  // which numbers
    uint32_t number = 0;
    const auto change = [&](auto& value) {
        if (odd >> number++ & 1) value = from.next<std::remove_reference_t<decltype(value)>>();
    };
    VesperToneSettings settings = VESPER_INIT(VesperToneSettings);
    vesper_tone_settings_defaults(&settings, sizeof settings);
    settings.tone_operator = from.next<uint8_t>() % 9, settings.glare = from.next<uint8_t>() % 7;
    change(settings.tone_operator), change(settings.glare), change(settings.bins), change(settings.age),
        change(settings.pigmentation);
    change(settings.gaze[0]), change(settings.gaze[1]), change(settings.colour_loss), change(settings.acuity_loss),
        change(settings.purkinje);
    change(settings.display_peak), change(settings.display_black), change(settings.display_ambient);
    VesperPicture picture = VESPER_INIT(VesperPicture);
    picture.width = from.next<uint8_t>() % kMostSide + 1, picture.height = from.next<uint8_t>() % kMostSide + 1;
    picture.channels = 3, picture.scale = 1, picture.vertical_fov = 0.7f;
    change(picture.channels), change(picture.scale), change(picture.vertical_fov);
    float seconds = 0.1f;
    change(seconds);
    std::vector<uint8_t> eye(vesper_eye_size());
    const bool another_eye = odd >> 31;
    for (uint8_t& byte : eye) byte = another_eye ? from.next<uint8_t>() : 0;
    std::vector<float> values(kMostSide * kMostSide * 4), light(values.size());
    for (size_t i = 0; i < values.size() && !from.rest().empty(); ++i) values[i] = from.next<float>();
    picture.values = values.data();
    std::vector<uint8_t> codes(values.size());
    VesperFrameReport report = VESPER_INIT(VesperFrameReport);
    VesperOutputs outputs = VESPER_INIT(VesperOutputs);
    outputs.codes = codes.data(), outputs.display_light = light.data(), outputs.report = &report;
    VesperError error;
    vesper_tone_mapper_reset(open.mapper, &error);
    vesper_tone_mapper_set_eye(open.mapper, eye.data(), eye.size(), &error);
    expect_message(vesper_tone_map(open.mapper, &settings, &picture, seconds, &outputs, &error), error);
}

// The same for figures of what an observer sees: two pictures that have everything in common but their values, unless
// numbers are changed.
void call_vision(Bytes bytes) {
    const Opened& open = opened();
    constexpr uint32_t kMostSide = 48, kTargets = 4;
    Giver from(bytes);
    const auto odd = from.next<uint32_t>();  // which numbers
    uint32_t number = 0;
    const auto change = [&](auto& value) {
        if (odd >> number++ & 1) value = from.next<std::remove_reference_t<decltype(value)>>();
    };
    VesperObserver observer = VESPER_INIT(VesperObserver);
    observer.age = 40, observer.pigmentation = 0.5f;
    change(observer.size), change(observer.age), change(observer.pigmentation), change(observer.scattered);
    VesperPicture first = VESPER_INIT(VesperPicture);
    first.width = from.next<uint8_t>() % kMostSide + 1, first.height = from.next<uint8_t>() % kMostSide + 1;
    first.channels = 3, first.scale = 1, first.vertical_fov = 0.03f;
    change(first.channels), change(first.scale), change(first.vertical_fov);
    for (float& edge : first.edges) change(edge);
    VesperPicture second = first;
    change(second.scale), change(second.vertical_fov), change(second.edges[0]);
    VesperTarget target = VESPER_INIT(VesperTarget);
    target.arc_minutes = 10, target.seconds = 0.2f, target.age = 40;
    change(target.size), change(target.arc_minutes), change(target.seconds), change(target.age), change(target.veil);
    float luminance[kTargets], background[kTargets];
    for (uint32_t i = 0; i < kTargets; ++i) luminance[i] = from.next<float>(), background[i] = from.next<float>();
    std::vector<float> values(kMostSide * kMostSide * 4), others(values.size()), map(values.size());
    for (size_t i = 0; i < values.size() && !from.rest().empty(); ++i)
        values[i] = from.next<float>(), others[values.size() - 1 - i] = values[i];
    first.values = values.data(), second.values = others.data();

    VesperDifferences found = VESPER_INIT(VesperDifferences);
    VesperFidelity maps = VESPER_INIT(VesperFidelity);
    maps.lost = map.data();
    VesperError error;
    expect_message(vesper_visible_differences(open.vision, &observer, &first, &second, map.data(), &found, &error),
                   error);
    expect_message(vesper_contrast_fidelity(open.vision, &observer, &first, &second, &maps, &error), error);
    expect_message(vesper_saliency(open.vision, &first, map.data(), &error), error);
    const VesperResult result = vesper_visibility_levels(&target, kTargets, luminance, background, map.data(), &error);
    expect_message(result, error);
    for (uint32_t i = 0; result == VESPER_OK && i < kTargets; ++i)
        if (!std::isfinite(map[i])) throw std::runtime_error("a visibility level that is no number");
}

std::map<std::string, FuzzTarget> make_targets() {
    return {
        {"drive", of_file("x.json", [](const fs::path& file) { drive::read_drive(file); })},
        {"controllers", of_file("x.json", [](const fs::path& file) { drive::read_controllers(file); })},
        {"channels", of_file("x.json", [](const fs::path& file) { drive::read_channels(file); })},
        {"bench_result", of_file("x.json", [](const fs::path& file) { bench::read_result(file); })},
        {"tone_log", of_file("x.csv", [](const fs::path& file) { apps::read_log(file); })},
        {"lamp_list", of_file("x.csv", [](const fs::path& file) { apps::read_lamps(file); })},
        {"c_interface", call_c_interface},
        {"c_vision", call_vision},
    };
}

}  // namespace

const std::map<std::string, FuzzTarget>& program_fuzz_targets() {
    static const std::map<std::string, FuzzTarget> targets = answering(make_targets());
    return targets;
}

}  // namespace vesper::test
