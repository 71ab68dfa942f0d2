// `vesper-bench` as people run it, and its files. SPDX-License-Identifier: MIT
#include <fstream>

#include <nlohmann/json.hpp>

#include "io/image_file.h"
#include "io/read_file.h"
#include "places.h"
#include "result.h"
#include "support/program.h"

namespace vesper::test {
namespace {

using bench::BenchResult;

class BenchProgram : public ProgramTest {
protected:
    BenchProgram() : ProgramTest(VESPER_BENCH) {}

    std::string put(const std::string& name, const std::string& text) {
        std::ofstream(folder / name) << text;
        return (folder / name).string();
    }
    std::string put(const std::string& name, const BenchResult& result) { return put(name, bench::json_of(result)); }
};

bench::RunResult made_up_run(uint32_t lamps, double scale) {
    bench::RunResult run;
    run.settings = {.scene = "street",
                    .tone_operator = "ward",
                    .glare = "none",
                    .width = 64,
                    .height = 36,
                    .channels = 2,
                    .lamps = lamps,
                    .triangles = 1ull << 40,
                    .frames = 3,
                    .laps = 2,
                    .warm_up = 1};
    run.fps = 100 / scale;
    run.frame = {10 * scale, 9 * scale, 12 * scale};
    run.p5 = 8 * scale, run.p95 = 13 * scale, run.p99 = 14 * scale, run.low_fps = 70 / scale;
    run.processor = {900, 800, 1000}, run.in_flight_fps = 2.5;
    run.arithmetic = {5, 4, 6}, run.listed = 20, run.kept = 10;
    run.parts = {30, 12}, run.triangles = {2000, 700};
    for (size_t i = 0; i < run.host.size(); ++i)
        run.host[i] = {double(i) * scale, double(i) * scale, double(i) * scale};
    run.passes = {{"shade", {4 * scale, 3 * scale, 5 * scale}, 3e6, 1e6}, {"composite", {1, 1, 1}, 2e6, 2e6}};
    run.host_bytes = 3 << 20, run.device_bytes = 5 << 20, run.pipelines = 7, run.pipelines_ms = 1.5,
    run.first_frame_ms = 2.25;
    run.starts = {{"cold", 4}, {"warm", 2 * scale}};
    return run;
}

BenchResult made_up(std::vector<uint32_t> lamps, double scale = 1) {
    BenchResult result{.version = "1.2.3",
                       .command = "--size=64x36",
                       .device = "a \"device\"",
                       .driver = "its driver",
                       .host = "a processor",
                       .threads = 2,
                       .cpu = true,
                       .copy_bandwidth = 8e9,
                       .runs = {}};
    for (const uint32_t count : lamps) result.runs.push_back(made_up_run(count, scale));
    return result;
}

TEST_F(BenchProgram, ReadsWhatItWrites) {
    const BenchResult result = made_up({64, 256});
    const std::string text = bench::json_of(result);
    EXPECT_EQ(bench::json_of(bench::read_result(put("a.json", text))), text);
    const auto json = nlohmann::json::parse(text);
    EXPECT_EQ(json["schema"], "vesper-bench 1");
    EXPECT_EQ(json["runs"][1]["settings"]["lamps"], 256);
    // 4 MB in 4 ms are an eighth of 8 GB/s.
    EXPECT_NEAR(json["runs"][0]["passes"][0]["copy_fraction"].get<double>(), 0.125, 1e-12);
    EXPECT_EQ(json["runs"][0]["host_ms"]["wait"]["median"], 5);
    EXPECT_EQ(json["runs"][0]["triangles"]["seen"], 700);
    EXPECT_EQ(json["runs"][0]["settings"]["light"]["quality"], "standard");
    // Older files have neither.
    nlohmann::json old = json;
    for (const char* member : {"parts", "triangles"}) old["runs"][0].erase(member);
    for (const char* member : {"merge_error", "shadow_error", "threshold"})
        old["runs"][0]["settings"]["light"].erase(member);
    old["runs"][0]["settings"]["light"]["threshold"] = double(0.001f);
    const bench::RunResult run = bench::read_result(put("old.json", old.dump())).runs[0];
    EXPECT_EQ(run.triangles.seen, 0);
    EXPECT_EQ(run.settings.light.quality, "standard");
    EXPECT_TRUE(run.settings.light.same_values(result.runs[0].settings.light)) << "it is compared with new ones";
}

TEST_F(BenchProgram, ComparesTwoFiles) {
    put("a.json", made_up({64})), put("b.json", made_up({64}, 0.5));
    ASSERT_EQ(run("--compare a.json b.json"), 0) << said;
    const auto line = [&](const std::string& begin) {
        const size_t at = printed.find("  " + begin);
        return at == printed.npos ? "no line " + begin : printed.substr(at, printed.find('\n', at) - at);
    };
    EXPECT_NE(line("frame, ms").find(" 10.00      5.00   0.500  (0.375 to 0.667)"), std::string::npos) << printed;
    EXPECT_NE(line("pass: shade, ms").find(" 0.500  (0.300 to 0.833)"), std::string::npos) << printed;
    EXPECT_NE(line("pass: composite, ms").find(" 1.000  (1.000 to 1.000)"), std::string::npos) << printed;
    EXPECT_NE(line("frame over that").find(" 2.00      1.00   0.500"), std::string::npos) << printed;
    EXPECT_NE(line("host: update, ms").find(" -"), std::string::npos) << "nothing to relate to";
    EXPECT_NE(line("start, warm, s").find(" 2.00      1.00   0.500"), std::string::npos) << printed;
}

// One lap says nothing of the next, so no bracket says that it did; and what else was asked for is shown.
TEST_F(BenchProgram, SingleLapsHaveNoSpread) {
    BenchResult a = made_up({64}), b = made_up({64}, 0.5);
    for (BenchResult* result : {&a, &b}) result->runs[0].settings.laps = 1;
    b.command = "--size=64x36 --age=70";
    put("a.json", a), put("b.json", b);
    ASSERT_EQ(run("--compare a.json b.json"), 0) << said;
    EXPECT_NE(printed.find(" 10.00      5.00   0.500\n"), std::string::npos) << printed;
    EXPECT_NE(printed.find("A with: --size=64x36\nB with: --size=64x36 --age=70\n"), std::string::npos) << printed;
}

TEST_F(BenchProgram, ComparesRunsThatAreAlike) {
    put("a.json", made_up({64, 256})), put("b.json", made_up({256, 1024}, 2)), put("c.json", made_up({1, 2}));
    ASSERT_EQ(run("--compare a.json b.json"), 0) << said;
    EXPECT_NE(printed.find("256 lamps"), std::string::npos) << printed;
    EXPECT_EQ(printed.find("64 lamps"), std::string::npos) << printed;
    EXPECT_EQ(printed.find("1024 lamps"), std::string::npos) << printed;
    EXPECT_NE(printed.find(" 2.000  (1.500 to 2.667)"), std::string::npos) << printed;
    expect_refused("--compare a.json c.json", {"no run"});
}

TEST_F(BenchProgram, RunsWithOtherBoundsAreNotAlike) {
    BenchResult b = made_up({64, 256});
    for (bench::RunResult& run : b.runs) run.settings.light.value("merge_error") = 1;
    put("a.json", made_up({64, 256})), put("b.json", b);
    expect_refused("--compare a.json b.json", {"no run"});
    b.runs[0].settings.light.value("merge_error") = double(0.001f);
    put("b.json", b);
    ASSERT_EQ(run("--compare a.json b.json"), 0) << said;
    EXPECT_EQ(printed.find("256 lamps"), std::string::npos) << printed;
}

TEST_F(BenchProgram, PassesThatOneAloneHasAreNamed) {
    BenchResult b = made_up({64});
    b.runs[0].passes[1].name = "another";
    put("a.json", made_up({64})), put("b.json", b);
    ASSERT_EQ(run("--compare a.json b.json"), 0) << said;
    EXPECT_NE(printed.find("composite, 1.00 ms, is in A alone"), std::string::npos) << printed;
    EXPECT_NE(printed.find("another, 1.00 ms, is in B alone"), std::string::npos) << printed;
}

TEST_F(BenchProgram, RefusesFilesThatAreNone) {
    const std::string good = bench::json_of(made_up({64}));
    put("good.json", good);
    const auto with = [&](const char* pointer, const nlohmann::json& value) {
        nlohmann::json json = nlohmann::json::parse(good);
        json[nlohmann::json::json_pointer(pointer)] = value;
        return json.dump();
    };
    const auto without = [&](const std::string& parent, const char* key) {
        nlohmann::json json = nlohmann::json::parse(good);
        json[nlohmann::json::json_pointer(parent)].erase(key);
        return json.dump();
    };
    const struct {
        std::string text;
        std::vector<std::string> words;
    } bad[]{{"", {"bad.json"}},
            {"{", {"bad.json", "not valid JSON"}},
            {"[]", {"bad.json", "object"}},
            {good.substr(0, good.size() / 2), {"bad.json", "not valid JSON"}},
            {std::string(100000, '['), {"bad.json", "deeper"}},
            {without("", "schema"), {"schema"}},
            {with("/schema", "vesper-bench 2"), {"/schema", "vesper-bench 2", "vesper-bench 1"}},
            {with("/schema", std::string(100000, 'x')), {"/schema"}},
            {with("/schema", "a\nb"), {"/schema"}},
            {with("/schema", 1), {"/schema"}},
            {without("", "runs"), {"runs"}},
            {with("/runs", 3), {"/runs"}},
            {without("/runs/0", "frame_ms"), {"/runs/0", "frame_ms"}},
            {without("/runs/0/frame_ms", "high"), {"/runs/0/frame_ms", "high"}},
            {without("/runs/0/host_ms", "submit"), {"submit"}},
            {without("/runs/0/passes/1", "bytes_read"), {"/runs/0/passes/1", "bytes_read"}},
            {with("/runs/0/frame_ms/median", -1), {"/runs/0/frame_ms/median"}},
            {with("/runs/0/frame_ms/median", "fast"), {"/runs/0/frame_ms/median"}},
            {with("/runs/0/frame_ms/low", 1e6), {"/runs/0/frame_ms", "low"}},
            {with("/runs/0/settings/width", 1e300), {"/runs/0/settings/width"}},
            {with("/runs/0/settings/scene", nlohmann::json::array()), {"/runs/0/settings/scene"}}};
    for (const auto& [text, words] : bad) {
        put("bad.json", text);
        expect_refused("--compare good.json bad.json", words);
        expect_refused("--tables bad.json", words);
    }
    expect_refused("--compare good.json nowhere.json", {"nowhere.json"});
    expect_refused("--compare good.json", {"--compare"});
}

TEST_F(BenchProgram, RefusesWhatCannotBeRun) {
    expect_refused("--scene nowhere", {"nowhere"});
    expect_refused("--scene nowhere.gltf --no-start", {"nowhere.gltf"});
    expect_refused("--scene nowhere.gltf", {"nowhere.gltf", "start"});
    expect_refused("--luminaire point", {"--luminaire", "street"});
    expect_refused("--scene street --luminaire nowhere.ies --no-start", {"nowhere.ies"});
    expect_refused("--size 12", {"--size"});
    expect_refused("--operator ward,nothing", {"nothing"});
    expect_refused("--glare none,nothing", {"nothing"});
    expect_refused("--lamps -1", {"--lamps"});
    expect_refused("--frames 0", {"--frames"});
    expect_refused("--scene street --json nowhere/a.json", {"nowhere"});
    expect_refused("--scene street --matrix nowhere/growth", {"nowhere"});
    put("file", "");
    expect_refused("--scene street --matrix file", {"file"});
    expect_refused("--scene street --device none --size 8x8", {"none"});
    expect_refused("--compare a b --tables c", {"--"});
    expect_refused("--compare a b --json c", {"--json"});
    expect_refused("--tables a --picture c.png", {"--picture"});
}

// No lamps are none, and what was measured before a run failed is kept.
TEST_F(BenchProgram, KeepsWhatItMeasuredBeforeAFailure) {
    put("a.csv", "");
    EXPECT_NE(run("--scene street --lamps 0,8 --luminaire point,a.csv --triangles 0 --size 8x8 --frames 1 --laps 1 "
                  "--warm-up 0 --no-start --json a.json"),
              0);
    const BenchResult result = bench::read_result((folder / "a.json").string());
    ASSERT_EQ(result.runs.size(), 2u) << said;
    EXPECT_EQ(result.runs[0].settings.lamps, 0u);
    EXPECT_EQ(result.runs[1].settings.lamps, 8u);
}

TEST_F(BenchProgram, PrintsTables) {
    BenchResult named = made_up({64, 256});
    named.runs[1].settings.scene = "a|b.glb";
    put("a.json", named);
    ASSERT_EQ(run("--tables a.json"), 0) << said;
    EXPECT_NE(printed.find(" a\\|b.glb "), std::string::npos) << printed;
    EXPECT_NE(printed.find("\n| shade | 4.00 | 3.8 | 12 % |\n"), std::string::npos) << printed;
    EXPECT_NE(printed.find("| whole frame, median (medians of the laps) | 10.0 ms (9.0 to 12.0) |"), std::string::npos)
        << printed;
    EXPECT_NE(printed.find("## Growth"), std::string::npos) << printed;
}

// What was measured has to hang together; how fast it was is nobody's business here.
TEST_F(BenchProgram, DrivesASmallStreet) {
    ASSERT_EQ(run("--scene street --lamps 8 --triangles 500 --size 64x36 --channels 2 --frames 3 --laps 2 --warm-up 1 "
                  "--operator reinhard --glare ldr --json a.json --picture a.png"),
              0)
        << said;
    EXPECT_EQ(said, "");
    EXPECT_TRUE(printed.starts_with("64x36 street reinhard: ")) << printed;
    EXPECT_NE(printed.substr(0, printed.find('\n')).find(" fps ("), std::string::npos) << printed;
    const BenchResult result = bench::read_result((folder / "a.json").string());
    ASSERT_EQ(result.runs.size(), 1u);
    const bench::RunResult& r = result.runs[0];
    EXPECT_EQ(printed.find(bench::headline(result, r)), 0u) << "the file says what the terminal does";
    EXPECT_EQ(r.settings.lamps, 8u);
    EXPECT_GE(r.settings.triangles, 500u);
    EXPECT_EQ(r.settings.glare, "ldr");
    EXPECT_EQ(r.settings.channels, 2u);
    EXPECT_GT(result.copy_bandwidth, 0);
    EXPECT_GT(r.arithmetic.low, 0);
    EXPECT_GT(r.processor.low, 0);
    EXPECT_GT(r.in_flight_fps, 0);
    EXPECT_GT(r.listed, 0);
    EXPECT_LE(r.kept, r.listed);
    EXPECT_GT(r.triangles.seen, 0);
    EXPECT_LE(r.triangles.seen, r.triangles.in_view);
    EXPECT_LE(r.triangles.in_view, 2 * double(r.settings.triangles)) << "of two channels";
    EXPECT_LE(r.parts.seen, r.parts.in_view);
    EXPECT_NE(printed.find(" of them seen"), std::string::npos) << printed;
    EXPECT_FALSE(result.device.empty() || result.driver.empty() || result.host.empty() || result.version.empty());
    EXPECT_LE(r.p5, r.frame.median);
    EXPECT_LE(r.frame.median, r.p95);
    EXPECT_LE(r.p95, r.p99);
    EXPECT_LE(1000 / r.low_fps, r.p99 * 1.5);
    EXPECT_LE(r.low_fps, r.fps);
    EXPECT_LE(r.frame.low, r.frame.high);
    for (const bench::Spread& part : r.host)
        EXPECT_LE(part.high, 1000 / r.low_fps) << "no part is longer than the longest frame";
    ASSERT_FALSE(r.passes.empty());
    for (const bench::PassResult& pass : r.passes) EXPECT_GT(pass.bytes(), 0) << pass.name;
    // The composite reads the scene, 16 bytes a pixel, and writes codes of 4, for both channels.
    const auto composite = std::find_if(r.passes.begin(), r.passes.end(),
                                        [](const bench::PassResult& pass) { return pass.name == "composite"; });
    ASSERT_NE(composite, r.passes.end());
    EXPECT_EQ(composite->bytes_written, 2 * 64 * 36 * 4);
    EXPECT_GE(composite->bytes_read, 2 * 64 * 36 * 16);
    EXPECT_GT(r.host_bytes, 1 << 20);
    EXPECT_GT(r.device_bytes, 64 * 36 * 16);
    EXPECT_GT(r.pipelines, 5u);
    ASSERT_EQ(r.starts.size(), 2u);
    EXPECT_EQ(r.starts[0].cache + r.starts[1].cache, "coldwarm");
    EXPECT_GT(r.starts[1].seconds, 0);
    EXPECT_EQ(io::decode_image(io::read_file(folder / "a.png", 1u << 20), 64).width, 64u);
}

TEST_F(BenchProgram, DrawsGrowth) {
    ASSERT_EQ(run("--matrix growth --lamps 2,4 --size 16x9,32x18 --operator linear --frames 2 --laps 1 --warm-up 0 "
                  "--json growth/all.json"),
              0)
        << said;
    const BenchResult result = bench::read_result((folder / "growth/all.json").string());
    ASSERT_EQ(result.runs.size(), 4u);
    EXPECT_TRUE(printed.starts_with("16x9 street linear: ")) << printed;
    EXPECT_EQ(result.runs[1].settings.width, 32u);
    EXPECT_EQ(result.runs[2].settings.lamps, 4u);
    EXPECT_TRUE(result.runs[0].starts.empty());
    for (const char* plot : {"lamps.png", "passes.png", "pixels.png"})
        EXPECT_EQ(io::decode_image(io::read_file(folder / "growth" / plot, 1u << 24), 2000).width, 1100u) << plot;
}

}  // namespace
}  // namespace vesper::test
