// What the studies measure with. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "print.h"
#include "study.h"

namespace vesper {
namespace {

/// Three codes a pixel.
std::vector<uint32_t> codes_of(const ToneMapped& shown, const Display& display) {
    std::vector<uint32_t> codes;
    codes.reserve(shown.display.size() / 4 * 3);
    for (size_t i = 0; i < shown.display.size(); i += 4) {
        uint32_t word;
        std::memcpy(&word, &shown.display[i], 4);
        for (uint32_t c = 0; c < 3; ++c) codes.push_back(word >> (c * display.bits) & display.largest_code());
    }
    return codes;
}

/// The code, fractions included, of a luminance in the dark.
double code_of(const DisplayCurve& curve, double luminance, uint32_t largest) {
    double low = 0, high = 1;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        (curve.emitted(middle) < luminance ? low : high) = middle;
    }
    return (low + high) / 2 * largest;
}

}  // namespace

ToneMapped Study::map(const StudyPicture& picture, const ToneChainSettings& with) const {
    mapper.reset_adaptation();
    return mapper.map(with, picture.host(), 0);
}

std::vector<Operator> histogram_operators() {
    std::vector<Operator> found;
    for (const OperatorInfo& op : operators())
        if (op.histogram) found.push_back(op.tone_operator);
    return found;
}

std::vector<Operator> studied_operators(const StudyArguments& arguments, const std::vector<Operator>& candidates,
                                        const std::string& why) {
    const EyeArguments& eye = arguments.tone.eye;
    if (eye.command.count("--operator") == 0) return candidates;
    const Operator given = tone_settings(arguments.tone).tone_operator;
    if (std::find(candidates.begin(), candidates.end(), given) == candidates.end())
        throw Error("--operator " + name_of(given) + ": " + why);
    return {given};
}

std::vector<double> luminances_of(const StudyPicture& picture) {
    constexpr int kSteps = 1000;
    std::vector<double> luminances;
    for (int i = 0; i <= kSteps; ++i)
        luminances.push_back(picture.darkest * std::pow(picture.brightest / picture.darkest, double(i) / kSteps));
    return luminances;
}

std::vector<double> curve_codes(const ToneMapped& shown, Operator op, const Display& display,
                                const std::vector<double>& luminances) {
    const DisplayCurve curve(display);
    const double reflected = double(display.low() - display.black);
    std::vector<double> codes;
    for (const double l : luminances)
        codes.push_back(
            code_of(curve, shown_luminance(op, shown.curve, l, display) - reflected, display.largest_code()));
    return codes;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0;
    for (size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

Difference difference(const ToneMapped& from, const ToneMapped& to, const Display& display) {
    const std::vector<uint32_t> a = codes_of(from, display), b = codes_of(to, display);
    Difference made;
    made.map.reserve(a.size() / 3);
    double sum = 0;
    for (size_t i = 0; i < a.size(); i += 3) {
        uint32_t most = 0;
        for (size_t c = i; c < i + 3; ++c) most = std::max(most, a[c] > b[c] ? a[c] - b[c] : b[c] - a[c]);
        made.map.push_back(float(most));
        sum += most;
        made.largest = std::max(made.largest, double(most));
    }
    made.mean = sum / double(made.map.size());
    std::vector<float> sorted = made.map;
    const auto at = sorted.begin() + ptrdiff_t(0.99 * double(sorted.size() - 1));
    std::nth_element(sorted.begin(), at, sorted.end());
    made.percentile = double(*at);
    return made;
}

std::string describe(const Difference& d) {
    return format("curve %.2f, largest %.0f, 99 %% within %.0f, mean %.3f codes", d.curve, d.largest, d.percentile,
                  d.mean);
}

}  // namespace vesper
