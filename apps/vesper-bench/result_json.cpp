// Results of benchmarks as files. SPDX-License-Identifier: MIT
#include <algorithm>

#include <nlohmann/json.hpp>

#include "arguments/arguments.h"
#include "base/one_line.h"
#include "io/read_file.h"
#include "result.h"
#include "scene/json_value.h"

namespace vesper::bench {
namespace {

using scene::JsonValue;

constexpr const char* kSchema = "vesper-bench 1";
constexpr uint64_t kMaxFile = 64ull << 20;
constexpr double kMost = 1e18;  // of anything

using Json = nlohmann::ordered_json;

Json of(const Spread& s) { return {{"median", s.median}, {"low", s.low}, {"high", s.high}}; }

Json of(const Counted& c) { return {{"in_view", c.in_view}, {"seen", c.seen}}; }

Json of(const RunSettings& s) {
    return {{"scene", s.scene},
            {"width", s.width},
            {"height", s.height},
            {"channels", s.channels},
            {"operator", s.tone_operator},
            {"glare", s.glare},
            {"lamps", s.lamps},
            {"triangles", s.triangles},
            {"light", Json::parse("{" + apps::settings_json(s.light) + "}")},
            {"frames", s.frames},
            {"laps", s.laps},
            {"warm_up", s.warm_up}};
}

Json of(const BenchResult& result, const RunResult& run) {
    Json host = Json::object(), passes = Json::array(), starts = Json::array();
    for (size_t i = 0; i < kHostParts.size(); ++i) host[kHostParts[i]] = of(run.host[i]);
    for (const PassResult& pass : run.passes)
        passes.push_back({{"name", pass.name},
                          {"ms", of(pass.ms)},
                          {"bytes_read", pass.bytes_read},
                          {"bytes_written", pass.bytes_written},
                          {"copy_fraction", result.copy_fraction(pass)}});
    for (const Start& start : run.starts) starts.push_back({{"cache", start.cache}, {"seconds", start.seconds}});
    return {{"settings", of(run.settings)},
            {"fps", run.fps},
            {"frame_ms", of(run.frame)},
            {"frame_ms_percentiles", {{"p5", run.p5}, {"p95", run.p95}, {"p99", run.p99}}},
            {"one_percent_low_fps", run.low_fps},
            {"processor_ms", of(run.processor)},
            {"in_flight_fps", run.in_flight_fps},
            {"arithmetic_ms", of(run.arithmetic)},
            {"lamps_of_a_block", {{"listed", run.listed}, {"kept", run.kept}}},
            {"parts", of(run.parts)},
            {"triangles", of(run.triangles)},
            {"host_ms", host},
            {"passes", passes},
            {"memory_bytes", {{"host_peak", run.host_bytes}, {"device_peak", run.device_bytes}}},
            {"pipelines", {{"count", run.pipelines}, {"ms", run.pipelines_ms}, {"first_frame_ms", run.first_frame_ms}}},
            {"starts", starts}};
}

double amount(const JsonValue& value) { return value.number(0, kMost); }
uint32_t count(const JsonValue& value) { return uint32_t(value.integer(UINT32_MAX)); }
std::string words(const JsonValue& value) { return one_line(value.text()); }

Spread read_spread(const JsonValue& value) {
    const Spread s{amount(value.at("median")), amount(value.at("low")), amount(value.at("high"))};
    if (s.low > s.median || s.median > s.high) value.fail("\"low\", \"median\" and \"high\" do not ascend");
    return s;
}

// A setting that the file lacks has the value of its set.
apps::RecordedSettings read_light(const JsonValue& value) {
    const JsonValue quality = value.at("quality");
    if (std::ranges::find(render::kQualityNames, quality.text()) == render::kQualityNames.end())
        quality.fail("\"" + words(quality) + "\" is no quality");
    apps::RecordedSettings light{quality.text(), {}};
    for (const render::LightSetting& row : render::light_rows()) {
        double number = row.value(render::quality_named(light.quality));
        if (const std::optional<JsonValue> given = value.find(std::string(row.name).c_str())) {
            number =
                row.kind == render::SettingKind::Switch ? double(given->boolean()) : given->number(row.low, row.high);
        }
        light.values.push_back(row.rounded(number));
    }
    return light;
}

RunSettings read_settings(const JsonValue& value) {
    return {.scene = words(value.at("scene")),
            .tone_operator = words(value.at("operator")),
            .glare = words(value.at("glare")),
            .width = count(value.at("width")),
            .height = count(value.at("height")),
            .channels = count(value.at("channels")),
            .lamps = count(value.at("lamps")),
            .triangles = value.at("triangles").integer(),
            .light = read_light(value.at("light")),
            .frames = count(value.at("frames")),
            .laps = count(value.at("laps")),
            .warm_up = count(value.at("warm_up"))};
}

RunResult read_run(const JsonValue& value) {
    RunResult run;
    run.settings = read_settings(value.at("settings"));
    run.fps = amount(value.at("fps"));
    run.frame = read_spread(value.at("frame_ms"));
    const JsonValue percentiles = value.at("frame_ms_percentiles"), memory = value.at("memory_bytes"),
                    pipelines = value.at("pipelines");
    run.p5 = amount(percentiles.at("p5")), run.p95 = amount(percentiles.at("p95")),
    run.p99 = amount(percentiles.at("p99"));
    run.low_fps = amount(value.at("one_percent_low_fps"));
    if (value.find("processor_ms")) run.processor = read_spread(value.at("processor_ms"));
    if (value.find("in_flight_fps")) run.in_flight_fps = amount(value.at("in_flight_fps"));
    if (value.find("arithmetic_ms")) run.arithmetic = read_spread(value.at("arithmetic_ms"));
    if (const std::optional<JsonValue> lamps = value.find("lamps_of_a_block"))
        run.listed = amount(lamps->at("listed")), run.kept = amount(lamps->at("kept"));
    for (const auto& [name, counted] : {std::pair("parts", &run.parts), {"triangles", &run.triangles}})
        if (const std::optional<JsonValue> counts = value.find(name))
            *counted = {amount(counts->at("in_view")), amount(counts->at("seen"))};
    for (size_t i = 0; i < kHostParts.size(); ++i) run.host[i] = read_spread(value.at("host_ms").at(kHostParts[i]));
    for (const JsonValue& pass : value.at("passes").elements())
        run.passes.push_back({words(pass.at("name")), read_spread(pass.at("ms")), amount(pass.at("bytes_read")),
                              amount(pass.at("bytes_written"))});
    run.host_bytes = amount(memory.at("host_peak")), run.device_bytes = amount(memory.at("device_peak"));
    run.pipelines = count(pipelines.at("count"));
    run.pipelines_ms = amount(pipelines.at("ms")), run.first_frame_ms = amount(pipelines.at("first_frame_ms"));
    for (const JsonValue& start : value.at("starts").elements())
        run.starts.push_back({words(start.at("cache")), amount(start.at("seconds"))});
    return run;
}

}  // namespace

std::string json_of(const BenchResult& result) {
    Json runs = Json::array();
    for (const RunResult& run : result.runs) runs.push_back(of(result, run));
    const Json root{{"schema", kSchema},
                    {"version", result.version},
                    {"command", result.command},
                    {"device",
                     {{"name", result.device},
                      {"driver", result.driver},
                      {"cpu", result.cpu},
                      {"copy_bytes_per_second", result.copy_bandwidth}}},
                    {"host", {{"processor", result.host}, {"threads", result.threads}}},
                    {"runs", runs}};
    return root.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

BenchResult read_result(const std::string& file) {
    const scene::JsonFile json = scene::parse_json(io::read_file(file, kMaxFile), file);
    const JsonValue root(json);
    const JsonValue schema = root.at("schema");
    if (schema.text() != kSchema) schema.fail("is \"" + words(schema) + "\"; this program reads \"" + kSchema + "\"");
    BenchResult result;
    result.version = words(root.at("version")), result.command = words(root.at("command"));
    const JsonValue device = root.at("device"), host = root.at("host");
    result.device = words(device.at("name")), result.driver = words(device.at("driver")),
    result.cpu = device.at("cpu").boolean();
    result.copy_bandwidth = amount(device.at("copy_bytes_per_second"));
    result.host = words(host.at("processor")), result.threads = count(host.at("threads"));
    for (const JsonValue& run : root.at("runs").elements()) result.runs.push_back(read_run(run));
    return result;
}

}  // namespace vesper::bench
