// Drago, Myszkowski, Annen and Chiba 2003, "Adaptive Logarithmic Mapping For Displaying High Contrast Scenes": in
// double, and on the device. SPDX-License-Identifier: MIT
#include <cmath>

#include <gtest/gtest.h>

#include "support/operator_chain.h"

namespace vesper::reference::drago_test {
namespace {

/// Eq. 4: displayed luminance over white of luminance `l`; `average` is the log average, `most` the largest luminance.
double drago(double l, double average, double most, double bias) {
    const double x = l / average, brightest = most / average;
    const double base = 2 + 8 * std::pow(std::min(l / most, 1.0), std::log(bias) / std::log(0.5));
    return std::log1p(x) / std::log(base) / (std::log1p(brightest) / std::log(10));
}

void drago_frame(const OperatorFrame& f, Adapted& out) {
    const double bias = std::pow(0.5, double(f.in.parameters.settings[0].x)), most = std::max(f.maximum, kFloor);
    write_table(f.in.parameters, out.tone, [&](double l) { return drago(l, f.log_average, most, bias); });
}

const KnownReference kKnown(render::Operator::Drago, {.frame = drago_frame});

/// Log average as pfstmo_drago03 has it.
double average_of(const std::vector<double>& luminances) {
    double sum = 0;
    for (const double l : luminances) sum += std::log(l + 1e-4);
    return std::exp(sum / double(luminances.size()));
}

// pfstmo_drago03 of pfstools 2.2.0 on a row of these greys, cd/m^2.
TEST(Drago, GivesTheDigitsOfPfstmo) {
    const std::vector<double> row{0.1, 0.1, 1, 10, 100, 1000};
    const std::pair<double, std::vector<double>> shown[]{
        {0.85, {0.008506948, 0.008506948, 0.06543696, 0.317065, 0.7033999, 1}},
        {0.7, {0.01254226, 0.01254226, 0.1042181, 0.4865488, 0.8940538, 1}}};
    for (const auto& [bias, want] : shown)
        for (size_t i = 0; i < row.size(); ++i)
            EXPECT_NEAR(drago(row[i], average_of(row), 1000, bias) / want[i], 1, 3e-6) << bias << ", " << row[i];
}

// The brightest pixel is white, no light is black, and a bias of 1 is a logarithm to base 10 of everything.
TEST(Drago, HasTheLimitsOfThePaper) {
    for (const double bias : {0.7, 0.85, 1.0}) {
        EXPECT_NEAR(drago(300, 2, 300, bias), 1, 1e-12);
        EXPECT_EQ(drago(0, 2, 300, bias), 0);
        for (double l = 0.01, last = 0; l < 300; l *= 1.3) {
            EXPECT_GT(drago(l, 2, 300, bias), last) << l;
            last = drago(l, 2, 300, bias);
        }
    }
    EXPECT_NEAR(drago(20, 2, 300, 1), std::log10(11) / std::log10(151), 1e-12);
    EXPECT_NEAR(drago(150, 2, 300, 0.5), std::log(76) / std::log(6) / std::log10(151), 1e-12)
        << "half of white: base 6";
    EXPECT_GT(drago(2, 2, 300, 0.7), drago(2, 2, 300, 0.85)) << "less bias lifts dark parts";
}

}  // namespace
}  // namespace vesper::reference::drago_test

namespace vesper::test::drago_test {
namespace {

TEST(Drago, TheDeviceEqualsTheReference) {
    render::OperatorSettings settings;
    for (const float bias : {0.6f, 0.85f, 1.0f}) {
        settings.drago.bias = bias;
        expect_reference(render::Operator::Drago, settings);
    }
}

}  // namespace
}  // namespace vesper::test::drago_test
