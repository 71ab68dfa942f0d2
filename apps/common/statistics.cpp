#include "statistics.h"

#include <algorithm>
#include <cmath>

#include "base/one_line.h"
#include "print.h"
#include "shared/photometry.h"

namespace vesper::apps {
namespace {

constexpr double kPercents[] = {1, 5, 25, 50, 75, 95, 99, 99.9};

std::string number(double value) { return format("%.6g", value); }

}  // namespace

LuminanceStatistics luminance_statistics(std::span<const float> pixels, size_t channels) {
    LuminanceStatistics s;
    std::vector<float> luminances;
    luminances.reserve(pixels.size() / channels);
    for (size_t i = 0; i + channels <= pixels.size(); i += channels) {
        const double y = double(shared::kRed) * double(pixels[i]) + double(shared::kGreen) * double(pixels[i + 1]) +
                         double(shared::kBlue) * double(pixels[i + 2]);
        if (!std::isfinite(y)) {
            ++s.non_finite;
            continue;
        }
        s.mean += y;
        s.log_mean += std::log(std::max(y, double(shared::kLuminanceFloor)));
        luminances.push_back(float(y));
        s.zero += y == 0;
        s.negative += y < 0;
        if (y > 0 && (s.least_positive == 0 || y < s.least_positive)) s.least_positive = y;
    }
    s.finite = luminances.size();
    if (luminances.empty()) return s;
    s.mean /= double(s.finite);
    s.log_mean = std::exp(s.log_mean / double(s.finite));
    std::sort(luminances.begin(), luminances.end());
    s.minimum = double(luminances.front());
    s.maximum = double(luminances.back());
    for (const double percent : kPercents)
        s.percentiles.emplace_back(percent, double(luminances[size_t(percent / 100 * double(s.finite - 1) + 0.5)]));
    return s;
}

bool is_damaged(double luminance) { return !std::isfinite(luminance) || luminance < 0; }

std::string damaged_text(const std::string& file, uint64_t pixels, const std::string& taken) {
    return one_line(file) + ": " + std::to_string(pixels) + " pixels are not finite or of negative luminance: " + taken;
}

std::string text_of(const LuminanceStatistics& s, const std::string& heading) {
    std::string text = heading + "\n  minimum   " + number(s.minimum) + "\n";
    for (const auto& [percent, luminance] : s.percentiles) {
        std::string label = number(percent) + " %";
        label.resize(10, ' ');
        text += "  " + label + number(luminance) + "\n";
    }
    text += "  maximum   " + number(s.maximum) + "\n  mean      " + number(s.mean) + "\n  log mean  " +
            number(s.log_mean) + "\n";
    if (s.zero || s.negative) {
        text += "  least > 0 " + number(s.least_positive) + "\n  pixels of 0: " + std::to_string(s.zero);
        text += ", negative: " + std::to_string(s.negative) + "\n";
    }
    if (s.non_finite) text += "  pixels that are not finite: " + std::to_string(s.non_finite) + "\n";
    return text;
}

std::string json_of(const LuminanceStatistics& s) {
    std::string text = "{\"minimum_cd_m2\": " + number(s.minimum) + ", \"maximum_cd_m2\": " + number(s.maximum) +
                       ", \"mean_cd_m2\": " + number(s.mean) + ", \"log_mean_cd_m2\": " + number(s.log_mean) +
                       ", \"percentiles_cd_m2\": {";
    for (size_t i = 0; i < s.percentiles.size(); ++i)
        text += (i ? ", \"" : "\"") + number(s.percentiles[i].first) + "\": " + number(s.percentiles[i].second);
    return text + "}, \"least_positive_cd_m2\": " + number(s.least_positive) +
           ", \"zero_pixels\": " + std::to_string(s.zero) + ", \"negative_pixels\": " + std::to_string(s.negative) +
           ", \"non_finite_pixels\": " + std::to_string(s.non_finite) + "}";
}

}  // namespace vesper::apps
