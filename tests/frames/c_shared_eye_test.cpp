// One eye before several screens, by the C interface. SPDX-License-Identifier: MIT
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "support/c_scene.h"

namespace vesper::test {
namespace {

class CSharedEye : public testing::Test {
protected:
    CSharedEye() {
        EXPECT_EQ(vesper_device_open(nullptr, &device, &error), VESPER_OK) << error.message;
        EXPECT_EQ(vesper_scene_create(&scene, &error), VESPER_OK);
        const VesperMaterial material = white();
        uint32_t index = 0;
        EXPECT_EQ(vesper_scene_add_material(scene, &material, &index, &error), VESPER_OK);
        const VesperMesh mesh = square(index);
        EXPECT_EQ(vesper_scene_add_mesh(scene, &mesh, &index, &error), VESPER_OK);
        const std::vector<float> origin = at(0, 0, 0);
        EXPECT_EQ(vesper_scene_add_node(scene, "ground", index, origin.data(), &index, &error), VESPER_OK);
        const VesperLamp lamp = candle();
        EXPECT_EQ(vesper_scene_add_lamp(scene, &lamp, &index, &error), VESPER_OK);
        EXPECT_EQ(vesper_renderer_create(device, scene, &renderer, &error), VESPER_OK);
        vesper_tone_settings_defaults(&settings, sizeof settings);
        settings.glare = VESPER_GLARE_CIE;
    }
    ~CSharedEye() override {
        vesper_shared_eye_destroy(eye);
        vesper_renderer_destroy(renderer);
        vesper_scene_destroy(scene);
        vesper_device_close(device);
    }
    void make(uint32_t views) {
        ASSERT_EQ(vesper_shared_eye_create(device, views, &eye, &error), VESPER_OK) << error.message;
    }
    static VesperOutputs codes_to(std::vector<uint8_t>& codes) {
        codes.assign(size_t{4} * kSide * kSide, 0);
        VesperOutputs to = VESPER_INIT(VesperOutputs);
        to.codes = codes.data();
        return to;
    }
    std::vector<uint8_t> shown(uint32_t index) {
        std::vector<uint8_t> codes;
        const VesperOutputs to = codes_to(codes);
        EXPECT_EQ(vesper_shared_eye_show(eye, index, &settings, &to, &error), VESPER_OK) << error.message;
        return codes;
    }
    void look(uint32_t index, const VesperView& view) {
        ASSERT_EQ(vesper_shared_eye_look(eye, index, renderer, &settings, &view, &error), VESPER_OK) << error.message;
    }

    VesperError error{};
    VesperDevice* device = nullptr;
    VesperScene* scene = nullptr;
    VesperRenderer* renderer = nullptr;
    VesperSharedEye* eye = nullptr;
    VesperToneSettings settings = VESPER_INIT(VesperToneSettings);
};

// One view: the frames of a renderer, as the eye adapts.
TEST_F(CSharedEye, OfOneViewSeesWhatARendererShows) {
    make(1);
    for (const float seconds : {0.0f, 0.2f, 2.0f}) {
        const VesperView view = down(seconds);
        std::vector<uint8_t> want;
        VesperOutputs to = codes_to(want);
        VesperFrameReport of_frame = VESPER_INIT(VesperFrameReport), of_eye = VESPER_INIT(VesperFrameReport);
        to.report = &of_frame;
        ASSERT_EQ(vesper_render(renderer, &settings, &view, seconds, &to, &error), VESPER_OK) << error.message;
        look(0, view);
        ASSERT_EQ(vesper_shared_eye_adapt(eye, &settings, 0, seconds, &of_eye, &error), VESPER_OK) << error.message;
        EXPECT_EQ(shown(0), want);
        EXPECT_EQ(of_eye.adaptation, of_frame.adaptation);
        EXPECT_EQ(of_eye.log_average, of_frame.log_average);
    }
    ASSERT_EQ(vesper_shared_eye_reset(eye, &error), VESPER_OK);
}

// Two views share one curve: where they look at the same they show the same, and a bright one changes the dim one.
TEST_F(CSharedEye, OfTwoViewsAdaptsToBoth) {
    make(2);
    look(0, down()), look(1, down());
    ASSERT_EQ(vesper_shared_eye_adapt(eye, &settings, 0, 0, nullptr, &error), VESPER_OK) << error.message;
    const std::vector<uint8_t> both = shown(0);
    EXPECT_EQ(shown(1), both);
    ASSERT_EQ(vesper_shared_eye_reset(eye, &error), VESPER_OK);
    look(0, down()), look(1, down(5));  // 5 m off, 130 times darker
    ASSERT_EQ(vesper_shared_eye_adapt(eye, &settings, 1, 0, nullptr, &error), VESPER_OK) << error.message;
    EXPECT_NE(shown(0), both);
    EXPECT_NE(shown(1), shown(0));
}

TEST_F(CSharedEye, RefusesWhatDoesNotGoTogether) {
    EXPECT_EQ(vesper_shared_eye_create(device, 0, &eye, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_shared_eye_create(device, 17, &eye, &error), VESPER_BAD_ARGUMENT);
    EXPECT_STREQ(error.message, "a shared eye has 1 to 16 views");
    make(2);
    const VesperView view = down();
    EXPECT_EQ(vesper_shared_eye_look(eye, 2, renderer, &settings, &view, &error), VESPER_BAD_ARGUMENT);
    look(0, view);
    EXPECT_EQ(vesper_shared_eye_adapt(eye, &settings, 0, 0, nullptr, &error), VESPER_BAD_ARGUMENT);
    EXPECT_STREQ(error.message, "a view was not looked at since the last adaptation");
    std::vector<uint8_t> codes;
    VesperOutputs to = codes_to(codes);
    EXPECT_EQ(vesper_shared_eye_show(eye, 0, &settings, &to, &error), VESPER_BAD_ARGUMENT);
    look(1, view);
    ASSERT_EQ(vesper_shared_eye_adapt(eye, &settings, 0, 0, nullptr, &error), VESPER_OK) << error.message;
    std::vector<float> luminance(codes.size());
    to.luminance = luminance.data();
    EXPECT_EQ(vesper_shared_eye_show(eye, 0, &settings, &to, &error), VESPER_BAD_ARGUMENT);
    settings.tone_operator = VESPER_LDR;
    EXPECT_EQ(vesper_shared_eye_look(eye, 0, renderer, &settings, &view, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_shared_eye_look(nullptr, 0, renderer, &settings, &view, &error), VESPER_BAD_ARGUMENT);
    vesper_shared_eye_destroy(nullptr);
}

}  // namespace
}  // namespace vesper::test
