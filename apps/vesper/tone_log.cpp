#include "tone_log.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "arguments.h"
#include "base/error.h"
#include "glare_arguments.h"
#include "shown.h"

namespace vesper {
namespace {

// The floats of EyeState before the shares, in order.
constexpr const char* kStateNames[]{"adaptation", "eye_seconds", "cone_pigment", "cone_fast", "cone_slow", "rod_pigment",
                                    "rod_fast",   "rod_slow",    "ln_placed",    "bins",      "ln_low",    "bins_per_ln",
                                    "lagging_cones", "lagging_rods", "lagging_cone_pigment", "lagging_rod_pigment"};
constexpr size_t kNamed = std::size(kStateNames);
constexpr size_t kFloats = sizeof(shared::EyeState) / sizeof(float);
static_assert(kFloats == kNamed + shared::kMaxBins);

constexpr int kSamples = 101;
double sample_log10(int i) { return -4 + i / 10.0; }

std::vector<float> floats_of(const shared::EyeState& eye) {
    std::vector<float> values(kFloats);
    std::memcpy(values.data(), &eye, sizeof eye);
    return values;
}

}  // namespace

std::vector<double> curve_samples(const shared::ToneCurve& curve, uint32_t form, const Display& display) {
    std::vector<double> shown;
    for (int i = 0; i < kSamples; ++i) shown.push_back(shown_luminance(curve, form, std::pow(10.0, sample_log10(i)), display));
    return shown;
}

std::vector<std::pair<std::string, double>> named_state(const shared::EyeState& eye) {
    const std::vector<float> values = floats_of(eye);
    std::vector<std::pair<std::string, double>> named;
    for (size_t i = 0; i < kNamed; ++i) named.emplace_back(kStateNames[i], double(values[i]));
    return named;
}

std::string log_heading() {
    std::string line = "frame,seconds,step";
    for (const char* name : kStateNames) line += std::string(",") + name;
    for (uint32_t i = 0; i < shared::kMaxBins; ++i) line += format(",share%u", i);
    line += ",cone_sigma,rod_sigma,log_average,maximum,under_full,slack";
    for (int i = 0; i < kSamples; ++i) line += format(",Ld(1e%.1f)", sample_log10(i));
    return line + glare_columns() + "\n";
}

std::string log_line(unsigned index, const LoggedFrame& frame, const shared::ToneCurve& curve, uint32_t form, const Display& display, const GlareReport& glare) {
    std::string line = format("%u,%.17g,%.9g", index, frame.seconds, double(frame.step));
    for (float value : floats_of(frame.eye)) line += format(",%.9g", double(value));
    for (float value : {curve.cone_sigma, curve.rod_sigma, curve.log_average, curve.maximum, curve.under_full, curve.slack}) line += format(",%.9g", double(value));
    for (double shown : curve_samples(curve, form, display)) line += format(",%.6g", shown);
    return line + glare_values(glare) + "\n";
}

std::vector<LoggedFrame> read_log(const std::string& file) {
    std::ifstream in(file);
    if (!in) throw Error(file + ": cannot be read");
    std::vector<LoggedFrame> frames;
    std::string line;
    if (!std::getline(in, line) || line + "\n" != log_heading()) throw Error(file + ": line 1: these are not the columns of a log of this version");
    const size_t columns = size_t(std::count(line.begin(), line.end(), ',')) + 1;
    for (size_t number = 2; std::getline(in, line); ++number) {
        std::vector<double> values;
        const char* at = line.c_str();
        while (*at) {
            char* end = nullptr;
            values.push_back(std::strtod(at, &end));
            if (end == at || (*end != ',' && *end != 0) || !std::isfinite(values.back())) throw Error(file + ": line " + std::to_string(number) + ": a number is expected in column " + std::to_string(values.size()));
            at = *end ? end + 1 : end;
        }
        if (values.size() != columns) throw Error(file + ": line " + std::to_string(number) + ": has " + std::to_string(values.size()) + " of " + std::to_string(columns) + " values");
        LoggedFrame frame{values[1], float(values[2])};
        std::vector<float> state(values.begin() + 3, values.begin() + 3 + kFloats);
        std::memcpy(&frame.eye, state.data(), sizeof frame.eye);
        frames.push_back(frame);
    }
    if (frames.empty()) throw Error(file + ": no frames");
    return frames;
}

}  // namespace vesper
