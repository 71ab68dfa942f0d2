#include "render/eye_state.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdio>

namespace vesper::render {
namespace {

constexpr size_t kFloats = sizeof(shared::EyeState) / sizeof(float);
constexpr size_t index_of(size_t offset) { return offset / sizeof(float); }

constexpr double kDarkest = 1e-4, kBrightest = 1e6;  // cd/m^2 to which an eye adapts (adapt.comp)
constexpr double kScotopic = 10;                     // at most, scotopic luminance over luminance
constexpr double kLeastPigment = 1e-9;  // unbleached by 1e7 scotopic cd/m^2, of receptors that the settings allow
constexpr double kFactor = 12;          // log10, of an adaptation on sigma
constexpr double kChroma = 40;          // ln, of cones' responses from the darkest to the brightest light
constexpr double kShown = 20;           // ln of display luminance, cd/m^2
constexpr double kStep = 1e-3;          // ln: falling of a curve by rounding

/// A value that is in no range is refused, NaN among them. Where there is nothing to remember, 0 stands for it.
struct Range {
    size_t offset;
    double low, high;
    const char* unit;
};
const Range kOfEye[]{{offsetof(shared::EyeState, adaptation), kDarkest, kBrightest, " cd/m^2"},
                     {offsetof(shared::EyeState, seconds), 0, shared::kLongestLife, " s"},
                     {offsetof(shared::EyeState, pupil), 1.9, 7.9, " mm"},
                     {offsetof(shared::EyeState, cones.pigment), kLeastPigment, 1, ""},
                     {offsetof(shared::EyeState, cones.fast), -kFactor, kFactor, ""},
                     {offsetof(shared::EyeState, cones.slow), -kFactor, kFactor, ""},
                     {offsetof(shared::EyeState, rods.pigment), kLeastPigment, 1, ""},
                     {offsetof(shared::EyeState, rods.fast), -kFactor, kFactor, ""},
                     {offsetof(shared::EyeState, rods.slow), -kFactor, kFactor, ""},
                     {offsetof(shared::EyeState, chroma.x), -kChroma, kChroma, ""},
                     {offsetof(shared::EyeState, chroma.y), -kChroma, kChroma, ""},
                     {offsetof(shared::EyeState, chroma.z), -kChroma, kChroma, ""}};
constexpr Range kOfLag[]{
    {offsetof(shared::EyeState, pattanaik.cones), kDarkest, kBrightest, " cd/m^2"},
    {offsetof(shared::EyeState, pattanaik.rods), kDarkest / kScotopic, kScotopic* kBrightest, " scotopic cd/m^2"},
    {offsetof(shared::EyeState, pattanaik.cone_pigment), 0.6, 1, ""},
    {offsetof(shared::EyeState, pattanaik.rod_pigment), kLeastPigment, 1, ""}};
constexpr Range kOfCurve[]{
    {offsetof(shared::EyeState, ln_low), -kShown, 21, ""},  // of 1e9 cd/m^2
    {offsetof(shared::EyeState, steps_per_ln), 1e-3, 1e5, ""},
};
constexpr size_t kFirstNode = index_of(offsetof(shared::EyeState, node));

std::string text(const char* form, double a, double b = 0, double c = 0) {
    char line[128];
    std::snprintf(line, sizeof line, form, a, b, c);
    return line;
}

using Values = std::array<float, kFloats>;
using Fault = std::optional<EyeFault>;

Fault out_of_range(const Values& values, size_t index, double low, double high, const char* unit = "") {
    const double value = values[index];
    constexpr double kRounding = 1e-6;
    if (value >= low - kRounding * std::abs(low) && value <= high + kRounding * std::abs(high)) return {};
    return EyeFault{index, text("%.9g is not from %.6g to %.6g", value, low, high) + unit};
}

template <size_t n>
Fault out_of_ranges(const Values& values, const Range (&ranges)[n]) {
    for (const Range& range : ranges)
        if (Fault fault = out_of_range(values, index_of(range.offset), range.low, range.high, range.unit)) return fault;
    return {};
}

/// Nothing is remembered: all of them are 0.
Fault not_zero(const Values& values, size_t first, size_t end) {
    for (size_t i = first; i < end; ++i)
        if (values[i] != 0) return EyeFault{i, text("%.9g is not 0 as the values that belong to it", values[i])};
    return {};
}

/// Displays show more luminance for more, and no nodes follow the last.
Fault fault_of_nodes(const Values& values, size_t steps) {
    for (size_t i = 0; i <= steps; ++i) {
        const size_t at = kFirstNode + i;
        if (Fault fault = out_of_range(values, at, -kShown, kShown)) return fault;
        if (i > 0 && double(values[at]) < double(values[at - 1]) - kStep)
            return EyeFault{at, text("%.9g is less than %.9g, the node before", values[at], values[at - 1])};
    }
    return not_zero(values, kFirstNode + steps + 1, kFloats);
}

Fault fault_of_curve(const Values& values, const shared::EyeState& eye) {
    constexpr size_t steps_at = index_of(offsetof(shared::EyeState, steps));
    if (Fault fault = out_of_range(values, steps_at, 0, shared::kMaxBins)) return fault;
    if (eye.steps != std::floor(eye.steps)) return EyeFault{steps_at, text("%.9g is no whole number", eye.steps)};
    if (eye.steps == 0) {
        if (Fault fault = not_zero(values, steps_at, steps_at + 3)) return fault;
        return not_zero(values, kFirstNode, kFloats);
    }
    if (Fault fault = out_of_ranges(values, kOfCurve)) return fault;
    return fault_of_nodes(values, size_t(eye.steps));
}

}  // namespace

std::optional<EyeFault> fault_of(const shared::EyeState& eye) {
    const auto values = std::bit_cast<Values>(eye);
    if (eye.adaptation == 0) {  // it has seen nothing, at whatever age
        constexpr size_t seconds_at = index_of(offsetof(shared::EyeState, seconds));
        if (Fault fault = out_of_range(values, seconds_at, 0, shared::kLongestLife, " s")) return fault;
        if (Fault fault = not_zero(values, 0, seconds_at)) return fault;
        return not_zero(values, seconds_at + 1, kFloats);
    }
    if (Fault fault = out_of_ranges(values, kOfEye)) return fault;
    // Some units in the last place of the time.
    const double lost = std::ldexp(double(eye.seconds), -21);
    if (Fault fault = out_of_range(values, index_of(offsetof(shared::EyeState, seconds_lost)), -lost, lost, " s"))
        return fault;
    constexpr size_t lag_at = index_of(offsetof(shared::EyeState, pattanaik));
    constexpr size_t lag_floats = sizeof(shared::PattanaikState) / sizeof(float);
    if (Fault fault =
            eye.pattanaik.cones == 0 ? not_zero(values, lag_at, lag_at + lag_floats) : out_of_ranges(values, kOfLag))
        return fault;
    return fault_of_curve(values, eye);
}

}  // namespace vesper::render
