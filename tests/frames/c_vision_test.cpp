// Figures of vision through the C interface: those of the engine, those of closed forms, and what is refused.
// SPDX-License-Identifier: MIT
#include <vesper/vision.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analysis/contrast_fidelity.h"
#include "analysis/display_light.h"
#include "analysis/saliency_mapper.h"
#include "analysis/visible_differences.h"
#include "render/retina.h"
#include "support/c_device.h"
#include "vision/visibility.h"

namespace vesper::test {
namespace {

constexpr uint32_t kWidth = 61, kHeight = 47;
constexpr float kFov = 0.03f;  // rad
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

class CVision : public CDevice {
protected:
    void SetUp() override {
        ASSERT_NO_FATAL_FAILURE(CDevice::SetUp());
        ASSERT_EQ(vesper_vision_create(device, &vision, &error), VESPER_OK) << error.message;
        differences.size = sizeof differences;
    }
    void TearDown() override {
        vesper_vision_destroy(vision);
        CDevice::TearDown();
    }
    VesperResult compare(const VesperPicture& first, const VesperPicture& second,
                         const VesperObserver* observer = nullptr) {
        return vesper_visible_differences(vision, observer, &first, &second, map.data(), &differences, &error);
    }
    VesperVision* vision = nullptr;
    VesperDifferences differences{};
    std::vector<float> map = std::vector<float>(kWidth * kHeight, -1);
};

VesperPicture described(const std::vector<float>& rgb, uint32_t width = kWidth, uint32_t height = kHeight) {
    VesperPicture picture = VESPER_INIT(VesperPicture);
    picture.width = width, picture.height = height, picture.channels = 3, picture.values = rgb.data(),
    picture.scale = 1, picture.vertical_fov = kFov;
    return picture;
}

// 1 cd/m^2, and `factor` times that in a square of 8 px.
std::vector<float> square(float factor, uint32_t width = kWidth, uint32_t height = kHeight) {
    std::vector<float> rgb(size_t{3} * width * height, 1);
    for (uint32_t y = 20; y < 28; ++y)
        for (uint32_t x = 30; x < 38; ++x)
            for (uint32_t c = 0; c < 3; ++c) rgb[3 * (y * width + x) + c] = factor;
    return rgb;
}

struct Retinae {
    std::vector<float> first, second;
};

Retinae retinae(const std::vector<float>& a, const std::vector<float>& b, float scale,
                const std::optional<eye::ScatterSettings>& eye) {
    gpu::Device own;
    render::ToneMapper engine(own);
    const auto one = [&](const std::vector<float>& rgb) {
        return render::retinal_luminance(engine, {{kWidth, kHeight}, rgb, 3, scale, double(kFov)}, eye);
    };
    return {one(a), one(b)};
}

const double kPerDegree = kHeight / (2 * std::tan(double(kFov) / 2)) * std::numbers::pi / 180;  // px

VesperObserver old_eye() {
    VesperObserver observer = VESPER_INIT(VesperObserver);
    observer.age = 70, observer.pigmentation = 1.2f;
    return observer;
}

// Pictures on the retina differ as those before the eye do.
TEST_F(CVision, ScatteredPicturesAreThoseOnTheRetina) {
    // 2 % were seen while the eye summed over a field of 10 degrees; Barten's sums over its own area.
    const std::vector<float> a = square(1), b = square(1.05f);
    ASSERT_EQ(compare(described(a), described(b)), VESPER_OK) << error.message;
    const std::vector<float> before = map;
    EXPECT_GT(differences.largest, 0.1);
    EXPECT_LT(differences.largest, 0.999);
    const Retinae on = retinae(a, b, 1, eye::ScatterSettings{.eye = {23, 0.5}});
    const auto grey = [](const std::vector<float>& luminances) {
        std::vector<float> rgb;
        for (const float l : luminances) rgb.insert(rgb.end(), 3, l);
        return rgb;
    };
    const std::vector<float> first = grey(on.first), second = grey(on.second);
    VesperObserver observer = VESPER_INIT(VesperObserver);
    observer.age = 23, observer.pigmentation = 0.5f, observer.scattered = 1;
    ASSERT_EQ(compare(described(first), described(second), &observer), VESPER_OK) << error.message;
    for (size_t i = 0; i < map.size(); ++i) ASSERT_NEAR(map[i], before[i], 1e-3f) << "sums of three floats round";
}

// All bits, with each of the observer's numbers, and each of them changes the figures.
TEST_F(CVision, DifferencesAreThoseOfTheEngine) {
    std::vector<float> a = square(1), b = square(1.06f);
    a[3 * (kWidth * 5 + 7)] = b[3 * (kWidth * 5 + 7)] = 300, a[5] = kNan, b[8] = kInfinity, a[11] = -3;
    VesperPicture first = described(a), second = described(b);
    first.scale = second.scale = 0.5f;
    VesperObserver scattered = old_eye(), dark = old_eye();
    scattered.scattered = 1, dark.pigmentation = 0;
    const VesperObserver old = old_eye();
    std::vector<std::vector<float>> maps;
    for (const VesperObserver* observer :
         std::initializer_list<const VesperObserver*>{nullptr, &old, &scattered, &dark}) {
        ASSERT_EQ(compare(first, second, observer), VESPER_OK) << error.message;
        const double age = observer ? 70 : 23, iris = observer ? double(observer->pigmentation) : 0.5;
        std::optional<eye::ScatterSettings> eye;
        if (observer != &scattered) eye = {.eye = {age, iris}};
        const Retinae on = retinae(a, b, 0.5f, eye);
        const auto want = analysis::visible_differences({kWidth, kHeight, kPerDegree, on.first, on.second},
                                                        {.age = age, .scatters = vision::ScatteringEye{age, iris}});
        EXPECT_EQ(map, want.probability);
        EXPECT_EQ(differences.x, want.x);
        EXPECT_EQ(differences.y, want.y);
        EXPECT_EQ(differences.largest, float(want.largest));
        EXPECT_EQ(differences.above_half, float(want.above_half));
        EXPECT_EQ(differences.above_75, float(want.above_75));
        EXPECT_EQ(differences.above_95, float(want.above_95));
        for (const auto& other : maps) EXPECT_NE(map, other) << maps.size();
        maps.push_back(map);
    }
    const std::vector<float> of_old = maps[1];
    ASSERT_EQ(compare(second, first, &old), VESPER_OK) << error.message;
    for (size_t i = 0; i < map.size(); ++i) ASSERT_NEAR(map[i], of_old[i], 1e-6f) << "no order, and no memory";
}

TEST_F(CVision, EqualPicturesDifferNowhereAndLampsEverybodySees) {
    const std::vector<float> plain = square(1), lamp = square(50);
    ASSERT_EQ(compare(described(lamp), described(lamp)), VESPER_OK) << error.message;
    EXPECT_EQ(differences.largest, 0);
    EXPECT_EQ(map, std::vector<float>(kWidth * kHeight, 0));
    ASSERT_EQ(compare(described(plain), described(lamp)), VESPER_OK) << error.message;
    EXPECT_GT(differences.largest, 0.999f);
    EXPECT_NEAR(differences.x, 33.5, 6);
    EXPECT_NEAR(differences.y, 23.5, 6);
    EXPECT_EQ(vesper_visible_differences(vision, nullptr, nullptr, nullptr, nullptr, nullptr, &error),
              VESPER_BAD_ARGUMENT);
    const VesperPicture picture = described(plain);
    EXPECT_EQ(vesper_visible_differences(vision, nullptr, &picture, &picture, nullptr, nullptr, &error), VESPER_OK)
        << error.message;
}

TEST_F(CVision, FidelityIsThatOfTheEngine) {
    const std::vector<float> scene = square(8), flat = square(1);
    const VesperPicture a = described(scene), b = described(flat);
    const VesperObserver observer = old_eye();
    std::vector<float> seen(map.size()), lost(map.size()), invented(map.size()), amplified(map.size());
    VesperFidelity maps = VESPER_INIT(VesperFidelity);
    maps.seen = seen.data(), maps.lost = lost.data(), maps.invented = invented.data(),
    maps.amplified = amplified.data();
    for (const bool forward : {true, false}) {
        ASSERT_EQ(vesper_contrast_fidelity(vision, &observer, forward ? &a : &b, forward ? &b : &a, &maps, &error),
                  VESPER_OK)
            << error.message;
        const Retinae on =
            retinae(forward ? scene : flat, forward ? flat : scene, 1, eye::ScatterSettings{.eye = {70, double(1.2f)}});
        const auto want = analysis::contrast_fidelity({kWidth, kHeight, kPerDegree, on.first, on.second},
                                                      {.age = 70, .scatters = vision::ScatteringEye{70, double(1.2f)}});
        EXPECT_EQ(seen, want.seen);
        EXPECT_EQ(lost, want.lost);
        EXPECT_EQ(invented, want.invented);
        EXPECT_EQ(amplified, want.amplified);
        EXPECT_EQ(forward, analysis::mean_of(lost) > analysis::mean_of(invented)) << "a flat display loses the square";
    }
    maps.lost = nullptr;
    EXPECT_EQ(vesper_contrast_fidelity(vision, &observer, &a, &b, &maps, &error), VESPER_OK) << error.message;
    EXPECT_EQ(vesper_contrast_fidelity(vision, &observer, &a, &b, nullptr, &error), VESPER_BAD_ARGUMENT);
}

TEST_F(CVision, SaliencyIsThatOfTheEngine) {
    gpu::Device own;
    analysis::SaliencyMapper engine(own);
    for (const auto& [width, height] : {std::pair{61u, 47u}, {131u, 257u}, {32u, 48u}}) {
        const std::vector<float> rgb = square(40, width, height);
        const VesperPicture picture = described(rgb, width, height);
        std::vector<float> salient(size_t{(width + 15) / 16} * ((height + 15) / 16) + 1, -7);
        ASSERT_EQ(vesper_saliency(vision, &picture, salient.data(), &error), VESPER_OK) << error.message;
        EXPECT_EQ(salient.back(), -7) << "more than the map is written";
        salient.pop_back();
        EXPECT_EQ(salient, engine.map({{width, height}, rgb}).values);
        if (width == 131) {  // large enough for a maximum in the texels of the square
            const auto place = std::max_element(salient.begin(), salient.end()) - salient.begin();
            EXPECT_LE(place % 9, 3);
            EXPECT_LE(place / 9, 2);
        }
    }
    const std::vector<float> narrow = square(2, 40, 31);
    const VesperPicture picture = described(narrow, 40, 31);
    EXPECT_EQ(vesper_saliency(vision, &picture, map.data(), &error), VESPER_BAD_ARGUMENT) << "31 px";
    EXPECT_EQ(vesper_saliency(vision, &picture, nullptr, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_saliency(nullptr, &picture, map.data(), &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(map.front(), -1);
}

// Pictures of one size and angle; what is refused leaves the outputs as they are.
TEST_F(CVision, OtherPicturesAreRefused) {
    const std::vector<float> rgb = square(2);
    const VesperPicture right = described(rgb);
    struct Case {
        const char* what;
        void (*spoil)(VesperPicture&);
    };
    const Case cases[]{{"size of the structure", [](auto& p) { p.size = 8; }},
                       {"width", [](auto& p) { p.width -= 1; }},
                       {"no pixels", [](auto& p) { p.height = 0; }},
                       {"channels", [](auto& p) { p.channels = 2; }},
                       {"values", [](auto& p) { p.values = nullptr; }},
                       {"scale", [](auto& p) { p.scale = kNan; }},
                       {"angle", [](auto& p) { p.vertical_fov *= 1.01f; }},
                       {"not an angle", [](auto& p) { p.vertical_fov = kNan; }},
                       {"edges that are no number", [](auto& p) { p.edges[0] = kNan; }}};
    for (const Case& c : cases) {
        VesperPicture wrong = right;
        c.spoil(wrong);
        EXPECT_EQ(compare(right, wrong), VESPER_BAD_ARGUMENT) << c.what;
        EXPECT_EQ(compare(wrong, right), VESPER_BAD_ARGUMENT) << c.what;
        EXPECT_NE(std::string(error.message), "");
    }
    for (const float fov : {1e-30f, 1e-3f, 3.05f}) {
        VesperPicture both = right;
        both.vertical_fov = fov;
        EXPECT_EQ(compare(both, both), VESPER_BAD_ARGUMENT) << fov << " rad";
    }
    VesperPicture large = right;
    large.width = 16384, large.height = 2049;
    EXPECT_EQ(compare(large, large), VESPER_BAD_ARGUMENT) << "its values are not read";
    for (const float age : {0.0f, 121.0f, kNan}) {
        VesperObserver observer = old_eye();
        observer.age = age;
        EXPECT_EQ(compare(right, right, &observer), VESPER_BAD_ARGUMENT) << age;
    }
    VesperObserver observer = old_eye();
    observer.pigmentation = 1.6f;
    EXPECT_EQ(compare(right, right, &observer), VESPER_BAD_ARGUMENT);
    observer = old_eye(), observer.size = 4;
    EXPECT_EQ(compare(right, right, &observer), VESPER_BAD_ARGUMENT);
    differences.size = 4;
    EXPECT_EQ(compare(right, right), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_visible_differences(nullptr, nullptr, &right, &right, map.data(), nullptr, &error),
              VESPER_BAD_ARGUMENT);
    EXPECT_EQ(map, std::vector<float>(kWidth * kHeight, -1));
}

// The middle of the angle, given by edges: the same figures as by the angle. Other pixels are refused.
TEST_F(CVision, EdgesAreAnglesToo) {
    const std::vector<float> a = square(1), b = square(1.1f);
    VesperPicture first = described(a), second = described(b);
    ASSERT_EQ(compare(first, second), VESPER_OK) << error.message;
    const std::vector<float> want = map;
    const float up = std::tan(kFov / 2), right = up * kWidth / kHeight;
    for (VesperPicture* picture : {&first, &second})
        picture->edges[0] = -right, picture->edges[1] = right, picture->edges[2] = -up, picture->edges[3] = up,
        picture->vertical_fov = 0;
    ASSERT_EQ(compare(first, second), VESPER_OK) << error.message;
    for (size_t i = 0; i < map.size(); ++i) ASSERT_NEAR(map[i], want[i], 1e-4f) << i;  // edges are floats
    for (VesperPicture* picture : {&first, &second}) picture->edges[1] *= 1.05f;
    EXPECT_EQ(compare(first, second), VESPER_BAD_ARGUMENT) << "pixels that are not square";
}

TEST(CVisionLuminance, LightOfCodesIsThatOfTheDisplay) {
    VesperToneSettings settings;
    vesper_tone_settings_defaults(&settings, sizeof settings);
    settings.display_peak = 200, settings.display_black = 0.5f, settings.display_gamma = 2,
    settings.display_ambient = 31.4159265f, settings.display_reflection = 0.02f;  // reflects 0.2 cd/m^2
    const std::vector<uint8_t> codes{0, 0, 0, 9, 255, 255, 255, 0, 51, 102, 0, 255};
    std::vector<float> light(9);
    VesperError error;
    ASSERT_EQ(vesper_light_of_codes(&settings, 3, 1, codes.data(), light.data(), &error), VESPER_OK) << error.message;
    const float want[]{
        0.7f, 0.7f, 0.7f, 200.2f, 200.2f, 200.2f, 0.7f + 199.5f * 0.2f * 0.2f, 0.7f + 199.5f * 0.4f * 0.4f, 0.7f};
    for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(light[i], want[i], 2e-5f * want[i]) << i;  // primaries are rounded
    // Ten bits, through the profile of a name.
    const std::vector<uint8_t> words{0xff, 0xff, 0xff, 0x3f, 0, 0, 0, 0};
    settings.display = "hdr10";
    ASSERT_EQ(vesper_light_of_codes(&settings, 2, 1, words.data(), light.data(), &error), VESPER_OK) << error.message;
    const auto hdr10 = std::find_if(vision::known_displays().begin(), vision::known_displays().end(),
                                    [](const auto& known) { return std::string(known.name) == "hdr10"; });
    const std::vector<float> same = analysis::DisplayLight(hdr10->display).of_words(words);
    EXPECT_EQ(std::vector<float>(light.begin(), light.begin() + 6), same);
    EXPECT_GT(light[0], 100 * light[3]);

    const std::vector<float> before = light;
    EXPECT_EQ(vesper_light_of_codes(&settings, 0, 1, words.data(), light.data(), &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_light_of_codes(&settings, 16385, 1, words.data(), light.data(), &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_light_of_codes(&settings, 2, 1, nullptr, light.data(), &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_light_of_codes(&settings, 2, 1, words.data(), nullptr, &error), VESPER_BAD_ARGUMENT);
    settings.display = "no such display";
    EXPECT_EQ(vesper_light_of_codes(&settings, 2, 1, words.data(), light.data(), &error), VESPER_FAILED);
    EXPECT_EQ(light, before);
    EXPECT_EQ(vesper_light_of_codes(nullptr, 2, 1, words.data(), light.data(), &error), VESPER_OK) << "the default";
}

// Thresholds of tests/vision/visibility_test.cpp: 0.0807713 cd/m^2 at 1 cd/m^2, darker 0.0476494.
TEST(CVisionLuminance, VisibilityLevelsAreAdrians) {
    const std::vector<float> luminance{1 + 3 * 0.0807713f, 1 - 2 * 0.0476494f, 1}, background{1, 1, 1};
    std::vector<float> levels(3);
    VesperError error;
    const auto compute = [&](const VesperTarget* target) {
        return vesper_visibility_levels(target, 3, luminance.data(), background.data(), levels.data(), &error);
    };
    ASSERT_EQ(compute(nullptr), VESPER_OK) << error.message;
    EXPECT_NEAR(levels[0], 3, 1e-4f);
    EXPECT_NEAR(levels[1], -2, 1e-4f);
    EXPECT_EQ(levels[2], 0);
    VesperTarget target = VESPER_INIT(VesperTarget);
    target.arc_minutes = 7, target.seconds = 0.5f, target.age = 65, target.veil = 0.4f;
    ASSERT_EQ(compute(&target), VESPER_OK) << error.message;
    for (size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(levels[i],
                    vision::visibility_level(double(luminance[i]) + double(0.4f), 1 + double(0.4f),
                                             {.size = 7, .seconds = 0.5, .age = 65}),
                    1e-6)
            << i;
    std::vector<float> both = luminance;
    ASSERT_EQ(vesper_visibility_levels(&target, 3, both.data(), background.data(), both.data(), &error), VESPER_OK);
    EXPECT_EQ(both, levels) << "in place of the luminances";
    EXPECT_EQ(vesper_visibility_levels(&target, 0, nullptr, nullptr, nullptr, &error), VESPER_OK);
}

TEST(CVisionLuminance, OtherTargetsAreRefused) {
    VesperError error;
    float luminance[2]{1, 1}, background[2]{1, 1}, levels[2]{-7, -7};
    VesperTarget target = VESPER_INIT(VesperTarget);
    target.arc_minutes = 10, target.seconds = 0.2f, target.age = 23;
    const auto compute = [&] { return vesper_visibility_levels(&target, 2, luminance, background, levels, &error); };
    for (float* value :
         {&target.arc_minutes, &target.seconds, &target.age, &target.veil, &luminance[1], &background[1]}) {
        const float right = *value;
        for (const float wrong : {-1.0f, 2e9f, kNan, kInfinity}) {
            *value = wrong;
            EXPECT_EQ(compute(), VESPER_BAD_ARGUMENT) << wrong;
        }
        *value = right;
    }
    for (float* value : {&target.arc_minutes, &target.seconds, &target.age, &background[0]}) {
        const float right = *value;
        *value = 0;
        EXPECT_EQ(compute(), VESPER_BAD_ARGUMENT);
        *value = right;
    }
    EXPECT_EQ(vesper_visibility_levels(&target, 2, nullptr, background, levels, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_visibility_levels(&target, 2, luminance, nullptr, levels, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_visibility_levels(&target, 2, luminance, background, nullptr, &error), VESPER_BAD_ARGUMENT);
    target.size = 8;
    EXPECT_EQ(compute(), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(levels[0], -7);
    EXPECT_EQ(levels[1], -7);
    target.size = sizeof target, background[0] = 0, target.veil = 0.3f;
    EXPECT_EQ(compute(), VESPER_OK) << error.message;
    EXPECT_GT(levels[0], 0) << "the veil is its background";
}

TEST(CVisionLuminance, NeedsADevice) {
    VesperVision* vision = nullptr;
    VesperError error;
    EXPECT_EQ(vesper_vision_create(nullptr, &vision, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vision, nullptr);
    vesper_vision_destroy(nullptr);
}

}  // namespace
}  // namespace vesper::test
