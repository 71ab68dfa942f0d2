// Tone mapping, colour and display model in double. SPDX-License-Identifier: MIT
#include "passes/composite_reference.h"

#include "analysis/pattanaik.h"

#include <random>

#include <gtest/gtest.h>

namespace vesper::reference::composite_reference_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();

/// A curve that shows 1 cd/m^2 and less as 1 cd/m^2, 100 and more as 100, and is straight in ln between: identity
/// there.
shared::ToneCurve identity() {
    shared::ToneCurve c{};
    c.bins = 20, c.ln_low = 0, c.bins_per_ln = float(20 / std::log(100.0));
    for (int i = 0; i <= 20; ++i) c.node[i].x = float(std::log(100.0) * i / 20);
    return c;
}

shared::ToneCurve reinhard(double log_average, double key, double white) {
    shared::ToneCurve c{};
    c.block[0].x = float(key / log_average);
    c.block[0].y = float(std::pow(log_average / (key * white), 2));
    return c;
}

// Mantiuk et al. 2008, the "lcd" preset of pfstools: 200 cd/m^2, black 0.8, 60 lx, k 0.01.
TEST(CompositeReference, DisplayModel) {
    EXPECT_NEAR(display_luminance(0, 200, 0.8, 2.2, 60, 0.01), 0.8 + 0.6 / 3.14159265358979, 1e-12);
    EXPECT_NEAR(display_luminance(1, 200, 0.8, 2.2, 60, 0.01), 200 + 0.190986, 1e-6);
    EXPECT_NEAR(display_luminance(0.5, 200, 0, 2, 0, 0), 50, 1e-12);
}

// tone-mapping.md, section 5: what pfstmo_reinhard02 gives for six decades with key 0.18 (its log average adds 1e-5).
TEST(CompositeReference, ReinhardGivesThePublishedDigits) {
    const shared::ToneCurve c = reinhard(3.162863, 0.18, 1000);
    const std::pair<double, double> table[]{{0.01, 5.68781e-4}, {0.1, 5.65885e-3}, {1, 5.38470e-2},
                                            {10, 0.3627576},    {100, 0.8520411},  {1000, 1}};
    for (auto [scene, shown] : table)
        EXPECT_NEAR(tone_mapped(scene, shared::kToneReinhard, c, 0, 1) / shown, 1, 3e-6) << scene;
}

TEST(CompositeReference, CurveIsRelativeToTheDisplaysRange) {
    const shared::ToneCurve c = identity();
    for (double y : {1.0, 3.0, 42.0, 100.0})
        EXPECT_NEAR(tone_mapped(y, shared::kToneCurve, c, 1, 100), (y - 1) / 99, 1e-6) << y;
    EXPECT_EQ(tone_mapped(1e-9, shared::kToneCurve, c, 1, 100), 0);
    EXPECT_NEAR(tone_mapped(1e9, shared::kToneCurve, c, 1, 100), 1, 1e-6);
}

TEST(CompositeReference, LinearRunsFromLowToHigh) {
    shared::ToneCurve c{};
    c.block[0].x = 10, c.block[0].y = 1.0f / 40;
    EXPECT_EQ(tone_mapped(5, shared::kToneLinear, c, 0, 1), 0);
    EXPECT_NEAR(tone_mapped(20, shared::kToneLinear, c, 0, 1), 0.25, 1e-7);
    EXPECT_EQ(tone_mapped(1e6, shared::kToneLinear, c, 0, 1), 1);
}

constexpr uint32_t kCurveKept = shared::kToneCurve | shared::kGamutChromaticity;
constexpr uint32_t kLinearKept = shared::kToneLinear | shared::kGamutChromaticity;

// Whatever the colour, its chromaticity is kept, and its luminance unless the display is not that bright in that
// colour.
TEST(CompositeReference, ColoursAreKeptAndAsBrightAsTheDisplayIsInThem) {
    const shared::ToneCurve c = identity();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int i = 0; i < 2000; ++i) {
        const dvec3 rgb =
            dvec3(uniform(random), uniform(random), uniform(random)) * std::pow(10, 4 * uniform(random) - 1);
        const dvec3 shown = displayed(rgb, kCurveKept, c, 1, 100);
        const double most = std::max({shown.x, shown.y, shown.z}),
                     want = tone_mapped(luminance(rgb), shared::kToneCurve, c, 1, 100);
        EXPECT_LE(most, 1 + 1e-12);
        EXPECT_LE(luminance(shown), want + 1e-12);
        if (most < 1 - 1e-9) {
            EXPECT_NEAR(luminance(shown), want, 1e-12);
        }
        if (want > 0) {
            EXPECT_NEAR(glm::length(shown / luminance(shown) - rgb / luminance(rgb)), 0, 1e-9);
        }
    }
}

// A tail lamp stays red, however bright. Nothing else could be as bright and red.
TEST(CompositeReference, BrightRedStaysRed) {
    shared::ToneCurve c{};
    c.block[0].y = 1;
    EXPECT_EQ(displayed({2, 0, 0}, kLinearKept, c, 0, 1), dvec3(1, 0, 0));
    EXPECT_EQ(displayed({2000, 0, 0}, kLinearKept, c, 0, 1), dvec3(1, 0, 0));
    EXPECT_NEAR(glm::length(displayed({2, 1, 0.5}, kLinearKept, c, 0, 1) - dvec3(1, 0.5, 0.25)), 0, 1e-12);
    EXPECT_EQ(displayed({0.9, 0.5, 0.1}, kLinearKept, c, 0, 1), dvec3(0.9, 0.5, 0.1)) << "others are left alone";
}

// Ottosson 2020 has white at (1, 0, 0); the primaries of sRGB as CSS Color 4 implementations print them.
TEST(CompositeReference, OklabIsThePublishedOne) {
    const std::pair<dvec3, dvec3> published[]{{dvec3(1), {1, 0, 0}},
                                              {{1, 0, 0}, {0.62796, 0.22486, 0.12585}},
                                              {{0, 1, 0}, {0.86644, -0.23389, 0.17950}},
                                              {{0, 0, 1}, {0.45201, -0.03246, -0.31153}}};
    for (const auto& [rgb, lab] : published) {
        EXPECT_NEAR(glm::length(Oklab{}.of(rgb) - lab), 0, 1e-5);
        EXPECT_NEAR(glm::length(Oklab{}.rgb(Oklab{}.of(rgb)) - rgb), 0, 1e-12);
    }
    const dvec3 warm(1, 0.9, 0.7);
    EXPECT_NEAR(glm::length(Oklab{.white = warm}.of(warm) - dvec3(1, 0, 0)), 0, 1e-7);
}

dvec3 bright(dvec3 colour, double d, uint32_t gamut = shared::kGamutLuminance,
             const glm::dmat3& to_own = glm::dmat3(1)) {
    shared::ToneCurve c{};
    c.block[0].y = 1;
    return displayed(colour * (d / luminance(colour)), shared::kToneLinear | gamut, c, 0, 1, to_own);
}

double chroma_over_lightness(dvec3 rgb) {
    const dvec3 lab = Oklab{}.of(rgb);
    return std::hypot(lab.y, lab.z) / lab.x;
}

TEST(CompositeReference, GreysAreNeitherPrimariesBelowTheKnee) {
    for (double d = 0; d <= 1; d += 1.0 / 64) EXPECT_NEAR(glm::length(bright(dvec3(3), d) - dvec3(d)), 0, 1e-12) << d;
    EXPECT_NEAR(glm::length(bright(dvec3(3), 1e9) - dvec3(1)), 0, 1e-12);
    for (dvec3 colour :
         {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1), dvec3(0, 1, 1), dvec3(1, 0, 1), dvec3(1, 0.3, 0)})
        EXPECT_NEAR(glm::length(bright(colour, 0.85 * luminance(colour)) - 0.85 * colour), 0, 1e-12)
            << "its largest channel is 0.85";
}

// Light as bright as white loses 0.2 of its chroma and half of its own luminance, on the display's edge; in the middle
// of the knee, where the largest channel would just end, it has 1 - knee / 4 and a quarter of a knee is lost of what is
// lost beyond.
TEST(CompositeReference, PrimariesHaveClosedForms) {
    for (dvec3 colour : {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1), dvec3(0, 1, 1), dvec3(1, 0, 1)}) {
        const double own = luminance(colour), lost = (0.2 + 0.5 * own) * std::min((1 / own - 1) / 0.3, 1.0);
        for (double d : {1.0, 7.0}) {
            const dvec3 shown = bright(colour, d);
            EXPECT_NEAR(std::max({shown.x, shown.y, shown.z}), 1, 1e-12);
            // Blue leaves Rec. 709 by a thousandth on its way, and is cut.
            EXPECT_NEAR(chroma_over_lightness(shown) / chroma_over_lightness(colour), 1 - lost, 2e-3);
        }
        const dvec3 knee = bright(colour, own), half = bright(colour, (1 + own) / 2);
        EXPECT_NEAR(std::max({knee.x, knee.y, knee.z}), 1 - 0.15 / 4, 1e-12);
        EXPECT_NEAR(chroma_over_lightness(knee) / chroma_over_lightness(colour), 1 - lost * 0.15 / 4 / (1 / own - 1),
                    2e-3);
        EXPECT_NEAR(chroma_over_lightness(half) / chroma_over_lightness(colour), 1 - lost / 2, 2e-3)
            << "half way from its own luminance to white's";
    }
    // Red as bright as white, by hand: Oklab (0.62796, 0.69368 (0.22486, 0.12585)) over its largest channel.
    const dvec3 red = Oklab{}.rgb({0.62796, 0.155981, 0.087300});
    EXPECT_NEAR(glm::length(bright({1, 0, 0}, 1) - red / red.x), 0, 1e-4);
}

/// Hues around the edge of the display, and nearer to white.
std::vector<dvec3> every_hue(int steps) {
    std::vector<dvec3> colours;
    for (double purity : {1.0, 0.97, 0.8, 0.5, 0.2, 0.03})
        for (int i = 0; i < steps; ++i) {
            const auto channel = [&](double at) {
                return 1 - purity * std::clamp(2 - std::abs(std::fmod(6.0 * i / steps + at, 6) - 3), 0.0, 1.0);
            };
            colours.emplace_back(channel(0), channel(4), channel(2));
        }
    return colours;
}

// For every hue: brighter is shown brighter, never brighter than asked, in [0, 1], of the same hue, and without a step
// or an edge.
TEST(CompositeReference, OrderAndHueAreKeptAndNothingJumps) {
    constexpr int kSteps = 2000;
    constexpr double kStep = 1.0 / kSteps;
    for (dvec3 colour : every_hue(90)) {
        const double most = std::max({colour.x, colour.y, colour.z}) / luminance(colour);
        const dvec3 lab = Oklab{}.of(colour);
        dvec3 last(0), before(0);
        double last_luminance = 0;
        for (int i = 1; i <= kSteps; ++i) {
            const double d = kStep * i;
            const dvec3 shown = bright(colour, d), now = Oklab{}.of(shown);
            ASSERT_GE(std::min({shown.x, shown.y, shown.z}), 0);
            ASSERT_LE(std::max({shown.x, shown.y, shown.z}), 1 + 1e-12);
            ASSERT_LE(luminance(shown), d + 1e-12);
            ASSERT_GT(luminance(shown), last_luminance + 0.03 * kStep)
                << "the least is of blue, which has 14 times its own luminance to go";
            // 0.2 degrees: where blue is cut at the edge of Rec. 709.
            const double turned =
                (now.y * lab.z - now.z * lab.y) / (std::hypot(now.y, now.z) * std::hypot(lab.y, lab.z));
            ASSERT_LT(std::abs(turned), 0.2 / 57.3) << d;
            // 5: of colours nearly as bright as white, whose blue comes up over a short way.
            ASSERT_LT(glm::length(shown - last), std::max(1.1 * std::sqrt(3.0) * most, 5.0) * kStep)
                << "no step at " << d;
            // An edge would bend a channel by up to its slope, `most`, within a step; a parabola over two knees does by
            // most^2 / (2 knee).
            if (i > 2 && most > 1.5) {
                ASSERT_LT(glm::length(shown - 2.0 * last + before),
                          2 * std::sqrt(3.0) * most * most / 0.3 * kStep * kStep)
                    << "no edge at " << d;
            }
            before = last, last = shown, last_luminance = luminance(shown);
        }
    }
}

// Around the edge of the display, at every luminance: nowhere more of a step than where chromaticity is kept, which has
// its largest near blue.
TEST(CompositeReference, NeighbouringHuesLookAlike) {
    const std::vector<dvec3> colours = every_hue(720);
    const auto largest_step = [&](uint32_t gamut) {
        double largest = 0;
        for (double d = 0.01; d <= 1; d += 0.01)
            for (size_t i = 1; i < 720; ++i)
                largest =
                    std::max(largest, glm::length(bright(colours[i], d, gamut) - bright(colours[i - 1], d, gamut)));
        return largest;
    };
    EXPECT_LT(largest_step(shared::kGamutLuminance), largest_step(shared::kGamutChromaticity));
}

// What is white is the display's, also where it is another than the scene's.
TEST(CompositeReference, OtherDisplaysHaveAWhiteOfTheirOwn) {
    for (const io::Primaries& primaries :
         {io::kDisplayP3, io::kRec2020, io::Primaries{{0.66, 0.32}, {0.28, 0.65}, {0.15, 0.05}, {0.30, 0.32}}}) {
        const glm::dmat3 to_own = from_rec709(primaries), from_own = glm::inverse(to_own);
        for (double d : {0.2, 0.9, 0.999})
            EXPECT_NEAR(glm::length(bright(from_own * dvec3(1), d, shared::kGamutLuminance, to_own) - dvec3(d)), 0,
                        1e-5);
        for (dvec3 own : every_hue(30)) {
            double last = 0;
            for (double d = 0.01; d <= 1; d += 0.01) {
                const dvec3 shown = bright(from_own * own, d, shared::kGamutLuminance, to_own);
                ASSERT_GE(std::min({shown.x, shown.y, shown.z}), -1e-12);
                ASSERT_LE(std::max({shown.x, shown.y, shown.z}), 1 + 1e-12);
                ASSERT_GT(luminance(from_own * shown), last);
                last = luminance(from_own * shown);
            }
        }
    }
}

TEST(CompositeReference, ClippedChannelsEndOneByOne) {
    EXPECT_NEAR(glm::length(bright({2, 1, 0.5}, luminance({2, 1, 0.5}) / 2, shared::kGamutClip) - dvec3(1, 0.5, 0.25)),
                0, 1e-12);
    EXPECT_NEAR(glm::length(bright({2, 1, 0.5}, 0.8 * luminance({2, 1, 0.5}), shared::kGamutClip) - dvec3(1, 0.8, 0.4)),
                0, 1e-12);
    EXPECT_NEAR(bright({0.4, 0.6, -0.2}, 0.3, shared::kGamutClip).z, 0, 0);
}

// Outside the primaries: the same luminance and dominant wavelength, on the edge of the triangle.
TEST(CompositeReference, ColoursOutsideGoTowardsGreyNoFartherThanTheyMust) {
    shared::ToneCurve c{};
    c.block[0].y = 1;
    const dvec3 rgb(0.4, 0.6, -0.2), shown = displayed(rgb, shared::kToneLinear, c, 0, 1), grey(luminance(rgb));
    EXPECT_NEAR(shown.z, 0, 1e-12);
    EXPECT_NEAR(luminance(shown), luminance(rgb), 1e-7);
    EXPECT_NEAR(glm::length(glm::cross(shown - grey, rgb - grey)), 0, 1e-7);
}

// Eyes adapted to an evening street, as adapt_reference.h makes their curves: Pattanaik's responses, and Ferwerda's
// gains.
shared::ToneCurve evening(uint32_t form) {
    shared::ToneCurve c{};
    if (form == shared::kToneRods) {
        c.block[0].x = 0.01f, c.block[0].y = 0.2f, c.block[1] = glm::vec4(0.4f);
        c.block[2].x = c.block[3].y = c.block[4].z = 1;
        return c;
    }
    const analysis::pattanaik::Appearance appearance(analysis::pattanaik::adapted(1, 2.57), 5e5);
    c.bins = shared::kMaxNodes, c.ln_low = float(std::log(1e-4)),
    c.bins_per_ln = float(shared::kMaxNodes / std::log(1e12));
    for (uint32_t i = 0; i <= shared::kMaxNodes; ++i) {
        const double luminance = std::pow(10, -4 + 12.0 * i / shared::kMaxNodes);
        c.node[i] =
            glm::vec4(float(appearance.cones(luminance)), float(appearance(luminance, luminance).colour_exponent),
                      float(appearance.rods(2.57 * luminance)), 0);
    }
    c.block[0].x = float(appearance.offset()), c.block[0].y = float(analysis::pattanaik::cone_sigma(25) / 125);
    return c;
}

// From grey out of Rec. 709 to where nothing is left of its luminance: what lies beside each other looks alike all the
// way.
TEST(CompositeReference, LightOutsideThePrimariesLeavesNoEdge) {
    constexpr int kSteps = 4000;
    for (uint32_t form : {shared::kToneColour, shared::kToneRods})
        for (double level : {0.01, 0.3, 3.0})
            for (dvec3 hue : every_hue(24)) {
                const shared::ToneCurve c = evening(form);
                dvec3 last = displayed(dvec3(level), form, c, 1, 100);
                for (int i = 1; i <= kSteps; ++i) {
                    const dvec3 shown = displayed(level * (1.0 + (hue - 1.0) * (2.5 * i / kSteps)), form, c, 1, 100);
                    // Blue of 3 cd/m^2 goes out with a slope of 19; powers of 1e-6 had one of 115 at the border.
                    ASSERT_LT(glm::length(shown - last), 25.0 / kSteps)
                        << "form " << form << ", " << level << " cd/m^2, hue " << hue.x << " " << hue.y << " " << hue.z
                        << " at " << 2.5 * i / kSteps;
                    last = shown;
                }
            }
}

// Radiance between no light and hardly any: no step.
TEST(CompositeReference, NoLightIsShownAsHardlyAny) {
    shared::ToneCurve c = identity();
    for (auto& node : c.node) node.x += 1;  // a curve that begins above the darkest
    EXPECT_EQ(displayed(dvec3(0), shared::kToneCurve, c, 1, 100),
              displayed(dvec3(1e-9), shared::kToneCurve, c, 1, 100));
    EXPECT_GT(displayed(dvec3(0), shared::kToneCurve, c, 1, 100).x, 0.01);
    c.block[0].x = 0.1f, c.block[0].y = 5;
    for (auto& node : c.node) node = {0.01f, 0.2f, 0.02f, 0};
    EXPECT_EQ(displayed(dvec3(0), shared::kToneColour, c, 1, 100),
              displayed(dvec3(1e-9), shared::kToneColour, c, 1, 100));
}

// Rods are blind to red lamps, and see blue ones well; white counts as its luminance.
TEST(CompositeReference, RodsSeeColours) {
    EXPECT_NEAR(scotopic(dvec3(3), 0), 3, 1e-12);
    EXPECT_NEAR(scotopic({1, 0, 0}, 0), 0.08466 / 2.57328, 1e-4);
    EXPECT_NEAR(scotopic({0, 0, 1}, 0), 0.51882 / 2.57328, 1e-5);
    EXPECT_NEAR(scotopic({1, 0.5, -1}, 0), scotopic({1, 0.5, 0}, 0), 1e-12);
    EXPECT_NEAR(scotopic({1, 0, 0}, shared::kTonePhotopicRods), 0.212639, 1e-12);
    const dvec3 dim = perceived({0, 0, 1e-3}, shared::kTonePurkinje, {});
    EXPECT_NEAR(dim.z, 1e-3 * 0.51882 / 2.57328 / 0.072192, 1e-6) << "blue grows brighter in the dark";
}

TEST(CompositeReference, NeitherNanNorInfinityNorNegativeLightIsShown) {
    const shared::ToneCurve c = identity();
    for (uint32_t tone : {shared::kToneCurve, shared::kToneReinhard, shared::kToneLinear, shared::kToneLdr})
        for (dvec3 rgb : {dvec3(kNan, 1, 1), dvec3(1, kInf, 1), dvec3(-kInf), dvec3(-1), dvec3(0)})
            EXPECT_EQ(displayed(rgb, tone, c, 1, 100), dvec3(0));
    EXPECT_EQ(displayed({0.5, 2, -1}, shared::kToneLdr, c, 1, 100), dvec3(0.5, 1, 0));
    EXPECT_NEAR(displayed({50, 50, -1}, shared::kToneCurve, c, 1, 100).z, 0, 1e-12);
}

TEST(CompositeReference, BilinearHitsTexelsAndTheMeansBetween) {
    const std::vector<dvec3> image{dvec3(1), dvec3(2), dvec3(3), dvec3(8)};
    const std::span<const dvec3> texels(image);
    EXPECT_EQ(bilinear(texels, 2, 2, {1, 0}), dvec3(2));
    EXPECT_EQ(bilinear(texels, 2, 2, {0.5, 0.5}), dvec3(3.5));
    EXPECT_EQ(bilinear(texels, 2, 2, {-3, 0.25}), dvec3(1.5));
    EXPECT_EQ(bilinear(texels, 2, 2, {9, 9}), dvec3(8));
}

TEST(CompositeReference, CodesInvertTheDisplay) {
    const vision::Display gamma{.gamma = 2};
    EXPECT_EQ(code(dvec3(0, 1, 4), gamma), dvec3(0, 255, 255));
    EXPECT_NEAR(code(dvec3(0.25), gamma).x, 127.5, 1e-9);
    const vision::Display srgb{
        .eotf = vision::Eotf::Srgb};  // IEC 61966-2-1: 18 % grey is 117.6, and the line below 0.0031308
    EXPECT_NEAR(code(dvec3(0.18), srgb).x, 117.6, 0.1);
    EXPECT_NEAR(code(dvec3(0.001), srgb).x, 255 * 0.01292, 1e-6);
    // ITU-R BT.2408: 100 cd/m^2 is 50.8 %, 203 cd/m^2 is 58.1 %, 1000 cd/m^2 is 75.2 % of PQ.
    const vision::Display pq{.peak = 10000, .black = 0, .eotf = vision::Eotf::Pq, .bits = 10};
    EXPECT_NEAR(code({0.01, 0.0203, 0.1}, pq).x / 1023, 0.508, 5e-4);
    EXPECT_NEAR(code({0.01, 0.0203, 0.1}, pq).y / 1023, 0.581, 5e-4);
    EXPECT_NEAR(code({0.01, 0.0203, 0.1}, pq).z / 1023, 0.752, 5e-4);
    const vision::Display table{
        .peak = 100, .black = 1, .eotf = vision::Eotf::Table, .table = {{0, 1}, {0.25, 5}, {0.7, 60}, {1, 100}}};
    EXPECT_NEAR(code(dvec3(59.0 / 99), table).x, 0.7 * 255, 1e-6);
}

TEST(CompositeReference, PrimariesKeepTheColour) {
    // ITU-R BT.2087: Rec. 709 red, green and blue in Rec. 2020.
    const glm::dmat3 m = from_rec709(io::kRec2020);
    const glm::dmat3 want{{0.6274, 0.0691, 0.0164}, {0.3293, 0.9195, 0.0880}, {0.0433, 0.0114, 0.8956}};
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(glm::length(m[c] - want[c]), 0, 1e-4) << c;
    EXPECT_NEAR(glm::length(m * dvec3(1) - dvec3(1)), 0, 1e-12) << "white";
}

TEST(CompositeReference, BloomIsAdded) {
    shared::ToneCurve c{};
    c.block[0].y = 0.01f;
    const std::vector<dvec3> scene(25, dvec3(20)), bloom(4, dvec3(0.1));
    vision::Display display{.peak = 1, .black = 0, .gamma = 1, .ambient = 0};
    const auto value = [&](bool with_bloom) {
        const CompositeFrame<dvec3> frame{scene, with_bloom ? std::span(bloom) : std::span<const dvec3>{}, {5, 5}, 2};
        return composite(frame, {4, 2}, shared::kToneLinear, c, display).y / 255;
    };
    EXPECT_NEAR(value(false), 0.2, 1e-7);
    EXPECT_NEAR(value(true), 0.4, 1e-7) << "displayed light times its gain, after the curve";
}

}  // namespace
}  // namespace vesper::reference::composite_reference_test
