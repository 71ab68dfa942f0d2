// Displays: transfer functions against their standards, tables, what is refused. SPDX-License-Identifier: MIT
#include "vision/display.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/srgb.h"

namespace vesper::test {
namespace {

using vision::Display;

// SMPTE ST 2084 / ITU-R BT.2408: 58.1 % is 203 cd/m^2, 75.2 % 1000 cd/m^2; the ends are exact.
TEST(Display, PqIsAbsolute) {
    EXPECT_EQ(vision::pq_luminance(0), 0);
    EXPECT_NEAR(vision::pq_luminance(1), 10000, 1e-9);
    EXPECT_NEAR(vision::pq_luminance(0.5), 92.2457, 1e-3);
    EXPECT_NEAR(vision::pq_luminance(0.580689), 203, 0.02);
    EXPECT_NEAR(vision::pq_luminance(0.751827), 1000, 0.05);
    const vision::DisplayCurve curve(Display{.peak = 600, .black = 0.01f, .eotf = vision::Eotf::Pq});
    EXPECT_NEAR(curve.emitted(0.5), 92.2457, 1e-3);
    EXPECT_FLOAT_EQ(float(curve.emitted(0)), 0.01f) << "the display's black";
    EXPECT_FLOAT_EQ(float(curve.emitted(0.9)), 600) << "and its peak";
}

TEST(Display, SrgbAndGamma) {
    EXPECT_NEAR(srgb_to_linear(0.5), 0.214041, 1e-6);
    EXPECT_NEAR(srgb_to_linear(0.02), 0.02 / 12.92, 1e-12);
    EXPECT_NEAR(srgb_to_linear(0.04045), srgb_to_linear(0.040451), 1e-6) << "the parts join";
    const vision::DisplayCurve srgb(Display{.peak = 80, .black = 0.5f, .eotf = vision::Eotf::Srgb});
    EXPECT_NEAR(srgb.emitted(0.5), 0.5 + 79.5 * 0.214041, 1e-4);
    const vision::DisplayCurve gamma(Display{.peak = 200, .black = 0.8f, .gamma = 2});
    EXPECT_NEAR(gamma.emitted(0.5), 0.8 + 199.2 / 4, 1e-6);
    EXPECT_NEAR(gamma.emitted(2), 200, 1e-9);
}

/// Measured at so many codes, denser towards black where `power` is more than 1.
Display sampled(const Display& source, int count, double power) {
    Display made = source;
    const vision::DisplayCurve curve(source);
    made.eotf = vision::Eotf::Table;
    for (int i = 0; i < count; ++i) {
        const double code = std::pow(i / (count - 1.0), power);
        made.table.push_back({code, curve.emitted(code)});
    }
    made.table.front().luminance = double(made.black), made.table.back().luminance = double(made.peak);
    return made;
}

// A table of a known display finds it again between its measurements: a gamma of 2.2 exactly, others nearly; sRGB,
// whose toe is straight, only where there are measurements near black.
TEST(Display, TablesAreInterpolatedAlmostAsDisplaysAre) {
    const auto worst = [](const Display& display, int count, double power) {
        const vision::DisplayCurve want(display), got(sampled(display, count, power));
        double most = 0;
        for (int i = 0; i <= 255; ++i)
            most = std::max(most, std::abs(got.emitted(i / 255.0) / want.emitted(i / 255.0) - 1));
        return most;
    };
    EXPECT_LT(worst({.peak = 100, .black = 0.1f}, 3, 1), 1e-6);
    EXPECT_LT(worst({.peak = 100, .black = 0.1f, .gamma = 2.6f}, 17, 1), 0.03);
    EXPECT_LT(worst({.peak = 100, .black = 0.1f, .eotf = vision::Eotf::Srgb}, 17, 2), 0.02);
}

TEST(Display, TablesRiseAndMeetTheirMeasurements) {
    const Display display{.peak = 50,
                          .black = 0.2f,
                          .eotf = vision::Eotf::Table,
                          .table = {{0, double(0.2f)}, {0.1, 0.21}, {0.5, 0.22}, {0.52, 30}, {0.9, 30.01}, {1, 50}}};
    const vision::DisplayCurve curve(display);
    for (const vision::DisplaySample& sample : display.table)
        EXPECT_NEAR(curve.emitted(sample.code), sample.luminance, 1e-9);
    double last = 0;
    for (int i = 0; i <= 5000; ++i) {
        const double luminance = curve.emitted(i / 5000.0);
        EXPECT_GE(luminance, last) << i;
        last = luminance;
    }
}

TEST(Display, KnownOnesAreSound) {
    std::vector<std::string> names;
    for (const vision::NamedDisplay& known : vision::known_displays()) {
        EXPECT_NO_THROW(vision::check_display(known.display)) << known.name;
        names.emplace_back(known.name);
    }
    for (const char* name : {"lcd", "office", "projector", "hdr10"})
        EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
    const auto find = [&](const std::string& name) {
        return vision::known_displays()[size_t(std::find(names.begin(), names.end(), name) - names.begin())].display;
    };
    EXPECT_EQ(find("projector").peak, 10);
    EXPECT_EQ(find("hdr10").bits, 10u);
    // pfstools: lcd is 200 and 0.8 cd/m^2 in 60 lx, of which 1 % is reflected.
    EXPECT_NEAR(double(find("lcd").low()), 0.8 + 0.6 / 3.14159265, 1e-6);
    EXPECT_NEAR(double(find("lcd").high()), 200 + 0.6 / 3.14159265, 1e-4);
}

TEST(Display, RefusesWhatCannotBe) {
    const float nan = std::nanf("");
    const vision::DisplaySample low{0, 1}, high{1, 100};
    const auto table = [&](std::vector<vision::DisplaySample> samples) {
        return Display{.peak = 100, .black = 1, .eotf = vision::Eotf::Table, .table = std::move(samples)};
    };
    EXPECT_NO_THROW(vision::check_display(table({low, high})));
    for (const Display& display :
         {Display{.peak = nan}, Display{.peak = 1, .black = 2}, Display{.black = -1}, Display{.black = 0, .ambient = 0},
          Display{.gamma = 0}, Display{.ambient = -1}, Display{.reflection = 2}, Display{.bits = 9},
          Display{.peak = 20000, .eotf = vision::Eotf::Pq},
          Display{.primaries = {{0.3, 0.3}, {0.3, 0.3}, {0.1, 0.1}, {0.3, 0.3}}}, table({}), table({low}),
          table({high, low}), table({low, {0.5, 0.5}, high}), table({low, {0.5, 50}, {0.5, 60}, high}),
          table({{0.1, 1}, high}), table({low, {0.9, 100}}), table({{0, 2}, high}),
          table({low, {0.5, std::nan("")}, high})})
        EXPECT_THROW(vision::check_display(display), Error);
}

}  // namespace
}  // namespace vesper::test
