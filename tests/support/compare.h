// Compares images by kind of value, and leaves pictures behind where they differ. SPDX-License-Identifier: MIT
// Three kinds: linear light (relative error with a floor, plus what rounding may do to each value), display codes
// (distance from the unrounded code), and counts (gtest's own EXPECT_EQ).
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace vesper::test {

/// An image of doubles, rows from the top.
struct Picture {
    uint32_t width = 0, height = 0, channels = 1;
    std::vector<double> values;  ///< width * height * channels

    Picture() = default;
    Picture(uint32_t w, uint32_t h, uint32_t c) : width(w), height(h), channels(c), values(size_t(w) * h * c) {}
    /// From what a pass gave: `T` is a scalar or a vector of `c` scalars.
    template <class T>
    static Picture of(uint32_t w, uint32_t h, uint32_t c, std::span<const T> texels) {
        Picture p(w, h, c);
        for (size_t i = 0; i < p.values.size(); ++i) p.values[i] = double(texels[i]);
        return p;
    }
    double& at(uint32_t x, uint32_t y, uint32_t c = 0) { return values[(size_t(y) * width + x) * channels + c]; }
    double at(uint32_t x, uint32_t y, uint32_t c = 0) const { return values[(size_t(y) * width + x) * channels + c]; }
};

/// How far a value may be from what is wanted: relative * max(|want|, floor).
struct Tolerance {
    double relative = 0;
    double floor = 0;  ///< magnitude below which the error no longer shrinks with the value
};

/// Half an ulp of a 16-bit float, relative: what storing in one costs when rounded to nearest.
constexpr double kHalfUlp16 = 1.0 / 2048;

/// Writes one to three channels as PFM (rows from the bottom, little endian), the fourth dropped.
inline void write_pfm(const std::filesystem::path& path, const Picture& p) {
    const uint32_t channels = p.channels >= 3 ? 3 : 1;
    std::ofstream file(path, std::ios::binary);
    file << (channels == 3 ? "PF\n" : "Pf\n") << p.width << ' ' << p.height << "\n"
         << (std::endian::native == std::endian::little ? "-1.0\n" : "1.0\n");
    for (uint32_t y = p.height; y-- > 0;)
        for (uint32_t x = 0; x < p.width; ++x)
            for (uint32_t c = 0; c < channels; ++c) {
                const float v = float(p.at(x, y, c));
                file.write(reinterpret_cast<const char*>(&v), sizeof v);
            }
}

/// Writes display codes 0..255 as PPM or PGM.
inline void write_pnm(const std::filesystem::path& path, const Picture& p) {
    const uint32_t channels = p.channels >= 3 ? 3 : 1;
    std::ofstream file(path, std::ios::binary);
    file << (channels == 3 ? "P6\n" : "P5\n") << p.width << ' ' << p.height << "\n255\n";
    for (uint32_t y = 0; y < p.height; ++y)
        for (uint32_t x = 0; x < p.width; ++x)
            for (uint32_t c = 0; c < channels; ++c)
                file.put(char(uint8_t(std::lround(std::clamp(p.at(x, y, c), 0.0, 255.0)))));
}

/// Puts got, want and error beside the test's log, under failures/, and returns where.
inline std::string write_failure(const std::string& name, const Picture& got, const Picture& want, const Picture& error,
                                 bool codes) {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string stem = test ? std::string(test->test_suite_name()) + "." + test->name() + "." + name : name;
    std::replace_if(
        stem.begin(), stem.end(), [](char c) { return c == '/' || c == ' '; }, '-');
    std::error_code ignored;  // a read-only directory must not hide the failure itself
    std::filesystem::create_directories("failures", ignored);
    const std::filesystem::path base = std::filesystem::path("failures") / stem;
    const auto write = [&](const char* kind, const Picture& p) {
        codes ? write_pnm(base.string() + kind + (p.channels >= 3 ? ".ppm" : ".pgm"), p)
              : write_pfm(base.string() + kind + ".pfm", p);
    };
    write(".got", got), write(".want", want);
    write_pfm(base.string() + ".error.pfm", error);
    return base.string() + ".{got,want,error}";
}

namespace detail {

/// `allowed(i)` is how far value i may be away. NaN equals NaN, an infinity equals itself.
template <class Allowed>
::testing::AssertionResult compare(const std::string& name, const Picture& got, const Picture& want, bool codes,
                                   Allowed allowed) {
    if (got.width != want.width || got.height != want.height || got.channels != want.channels ||
        got.values.size() != want.values.size())
        return ::testing::AssertionFailure()
               << name << ": got " << got.width << " x " << got.height << " x " << got.channels << ", want "
               << want.width << " x " << want.height << " x " << want.channels;
    Picture error(want.width, want.height, want.channels);
    size_t bad = 0, first = 0, worst = 0;
    double worst_ratio = 0;
    for (size_t i = 0; i < want.values.size(); ++i) {
        const double g = got.values[i], w = want.values[i];
        if (g == w || (std::isnan(g) && std::isnan(w))) continue;
        const double distance = std::abs(g - w), limit = std::isnan(allowed(i)) ? 0.0 : allowed(i);
        error.values[i] = std::isfinite(distance) ? distance : std::numeric_limits<double>::max();
        if (distance <= limit) continue;
        if (bad++ == 0) first = i;
        const double ratio = error.values[i] / std::max(limit, 1e-300);
        if (ratio > worst_ratio) worst_ratio = ratio, worst = i;
    }
    if (bad == 0) return ::testing::AssertionSuccess();
    const auto place = [&](size_t i) {
        std::ostringstream text;
        text.precision(9);
        const size_t pixel = i / want.channels;
        text << "(" << pixel % want.width << ", " << pixel / want.width << ") channel " << i % want.channels << ": got "
             << got.values[i] << ", want " << want.values[i] << " +- " << allowed(i);
        return text.str();
    };
    return ::testing::AssertionFailure() << name << ": " << bad << " of " << want.values.size()
                                         << " values differ; first " << place(first) << "; worst " << place(worst)
                                         << "; see " << write_failure(name, got, want, error, codes);
}

}  // namespace detail

/// Linear light: |got - want| <= relative * max(|want|, floor) + rounding, where `rounding` (empty: none) is what
/// single precision may do to that very value.
inline ::testing::AssertionResult same_light(const std::string& name, const Picture& got, const Picture& want,
                                             Tolerance t, const Picture& rounding = {}) {
    return detail::compare(name, got, want, false, [&](size_t i) {
        return t.relative * std::max(std::abs(want.values[i]), t.floor) +
               (rounding.values.empty() ? 0.0 : rounding.values[i]);
    });
}

/// Display codes: `want` is unrounded, so that a correct rounding is at most half a code away; `beyond` is what the
/// arithmetic may add, and `rounding` (empty: none) what single precision may do to that very value.
inline ::testing::AssertionResult same_codes(const std::string& name, const Picture& got, const Picture& want,
                                             double beyond, const Picture& rounding = {}) {
    return detail::compare(name, got, want, true, [&](size_t i) {
        return 0.5 + beyond + (rounding.values.empty() ? 0.0 : rounding.values[i]);
    });
}

}  // namespace vesper::test
