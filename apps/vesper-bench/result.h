// What a benchmark found out. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "arguments/setting_arguments.h"
#include "samples.h"

namespace vesper::bench {

/// What was run. Numbers are counts unless stated.
struct RunSettings {
    std::string scene, tone_operator, glare;
    uint32_t width = 0, height = 0;  ///< of one channel, px
    uint32_t channels = 1;           ///< views in every frame, side by side
    uint32_t lamps = 0;              ///< that shine
    uint64_t triangles = 0;
    apps::RecordedSettings light = apps::recorded_standard();
    uint32_t frames = 0, laps = 0, warm_up = 0;

    /// "1680x1050 rivoli ward".
    std::string title() const;
    /// What else tells runs apart: ", 591 lamps, glare ldr, 2 channels".
    std::string details() const;
};

/// Parts of a frame on the host, in their order.
constexpr std::array kHostParts{"update", "declare", "plan", "record", "submit", "wait", "read"};

struct PassResult {
    std::string name;
    Spread ms;                                 ///< on the device's clock, of all channels
    double bytes_read = 0, bytes_written = 0;  ///< sizes of the resources it reads and writes (Plan::Step), median
    double bytes() const { return bytes_read + bytes_written; }
};

/// How many of something a frame draws and sees, averages along the path; 0: not counted.
struct Counted {
    double in_view = 0, seen = 0;
};

/// A fresh process: how long to the first frame on the host.
struct Start {
    std::string cache;  ///< "cold": the driver's cache of shaders was empty; "warm": it was as the cold start left it
    double seconds = 0;
};

struct RunResult {
    RunSettings settings;
    double fps = 0;                   ///< frames by the time they took together
    Spread frame;                     ///< on the host's clock, ms
    double p5 = 0, p95 = 0, p99 = 0;  ///< of frame times, ms
    double low_fps = 0;               ///< of the slowest hundredth
    Spread processor;          ///< time that all threads of the process computed for a frame, ms; 0: not measured
    double in_flight_fps = 0;  ///< of frames that are submitted before those ahead of them are done; 0: not measured
    Spread arithmetic;         ///< of arithmetic_ms() before each lap, ms: how fast the host was then; 0: not measured
    double listed = 0, kept = 0;  ///< lamps of a block of pixels, on average: looked at, and seen; 0 without shadows
    Counted parts, triangles;     ///< of placed meshes; of these parts
    std::array<Spread, kHostParts.size()> host;  ///< ms
    std::vector<PassResult> passes;              ///< in the order they run; empty where the device has no timestamps
    double host_bytes = 0, device_bytes = 0;     ///< peaks: resident memory of the process, allocations on the device
    uint32_t pipelines = 0;
    double pipelines_ms = 0, first_frame_ms = 0;
    std::vector<Start> starts;

    double passes_ms() const;  ///< sum of medians
};

struct BenchResult {
    std::string version, command;      ///< of vesper; the arguments
    std::string device, driver, host;  ///< host: its processor
    uint32_t threads = 0;              ///< of the host
    bool cpu = false;                  ///< the device is one
    double copy_bandwidth = 0;         ///< measured: bytes read and written per second
    std::vector<RunResult> runs;

    /// Which part of the copy bandwidth a pass reaches, as if it moved its bytes and nothing else; 0 if unknown.
    double copy_fraction(const PassResult&) const;
};

/// As JSON (docs/benchmark.md), and back. Throws Error naming file, place and reason.
std::string json_of(const BenchResult&);
BenchResult read_result(const std::string& file);

/// The first line of a run: "1680x1050 rivoli ward: 7.1 fps (140.2 ms) on llvmpipe".
std::string headline(const BenchResult&, const RunResult&);
/// The rest of it, as a table for a terminal.
std::string text_of(const BenchResult&, const RunResult&);
/// Every run as tables of Markdown.
std::string markdown_of(const BenchResult&);
/// What B takes relative to A, run by run. Throws Error if no run of one has its like in the other.
std::string comparison(const BenchResult& a, const BenchResult& b);
/// Draws how time grows with lamps and with pixels into a folder, as far as runs differ in them. Gives the files'
/// names.
std::vector<std::string> save_growth(const std::string& folder, const BenchResult&);

}  // namespace vesper::bench
