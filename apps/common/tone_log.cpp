#include "tone_log.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>

#include "arguments/glare_arguments.h"
#include "arguments/obstacle_arguments.h"
#include "base/digest.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/read_file.h"
#include "photometry/table.h"
#include "print.h"
#include "render/eye_state.h"

namespace vesper::apps {
namespace {

// The floats of EyeState before the nodes of the curve, in order.
constexpr const char* kStateNames[]{"adaptation",
                                    "eye_seconds",
                                    "eye_seconds_lost",
                                    "pupil_at_rest",
                                    "cone_pigment",
                                    "cone_fast",
                                    "cone_slow",
                                    "rod_pigment",
                                    "rod_fast",
                                    "rod_slow",
                                    "steps",
                                    "ln_low",
                                    "steps_per_ln",
                                    "lagging_cones",
                                    "lagging_rods",
                                    "lagging_cone_pigment",
                                    "lagging_rod_pigment",
                                    "chroma_long",
                                    "chroma_middle",
                                    "chroma_short"};
constexpr size_t kNamed = std::size(kStateNames);
constexpr size_t kFloats = sizeof(shared::EyeState) / sizeof(float);
static_assert(kFloats == kNamed + shared::kMaxBins + 1);

constexpr uint64_t kMostLogBytes = 2ull << 30;
constexpr int kSamples = 101;
double sample_log10(int i) { return -4 + i / 10.0; }

std::vector<float> floats_of(const shared::EyeState& eye) {
    std::vector<float> values(kFloats);
    std::memcpy(values.data(), &eye, sizeof eye);
    return values;
}

std::string state_name(size_t i) { return i < kNamed ? kStateNames[i] : format("node%zu", i - kNamed); }
std::string column(size_t i, std::string_view name) {
    return "column " + std::to_string(i + 1) + " (" + one_line(std::string(name), 40) + ")";
}

constexpr std::string_view kSum = ",sum";
/// Of the values after the number of the frame, which is another where the same frame is rendered alone.
std::string sum_of(std::string_view row) {
    Digest digest;
    digest.add_list(row.substr(std::min(row.find(','), row.size())));
    return hexadecimal(digest.value());
}

}  // namespace

std::vector<double> curve_samples(const shared::ToneCurve& curve, render::Operator tone_operator,
                                  const vision::Display& display) {
    std::vector<double> shown;
    for (int i = 0; i < kSamples; ++i)
        shown.push_back(render::shown_luminance(tone_operator, curve, std::pow(10.0, sample_log10(i)), display));
    return shown;
}

std::vector<std::pair<std::string, double>> named_state(const shared::EyeState& eye) {
    const std::vector<float> values = floats_of(eye);
    std::vector<std::pair<std::string, double>> named;
    for (size_t i = 0; i < kNamed; ++i) named.emplace_back(kStateNames[i], double(values[i]));
    return named;
}

std::string log_heading() {
    std::string line = "frame,seconds,step,operator";
    for (const char* name : kStateNames) line += std::string(",") + name;
    for (uint32_t i = 0; i <= shared::kMaxBins; ++i) line += format(",node%u", i);
    line += ",cone_sigma,rod_sigma,log_average,maximum,under_full,slack";
    for (int i = 0; i < kSamples; ++i) line += format(",Ld(1e%.1f)", sample_log10(i));
    return line + glare_columns();
}

std::string log_line(unsigned index, const LoggedFrame& frame, const shared::ToneCurve& curve,
                     render::Operator tone_operator, const vision::Display& display, const vision::GlareReport& glare) {
    std::string line =
        format("%u,%.17g,%.9g,%s", index, frame.seconds, double(frame.step), frame.tone_operator.c_str());
    for (float value : floats_of(frame.eye)) line += format(",%.9g", double(value));
    for (float value :
         {curve.cone_sigma, curve.rod_sigma, curve.log_average, curve.maximum, curve.under_full, curve.slack})
        line += format(",%.9g", double(value));
    for (double shown : curve_samples(curve, tone_operator, display)) line += format(",%.6g", shown);
    return line + glare_values(glare);
}

std::string summed_heading(const std::string& heading) { return heading + std::string(kSum); }
std::string summed_line(const std::string& line) { return line + "," + sum_of(line); }

std::vector<LoggedFrame> read_log(const std::string& file) {
    constexpr size_t kName = 3;  // the column that is no number
    const std::vector<uint8_t> bytes = io::read_file(file, kMostLogBytes);
    photometry::LineReader lines(bytes, one_line(file));
    std::string_view heading = lines.next().value_or("");
    const bool summed = heading.ends_with(kSum);
    if (summed) heading.remove_suffix(kSum.size());
    const std::string known = log_heading();
    if (!heading.starts_with(known) || !are_obstacle_columns(std::string(heading.substr(known.size()))))
        lines.fail("these are not the columns of a log of this version");
    const std::vector<std::string_view> names = photometry::fields_of(heading, ',', heading.size());
    const size_t columns = names.size(), read = size_t(std::count(known.begin(), known.end(), ',')) + 1;
    std::vector<LoggedFrame> frames;
    while (auto line = lines.next()) {
        if (summed) {
            const size_t end = std::min(line->rfind(','), line->size());
            if (line->substr(std::min(end + 1, line->size())) != sum_of(line->substr(0, end)))
                lines.fail(column(columns, kSum.substr(1)) +
                           ": is not that of the values before it: they were changed");
            line = line->substr(0, end);
        }
        const auto fields = photometry::fields_of(*line, ',', columns);
        if (fields.size() != columns) lines.fail("has not " + std::to_string(columns) + " values");
        LoggedFrame frame;
        std::vector<double> values(read);
        for (size_t i = 0; i < read; ++i) {
            if (i == kName) continue;
            const auto value = fields[i] == "inf" && i > kName + kFloats
                                   ? std::optional(0.0)
                                   : photometry::number_of(fields[i], false);  // a threshold increment
            if (!value || std::abs(*value) > double(FLT_MAX))
                lines.fail(column(i, names[i]) + ": a number is expected");
            values[i] = *value;
        }
        frame.tone_operator = fields[kName];
        frame.seconds = values[1];
        frame.step = float(values[2]);
        std::vector<float> state(values.begin() + kName + 1, values.begin() + kName + 1 + kFloats);
        std::memcpy(&frame.eye, state.data(), sizeof frame.eye);
        if (!(frame.step >= 0 && frame.step <= shared::kLongestLife))
            lines.fail(column(2, "step") + ": " + std::string(fields[2]) + " is no time since the frame before");
        if (const auto fault = render::fault_of(frame.eye))
            lines.fail(column(kName + 1 + fault->index, state_name(fault->index)) + ": " + fault->reason);
        frames.push_back(std::move(frame));
    }
    if (frames.empty()) throw Error(one_line(file) + ": no frames");
    return frames;
}

}  // namespace vesper::apps
