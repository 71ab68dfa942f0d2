#include "drive_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <nlohmann/json.hpp>

#include "arguments.h"
#include "base/error.h"
#include "io/atomic_file.h"
#include "scene/json_value.h"

namespace vesper {
namespace {

using nlohmann::json;

constexpr uint64_t kMostBytes = 2ull << 30;
constexpr unsigned kSafeEvery = 60;  // events
constexpr const char* kBeams[]{"off", "low", "high"};
constexpr const char* kIndicators[]{"none", "left", "right", "both"};

template <size_t N>
size_t choice(const JsonValue& value, const char* const (&names)[N]) {
    for (size_t i = 0; i < N; ++i)
        if (value.text() == names[i]) return i;
    value.fail("is not known");
}

DriverInput read_input(const JsonValue& step, const DriverInput& before) {
    step.allow_only({"steering", "throttle", "brake", "reverse", "beam", "indicator", "autopilot"});
    DriverInput input = before;
    input.steering = step.number_or("steering", before.steering, -1, 1);
    input.throttle = step.number_or("throttle", before.throttle, 0, 1);
    input.brake = step.number_or("brake", before.brake, 0, 1);
    input.reverse = step.boolean_or("reverse", before.reverse);
    input.autopilot = step.boolean_or("autopilot", before.autopilot);
    if (const auto beam = step.find("beam")) input.beam = Beam(choice(*beam, kBeams));
    if (const auto indicator = step.find("indicator")) input.indicator = Indicator(choice(*indicator, kIndicators));
    return input;
}

// What differs from the step before.
std::string input_text(const DriverInput& input, const DriverInput& before) {
    json made = json::object();
    if (input.steering != before.steering) made["steering"] = input.steering;
    if (input.throttle != before.throttle) made["throttle"] = input.throttle;
    if (input.brake != before.brake) made["brake"] = input.brake;
    if (input.reverse != before.reverse) made["reverse"] = input.reverse;
    if (input.autopilot != before.autopilot) made["autopilot"] = input.autopilot;
    if (input.beam != before.beam) made["beam"] = kBeams[size_t(input.beam)];
    if (input.indicator != before.indicator) made["indicator"] = kIndicators[size_t(input.indicator)];
    return made.dump();
}

// A path as seen from a folder.
std::string seen_from(const std::filesystem::path& folder, const std::filesystem::path& file) {
    if (file.empty()) return "";
    std::error_code failed;
    const std::filesystem::path near = std::filesystem::proximate(std::filesystem::absolute(file, failed), folder, failed);
    return (near.empty() ? file : near).generic_string();
}

std::string heading(const DriveStart& start, const std::filesystem::path& folder) {
    json head{{"vesper_drive", 1}, {"scene", seen_from(folder, start.scene)}, {"seed", start.seed}, {"time_step_s", start.time_step}, {"settings", start.settings}};
    if (!start.run.empty()) head["run"] = seen_from(folder, start.run);
    if (!start.scenario.empty()) head["scenario"] = seen_from(folder, start.scenario);
    std::string text = head.dump();
    text.pop_back();
    return text + ",\"events\":[\n";
}

DriveSettings::Values read_values(const JsonValue& object) {
    if (!object.json().is_object()) object.fail("must be an object");
    DriveSettings::Values values;
    for (const auto& [name, value] : object.json().items()) values[name] = object.at(name.c_str()).text();
    return values;
}

// A file whose program ended early: up to its last whole line, and closed.
std::vector<uint8_t> completed(std::vector<uint8_t> text, bool& was_complete) {
    const auto parses = [](const std::vector<uint8_t>& candidate) { return json::accept(candidate.begin(), candidate.end()); };
    was_complete = parses(text);
    if (was_complete) return text;
    // The last line may have been cut short.
    for (int tries = 0; tries < 2; ++tries) {
        std::vector<uint8_t> candidate = text;
        for (const char c : {']', '}'}) candidate.push_back(uint8_t(c));
        if (parses(candidate)) return candidate;
        while (!text.empty() && text.back() != '\n') text.pop_back();
    }
    return text;
}

}  // namespace

Drive read_drive(const std::filesystem::path& file) {
    Drive drive;
    const JsonFile text = parse_json(completed(read_file(file, kMostBytes), drive.complete), file.string());
    const JsonValue root(text);
    root.allow_only({"vesper_drive", "scene", "run", "scenario", "seed", "time_step_s", "settings", "events"});
    if (root.at("vesper_drive").integer() != 1) root.at("vesper_drive").fail("this version of Vesper reads drives of version 1");
    const auto found = [&](const std::filesystem::path& named) { return named.empty() || named.is_absolute() ? named : file.parent_path() / named; };
    drive.start.scene = found(root.at("scene").text());
    drive.start.run = found(root.text_or("run", "")), drive.start.scenario = found(root.text_or("scenario", ""));
    drive.start.seed = root.integer_or("seed", 1);
    drive.start.time_step = root.number_or("time_step_s", 1.0 / 60, 1e-4, 0.1);
    if (const auto settings = root.find("settings")) drive.start.settings = read_values(*settings);
    DriverInput input;
    for (const JsonValue& event : root.at("events").elements()) {
        event.allow_only({"step", "pose", "frame", "set", "restart"});
        if (event.json().size() != (event.find("step") ? 2 : 1)) event.fail("is more than one step, frame, set or restart");
        const auto happens = [&](const char* name) {
            const auto found_event = event.find(name);
            if (found_event && !(found_event->json().is_boolean() && found_event->json().get<bool>())) found_event->fail("must be true");
            return found_event.has_value();
        };
        if (const auto step = event.find("step")) {
            input = read_input(*step, input);
            const auto pose = event.at("pose").elements(4);
            drive.events.push_back({.kind = DriveEvent::Kind::Step, .input = input, .pose = {pose[0].number(), pose[1].number(), pose[2].number(), pose[3].number()}, .name = {}, .value = {}});
        } else if (const auto set = event.find("set")) {
            for (const auto& [name, value] : read_values(*set)) drive.events.push_back({.kind = DriveEvent::Kind::Set, .name = name, .value = value});
        } else if (happens("frame")) {
            drive.events.push_back({.kind = DriveEvent::Kind::Frame, .name = {}, .value = {}});
        } else if (happens("restart")) {
            drive.events.push_back({.kind = DriveEvent::Kind::Restart, .name = {}, .value = {}});
        } else {
            event.fail("is no step, frame, set or restart");
        }
    }
    return drive;
}

DriveRecorder::DriveRecorder(DriveStart start) : start_(std::move(start)) {}

DriveRecorder::~DriveRecorder() {
    try {
        close();
    } catch (const Error&) {
        // What was written before stays readable.
    }
}

void DriveRecorder::add(const DriveEvent& event) {
    std::string line = first_ ? "" : ",";
    switch (event.kind) {
        case DriveEvent::Kind::Step:
            line += "{\"step\":" + input_text(event.input, last_) + format(",\"pose\":[%.17g,%.17g,%.17g,%.17g]}", event.pose.x, event.pose.y, event.pose.z, event.pose.w);
            last_ = event.input;
            break;
        case DriveEvent::Kind::Frame: line += "{\"frame\":true}"; break;
        case DriveEvent::Kind::Set: line += json{{"set", {{event.name, event.value}}}}.dump(); break;
        case DriveEvent::Kind::Restart: line += "{\"restart\":true}"; break;
    }
    line += "\n";
    first_ = false;
    lines_ += line;
    if (descriptor_ < 0) return;
    write(line);
    if (++unsafe_ < kSafeEvery) return;
    ::fdatasync(descriptor_);
    unsafe_ = 0;
}

void DriveRecorder::open(const std::filesystem::path& file) {
    close();
    file_ = file;
    std::error_code failed;
    const std::string text = heading(start_, std::filesystem::absolute(file, failed).parent_path()) + lines_;
    replace_file(file, std::vector<uint8_t>(text.begin(), text.end()));  // an earlier drive stays until this one can be read
    descriptor_ = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (descriptor_ < 0) throw Error(one_line(file.string()) + ": cannot be written: " + std::strerror(errno));
}

void DriveRecorder::write(const std::string& text) {
    for (size_t done = 0; done < text.size();) {
        const ssize_t written = ::write(descriptor_, text.data() + done, text.size() - done);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) {
            const std::string reason = std::strerror(errno);
            ::close(descriptor_);
            descriptor_ = -1;
            throw Error(one_line(file_.string()) + ": the recording ends: " + reason);
        }
        done += size_t(written);
    }
}

void DriveRecorder::close() {
    if (descriptor_ < 0) return;
    write("]}\n");
    ::fdatasync(descriptor_);
    ::close(descriptor_);
    descriptor_ = -1;
}

}  // namespace vesper
