// Adaptation and tone curve on the device against their reference. SPDX-License-Identifier: MIT
#include "passes/adapt_reference.h"

#include <random>

#include "support/compare.h"
#include "support/texels.h"

namespace vesper::test {
namespace {

// ln of display luminance, absolute: 24 rounds of sums over 256 bins in float. An eighth of the smallest step of an
// 8-bit display near white (1 / 255 / gamma is 2e-3 in ln).
constexpr double kNodeError = 2e-4;

struct Frame {
    shared::Histogram histogram{};
    glm::vec4 top{0};  ///< the 1x1 level
    HistogramSettings bins;
    ToneSettings tone;
    Display display;
    float seconds = 0;

    shared::AdaptPush push() const {
        return {bins.bins, bins.ln_low(), bins.bins_per_ln(), display.low(),    display.high(),
                tone.key,  tone.white,    tone.linear_low,    tone.linear_high, seconds};
    }
};

struct Got {
    shared::ToneCurve curve;
    shared::EyeState eye;
};

Got adapt(PassRig& rig, const Frame& frame) {
    FrameGraph graph;
    const Resource top = rig.image(graph, "top", kSceneFormat, {1, 1}, std::vector{frame.top});
    const Resource histogram = rig.buffer(graph, "histogram", std::vector{frame.histogram});
    const Adaptation a = add_adaptation(graph, rig.kernels(), {{top}, {{1, 1}}}, histogram, frame.bins, frame.tone,
                                        frame.display, frame.seconds);
    const Resource curve = keep<shared::ToneCurve>(graph, a.curve), eye = keep<shared::EyeState>(graph, a.eye.current);
    rig.run(graph);
    return {rig.got<shared::ToneCurve>(curve).at(0), rig.got<shared::EyeState>(eye).at(0)};
}

/// Votes of a mixture of hills, `at` and `spread` in bins.
struct Hill {
    double at, spread;
    uint32_t votes;
};
Frame frame_of(const std::vector<Hill>& hills, uint32_t bins = 100, uint32_t seed = 1) {
    Frame f;
    f.bins.bins = bins;
    std::mt19937 random(seed);
    double sum_ln = 0, sum = 0, highest = 0;
    for (const Hill& h : hills) {
        std::normal_distribution<double> hill(h.at, h.spread);
        for (uint32_t i = 0; i < h.votes; ++i) {
            const uint32_t bin = uint32_t(std::clamp(hill(random), 0.0, bins - 1.0));
            const double ln = f.bins.ln_low() + (bin + 0.5) / double(f.bins.bins_per_ln());
            ++f.histogram.count[bin], ++f.histogram.finite;
            sum_ln += ln, sum += std::exp(ln), highest = std::max(highest, std::exp(ln));
        }
    }
    if (f.histogram.finite)
        f.top = {sum / f.histogram.finite, f.histogram.finite, sum_ln / f.histogram.finite, highest};
    return f;
}

void expect_same(const Got& got, const reference::Adapted& want, const Frame& frame) {
    Picture got_nodes(frame.bins.bins + 1, 1, 1), want_nodes = got_nodes;
    for (uint32_t i = 0; i <= frame.bins.bins; ++i)
        got_nodes.values[i] = got.curve.node[i], want_nodes.values[i] = want.adjusted.curve.node[i];
    EXPECT_TRUE(same_light("nodes", got_nodes, want_nodes, {0, 0}, [&] {
        Picture allowed(frame.bins.bins + 1, 1, 1);
        for (double& a : allowed.values) a = kNodeError;
        return allowed;
    }()));
    const shared::ToneCurve& w = want.tone;
    const auto near = [](float a, float b, double relative) {
        return std::abs(a - b) <= relative * std::abs(b) + 1e-30;
    };
    // 1e-5: one exponential and a few products in float.
    EXPECT_TRUE(near(got.curve.adaptation, w.adaptation, 1e-5)) << got.curve.adaptation << " want " << w.adaptation;
    EXPECT_TRUE(near(got.curve.log_average, w.log_average, 1e-5)) << got.curve.log_average << " want " << w.log_average;
    EXPECT_TRUE(near(got.curve.maximum, w.maximum, 0)) << got.curve.maximum << " want " << w.maximum;
    EXPECT_TRUE(near(got.curve.reinhard_scale, w.reinhard_scale, 1e-5))
        << got.curve.reinhard_scale << " want " << w.reinhard_scale;
    EXPECT_TRUE(near(got.curve.reinhard_white, w.reinhard_white, 3e-5))
        << got.curve.reinhard_white << " want " << w.reinhard_white;
    EXPECT_EQ(got.curve.linear_low, w.linear_low);
    EXPECT_TRUE(near(got.curve.linear_gain, w.linear_gain, 1e-6)) << got.curve.linear_gain << " want " << w.linear_gain;
    EXPECT_EQ(got.curve.ln_low, w.ln_low);
    EXPECT_EQ(got.curve.bins_per_ln, w.bins_per_ln);
    EXPECT_EQ(got.curve.bins, w.bins);
    EXPECT_TRUE(near(got.eye.adaptation, want.eye.adaptation, 1e-5));
    EXPECT_FLOAT_EQ(got.eye.seconds, want.eye.seconds);
    if (frame.histogram.finite == 0) return;  // what is left over of an empty frame means nothing
    EXPECT_EQ(got.curve.ceiling, w.ceiling);
    EXPECT_NEAR(got.curve.slack, w.slack, kNodeError);
}

TEST(Adapt, MatchesTheReferenceOnRoadsDayAndNight) {
    PassRig rig;
    const std::vector<std::pair<const char*, Frame>> frames{
        {"night street", frame_of({{30, 8, 20000}, {85, 3, 200}})},
        {"unlit road", frame_of({{12, 5, 5000}, {70, 2, 10}})},
        {"day", frame_of({{78, 6, 9000}})},
        {"tunnel mouth", frame_of({{45, 4, 4000}, {80, 4, 3000}})},
        {"fog", frame_of({{74, 0.8, 1000}})},
        {"one luminance", frame_of({{40, 0, 100}})},
        {"everything at once", frame_of({{50, 40, 50000}})},
        {"256 bins", frame_of({{80, 25, 20000}, {220, 9, 300}}, 256)},
        {"17 bins", frame_of({{6, 2, 300}, {15, 0.5, 3}}, 17)},
        {"one bin", frame_of({{0, 0, 4}}, 1)},
    };
    for (const auto& [name, frame] : frames) {
        SCOPED_TRACE(name);
        PassRig fresh;
        expect_same(adapt(fresh, frame), reference::adapt(frame.histogram, frame.top, {}, frame.push()), frame);
        EXPECT_EQ(fresh.complaints(), "");
    }
}

TEST(Adapt, MatchesTheReferenceOnOtherDisplays) {
    for (const Display& display :
         {Display{10, 0.01f, 2.2f, 0, 0}, Display{1000, 0.001f, 2.4f, 0, 0}, Display{80, 1, 2.2f, 60, 0.02f}})
        for (Frame frame : {frame_of({{30, 8, 20000}, {85, 3, 200}}), frame_of({{74, 0.8, 1000}})}) {
            PassRig rig;
            frame.display = display;
            expect_same(adapt(rig, frame), reference::adapt(frame.histogram, frame.top, {}, frame.push()), frame);
        }
}

TEST(Adapt, MatchesTheReferenceOnRandomHistograms) {
    PassRig rig;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    shared::EyeState eye{};
    for (int k = 0; k < 40; ++k) {
        SCOPED_TRACE(k);
        std::vector<Hill> hills;
        for (int i = 0; i < 1 + k % 4; ++i)
            hills.push_back({100 * unit(random), 15 * unit(random), uint32_t(1 + 20000 * unit(random))});
        Frame frame = frame_of(hills, 100, uint32_t(k));
        frame.seconds = 0.02f;
        const auto want = reference::adapt(frame.histogram, frame.top, eye, frame.push());
        expect_same(adapt(rig, frame), want, frame);  // the same rig: the eye's clock goes on
        eye = want.eye;
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Adapt, ReinhardAndLinearParametersAsSet) {
    Frame frame = frame_of({{30, 8, 20000}, {85, 3, 200}});
    frame.tone = {.key = 0.36f, .white = 120, .linear_low = 0.5f, .linear_high = 40};
    PassRig rig;
    expect_same(adapt(rig, frame), reference::adapt(frame.histogram, frame.top, {}, frame.push()), frame);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Adapt, AnEmptyFrameIsBlackAndFinite) {
    PassRig rig;
    Frame frame;
    frame.histogram.non_finite = 35;
    const Got got = adapt(rig, frame);
    expect_same(got, reference::adapt(frame.histogram, frame.top, {}, frame.push()), frame);
    for (float node : got.curve.node) EXPECT_TRUE(std::isfinite(node));
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test
