// What the studies measure with. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "print.h"
#include "study.h"

namespace vesper::commands {
namespace {

/// Three codes a pixel.
std::vector<uint32_t> codes_of(const render::ToneMapped& shown, const vision::Display& display) {
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
double code_of(const vision::DisplayCurve& curve, double luminance, uint32_t largest) {
    double low = 0, high = 1;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        (curve.emitted(middle) < luminance ? low : high) = middle;
    }
    return (low + high) / 2 * largest;
}

}  // namespace

render::ToneMapped Study::map(const StudyPicture& picture, const render::ToneChainSettings& with) const {
    mapper.reset_adaptation();
    return mapper.map(with, picture.host(), 0);
}

std::vector<render::Operator> histogram_operators() {
    std::vector<render::Operator> found;
    for (const render::OperatorInfo& op : render::operators())
        if (op.histogram) found.push_back(op.tone_operator);
    return found;
}

std::vector<render::Operator> studied_operators(const StudyArguments& arguments,
                                                const std::vector<render::Operator>& candidates,
                                                const std::string& why) {
    const apps::EyeArguments& eye = arguments.tone.eye;
    if (eye.command.count("--operator") == 0) return candidates;
    const render::Operator given = apps::tone_settings(arguments.tone).tone_operator;
    if (std::find(candidates.begin(), candidates.end(), given) == candidates.end())
        throw Error("--operator " + apps::name_of(given) + ": " + why);
    return {given};
}

std::vector<double> luminances_of(const StudyPicture& picture) {
    constexpr int kSteps = 1000;
    std::vector<double> luminances;
    for (int i = 0; i <= kSteps; ++i)
        luminances.push_back(picture.darkest * std::pow(picture.brightest / picture.darkest, double(i) / kSteps));
    return luminances;
}

std::vector<double> curve_codes(const render::ToneMapped& shown, render::Operator op, const vision::Display& display,
                                const std::vector<double>& luminances) {
    const vision::DisplayCurve curve(display);
    const double reflected = double(display.low() - display.black);
    std::vector<double> codes;
    for (const double l : luminances)
        codes.push_back(
            code_of(curve, render::shown_luminance(op, shown.curve, l, display) - reflected, display.largest_code()));
    return codes;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0;
    for (size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

Difference difference(const render::ToneMapped& from, const render::ToneMapped& to, const vision::Display& display) {
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
    return apps::format("curve %.2f, largest %.0f, 99 %% within %.0f, mean %.3f codes", d.curve, d.largest,
                        d.percentile, d.mean);
}

}  // namespace vesper::commands
