// Reinhard and Devlin 2005, "Dynamic Range Reduction Inspired by Photoreceptor Physiology": in double, and on the
// device. SPDX-License-Identifier: MIT
#include <cmath>

#include <gtest/gtest.h>

#include "support/operator_chain.h"

namespace vesper::reference::devlin_test {
namespace {

/// The settings of the paper, and what a frame makes of them.
struct Receptor {
    double f = 1, m = 0.6, a = 1, c = 0;
    dvec3 average{0};          ///< colour of the frame
    double mean = 0;           ///< its luminance
    double low = 0, high = 1;  ///< responses shown as black and as white

    /// Of each channel.
    dvec3 response(dvec3 rgb) const {
        dvec3 v;
        for (int k = 0; k < 3; ++k) {
            const double local = c * rgb[k] + (1 - c) * luminance(rgb), global = c * average[k] + (1 - c) * mean;
            const double adaptation = std::max(a * local + (1 - a) * global, 1e-20);
            v[k] = rgb[k] > 0 ? rgb[k] / (rgb[k] + std::pow(f * adaptation, m)) : 0.0;
        }
        return v;
    }
    /// As the codes of a display, which are sRGB (IEC 61966-2-1).
    dvec3 codes(dvec3 rgb) const { return (response(rgb) - low) / (high - low); }
    dvec3 light(dvec3 rgb) const {
        dvec3 code = glm::clamp(codes(rgb), 0.0, 1.0);
        for (int k = 0; k < 3; ++k)
            code[k] = code[k] <= 0.04045 ? code[k] / 12.92 : std::pow((code[k] + 0.055) / 1.055, 2.4);
        return code;
    }
};

/// m of a frame by its key: of natural logarithms of luminance.
double contrast_of(double ln_low, double ln_average, double ln_high) {
    return 0.3 + 0.7 * std::pow(std::clamp((ln_high - ln_average) / (ln_high - ln_low), 0.0, 1.0), 1.4);
}

Receptor receptor_of(const shared::ToneCurve& curve) {
    const glm::vec4 *b = curve.block, set = b[0];
    return {set.x, set.y, set.z, set.w, dvec3(b[1]), b[1].w, b[2].x, double(b[2].x) + 1 / double(b[2].y)};
}

void devlin_frame(const OperatorFrame& f, Adapted& out) {
    const shared::ToneParameters& p = f.in.parameters;
    const double ln_high = std::log(std::max(f.maximum, kFloor)),
                 ln_low = std::min(percentile(out.share, 0.01, p), ln_high - 1);
    const glm::vec4 set = p.settings[0];
    Receptor r{set.x, set.y, set.z, set.w, dvec3(0), f.mean};
    if (set.y == 0) r.m = contrast_of(ln_low, std::log(f.log_average), ln_high);
    double pixels = 0;
    for (const dvec4& tile : f.in.colours.texels) r.average += dvec3(tile) * tile.w, pixels += tile.w;
    r.average = pixels > 0 ? r.average / pixels : dvec3(f.mean);
    const double low = luminance(r.response(dvec3(std::exp(ln_low)))),
                 high = luminance(r.response(dvec3(std::exp(ln_high))));
    r.low = low, r.high = low + std::max(high - low, 1e-6);
    out.tone.block[0] = {set.x, float(r.m), set.z, set.w};
    out.tone.block[1] = glm::vec4(glm::vec3(r.average), float(r.mean));
    out.tone.block[2] = {float(r.low), float(1 / (r.high - r.low)), 0, 0};
    write_table(p, out.tone, [&](double l) { return luminance(r.light(dvec3(l))); });
}

dvec3 devlin_rgb(const shared::ToneCurve& curve, dvec3 rgb) {
    return receptor_of(curve).light(glm::max(rgb, dvec3(0)));
}

const KnownReference kKnown(render::Operator::Devlin, {.frame = devlin_frame, .rgb = devlin_rgb});

/// Statistics as pfstmo_reinhard05 takes them: it adds up all pixels but the first, and divides by all.
Receptor of_pfstmo(const std::vector<dvec3>& row, double brightness, double c, double a) {
    double ln_sum = 0, least = 1e30, most = 0, count = double(row.size());
    Receptor r{std::exp(-brightness), 0, a, c};
    for (const dvec3& rgb : row) least = std::min(least, luminance(rgb)), most = std::max(most, luminance(rgb));
    for (size_t i = 1; i < row.size(); ++i) {
        ln_sum += std::log(2.3e-5 + luminance(row[i]));
        r.average += row[i] / count, r.mean += luminance(row[i]) / count;
    }
    r.m = contrast_of(std::log(least), ln_sum / count, std::log(most));
    double low = 1, high = 0;
    for (const dvec3& rgb : row)
        for (int k = 0; k < 3; ++k) low = std::min(low, r.response(rgb)[k]), high = std::max(high, r.response(rgb)[k]);
    r.low = low, r.high = high;
    return r;
}

// pfstmo_reinhard05 of pfstools 2.2.0 on rows of pixels, cd/m^2, for brightness, chromatic and light adaptation.
TEST(Devlin, GivesTheDigitsOfPfstmo) {
    const std::vector<dvec3> grey{dvec3(0.1), dvec3(0.1), dvec3(1), dvec3(10), dvec3(100), dvec3(1000)};
    const std::vector<dvec3> street{{1, 2, 4}, {1, 2, 4}, {10, 5, 1}, {0.3, 0.3, 0.3}, {50, 80, 20}, {600, 300, 100}};
    struct Run {
        const std::vector<dvec3>& row;
        double brightness, c, a;
        size_t pixel;
        dvec3 want;
    };
    const Run runs[]{{grey, 0, 0, 1, 2, {0.0884977, 0.0884978, 0.0884976}},
                     {grey, 0, 0, 1, 3, {0.390821, 0.390822, 0.390821}},
                     {grey, 0, 0, 1, 4, {0.754593, 0.754593, 0.754593}},
                     {grey, 0, 0, 0, 2, {0.00302538, 0.00302539, 0.00302538}},
                     {grey, 0, 0, 0, 3, {0.0788401, 0.0788402, 0.0788401}},
                     {grey, 0, 0, 0, 4, {0.662468, 0.662468, 0.662467}},
                     {grey, 1, 0.5, 0.75, 2, {0.0180221, 0.0180222, 0.0180221}},
                     {grey, 1, 0.5, 0.75, 3, {0.366417, 0.366417, 0.366417}},
                     {grey, 1, 0.5, 0.75, 4, {0.864542, 0.864542, 0.864542}},
                     {street, 0, 0.5, 0.75, 1, {0.00892791, 0.0441728, 0.169834}},
                     {street, 0, 0.5, 0.75, 2, {0.293785, 0.161621, 0.0167724}},
                     {street, 0, 0.5, 0.75, 4, {0.662612, 0.791277, 0.430701}},
                     {street, 0, 0.5, 0.75, 5, {1, 0.920954, 0.692169}},
                     {street, 0, 0.3, 0.6, 1, {0.0066525, 0.0286078, 0.106651}},
                     {street, 0, 0.3, 0.6, 2, {0.244958, 0.117205, 0.00947}},
                     {street, 0, 0.3, 0.6, 4, {0.640212, 0.780102, 0.383796}},
                     {street, 0, 0.3, 0.6, 5, {1, 0.917028, 0.672395}},
                     {street, 1, 1, 0.2, 1, {0.00667943, 0.0415658, 0.272461}},
                     {street, 1, 1, 0.2, 2, {0.248385, 0.162193, 0.0412833}},
                     {street, 1, 1, 0.2, 4, {0.715517, 0.863423, 0.725085}},
                     {street, 1, 1, 0.2, 5, {1, 0.980267, 0.943661}}};
    for (const Run& run : runs) {
        const dvec3 got = of_pfstmo(run.row, run.brightness, run.c, run.a).light(run.row[run.pixel]);
        // Their weights of luminance differ from ours in the fifth digit.
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], run.want[k], 5e-6) << run.c << " " << run.pixel << " " << k;
    }
}

// An eye adapted to a light responds to it with a half; m is 0.3 for a bright key and 1 for a dark one.
TEST(Devlin, HasTheLimitsOfThePaper) {
    Receptor r{.f = 1, .m = 1};
    for (const double l : {0.01, 1.0, 1e4})
        EXPECT_NEAR(r.response(dvec3(l)).y, 0.5, 1e-6) << "m 1, adapted to the pixel";
    r.a = 0, r.mean = 7;
    EXPECT_NEAR(r.response(dvec3(7)).x, 0.5, 1e-6);
    EXPECT_NEAR(r.response(dvec3(1e12)).x, 1, 1e-9);
    EXPECT_EQ(r.response(dvec3(0)), dvec3(0));
    r.c = 1, r.average = {2, 3, 4};
    EXPECT_NEAR(glm::length(r.response({2, 3, 4}) - dvec3(0.5)), 0, 1e-12) << "adapted to a colour, it is grey";
    EXPECT_NEAR(contrast_of(0, 5, 5), 0.3, 1e-12);
    EXPECT_NEAR(contrast_of(0, 0, 5), 1, 1e-12);
}

}  // namespace
}  // namespace vesper::reference::devlin_test

namespace vesper::test::devlin_test {
namespace {

TEST(Devlin, TheDeviceEqualsTheReference) {
    render::OperatorSettings settings;
    expect_reference(render::Operator::Devlin, settings);
    settings.devlin = {.intensity = 1, .contrast = 0.4f, .light_adaptation = 0.6f, .chromatic_adaptation = 0.3f};
    expect_reference(render::Operator::Devlin, settings);
    settings.devlin = {.intensity = -2, .contrast = 0, .light_adaptation = 0, .chromatic_adaptation = 1};
    expect_reference(render::Operator::Devlin, settings);
}

}  // namespace
}  // namespace vesper::test::devlin_test
