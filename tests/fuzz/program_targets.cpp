#include <vesper/vesper.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "channels.h"
#include "controllers.h"
#include "drive_file.h"
#include "fuzz/targets.h"
#include "glare_arguments.h"
#include "result.h"
#include "tone_log.h"

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
struct Mapper {
    VesperDevice* device = nullptr;
    VesperToneMapper* mapper = nullptr;
    Mapper() {
        if (vesper_device_open(nullptr, &device, nullptr) == VESPER_OK)
            vesper_tone_mapper_create(device, &mapper, nullptr);
    }
};

// What a host could hand over: sound settings and a picture with some numbers that may be anything, behind pointers
// that point to enough. Without a device there is no mapper, which is an answer.
void call_c_interface(Bytes bytes) {
    static const Mapper& open = *new Mapper;
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
    if (vesper_tone_map(open.mapper, &settings, &picture, seconds, &outputs, &error) != VESPER_OK && !*error.message)
        throw std::runtime_error("an error without a message");
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
    };
}

}  // namespace

const std::map<std::string, FuzzTarget>& program_fuzz_targets() {
    static const std::map<std::string, FuzzTarget> targets = answering(make_targets());
    return targets;
}

}  // namespace vesper::test
