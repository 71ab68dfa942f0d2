#include "session/drive_file.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/one_line.h"
#include "io/read_file.h"
#include "own_data.h"
#include "print.h"
#include "scene/json_text.h"
#include "scene/json_value.h"

namespace vesper::drive {
namespace {

using nlohmann::json;

constexpr uint64_t kMaxDriveBytes = 2ull << 30;
constexpr uint64_t kLargestSide = 16384;  // px, as of --size
constexpr const char* kBeams[]{"off", "low", "high"};
constexpr const char* kIndicators[]{"none", "left", "right", "both"};

template <size_t N>
size_t choice(const scene::JsonValue& value, const char* const (&names)[N]) {
    for (size_t i = 0; i < N; ++i)
        if (value.text() == names[i]) return i;
    value.fail("is not known");
}

traffic::DriverInput read_input(const scene::JsonValue& step, const traffic::DriverInput& before) {
    step.allow_only({"steering", "throttle", "brake", "reverse", "beam", "indicator", "autopilot"});
    traffic::DriverInput input = before;
    input.steering = step.number_or("steering", before.steering, -1, 1);
    input.throttle = step.number_or("throttle", before.throttle, 0, 1);
    input.brake = step.number_or("brake", before.brake, 0, 1);
    input.reverse = step.boolean_or("reverse", before.reverse);
    input.autopilot = step.boolean_or("autopilot", before.autopilot);
    if (const auto beam = step.find("beam")) input.beam = traffic::Beam(choice(*beam, kBeams));
    if (const auto indicator = step.find("indicator"))
        input.indicator = traffic::Indicator(choice(*indicator, kIndicators));
    return input;
}

// What differs from the step before.
std::string input_text(const traffic::DriverInput& input, const traffic::DriverInput& before) {
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

std::string step_text(const DriveEvent& event, const traffic::DriverInput& before) {
    const glm::dvec4 pose = event.pose.value_or(glm::dvec4(0));
    return "{\"step\":" + input_text(event.input, before) +
           apps::format(",\"pose\":[%.17g,%.17g,%.17g,%.17g]", pose.x, pose.y, pose.z, pose.w) +
           (event.shown ? apps::format(",\"messages_s\":%.17g}", *event.shown) : "}");
}

// A path as seen from a folder; what came with the program by a name that holds wherever either is moved.
std::string seen_from(const std::filesystem::path& folder, const std::filesystem::path& file) {
    if (file.empty()) return "";
    if (std::string own = apps::own_data_name(file); !own.empty() && apps::own_data_name(folder).empty()) return own;
    std::error_code failed;
    const std::filesystem::path near =
        std::filesystem::proximate(std::filesystem::absolute(file, failed), folder, failed);
    return (near.empty() ? file : near).generic_string();
}

json messages_json(const MessageSource& source, const std::filesystem::path& folder) {
    json made{{"file", seen_from(folder, source.file)}, {"live", source.live}};
    if (!source.models.empty()) made["models"] = seen_from(folder, source.models);
    if (!source.host.empty()) made["host"] = source.host;
    if (source.origin != glm::dvec4(0))
        made["origin"] = {source.origin.x, source.origin.y, source.origin.z, source.origin.w};
    if (source.heights != HeightReading::Auto) made["osi_z"] = kHeightReadings[size_t(source.heights)];
    return made;
}

std::string heading(const DriveStart& start, const std::filesystem::path& folder) {
    json head{{"vesper_drive", 1},
              {"scene", seen_from(folder, start.scene)},
              {"seed", start.seed},
              {"time_step_s", start.time_step},
              {"settings", start.settings}};
    if (start.messages.any()) head["messages"] = messages_json(start.messages, folder);
    if (start.size) head["size_px"] = {start.size->x, start.size->y};
    std::string text = head.dump();
    text.pop_back();
    return text + ",\"events\":[\n";
}

// The file that a path of a drive means, empty if it names none.
std::filesystem::path seen_path(const scene::JsonValue& root, const char* key, const std::filesystem::path& folder) {
    const std::string named = root.text_or(key, "");
    try {
        if (const auto own = apps::own_data_file(named)) return *own;
    } catch (const Error& error) {
        root.at(key).fail(error.what());
    }
    return named.empty() ? "" : folder / named;  // which an absolute one replaces
}

// A trace that was written beside a drive that broke off has not got its name yet; what has it is older.
std::filesystem::path trace_of(const std::filesystem::path& file, const std::filesystem::path& drive) {
    std::error_code failed;
    const std::filesystem::path part = io::GrowingFile::part_of(file.string());
    return drive.extension() == ".part" && std::filesystem::exists(part, failed) ? part : file;
}

MessageSource read_source(const scene::JsonValue& value, const std::filesystem::path& drive) {
    const std::filesystem::path folder = drive.parent_path();
    value.allow_only({"file", "live", "models", "host", "origin", "osi_z"});
    MessageSource source{.file = seen_path(value, "file", folder),
                         .live = value.boolean_or("live", false),
                         .models = seen_path(value, "models", folder),
                         .host = value.text_or("host", "")};
    value.at("file");
    if (source.live) source.file = trace_of(source.file, drive);
    try {
        source.host = host_of(source.host);
    } catch (const Error& error) {
        value.at("host").fail(error.what());
    }
    try {
        source.heights = height_reading_of(value.text_or("osi_z", kHeightReadings[0]));
    } catch (const Error& error) {
        value.at("osi_z").fail(error.what());
    }
    if (const auto origin = value.find("origin")) {
        constexpr double kFar = 1e9;
        const auto numbers = origin->elements(4);
        for (int i = 0; i < 4; ++i) source.origin[i] = numbers[size_t(i)].number(-kFar, kFar);
    }
    return source;
}

DriveSettings::Values read_values(const scene::JsonValue& object) {
    if (!object.json().is_object()) object.fail("must be an object");
    DriveSettings::Values values;
    for (const auto& [name, value] : object.json().items()) values[name] = object.at(name.c_str()).text();
    return values;
}

// What an event of a file says, added to a drive. `input`: of the step before.
void read_event(const scene::JsonValue& event, uint64_t place, traffic::DriverInput& input, DriveEvents& events) {
    event.allow_only({"step", "pose", "messages_s", "frame", "set", "restart"});
    size_t of_steps = 0;
    for (const auto& [part, named] : {std::pair("pose", "a pose"), std::pair("messages_s", "messages_s")}) {
        if (!event.find(part)) continue;
        if (!event.find("step")) event.fail(std::string("has ") + named + " without a step");
        ++of_steps;
    }
    if (event.json().size() != 1 + of_steps) event.fail("is more than one step, frame, set or restart");
    const auto happens = [&](const char* name) {
        const auto found_event = event.find(name);
        if (found_event && !(found_event->json().is_boolean() && found_event->json().get<bool>()))
            found_event->fail("must be true");
        return found_event.has_value();
    };
    if (const auto step = event.find("step")) {
        input = read_input(*step, input);
        DriveEvent driven{
            .kind = DriveEvent::Kind::Step, .input = input, .pose = {}, .shown = {}, .name = {}, .value = {}};
        if (const auto stated = event.find("pose")) {
            const auto pose = stated->elements(4);
            driven.pose = glm::dvec4(pose[0].number(), pose[1].number(), pose[2].number(), pose[3].number());
        }
        if (const auto shown = event.find("messages_s")) driven.shown = shown->number(-1e9, 1e9);
        events.push_back(driven);
    } else if (const auto set = event.find("set")) {
        for (const auto& [name, value] : read_values(*set))
            events.push_back({.kind = DriveEvent::Kind::Set,
                              .input = {},
                              .pose = {},
                              .shown = {},
                              .name = name,
                              .value = value,
                              .place = place});
    } else if (happens("frame")) {
        events.push_back({.kind = DriveEvent::Kind::Frame, .name = {}, .value = {}});
    } else if (happens("restart")) {
        events.push_back({.kind = DriveEvent::Kind::Restart, .name = {}, .value = {}});
    } else {
        event.fail("is no step, frame, set or restart");
    }
}

std::string place_of(const DriveEvent& event) { return "/events/" + std::to_string(event.place) + "/set"; }

// Takes events as they are parsed, so that a long drive is never in memory as JSON, and gives back the rest of the
// file.
class DriveParser {
public:
    DriveParser(std::string name, Drive& drive) : name_(std::move(name)), drive_(drive) {}

    scene::JsonFile parse(std::span<const uint8_t> text) {
        scene::check_json_text(text, name_, UINT64_MAX);  // take() has bounds of its own
        try {
            std::ignore = json::parse(text.begin(), text.end(), [this](int depth, json::parse_event_t at, json& value) {
                return take(depth, at, value);
            });
        } catch (const json::parse_error& error) {
            // A file whose program ended early is whole as far as it goes; a machine that lost its power may have put
            // zeros behind that. What is wrong lies beyond that end, then.
            size_t end = text.size();
            while (end > 0 && (text[end - 1] == 0 || text[end - 1] == '\n')) --end;
            drive_.complete = false;
            if (key_ != "events" || error.byte <= end)
                throw Error(name_ + ": byte " + std::to_string(error.byte) + ": not valid JSON");
            rest_[key_] = json::array();
        } catch (const json::exception& error) {  // a number beyond double
            throw Error(name_ + ": not valid JSON: " + one_line(error.what()));
        }
        return {name_, std::move(rest_)};
    }

private:
    static constexpr int kMostDepth = 8, kMostValues = 10'000;  // of JSON; of an event, or beside them

    bool take(int depth, json::parse_event_t at, json& value) {
        using Event = json::parse_event_t;
        if (depth > kMostDepth || ++values_ > kMostValues)
            throw Error(name_ + ": /" + one_line(key_) + ": has more in it than a drive has");
        if (depth == 1 && at == Event::key) key_ = value.get<std::string>();
        const bool ends = at == Event::value || at == Event::object_end || at == Event::array_end;
        if (depth == 1 && ends) {
            rest_[key_] = std::move(value);
            return true;
        }
        if (depth != 2 || !ends || key_ != "events") return true;
        const scene::JsonFile event(name_, std::move(value), "/events/" + std::to_string(place_));
        read_event(scene::JsonValue(event), place_++, input_, drive_.events);
        values_ = 0;
        return false;
    }

    std::string name_;
    Drive& drive_;
    json rest_;
    std::string key_;  // of the root, where the parser is
    int values_ = 0;
    uint64_t place_ = 0;
    traffic::DriverInput input_;
};

}  // namespace

Drive read_drive(const std::filesystem::path& file) {
    Drive drive{.file = file, .start = {}, .events = {}};
    const scene::JsonFile text = DriveParser(one_line(file.string()), drive).parse(io::read_file(file, kMaxDriveBytes));
    const scene::JsonValue root(text);
    root.allow_only({"vesper_drive", "scene", "run", "scenario", "messages", "seed", "time_step_s", "size_px",
                     "settings", "events"});
    if (root.at("vesper_drive").integer() != 1)
        root.at("vesper_drive").fail("this version of Vesper reads drives of version 1");
    root.at("events").elements(), root.at("scene").text();
    DriveStart& start = drive.start;
    start.scene = seen_path(root, "scene", file.parent_path());
    if (const auto scenario = root.find("scenario"))
        scenario->fail("storyboards are not played any more: take the lamps from an OSI trace (docs/osi.md)");
    if (const auto messages = root.find("messages"))
        start.messages = read_source(*messages, file);
    else
        start.messages.file = seen_path(root, "run", file.parent_path());  // as older versions wrote it
    drive.start.seed = root.integer_or("seed", 1);
    drive.start.time_step = root.number_or("time_step_s", 1.0 / 60, 1e-4, 0.1);
    if (const auto size = root.find("size_px")) {
        const auto sides = size->elements(2);
        drive.start.size = glm::uvec2(sides[0].integer(kLargestSide), sides[1].integer(kLargestSide));
        if (drive.start.size->x == 0 || drive.start.size->y == 0) size->fail("pictures have pixels");
    }
    if (const auto object = root.find("settings")) {
        drive.start.settings = read_values(*object);
        try {
            DriveSettings(drive.start.settings);
        } catch (const Error& error) {
            object->fail(error.what());
        }
    }
    check_settings(
        drive, {}, [](const DriveSettings&) {}, [](const DriveSettings&) {});
    return drive;
}

void check_settings(const Drive& drive, const DriveSettings::Values& kept, const SettingsCheck& possible,
                    const SettingsCheck& shown) {
    constexpr const char* kStart = "/settings";
    const auto check = [&](const std::string& place, const SettingsCheck& wanted, const DriveSettings& settings) {
        try {
            wanted(settings);
        } catch (const Error& error) {
            if (place == kStart) wanted(DriveSettings(kept));  // not of the drive, then
            throw Error(one_line(drive.file.string()) + ": " + place + ": " + one_line(error.what(), 1000));
        }
    };
    const auto passes = [&](const DriveSettings& settings) {
        try {
            shown(settings);
        } catch (const Error&) {
            return false;
        }
        return true;
    };
    DriveSettings::Values start = drive.start.settings;
    for (const auto& [name, value] : kept) start[name] = value;
    DriveSettings settings(start), before = settings;
    check(kStart, possible, settings);
    std::vector<DriveEvent> set;  // since the frame before
    // The place that a frame's settings are wrong from, and do not become right again until they are shown.
    const auto place_of_wrong = [&]() -> std::string {
        std::string place = kStart;
        for (const DriveEvent& event : set) {
            const bool well = passes(before);
            before.set(event.name, event.value);
            if (well && !passes(before)) place = place_of(event);
        }
        return place;
    };
    const auto frame = drive.events.frames() > 0 ? DriveEvent::Kind::Frame : DriveEvent::Kind::Step;
    bool first = true;
    for (const DriveEvent& event : drive.events) {
        if (event.kind == frame && (std::exchange(first, false) || !set.empty())) {
            if (!passes(settings)) check(place_of_wrong(), shown, settings);
            before = settings, set.clear();
        }
        if (event.kind != DriveEvent::Kind::Set || kept.contains(event.name)) continue;
        try {
            settings.set(event.name, event.value);
        } catch (const Error& error) {
            throw Error(one_line(drive.file.string()) + ": " + place_of(event) + ": " + one_line(error.what(), 1000));
        }
        check(place_of(event), possible, settings);
        set.push_back(event);
    }
}

std::filesystem::path messages_of(const std::filesystem::path& recording) {
    return std::filesystem::path(recording).replace_extension(".osi");
}

DriveRecorder::DriveRecorder(DriveStart start) : start_(std::move(start)) {}

void DriveRecorder::add(const DriveEvent& event) {
    events_.push_back(event);
    if (file_) write(line(event));
}

std::string DriveRecorder::line(const DriveEvent& event) {
    std::string line = std::exchange(first_, false) ? "" : ",";
    switch (event.kind) {
        case DriveEvent::Kind::Step:
            line += step_text(event, std::exchange(last_, event.input));
            break;
        case DriveEvent::Kind::Frame:
            line += "{\"frame\":true}";
            break;
        case DriveEvent::Kind::Set:
            line += json{{"set", {{event.name, event.value}}}}.dump();
            break;
        case DriveEvent::Kind::Restart:
            line += "{\"restart\":true}";
            break;
    }
    return line + "\n";
}

void DriveRecorder::open(const std::filesystem::path& file, std::optional<glm::uvec2> size) {
    constexpr size_t kAtOnce = 1 << 20;  // bytes
    close();
    file_ = std::make_unique<io::GrowingFile>(file);
    first_ = true, last_ = {}, start_.size = size;
    if (start_.messages.live) start_.messages.file = messages_of(file);
    std::error_code failed;
    std::string text = heading(start_, std::filesystem::absolute(file, failed).parent_path());
    for (const DriveEvent& event : events_) {
        text += line(event);
        if (text.size() > kAtOnce) write(std::exchange(text, {}));
    }
    write(text);
}

void DriveRecorder::write(const std::string& text) {
    try {
        file_->append(text);
    } catch (const Error& error) {
        file_.reset();
        throw Error("the recording ends: " + std::string(error.what()));
    }
}

void DriveRecorder::close() {
    if (!file_) return;
    write("]}\n");
    const auto file = std::move(file_);
    file->complete();
}

}  // namespace vesper::drive
