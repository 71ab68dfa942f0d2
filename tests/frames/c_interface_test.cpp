// The C interface: what it refuses, and that it shows what the engine shows. SPDX-License-Identifier: MIT
#include <vesper/vesper.h>

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "base/one_line.h"
#include "render/renderer.h"
#include "render/tone_mapper.h"
#include "scene/display_file.h"
#include "scene/read_scene.h"
#include "scene/scene_files.h"
#include "support/c_interface.h"

namespace vesper::test {
namespace {

TEST_F(CInterface, MapsAsTheEngineDoes) {
    VesperToneMapper* mapper = nullptr;
    ASSERT_EQ(vesper_tone_mapper_create(device, &mapper, &error), VESPER_OK) << error.message;
    gpu::Device own;
    render::ToneMapper engine(own);
    for (const auto& [width, height] : {std::pair{1u, 1u}, {7u, 5u}, {65u, 33u}}) {
        const std::vector<float> rgb = night_values(width, height);
        const VesperPicture picture = picture_of(rgb, width, height);
        VesperToneSettings settings;
        vesper_tone_settings_defaults(&settings, sizeof settings);
        settings.tone_operator = VESPER_WARD, settings.display_peak = 150, settings.bins = 64;
        std::vector<uint8_t> codes(4 * width * height);
        std::vector<float> light(4 * width * height);
        VesperFrameReport report = VESPER_INIT(VesperFrameReport);
        VesperOutputs outputs = VESPER_INIT(VesperOutputs);
        outputs.codes = codes.data(), outputs.display_light = light.data(), outputs.report = &report;
        ASSERT_EQ(vesper_tone_map(mapper, &settings, &picture, 0.5f, &outputs, &error), VESPER_OK) << error.message;

        render::ToneChainSettings same;
        same.tone_operator = render::Operator::Ward, same.histogram.bins = 64;
        same.display = vision::known_displays().front().display, same.display.peak = 150;
        const render::ToneMapped want =
            engine.map(same, {.extent = {width, height}, .values = rgb, .vertical_fov = double(0.7f)}, 0.5f,
                       {.display_light = true});
        EXPECT_EQ(codes, want.display);
        EXPECT_EQ(light, want.display_light);
        EXPECT_EQ(report.adaptation, want.curve.adaptation);
        EXPECT_EQ(report.not_finite, 0u);
        EXPECT_GT(report.milliseconds, 0);
    }
    vesper_tone_mapper_destroy(mapper);
}

// Each setting, changed alone, is the engine's: the same bits, and others than without it.
TEST_F(CInterface, EverySettingArrives) {
    VesperToneMapper* mapper = nullptr;
    ASSERT_EQ(vesper_tone_mapper_create(device, &mapper, &error), VESPER_OK) << error.message;
    gpu::Device own;
    render::ToneMapper engine(own);
    constexpr uint32_t width = 40, height = 30;
    std::vector<float> rgb = night_values(width, height);
    for (size_t i = 0; i < 3; ++i) rgb[3 * (width * 9 + 11) + i] = 3e5f / float(i + 1);  // a warm lamp
    VesperPicture picture = picture_of(rgb, width, height);
    picture.scale = 0.01f;
    struct Case {
        const char* name;
        void (*set)(VesperToneSettings&);
        void (*same)(render::ToneChainSettings&);
        float fov = 0.05f;
    };
    const Case cases[] = {
        {"ward", [](auto& s) { s.tone_operator = VESPER_WARD; },
         [](auto& e) { e.tone_operator = render::Operator::Ward; }},
        {"grave", [](auto& s) { s.tone_operator = VESPER_GRAVE; },
         [](auto& e) { e.tone_operator = render::Operator::Grave; }},
        {"bins", [](auto& s) { s.bins = 7; }, [](auto& e) { e.histogram.bins = 7; }},
        {"low", [](auto& s) { s.histogram_low = 0.1f; }, [](auto& e) { e.histogram.low = 0.1f; }},
        {"high", [](auto& s) { s.histogram_high = 100; }, [](auto& e) { e.histogram.high = 100; }},
        {"age", [](auto& s) { s.age = 80; }, [](auto& e) { e.tone.observer.age = 80, e.scatter.eye.age = 80; }},
        {"low vision", [](auto& s) { s.low_vision = 10; }, [](auto& e) { e.tone.observer.low_vision = 10; }},
        {"rods", [](auto& s) { s.rods = 1; }, [](auto& e) { e.tone.observer.use_rods = true; }},
        {"gaze", [](auto& s) { s.gaze[0] = 0.1f, s.gaze[1] = 0.9f; },
         [](auto& e) {
             e.tone.gaze = {0.1f, 0.9f};
         }},
        {"average", [](auto& s) { s.adapt_to = VESPER_ADAPT_AVERAGE; },
         [](auto& e) { e.tone.adapt_to = shared::kAdaptAverage; }},
        {"texel", [](auto& s) { s.adapt_to = VESPER_ADAPT_TEXEL; },
         [](auto& e) { e.tone.adapt_to = shared::kAdaptTexel; }},
        {"colour", [](auto& s) { s.colour_loss = 1; }, [](auto& e) { e.tone.colour_loss = true; }},
        {"acuity", [](auto& s) { s.acuity_loss = 1; }, [](auto& e) { e.tone.acuity_loss = true; },
         0.02f},  // fine enough for what dim light loses
        {"purkinje", [](auto& s) { s.purkinje = 1; }, [](auto& e) { e.tone.purkinje = true; }},
        {"chromaticity", [](auto& s) { s.gamut = VESPER_GAMUT_CHROMATICITY; },
         [](auto& e) { e.tone.gamut = shared::kGamutChromaticity; }},
        {"clip", [](auto& s) { s.gamut = VESPER_GAMUT_CLIP; }, [](auto& e) { e.tone.gamut = shared::kGamutClip; }},
        {"key", [](auto& s) { s.tone_operator = VESPER_REINHARD, s.key = 0.5f; },
         [](auto& e) { e.tone_operator = render::Operator::Reinhard, e.tone.operators.reinhard.key = 0.5f; }},
        {"white", [](auto& s) { s.tone_operator = VESPER_REINHARD, s.white = 50; },
         [](auto& e) { e.tone_operator = render::Operator::Reinhard, e.tone.operators.reinhard.white = 50; }},
        {"drago", [](auto& s) { s.tone_operator = VESPER_DRAGO, s.options = " bias=0.6  automatic=1"; },
         [](auto& e) { e.tone_operator = render::Operator::Drago, e.tone.operators.drago.bias = 0.6f; }},
        {"all by name, over fields",
         [](auto& s) {
             s.bins = 50, s.glare = VESPER_GLARE_CIE;
             s.options = "bins=9 adapt-to=texel fast-seconds=0.2 rods=on iris=1.2 glare=ward histogram_low=0.01";
         },
         [](auto& e) {
             e.histogram.bins = 9, e.histogram.low = 0.01f, e.tone.adapt_to = shared::kAdaptTexel;
             e.tone.observer.cones.fast_seconds = 0.2, e.tone.observer.use_rods = true;
             e.glare = render::Glare::Scatter, e.scatter.model = eye::ScatterSettings::Model::Ward;
             e.scatter.eye.pigmentation = 1.2;
         }},
        {"linear", [](auto& s) { s.tone_operator = VESPER_LINEAR, s.white = 50, s.black = 1; },
         [](auto& e) { e.tone_operator = render::Operator::Linear, e.tone.operators.linear = {.low = 1, .high = 50}; }},
        {"gamma", [](auto& s) { s.display_gamma = 1.8f; }, [](auto& e) { e.display.gamma = 1.8f; }},
        {"reflection", [](auto& s) { s.display_reflection = 0.1f; }, [](auto& e) { e.display.reflection = 0.1f; }},
        {"ambient", [](auto& s) { s.display_ambient = 500; }, [](auto& e) { e.display.ambient = 500; }},
        {"profile", [](auto& s) { s.display = "projector"; },
         [](auto& e) { e.display = scene::find_display("projector"); }},
        {"cie", [](auto& s) { s.glare = VESPER_GLARE_CIE, s.pigmentation = 1.2f; },
         [](auto& e) { e.glare = render::Glare::Scatter, e.scatter.eye.pigmentation = double(1.2f); }},
        {"ward's veil", [](auto& s) { s.glare = VESPER_GLARE_WARD; },
         [](auto& e) { e.glare = render::Glare::Scatter, e.scatter.model = eye::ScatterSettings::Model::Ward; }},
        {"spencer", [](auto& s) { s.glare = VESPER_GLARE_SPENCER, s.pupil = VESPER_PUPIL_SCOTOPIC; },
         [](auto& e) {
             e.glare = render::Glare::Scatter, e.scatter.model = eye::ScatterSettings::Model::Spencer,
             e.scatter.state = vision::SpencerState::Scotopic;
         }},
        {"temporal", [](auto& s) { s.glare = VESPER_GLARE_TEMPORAL, s.eye_seed = 5, s.lashes = 1; },
         [](auto& e) {
             e.glare = render::Glare::Scatter, e.scatter.model = eye::ScatterSettings::Model::Temporal,
             e.scatter.aperture = {5, true};
         }},
        {"paper's glare", [](auto& s) { s.glare = VESPER_GLARE_LDR; }, [](auto& e) { e.glare = render::Glare::Ldr; }},
    };
    std::vector<uint8_t> codes(4 * width * height);
    std::map<float, std::vector<uint8_t>> plain;
    VesperOutputs outputs = VESPER_INIT(VesperOutputs);
    outputs.codes = codes.data();
    for (const Case& c : cases) {
        picture.vertical_fov = c.fov;
        if (!plain.contains(c.fov)) {
            ASSERT_EQ(vesper_tone_mapper_reset(mapper, &error), VESPER_OK);
            ASSERT_EQ(vesper_tone_map(mapper, nullptr, &picture, 0, &outputs, &error), VESPER_OK) << error.message;
            plain[c.fov] = codes;
        }
        VesperToneSettings settings;
        vesper_tone_settings_defaults(&settings, sizeof settings);
        c.set(settings);
        ASSERT_EQ(vesper_tone_mapper_reset(mapper, &error), VESPER_OK);
        ASSERT_EQ(vesper_tone_map(mapper, &settings, &picture, 0, &outputs, &error), VESPER_OK)
            << c.name << ": " << error.message;
        render::ToneChainSettings same;
        same.tone.observer.age = same.scatter.eye.age = 23, same.display = vision::known_displays().front().display;
        c.same(same);
        engine.reset_adaptation();
        const render::HostPicture shown{.extent = {width, height},
                                        .values = rgb,
                                        .scale = picture.scale,
                                        .vertical_fov = double(picture.vertical_fov)};
        EXPECT_TRUE(codes == engine.map(same, shown, 0).display) << c.name;
        EXPECT_TRUE(codes != plain.at(c.fov)) << c.name;
    }
    vesper_tone_mapper_destroy(mapper);
}

// Between two pictures of one tone mapper.
TEST_F(CInterface, EditedDisplayFilesAreReadAgain) {
    const TempFolder folder;
    VesperToneMapper* mapper = nullptr;
    ASSERT_EQ(vesper_tone_mapper_create(device, &mapper, &error), VESPER_OK) << error.message;
    const std::vector<float> rgb = night_values(8, 8);
    const VesperPicture picture = picture_of(rgb, 8, 8);
    VesperToneSettings settings;
    vesper_tone_settings_defaults(&settings, sizeof settings);
    settings.tone_operator = VESPER_WARD;
    std::vector<uint8_t> codes(4 * 64);
    VesperOutputs outputs = VESPER_INIT(VesperOutputs);
    outputs.codes = codes.data();
    const auto shown = [&](const char* display) {
        settings.display = display;
        EXPECT_EQ(vesper_tone_map(mapper, &settings, &picture, 0, &outputs, &error), VESPER_OK) << error.message;
        return codes;
    };
    const auto lcd = shown("lcd"), projector = shown("projector");
    ASSERT_NE(lcd, projector);
    const auto edited = [&](const char* as) {
        return folder.write("d.json", scene::display_json(scene::find_display(as), "")).string();
    };
    const std::string file = edited("lcd");
    EXPECT_EQ(shown(file.c_str()), lcd);
    edited("projector");
    EXPECT_EQ(shown(file.c_str()), projector);
    std::filesystem::remove(file);
    EXPECT_EQ(vesper_tone_map(mapper, &settings, &picture, 0, &outputs, &error), VESPER_FAILED);
    vesper_tone_mapper_destroy(mapper);
}

// What curves are smoothed over shows in the frame after.
TEST_F(CInterface, SmoothingArrives) {
    const std::vector<float> dark(3 * 64, 0.5f), bright(3 * 64, 5.0f);
    const auto second = [&](float smoothing) {
        VesperToneMapper* mapper = nullptr;
        EXPECT_EQ(vesper_tone_mapper_create(device, &mapper, &error), VESPER_OK);
        VesperToneSettings settings;
        vesper_tone_settings_defaults(&settings, sizeof settings);
        settings.tone_operator = VESPER_WARD, settings.smoothing = smoothing;
        std::vector<uint8_t> codes(4 * 64);
        VesperOutputs outputs = VESPER_INIT(VesperOutputs);
        outputs.codes = codes.data();
        for (const auto* rgb : {&dark, &bright}) {
            const VesperPicture picture = picture_of(*rgb, 8, 8);
            EXPECT_EQ(vesper_tone_map(mapper, &settings, &picture, 0.1f, &outputs, &error), VESPER_OK) << error.message;
        }
        vesper_tone_mapper_destroy(mapper);
        return codes;
    };
    EXPECT_NE(second(0), second(5));
}

// An older caller's structure is filled as far as it goes.
TEST_F(CInterface, DefaultsKeepToTheSizeTheyAreGiven) {
    VesperToneSettings settings;
    std::memset(&settings, 0x55, sizeof settings);
    vesper_tone_settings_defaults(&settings, offsetof(VesperToneSettings, age));
    EXPECT_EQ(settings.size, offsetof(VesperToneSettings, age));
    EXPECT_EQ(settings.bins, 100u);
    for (size_t i = offsetof(VesperToneSettings, age); i < sizeof settings; ++i)
        ASSERT_EQ(reinterpret_cast<unsigned char*>(&settings)[i], 0x55);
    vesper_tone_settings_defaults(&settings, sizeof settings);
    EXPECT_EQ(settings.options, nullptr);
    vesper_tone_settings_defaults(nullptr, 0);
    uint32_t version[3]{9, 9, 9};
    vesper_version(version);
    EXPECT_EQ(version[1], uint32_t(VESPER_VERSION_MINOR));
    EXPECT_EQ(version[0], uint32_t(VESPER_VERSION_MAJOR));
    EXPECT_EQ(version[2], uint32_t(VESPER_VERSION_PATCH));
}

TEST_F(CInterface, RefusesWhatCannotBeAndTouchesNothing) {
    VesperToneMapper* mapper = nullptr;
    ASSERT_EQ(vesper_tone_mapper_create(device, &mapper, &error), VESPER_OK);
    const std::vector<float> rgb(12, 1.0f);
    std::vector<uint8_t> codes(16, 77);
    const auto refuses = [&](auto change) {
        VesperPicture picture = picture_of(rgb, 2, 2);
        VesperToneSettings settings;
        vesper_tone_settings_defaults(&settings, sizeof settings);
        VesperOutputs outputs = VESPER_INIT(VesperOutputs);
        outputs.codes = codes.data();
        float seconds = 0;
        change(picture, settings, outputs, seconds);
        error = {};
        const VesperResult result = vesper_tone_map(mapper, &settings, &picture, seconds, &outputs, &error);
        EXPECT_NE(result, VESPER_OK);
        EXPECT_GT(std::strlen(error.message), 10u);
        EXPECT_EQ(codes, std::vector<uint8_t>(16, 77));
        return std::string(error.message);
    };
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    refuses([](auto& p, auto&, auto&, auto&) { p.size = 0; });
    refuses([](auto& p, auto&, auto&, auto&) { p.width = 0; });
    refuses([](auto& p, auto&, auto&, auto&) { p.height = 1u << 31; });
    refuses([](auto& p, auto&, auto&, auto&) { p.channels = 2; });
    refuses([](auto& p, auto&, auto&, auto&) { p.values = nullptr; });
    refuses([](auto& p, auto&, auto&, auto&) { p.scale = kNan; });
    refuses([](auto& p, auto&, auto&, auto&) { p.vertical_fov = 4; });
    refuses([](auto& p, auto&, auto&, auto&) { p.edges[0] = 1; });
    refuses([](auto&, auto& s, auto&, auto&) { s.tone_operator = uint32_t(render::Operator::Ldr); });
    refuses([](auto&, auto& s, auto&, auto&) { s.tone_operator = 99; });
    refuses([](auto&, auto& s, auto&, auto&) { s.glare = 9; });
    refuses([](auto&, auto& s, auto&, auto&) { s.bins = 257; });
    refuses([](auto&, auto& s, auto&, auto&) { s.adapt_to = 5; });
    refuses([](auto&, auto& s, auto&, auto&) { s.pupil = 3; });
    refuses([](auto&, auto& s, auto&, auto&) { s.gamut = 3; });
    for (const char* options : {"bias", "bias=", "bias=x", "bias=0.7x", "bias=2", "bias=nan", "bia=0.7", "=1",
                                "automatic=2", "devlin-contrast=0.4,bias=0.7", "operator=ldr", "glare=moss", "pupil=3"})
        refuses([&](auto&, auto& s, auto&, auto&) { s.options = options; });
    const std::string long_options = std::string(4096, ' ') + "bias=0.7";
    refuses([&](auto&, auto& s, auto&, auto&) { s.options = long_options.c_str(); });
    refuses([](auto&, auto& s, auto&, auto&) { s.smoothing = -1; });
    refuses([](auto&, auto& s, auto&, auto&) { s.low_vision = 0; });
    refuses([](auto&, auto& s, auto&, auto&) { s.histogram_high = s.histogram_low; });
    refuses([](auto&, auto& s, auto&, auto&) { s.key = kNan; });
    refuses([](auto&, auto& s, auto&, auto&) { s.white = 1, s.black = 2; });
    refuses([](auto&, auto& s, auto&, auto&) { s.display_gamma = 0; });
    refuses([](auto&, auto& s, auto&, auto&) { s.age = kNan; });
    refuses([](auto&, auto& s, auto&, auto&) { s.gaze[1] = kNan; });
    refuses([](auto&, auto& s, auto&, auto&) { s.display_peak = -1; });
    EXPECT_NE(refuses([](auto&, auto& s, auto&, auto&) { s.display = "no such display"; }).find("no such display"),
              std::string::npos);
    refuses([](auto&, auto&, auto& o, auto&) { o.size = 0; });
    refuses([](auto&, auto&, auto&, auto& seconds) { seconds = -1; });
    refuses([](auto&, auto&, auto&, auto& seconds) { seconds = kNan; });
    EXPECT_EQ(vesper_tone_map(nullptr, nullptr, nullptr, 0, nullptr, nullptr), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_tone_mapper_create(nullptr, &mapper, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_scene_read("/nothing.gltf", nullptr, &error), VESPER_BAD_ARGUMENT);
    VesperScene* scene = nullptr;
    EXPECT_EQ(vesper_scene_read("/nothing.gltf", &scene, &error), VESPER_FAILED);
    EXPECT_NE(std::string(error.message).find("/nothing.gltf"), std::string::npos);
    EXPECT_EQ(vesper_scene_read_allowing("/nothing.gltf", nullptr, &scene, &error), VESPER_BAD_ARGUMENT);
    // A buffer beside the scene's folder.
    const TempFolder folder;
    std::filesystem::create_directory(folder / "scene");
    folder.write("buffer.bin", std::string(36, '\0'));
    const std::string file = folder.write(
        "scene/s.gltf", R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36, "uri": "../buffer.bin"}]})");
    EXPECT_EQ(vesper_scene_read(file.c_str(), &scene, &error), VESPER_FAILED);
    EXPECT_NE(std::string(error.message).find("outside"), std::string::npos) << error.message;
    EXPECT_EQ(vesper_scene_read_allowing(file.c_str(), folder.path().c_str(), &scene, &error), VESPER_OK)
        << error.message;
    vesper_scene_destroy(scene);
    vesper_tone_mapper_destroy(mapper);
    vesper_version(nullptr);
    vesper_tone_mapper_destroy(nullptr), vesper_renderer_destroy(nullptr), vesper_scene_destroy(nullptr),
        vesper_device_close(nullptr);
}

// Whatever a caller's names hold: one line of whole characters, cut off where it does not fit.
TEST_F(CInterface, MessagesAreALineOfWholeCharacters) {
    std::string accents;
    while (accents.size() < 1400) accents += "\u00e9";
    VesperScene* scene = nullptr;
    VesperRenderer* renderer = nullptr;
    ASSERT_EQ(vesper_scene_create(&scene, &error), VESPER_OK);
    ASSERT_EQ(vesper_renderer_create(device, scene, &renderer, &error), VESPER_OK) << error.message;
    VesperView view = VESPER_INIT(VesperView);
    view.width = view.height = 8;
    const VesperOutputs nothing = VESPER_INIT(VesperOutputs);
    for (const std::string& name :
         {accents, "x" + accents, std::string("two\nlines\r\x1b[31m"), std::string("no \xff UTF-8")}) {
        view.camera = name.c_str();
        EXPECT_EQ(vesper_render(renderer, nullptr, &view, 0, &nothing, &error), VESPER_FAILED);
        EXPECT_EQ(one_line(error.message, sizeof error), error.message);
        EXPECT_NE(std::string(error.message).find(name.substr(0, 2)), std::string::npos) << error.message;
        VesperDeviceOptions options = VESPER_INIT(VesperDeviceOptions);
        options.select = name.c_str();
        VesperDevice* other = nullptr;
        EXPECT_EQ(vesper_device_open(&options, &other, &error), VESPER_FAILED);
        EXPECT_EQ(one_line(error.message, sizeof error), error.message);
    }
    vesper_renderer_destroy(renderer), vesper_scene_destroy(scene);
}

// Fields are added at the end: a caller that knows more may say so, one with less than the first version has made a
// mistake.
TEST_F(CInterface, SizesAreOfTheFirstVersionAtLeast) {
    VesperToneMapper* mapper = nullptr;
    ASSERT_EQ(vesper_tone_mapper_create(device, &mapper, &error), VESPER_OK);
    const std::vector<float> rgb = night_values(9, 9);
    VesperPicture picture = picture_of(rgb, 9, 9);
    std::vector<uint8_t> codes(4 * 81, 77);
    VesperToneSettings settings;
    vesper_tone_settings_defaults(&settings, sizeof settings);
    VesperFrameReport report = VESPER_INIT(VesperFrameReport);
    VesperOutputs outputs = VESPER_INIT(VesperOutputs);
    outputs.codes = codes.data(), outputs.report = &report;
    const auto result = [&] { return vesper_tone_map(mapper, &settings, &picture, 0, &outputs, &error); };
    for (uint32_t* size : {&settings.size, &picture.size, &outputs.size, &report.size}) {
        const uint32_t right = *size;
        const uint32_t first = size == &settings.size ? uint32_t(offsetof(VesperToneSettings, options)) : right;
        for (const uint32_t wrong : {0u, 6u, first - 1, 65537u}) {
            if (size == &report.size && wrong > right) continue;
            *size = wrong;
            EXPECT_EQ(result(), VESPER_BAD_ARGUMENT) << wrong;
            EXPECT_EQ(codes, std::vector<uint8_t>(4 * 81, 77));
        }
        *size = first;
        EXPECT_EQ(result(), VESPER_OK) << error.message;
        std::fill(codes.begin(), codes.end(), uint8_t(77));
        *size = right;
    }
    settings.size += 8, report.size += 8;
    EXPECT_EQ(result(), VESPER_OK) << error.message;
    EXPECT_EQ(report.size, sizeof report);
    vesper_tone_mapper_destroy(mapper);
}

TEST_F(CInterface, DisplaysSayHowManyBitsTheirCodesHave) {
    uint32_t bits = 0;
    ASSERT_EQ(vesper_display_bits("hdr10", &bits, &error), VESPER_OK) << error.message;
    EXPECT_EQ(bits, 10u);
    ASSERT_EQ(vesper_display_bits("projector", &bits, &error), VESPER_OK) << error.message;
    EXPECT_EQ(bits, 8u);
    EXPECT_EQ(vesper_display_bits("no such display", &bits, &error), VESPER_FAILED);
    EXPECT_EQ(vesper_display_bits(nullptr, &bits, &error), VESPER_BAD_ARGUMENT);
}

// 1 cd at 1 m on ground of reflectance 1 gives 1 / pi cd/m^2; moved 3 m up, a ninth.
TEST_F(CInterface, LampsOfOnesOwnLightAndMove) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("c_interface_" + std::to_string(::getpid()) + ".gltf");
    std::ofstream(file)
        << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": "ground", "mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}]}], "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0}}],
 "buffers": [{"byteLength": 108, "uri": "data:application/octet-stream;base64,AACgwQAAAAAAAKBBAACgQQAAAAAAAKBBAACgQQAAAAAAAKDBAACgwQAAAAAAAKDBAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAABAAIAAAACAAMA"}],
 "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 48}, {"buffer": 0, "byteOffset": 96, "byteLength": 12}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-20, 0, -20], "max": [20, 0, 20]},
               {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"}, {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}]})";
    VesperScene* scene = nullptr;
    ASSERT_EQ(vesper_scene_read(file.c_str(), &scene, &error), VESPER_OK) << error.message;
    std::filesystem::remove(file);
    EXPECT_STREQ(vesper_scene_node_name(scene, 0), "ground");
    EXPECT_EQ(vesper_scene_node_name(scene, 1), nullptr);
    VesperLamp lamp = VESPER_INIT(VesperLamp);
    lamp.position[1] = 1, lamp.intensity = 1, lamp.colour[0] = lamp.colour[1] = lamp.colour[2] = 3;
    uint32_t node = 99;
    ASSERT_EQ(vesper_scene_add_lamp(scene, &lamp, &node, &error), VESPER_OK) << error.message;
    EXPECT_EQ(node, 1u);
    EXPECT_EQ(vesper_scene_node_count(scene), 2u);
    lamp.colour[0] = -1;
    EXPECT_EQ(vesper_scene_add_lamp(scene, &lamp, &node, &error), VESPER_BAD_ARGUMENT);
    VesperRenderer* renderer = nullptr;
    ASSERT_EQ(vesper_renderer_create(device, scene, &renderer, &error), VESPER_OK) << error.message;

    VesperView view = VESPER_INIT(VesperView);
    view.width = view.height = 9, view.eye[1] = 0.5f, view.forward[1] = -2, view.up[2] = -3, view.vertical_fov = 0.02f,
    view.near_plane = 0.1f;
    std::vector<float> luminance(4 * 81);
    VesperOutputs outputs = VESPER_INIT(VesperOutputs);
    outputs.luminance = luminance.data();
    ASSERT_EQ(vesper_render(renderer, nullptr, &view, 0, &outputs, &error), VESPER_OK) << error.message;
    EXPECT_NEAR(luminance[4 * 40] * 3.14159265f, 1, 2e-3);  // F0 of the surface is 0.04 (1 - 1), roughness 1: matt
    const float up[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 3, 0, 1};
    ASSERT_EQ(vesper_renderer_place(renderer, node, up, &error), VESPER_OK);
    ASSERT_EQ(vesper_render(renderer, nullptr, &view, 0, &outputs, &error), VESPER_OK);
    EXPECT_NEAR(luminance[4 * 40] * 3.14159265f, 1.0 / 9, 3e-4);
    const float flat[16] = {};
    EXPECT_EQ(vesper_renderer_place(renderer, node, flat, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_renderer_place(renderer, 7, up, &error), VESPER_BAD_ARGUMENT);
    view.up[2] = 0, view.up[1] = 1;
    EXPECT_EQ(vesper_render(renderer, nullptr, &view, 0, &outputs, &error), VESPER_BAD_ARGUMENT)
        << "up and forward are one line";
    view.camera = "nobody";
    EXPECT_EQ(vesper_render(renderer, nullptr, &view, 0, &outputs, &error), VESPER_FAILED);
    vesper_renderer_destroy(renderer);
    vesper_scene_destroy(scene);
}

}  // namespace
}  // namespace vesper::test
