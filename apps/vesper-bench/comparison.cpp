// Two results side by side. SPDX-License-Identifier: MIT
#include <algorithm>

#include "arguments/arguments.h"
#include "base/error.h"
#include "base/one_line.h"
#include "print.h"
#include "result.h"

namespace vesper::bench {
namespace {

using apps::format;

bool alike(const RunSettings& a, const RunSettings& b) {
    return a.scene == b.scene && a.tone_operator == b.tone_operator && a.glare == b.glare && a.width == b.width &&
           a.height == b.height && a.channels == b.channels && a.lamps == b.lamps && a.triangles == b.triangles &&
           a.light.same_values(b.light);
}

// `laps`: whether there were several of either; one says nothing about the next.
std::string row(const std::string& name, const Spread& a, const Spread& b, bool laps) {
    const Ratio r = ratio(a, b);
    const std::string numbers = "  " + apps::column(name, 36) + format(" %9.2f %9.2f", a.median, b.median);
    if (!laps && r.median > 0) return numbers + format("  %6.3f\n", r.median);
    return numbers + (r.median > 0 ? format("  %6.3f  (%.3f to %.3f)\n", r.median, r.low, r.high) : "       -\n");
}

// Of what was measured once.
std::string row(const std::string& name, double a, double b) {
    return "  " + apps::column(name, 36) + format(" %9.2f %9.2f", a, b) +
           (a > 0 ? format("  %6.3f\n", b / a) : "       -\n");
}

std::string compare_runs(const RunResult& a, const RunResult& b) {
    constexpr double kMiB = 1 << 20;
    const bool laps = a.settings.laps > 1 || b.settings.laps > 1;
    std::string text = a.settings.title() + a.settings.details();
    if (!alike(a.settings, b.settings)) text += "\nwith " + b.settings.title() + b.settings.details();
    text += "\n  " + apps::column("", 36) + "         A         B   B / A  (as laps differ)\n" +
            row("frame, ms", a.frame, b.frame, laps) + row("frame, 99 %, ms", a.p99, b.p99);
    if (a.arithmetic.median > 0 && b.arithmetic.median > 0)
        text += row("arithmetic on all threads, ms", a.arithmetic, b.arithmetic, laps) +
                row("frame over that", a.frame.median / a.arithmetic.median, b.frame.median / b.arithmetic.median);
    if (a.listed > 0 && b.listed > 0)
        text += row("lamps on the list of a block", a.listed, b.listed) + row("lamps seen by it", a.kept, b.kept);
    for (size_t i = 0; i < kHostParts.size(); ++i)
        text += row(std::string("host: ") + kHostParts[i] + ", ms", a.host[i], b.host[i], laps);
    std::string only;
    for (const PassResult& pass : a.passes) {
        const auto other =
            std::find_if(b.passes.begin(), b.passes.end(), [&](const PassResult& p) { return p.name == pass.name; });
        if (other != b.passes.end())
            text += row("pass: " + pass.name + ", ms", pass.ms, other->ms, laps);
        else
            only += "  pass: " + pass.name + format(", %.2f ms, is in A alone\n", pass.ms.median);
    }
    for (const PassResult& pass : b.passes)
        if (std::none_of(a.passes.begin(), a.passes.end(), [&](const PassResult& p) { return p.name == pass.name; }))
            only += "  pass: " + pass.name + format(", %.2f ms, is in B alone\n", pass.ms.median);
    text += only + row("passes, sum, ms", a.passes_ms(), b.passes_ms());
    text += row("memory of the host, MiB", a.host_bytes / kMiB, b.host_bytes / kMiB) +
            row("memory of the device, MiB", a.device_bytes / kMiB, b.device_bytes / kMiB);
    for (const Start& start : a.starts)
        for (const Start& other : b.starts)
            if (start.cache == other.cache) text += row("start, " + start.cache + ", s", start.seconds, other.seconds);
    return text;
}

std::string who(const char* name, const BenchResult& r) {
    return std::string(name) + ": vesper " + r.version + " on " + r.device + " (" + r.driver + "), " + r.host + "\n";
}

}  // namespace

std::string comparison(const BenchResult& a, const BenchResult& b) {
    std::string text = who("A", a) + who("B", b);
    if (a.command != b.command)
        text += "A with: " + one_line(a.command, 1000) + "\nB with: " + one_line(b.command, 1000) + "\n";
    if (a.runs.size() == 1 && b.runs.size() == 1) return text + compare_runs(a.runs[0], b.runs[0]);
    bool any = false;
    for (const RunResult& run : a.runs)
        for (const RunResult& other : b.runs)
            if (alike(run.settings, other.settings)) {
                text += compare_runs(run, other);
                any = true;
                break;
            }
    if (!any) throw Error("--compare: no run of one file has its like in the other");
    return text;
}

}  // namespace vesper::bench
