// Adaptation and tone curve on the device against their reference. SPDX-License-Identifier: MIT
#include "passes/adapt_reference.h"

#include <cstring>
#include <random>

#include "render/passes/adapt.h"
#include "support/compare.h"
#include "support/texels.h"

namespace vesper::test::adapt_test {
namespace {

using render::Operator;

// ln of display luminance, absolute: sums over 256 steps in float. An eighth of the smallest step of an 8-bit display
// near white (1 / 255 / gamma is 2e-3 in ln).
constexpr double kNodeError = 2e-4;
// With rods: the lesser of two thresholds has a kink within one step, which the quadrature rules here and there weigh
// differently.
constexpr double kNodeErrorWithRods = 5e-4;

struct Frame {
    shared::Histogram histogram{};
    glm::vec4 top{0};         ///< the 1x1 level
    VkExtent2D texels{1, 1};  ///< of the foveal level
    std::vector<glm::vec4> fovea{};
    render::HistogramSettings bins;
    render::ToneSettings tone;
    vision::Display display;
    Operator tone_operator = Operator::Irawan;
    float seconds = 0;
    VkExtent2D tiles{3, 2};
    std::vector<glm::vec4> colours{{1, 0.5, 0.2, 900},  {3, 2, 1, 1024}, {0, 0, 0, 0},
                                   {0.1, 0.1, 0.3, 17}, {-1, 2, 0, 5},   {1e4, 5e3, 10, 1024}};

    const render::OperatorInfo& op() const { return render::operator_info(tone_operator); }
    shared::ToneParameters parameters() const {
        return render::tone_parameters(op(), bins, tone, display, {1, texels, {2 * texels.width, 2 * texels.height}},
                                       seconds);
    }
    reference::Adapted wanted(const shared::EyeState& previous) const {
        const std::vector<glm::dvec4> level(fovea.begin(), fovea.end());
        return reference::adapt({histogram,
                                 top,
                                 {texels.width, texels.height, level},
                                 previous,
                                 parameters(),
                                 tone.observer,
                                 op().tone_operator,
                                 op().chromatic
                                     ? reference::PyramidLevel{tiles.width, tiles.height,
                                                               std::vector<glm::dvec4>(colours.begin(), colours.end())}
                                     : reference::PyramidLevel{}});
    }
};

struct Got {
    shared::ToneCurve curve;
    shared::EyeState eye;
};

/// The eye goes on from the last frame, or from `eye`.
Got adapt(PassRig& rig, const Frame& frame, const render::EyeState& eye = {.on_device = true}) {
    graph::FrameGraph graph;
    const graph::Resource top = rig.image(graph, "top", render::kSceneFormat, {1, 1}, std::vector{frame.top});
    const graph::Resource fovea = rig.image(graph, "fovea", render::kSceneFormat, frame.texels, frame.fovea);
    const graph::Resource histogram = rig.buffer(graph, "histogram", std::vector{frame.histogram});
    const render::Colours colours =
        frame.op().chromatic
            ? render::Colours{rig.image(graph, "colours", render::kSceneFormat, frame.tiles, frame.colours),
                              frame.tiles}
            : render::Colours{};
    const render::Adaptation a = render::add_adaptation(
        rig.frame(graph, gpu_scene::View{}), {top, fovea, histogram, colours, eye}, frame.op(), frame.parameters());
    const graph::Resource curve = keep<shared::ToneCurve>(graph, a.curve), left = keep<shared::EyeState>(graph, a.eye);
    rig.run(graph);
    return {rig.got<shared::ToneCurve>(curve).at(0), rig.got<shared::EyeState>(left).at(0)};
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
            ++f.histogram.count[bin], ++f.histogram.finite, ++f.histogram.votes;
            sum_ln += ln, sum += std::exp(ln), highest = std::max(highest, std::exp(ln));
        }
    }
    if (f.histogram.finite)
        f.top = {sum / f.histogram.finite, f.histogram.finite, sum_ln / f.histogram.finite, highest};
    f.fovea = {f.top};
    return f;
}

bool near(double a, double b, double relative, double floor = 0) {
    return std::abs(a - b) <= relative * std::max(std::abs(b), floor) + 1e-30;
}

void expect_same(const Got& got, const reference::Adapted& want, const Frame& frame) {
    const uint32_t steps = frame.bins.bins * frame.bins.steps_per_bin();
    const bool has_table = want.tone.bins == float(shared::kMaxNodes);  // not of the histogram
    const double node_error = frame.tone.observer.use_rods ? kNodeErrorWithRods : kNodeError;
    Picture got_nodes(steps + 1, 1, 1), want_nodes = got_nodes;
    for (uint32_t i = 0; i <= steps; ++i)
        got_nodes.values[i] = got.curve.node[i].x, want_nodes.values[i] = want.adjusted.curve.node[i];
    if (!has_table) {
        EXPECT_TRUE(same_light("nodes", got_nodes, want_nodes, {0, 0}, [&] {
            Picture allowed(steps + 1, 1, 1);
            for (double& a : allowed.values) a = node_error;
            return allowed;
        }()));
    }
    if (has_table) {
        // Two powers and a logarithm to base 10 in float, of responses up to 1.
        for (uint32_t i = 0; i <= shared::kMaxNodes; ++i)
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(got.curve.node[i][k], want.tone.node[i][k], 2e-5 + 1e-4 * std::abs(want.tone.node[i][k]))
                    << i << " " << k;
    }
    for (uint32_t i = steps + 1; i <= shared::kMaxNodes && !has_table; ++i)
        EXPECT_EQ(got.curve.node[i], glm::vec4(0)) << "nodes beyond the last";
    const shared::ToneCurve& w = want.tone;
    // 1e-5: one exponential and a few products in float. 5e-5: two logarithms to base 10 and back. 1e-3: a percentile
    // in a bin that has 1e-4 of the votes, of sums of which floats have 1e-7.
    EXPECT_TRUE(near(got.curve.adaptation, w.adaptation, 1e-5)) << got.curve.adaptation << " want " << w.adaptation;
    EXPECT_TRUE(near(got.curve.log_average, w.log_average, 1e-5)) << got.curve.log_average << " want " << w.log_average;
    EXPECT_TRUE(near(got.curve.maximum, w.maximum, 0)) << got.curve.maximum << " want " << w.maximum;
    EXPECT_TRUE(near(got.curve.cone_sigma, w.cone_sigma, 5e-5)) << got.curve.cone_sigma << " want " << w.cone_sigma;
    EXPECT_TRUE(near(got.curve.rod_sigma, w.rod_sigma, 5e-5)) << got.curve.rod_sigma << " want " << w.rod_sigma;
    const auto same_number = [&](int texel, int k, double relative, double absolute) {
        const float g = got.curve.block[texel][k], expected = w.block[texel][k];
        EXPECT_NEAR(g, expected, relative * std::abs(expected) + absolute) << "block " << texel << " " << k;
    };
    const uint32_t form = frame.op().form;
    const bool automatic = frame.op().tone_operator == Operator::Reinhard && frame.tone.operators.reinhard.automatic;
    for (int k = 0; k < 4; ++k)
        same_number(0, k, automatic ? 1e-3 : 5e-5, form == shared::kToneColour && k == 0 ? 2e-5 : 1e-30);
    for (int k = 0; k < 4; ++k) same_number(1, k, 1e-4, 1e-30);
    for (int k = 0; k < 4; ++k) {
        // A dozen products after logarithms and exponentials of responses, whose ratios go to some hundred.
        for (int row = 2; row < 5; ++row) same_number(row, k, 2e-4, 2e-4);
        if (k < 3) {
            EXPECT_NEAR(got.eye.chroma[k], want.eye.chroma[k], 2e-5);
        }
    }
    EXPECT_FLOAT_EQ(got.curve.ln_low, w.ln_low);
    EXPECT_FLOAT_EQ(got.curve.bins_per_ln, w.bins_per_ln);
    const shared::PattanaikState &lag = got.eye.pattanaik, &want_lag = want.eye.pattanaik;
    EXPECT_TRUE(near(lag.cones, want_lag.cones, 5e-5) && near(lag.rods, want_lag.rods, 5e-5) &&
                near(lag.cone_pigment, want_lag.cone_pigment, 1e-5) &&
                near(lag.rod_pigment, want_lag.rod_pigment, 5e-5));
    EXPECT_EQ(got.curve.bins, w.bins);
    EXPECT_TRUE(near(got.eye.adaptation, want.eye.adaptation, 1e-5));
    EXPECT_NEAR(double(got.eye.seconds) + double(got.eye.seconds_lost),
                double(want.eye.seconds) + double(want.eye.seconds_lost), 1e-5);
    EXPECT_NEAR(got.eye.pupil, want.eye.pupil, 1e-5);
    const auto same_memory = [](const shared::ReceptorMemory& a, const shared::ReceptorMemory& b) {
        return near(a.pigment, b.pigment, 1e-5) && near(a.fast, b.fast, 1e-5, 1) && near(a.slow, b.slow, 1e-5, 1);
    };
    EXPECT_TRUE(same_memory(got.eye.cones, want.eye.cones))
        << got.eye.cones.pigment << " " << got.eye.cones.fast << " " << got.eye.cones.slow;
    EXPECT_TRUE(same_memory(got.eye.rods, want.eye.rods))
        << got.eye.rods.pigment << " " << got.eye.rods.fast << " " << got.eye.rods.slow;
    EXPECT_EQ(got.eye.steps, want.eye.steps);
    for (uint32_t i = 0; i <= shared::kMaxBins; ++i)
        EXPECT_NEAR(got.eye.node[i], want.eye.node[i], node_error) << "node " << i;
    if (frame.histogram.finite == 0) return;  // what is left over of an empty frame means nothing
    EXPECT_EQ(got.curve.under_full, w.under_full);
    EXPECT_NEAR(got.curve.slack, w.slack, node_error);
}

/// The next frame of the eye that the rig keeps; `eye`: that it has before, and then after it.
void expect_next(PassRig& rig, const Frame& frame, shared::EyeState& eye) {
    const reference::Adapted want = frame.wanted(eye);
    const Got got = adapt(rig, frame);
    expect_same(got, want, frame);
    eye = got.eye;
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
    for (const auto& [name, frame] : frames)
        for (Operator op : {Operator::Irawan, Operator::Ward}) {
            SCOPED_TRACE(std::string(name) + ", " + std::string(render::operator_info(op).name));
            Frame shown = frame;
            shown.tone_operator = op;
            expect_same(adapt(rig, shown, render::EyeState{}), shown.wanted({}), shown);
        }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Adapt, MatchesTheReferenceOnOtherDisplays) {
    for (const vision::Display& display :
         {vision::Display{10, 0.01f, 2.2f, 0, 0}, vision::Display{1000, 0.001f, 2.4f, 0, 0},
          vision::Display{80, 1, 2.2f, 60, 0.02f}})
        for (Frame frame : {frame_of({{30, 8, 20000}, {85, 3, 200}}), frame_of({{74, 0.8, 1000}})}) {
            PassRig rig;
            frame.display = display;
            expect_same(adapt(rig, frame), frame.wanted({}), frame);
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
        expect_next(rig, frame, eye);
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Adapt, ReinhardAndLinearParametersAsSet) {
    Frame frame = frame_of({{30, 8, 20000}, {85, 3, 200}});
    frame.tone.operators.reinhard = {.key = 0.36f, .white = 120},
    frame.tone.operators.linear = {.low = 0.5f, .high = 40};
    PassRig rig;
    for (const Operator op : {Operator::Reinhard, Operator::Linear}) {
        frame.tone_operator = op;
        expect_same(adapt(rig, frame), frame.wanted({}), frame);
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Adapt, AnEmptyFrameIsBlackAndFinite) {
    PassRig rig;
    Frame frame;
    frame.histogram.non_finite = 35;
    frame.fovea = {glm::vec4(0)};
    const Got got = adapt(rig, frame);
    expect_same(got, frame.wanted({}), frame);
    for (const glm::vec4& node : got.curve.node) EXPECT_TRUE(std::isfinite(node.x));
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Adapt, MatchesTheReferenceForEveryObserver) {
    PassRig rig;
    const Frame street = frame_of({{30, 8, 20000}, {60, 5, 4000}, {85, 3, 200}});
    std::vector<render::ToneSettings> all(8);
    all[0].observer.use_rods = true;
    all[1].observer.age = 70, all[1].observer.low_vision = 3;
    all[2].observer.cones.semi_saturation = 1.5, all[2].observer.cones.fast_share = 0.8;
    all[3].ceiling = shared::kCeilingLinear;
    all[4].ceiling = shared::kCeilingCones, all[4].adapt_to = shared::kAdaptAverage;
    all[5].adapt_to = shared::kAdaptTexel;
    all[6].adapt_to = shared::kAdaptGazeMean;
    all[7].photopic_rods = all[7].observer.use_rods = true;
    for (const render::ToneSettings& tone : all) {
        SCOPED_TRACE(&tone - all.data());
        Frame frame = street;
        frame.tone = tone;
        expect_same(adapt(rig, frame, render::EyeState{}), frame.wanted({}), frame);
    }
    EXPECT_EQ(rig.complaints(), "");
}

// Every operator, over three frames of a street that grows darker.
TEST(Adapt, MatchesTheReferenceForEveryOperatorOverTime) {
    for (const render::OperatorInfo& op : render::operators())
        for (bool automatic : {false, true}) {
            SCOPED_TRACE(op.name);
            PassRig rig;
            shared::EyeState eye{};
            for (double at : {60.0, 40.0, 25.0}) {
                Frame frame = frame_of({{at, 8, 20000}, {85, 3, 200}});
                frame.tone_operator = op.tone_operator;
                frame.tone.operators.reinhard.automatic = automatic;
                frame.seconds = 0.1f;
                expect_next(rig, frame, eye);
            }
            EXPECT_EQ(rig.complaints(), "");
        }
}

// An eye that leaves one colour for another has half of the new one at once, and is between them for a while.
TEST(Adapt, MatchesTheReferenceWhileColoursChange) {
    for (const Operator op : {Operator::Durand, Operator::Devlin}) {
        SCOPED_TRACE(render::operator_info(op).name);
        PassRig rig;
        shared::EyeState eye{};
        for (const glm::vec3 colour : {glm::vec3(1, 0.5f, 0.1f), glm::vec3(0.2f, 0.5f, 1), glm::vec3(0.3f, 1, 0.2f)}) {
            Frame frame = frame_of({{60, 8, 20000}});
            frame.tone_operator = op;
            frame.colours.assign(6, glm::vec4(30.0f * colour, 1024));
            frame.seconds = 4;
            expect_next(rig, frame, eye);
        }
    }
}

// Pigments of Pattanaik's cones come back within minutes after a day, and his rods see down to starlight.
TEST(Adapt, MatchesTheReferenceFromDayToStarlight) {
    PassRig rig;
    shared::EyeState eye{};
    for (const auto& [at, seconds] : {std::pair(99.0, 0.0f), {70.0, 30.0f}, {15.0, 60.0f}, {2.0, 200.0f}}) {
        SCOPED_TRACE(at);
        Frame frame = frame_of({{at, 0.5, 20000}});
        frame.tone_operator = Operator::Pattanaik;
        frame.tone.operators.pattanaik.rod_constant = 500;  // the light below which rods are no brighter counts
        frame.seconds = seconds;
        expect_next(rig, frame, eye);
    }
}

// Ward's ceiling clips until little is left to clip: how little shows in few histograms.
TEST(Adapt, MatchesTheReferenceWhereWardStopsToClip) {
    PassRig rig;
    for (uint32_t spread = 0; spread < 60; ++spread) {
        SCOPED_TRACE(spread);
        Frame frame = frame_of({{70, 0.5 + 0.05 * spread, 20000}, {40, 10, 4000}}, 100, spread);
        frame.tone_operator = Operator::Ward;
        expect_same(adapt(rig, frame, render::EyeState{}), frame.wanted({}), frame);
    }
}

TEST(Adapt, TheGazeMovesOverTheFovealLevel) {
    PassRig rig;
    Frame frame = frame_of({{30, 8, 2000}, {60, 5, 400}});
    frame.texels = {7, 5};
    frame.fovea.clear();
    std::mt19937 random(3);
    std::uniform_real_distribution<float> decades(-2, 3), unit(0, 1);
    for (int i = 0; i < 35; ++i) {
        const float l = std::pow(10.0f, decades(random)), pixels = i % 6 == 0 ? 0 : std::floor(1 + 3.9f * unit(random));
        frame.fovea.emplace_back(pixels > 0 ? l : 0, pixels, std::log(l), l);
    }
    for (const glm::vec2 gaze : {glm::vec2(0.5f), {0, 0}, {1, 1}, {0.31f, 0.87f}, {0.99f, 0.02f}, {-3, 2}}) {
        frame.tone.gaze = gaze;
        for (uint32_t to : {shared::kAdaptGaze, shared::kAdaptGazeMean, shared::kAdaptTexel}) {
            frame.tone.adapt_to = to;
            expect_same(adapt(rig, frame, render::EyeState{}), frame.wanted({}), frame);
        }
    }
    EXPECT_EQ(rig.complaints(), "");
}

// Where there is nothing to look at but a picture around it, the eye stays as it is; after days its clock still goes.
TEST(Adapt, AGazeAtNothingKeepsTheEye) {
    PassRig rig;
    Frame frame = frame_of({{30, 8, 2000}, {60, 5, 400}});
    frame.texels = {3, 1};
    frame.fovea.assign(3, glm::vec4(0));
    frame.seconds = 1 / 60.0f;
    for (const bool first : {true, false}) {
        shared::EyeState eye{};
        if (!first) {
            eye = adapt(rig, frame_of({{30, 8, 2000}})).eye;
            eye.adaptation = 20, eye.seconds = 300000, eye.seconds_lost = 0.01f, eye.pupil = 3.3f;
        }
        for (uint32_t to : {shared::kAdaptGaze, shared::kAdaptGazeMean, shared::kAdaptTexel}) {
            SCOPED_TRACE(to);
            frame.tone.adapt_to = to;
            const Got got = adapt(rig, frame, {eye});
            expect_same(got, frame.wanted(eye), frame);
            EXPECT_TRUE(near(got.eye.adaptation, first ? std::exp(frame.top.z) : 20, 1e-5)) << got.eye.adaptation;
        }
    }
    EXPECT_EQ(rig.complaints(), "");
}

// tone-mapping.md, 2.6: 5000 to 50 cd/m^2. Two percent are asked for.
TEST(Adapt, EntersATunnelAsTabulated) {
    PassRig rig;
    const double table[][3]{{0.05, 4204, 1.064}, {0.2, 1772, 0.463},  {1, 1317, 0.351},    {5, 737.8, 0.208},
                            {10, 459.0, 0.140},  {20, 281.1, 0.0964}, {60, 184.3, 0.0736}, {300, 135.9, 0.0628}};
    const vision::ReceptorModel cones(vision::ReceptorKind::Cones, vision::Receptors::cones());
    Frame frame = frame_of({{60, 8, 2000}});
    frame.fovea = {{5000, 4, std::log(5000), 0}};
    adapt(rig, frame);
    frame.fovea = {{50, 4, std::log(50), 0}};
    double now = 0;
    for (const auto& [seconds, sigma, contrast] : table) {
        frame.seconds = float(seconds - now), now = seconds;
        const Got got = adapt(rig, frame);
        EXPECT_NEAR(got.curve.cone_sigma / sigma, 1, 0.002) << seconds;
        EXPECT_NEAR(cones.threshold(50, got.curve.cone_sigma) / 50 / contrast, 1, 0.005) << seconds;
    }
    EXPECT_EQ(rig.complaints(), "");
}

// 60 steps of 1/60 s and 30 of 1/30 s, within 0.5 %, and the curve they end with. Then a pause, which freezes
// everything.
TEST(Adapt, TimeCountsAndNotFrames) {
    const auto run = [](int steps, bool pause) {
        PassRig rig;
        Frame day = frame_of({{75, 5, 2000}}), tunnel = frame_of({{52, 6, 2000}, {80, 1, 20}});
        day.fovea = {{5000, 4, std::log(5000), 0}}, tunnel.fovea = {{50, 4, std::log(50), 0}};
        adapt(rig, day);
        tunnel.seconds = 1.0f / float(steps);
        Got got{};
        for (int i = 0; i < steps; ++i) got = adapt(rig, tunnel);
        if (pause) {
            day.seconds = 0;
            got = adapt(rig, day);
        }
        return got;
    };
    const Got many = run(60, false), few = run(30, false), paused = run(60, true);
    EXPECT_NEAR(many.curve.cone_sigma / few.curve.cone_sigma, 1, 1e-4);
    // 2e-3: nodes follow what moves itself, by steps.
    for (uint32_t i = 0; i <= 200; ++i) EXPECT_NEAR(many.curve.node[i].x, few.curve.node[i].x, 2e-3) << i;
    EXPECT_EQ(paused.eye.cones.fast, many.eye.cones.fast);
    EXPECT_EQ(paused.eye.cones.pigment, many.eye.cones.pigment);
    EXPECT_TRUE(std::ranges::equal(paused.eye.node, many.eye.node));
}

// The state of one run, given to another, continues it to the last bit.
TEST(Adapt, GoesOnFromAnyStateBitByBit) {
    PassRig rig, other;
    Got got{};
    Frame frame = frame_of({{30, 8, 20000}, {85, 3, 200}});
    for (int i = 0; i < 5; ++i) {
        frame.fovea = {{1.0f + float(i), 4, 0.3f * float(i), 0}};
        frame.seconds = 0.02f;
        const shared::EyeState before = got.eye;
        got = adapt(rig, frame);
        const Got again = i == 0 ? adapt(other, frame) : adapt(other, frame, {before});
        EXPECT_EQ(std::memcmp(&got.eye, &again.eye, sizeof got.eye), 0) << i;
        EXPECT_EQ(std::memcmp(&got.curve, &again.curve, sizeof got.curve), 0) << i;
    }
    EXPECT_EQ(rig.complaints() + other.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::adapt_test
