// A device and images of the host's through the C interface: the same bytes as through arrays, nothing borrowed
// destroyed, nothing said by the validation layer. SPDX-License-Identifier: MIT
#include "support/host_device.h"

#include <chrono>
#include <cmath>
#include <mutex>
#include <string>
#include <thread>

namespace vesper::test {
namespace {

constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                        kCopied = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
constexpr float kScale = 50;

// Frame by frame another picture, in units of kScale cd/m^2.
std::vector<float> street(VkExtent2D extent, unsigned frame) {
    std::vector<float> rgb;
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        const float l = std::pow(10.0f, -4 + 5 * float((i + 7 * frame) % 101) / 101);
        rgb.insert(rgb.end(), {l, 0.7f * l, 0.4f * l});
    }
    return rgb;
}

class OwnDevice : public ::testing::Test {
protected:
    explicit OwnDevice(const std::function<void(HostFeatures&, VkDeviceCreateInfo&)>& made = {}) : host(made) {}
    void SetUp() override {
        ASSERT_TRUE(host.validated()) << "without the layer these tests say little";
        const VesperHostDevice lent = host.lent();
        ASSERT_EQ(vesper_device_borrow(&lent, &device, &error), VESPER_OK) << error.message;
        ASSERT_EQ(vesper_tone_mapper_create(device, &mapper, &error), VESPER_OK) << error.message;
        vesper_tone_settings_defaults(&settings, sizeof settings);
    }
    void TearDown() override {
        vesper_tone_mapper_destroy(mapper);
        vesper_device_close(device);
        host->wait(time);
        for (::Image* image : {&picture, &shown}) host->destroy(*image);
    }
    void make_images(VkExtent2D size, VkFormat codes) {
        for (::Image* image : {&picture, &shown}) host->destroy(*image);
        extent = size, format = codes;
        picture = host->make_image(VK_FORMAT_R32G32B32A32_SFLOAT, size,
                                   VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
        shown = host->make_image(codes, size, VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    }
    VesperResult map_image(const VesperHandover* handover = nullptr) {
        const VesperImage from = described(picture, VK_FORMAT_R32G32B32A32_SFLOAT, extent, kRead, kRead);
        const VesperImage to = described(shown, format, extent, VK_IMAGE_LAYOUT_UNDEFINED, kCopied);
        VesperImagePicture given = VESPER_INIT(VesperImagePicture);
        given.image = &from, given.scale = kScale, given.vertical_fov = 0.7f;
        return vesper_tone_map_image(mapper, &settings, &given, 0.1f, &to, handover, &error);
    }
    void draw(unsigned frame) {
        host->submit([&](VkCommandBuffer commands) { draw_pixels(commands, picture, extent, street(extent, frame)); },
                     ++time);
    }
    std::vector<uint8_t> read() { return host->read(shown, extent, ++time); }
    std::vector<uint8_t> map_array(VesperToneMapper* other, unsigned frame) {
        const std::vector<float> rgb = street(extent, frame);
        VesperPicture given = VESPER_INIT(VesperPicture);
        given.width = extent.width, given.height = extent.height, given.channels = 3, given.values = rgb.data(),
        given.scale = kScale, given.vertical_fov = 0.7f;
        std::vector<uint8_t> codes(size_t{4} * extent.width * extent.height);
        VesperOutputs outputs = VESPER_INIT(VesperOutputs);
        outputs.codes = codes.data();
        EXPECT_EQ(vesper_tone_map(other, &settings, &given, 0.1f, &outputs, &error), VESPER_OK) << error.message;
        return codes;
    }
    static std::vector<uint8_t> eye_of(VesperToneMapper* of) {
        std::vector<uint8_t> eye(vesper_eye_size());
        VesperError why;
        EXPECT_EQ(vesper_tone_mapper_eye(of, eye.data(), &why), VESPER_OK) << why.message;
        return eye;
    }

    HostDevice host;
    VesperDevice* device = nullptr;
    VesperToneMapper* mapper = nullptr;
    VesperToneSettings settings;
    VesperError error;
    ::Image picture, shown;
    VkExtent2D extent{};
    VkFormat format{};
    uint64_t time = 0;
};

// Seven frames of an eye that adapts, without waiting for any, then the last one's codes: all bits as through arrays.
TEST_F(OwnDevice, MapsImagesAsArrays) {
    struct Case {
        VkExtent2D extent;
        VkFormat format;
        const char* display;
        uint32_t glare;
        bool blue_first;
    };
    const Case cases[] = {{{1, 1}, VK_FORMAT_R8G8B8A8_UNORM, nullptr, VESPER_GLARE_NONE, false},
                          {{7, 5}, VK_FORMAT_B8G8R8A8_UNORM, nullptr, VESPER_GLARE_CIE, true},
                          {{65, 33}, VK_FORMAT_R8G8B8A8_SRGB, nullptr, VESPER_GLARE_TEMPORAL, false},
                          {{33, 17}, VK_FORMAT_A2B10G10R10_UNORM_PACK32, "hdr10", VESPER_GLARE_NONE, false},
                          {{33, 17}, VK_FORMAT_R8G8B8A8_UNORM, nullptr, VESPER_GLARE_LDR, false}};
    VesperToneMapper* other = nullptr;
    ASSERT_EQ(vesper_tone_mapper_create(device, &other, &error), VESPER_OK);
    for (const Case& c : cases) {
        make_images(c.extent, c.format);
        settings.display = c.display, settings.glare = c.glare;
        std::vector<uint8_t> want;
        for (unsigned frame = 0; frame < 7; ++frame) {
            draw(frame);
            ASSERT_EQ(map_image(), VESPER_OK) << error.message;
            want = map_array(other, frame);
        }
        if (c.blue_first)
            for (size_t i = 0; i < want.size(); i += 4) std::swap(want[i], want[i + 2]);
        EXPECT_EQ(read(), want) << c.extent.width << " x " << c.extent.height << ", format " << c.format;
        EXPECT_EQ(eye_of(mapper), eye_of(other));
    }
    vesper_tone_mapper_destroy(other);
}

/// Made without the extensions that are used where a device has them.
class BareDevice : public OwnDevice {
protected:
    BareDevice() : OwnDevice([](HostFeatures&, VkDeviceCreateInfo& info) { info.enabledExtensionCount = 0; }) {}
};

TEST_F(BareDevice, MapsImagesAsAnyOther) {
    VesperDevice* own = nullptr;
    VesperToneMapper* other = nullptr;
    ASSERT_EQ(vesper_device_open(nullptr, &own, &error), VESPER_OK) << error.message;
    ASSERT_EQ(vesper_tone_mapper_create(own, &other, &error), VESPER_OK) << error.message;
    make_images({65, 33}, VK_FORMAT_R8G8B8A8_UNORM);
    settings.glare = VESPER_GLARE_CIE;
    std::vector<uint8_t> want;
    for (unsigned frame = 0; frame < 7; ++frame) {
        draw(frame);
        ASSERT_EQ(map_image(), VESPER_OK) << error.message;
        want = map_array(other, frame);
    }
    EXPECT_EQ(read(), want);
    vesper_tone_mapper_destroy(other);
    vesper_device_close(own);
}

// Other halves of a word: ten bits with blue in the lowest.
TEST_F(OwnDevice, TenBitsBeginWithEither) {
    settings.display = "hdr10";
    const auto words = [&](VkFormat codes) {
        make_images({9, 4}, codes);
        EXPECT_EQ(vesper_tone_mapper_reset(mapper, &error), VESPER_OK);
        draw(0);
        EXPECT_EQ(map_image(), VESPER_OK) << error.message;
        const std::vector<uint8_t> bytes = read();
        std::vector<uint32_t> made(bytes.size() / 4);
        std::memcpy(made.data(), bytes.data(), bytes.size());
        return made;
    };
    const std::vector<uint32_t> red = words(VK_FORMAT_A2B10G10R10_UNORM_PACK32),
                                blue = words(VK_FORMAT_A2R10G10B10_UNORM_PACK32);
    bool coloured = false;
    for (size_t i = 0; i < red.size(); ++i) {
        EXPECT_EQ(blue[i], (red[i] & 0xc00ffc00u) | (red[i] & 0x3ffu) << 20 | (red[i] >> 20 & 0x3ffu));
        coloured = coloured || (red[i] & 0x3ffu) != (red[i] >> 20 & 0x3ffu);
    }
    EXPECT_TRUE(coloured);
}

// Binary and timeline semaphores around it; what waits for Vesper's begins when Vesper is done.
TEST_F(OwnDevice, WaitsAndSignals) {
    make_images({17, 9}, VK_FORMAT_R8G8B8A8_UNORM);
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore binary = VK_NULL_HANDLE;
    check(vkCreateSemaphore(host.device(), &info, nullptr, &binary), "making a semaphore");
    for (unsigned frame = 0; frame < 5; ++frame) {
        draw(frame);
        VkSemaphoreSubmitInfo waits[2]{{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO},
                                       {VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO}},
            signals[2]{waits[0], waits[0]};
        waits[0].semaphore = signals[0].semaphore = host->timeline();
        waits[0].value = time, signals[0].value = ++time;
        waits[1].semaphore = signals[1].semaphore = binary;
        for (VkSemaphoreSubmitInfo* one : {&waits[0], &waits[1], &signals[0], &signals[1]})
            one->stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        VesperHandover handover = VESPER_INIT(VesperHandover);
        handover.wait_count = frame > 0 ? 2 : 1,
        handover.waits = waits;  // the binary one has been signalled by the frame before
        handover.signal_count = 2, handover.signals = signals;
        ASSERT_EQ(map_image(&handover), VESPER_OK) << error.message;
    }
    host->wait(time);  // of Vesper's last signal
    VesperToneMapper* other = nullptr;
    ASSERT_EQ(vesper_tone_mapper_create(device, &other, &error), VESPER_OK);
    std::vector<uint8_t> want;
    for (unsigned frame = 0; frame < 5; ++frame) want = map_array(other, frame);
    EXPECT_EQ(read(), want);
    VesperFrameReport report = VESPER_INIT(VesperFrameReport);
    ASSERT_EQ(vesper_tone_mapper_finish(mapper, &report, &error), VESPER_OK);
    EXPECT_GT(report.adaptation, 0);
    EXPECT_GT(report.milliseconds, 0);
    ASSERT_EQ(vesper_tone_mapper_finish(mapper, &report, &error), VESPER_OK) << "a second time there is none";
    EXPECT_EQ(report.adaptation, 0);
    vesper_tone_mapper_destroy(other);
    vkDestroySemaphore(host.device(), binary, nullptr);
}

// What a picture brought is kept until it is asked for, whatever waits for it before; a call that is refused does not
// even wait.
TEST_F(OwnDevice, ReportsStayUntilTheyAreAskedFor) {
    make_images({16, 16}, VK_FORMAT_R8G8B8A8_UNORM);
    VesperFrameReport report = VESPER_INIT(VesperFrameReport);
    const auto finish = [&] {
        EXPECT_EQ(vesper_tone_mapper_finish(mapper, &report, &error), VESPER_OK) << error.message;
        return report.adaptation;
    };
    const std::vector<uint8_t> rested = eye_of(mapper);
    const std::function<void()> waits[] = {
        [&] { eye_of(mapper); },
        [&] { EXPECT_EQ(vesper_tone_mapper_set_eye(mapper, rested.data(), rested.size(), &error), VESPER_OK); },
        [&] { EXPECT_EQ(vesper_tone_mapper_reset(mapper, &error), VESPER_OK); }, [&] { map_array(mapper, 3); },
        [&] {
            const float grey[3]{1, 1, 1};
            VesperPicture given = VESPER_INIT(VesperPicture);
            given.width = given.height = 1, given.channels = 3, given.values = grey, given.scale = 1,
            given.vertical_fov = 0.7f;
            const VesperOutputs outputs = VESPER_INIT(VesperOutputs);
            EXPECT_EQ(vesper_tone_map(mapper, &settings, &given, -1, &outputs, &error), VESPER_BAD_ARGUMENT);
        }};
    for (const auto& wait : waits) {
        draw(0);
        ASSERT_EQ(map_image(), VESPER_OK) << error.message;
        const float alone = finish();
        EXPECT_GT(alone, 0);
        ASSERT_EQ(vesper_tone_mapper_reset(mapper, &error), VESPER_OK);
        ASSERT_EQ(map_image(), VESPER_OK);
        wait();
        EXPECT_GT(finish(), 0);
        EXPECT_EQ(finish(), 0) << "a second time there is none";
        ASSERT_EQ(vesper_tone_mapper_reset(mapper, &error), VESPER_OK);
    }
}

// What the device took, however late the host asks.
TEST_F(OwnDevice, TimesAreTheDevices) {
    make_images({16, 16}, VK_FORMAT_R8G8B8A8_UNORM);
    VesperFrameReport report = VESPER_INIT(VesperFrameReport);
    const auto start = std::chrono::steady_clock::now();
    draw(0);
    ASSERT_EQ(map_image(), VESPER_OK) << error.message;
    read();  // waits for both
    const double all = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    std::this_thread::sleep_for(std::chrono::seconds(1));
    ASSERT_EQ(vesper_tone_mapper_finish(mapper, &report, &error), VESPER_OK);
    EXPECT_GT(report.milliseconds, 0);
    EXPECT_LT(report.milliseconds, 1.01 * all);
}

// Sizes and settings change while frames are under way: what they use is kept until they are done.
TEST_F(OwnDevice, ChangesUnderWay) {
    make_images({64, 48}, VK_FORMAT_R8G8B8A8_UNORM);
    draw(0);
    for (const auto& [glare, op] : {std::pair{VESPER_GLARE_NONE, VESPER_WARD},
                                    {VESPER_GLARE_CIE, VESPER_IRAWAN},
                                    {VESPER_GLARE_WARD, VESPER_PATTANAIK},
                                    {VESPER_GLARE_SPENCER, VESPER_GRAVE},
                                    {VESPER_GLARE_LDR, VESPER_DURAND}}) {
        settings.glare = glare, settings.tone_operator = op;
        for (int again = 0; again < 2; ++again) ASSERT_EQ(map_image(), VESPER_OK) << error.message;
    }
    ASSERT_EQ(vesper_tone_mapper_reset(mapper, &error), VESPER_OK);
    ASSERT_EQ(map_image(), VESPER_OK) << error.message;
    vesper_tone_mapper_destroy(mapper), mapper = nullptr;  // without waiting
    EXPECT_EQ(read().size(), 4u * 64 * 48);
}

TEST_F(OwnDevice, TheHostGoesOnWithoutVesper) {
    make_images({16, 16}, VK_FORMAT_R8G8B8A8_UNORM);
    draw(0);
    ASSERT_EQ(map_image(), VESPER_OK);
    vesper_tone_mapper_destroy(mapper), mapper = nullptr;
    vesper_device_close(device), device = nullptr;
    const std::vector<uint8_t> codes = read();
    draw(1);
    host->wait(time);
    const VesperHostDevice lent = host.lent();
    ASSERT_EQ(vesper_device_borrow(&lent, &device, &error), VESPER_OK) << "and again with Vesper: " << error.message;
    ASSERT_EQ(vesper_tone_mapper_create(device, &mapper, &error), VESPER_OK);
    draw(0);
    ASSERT_EQ(map_image(), VESPER_OK);
    EXPECT_EQ(read(), codes);
}

// A thread of the host's and Vesper take turns at one queue.
TEST_F(OwnDevice, TheQueueIsLocked) {
    struct Turns {
        std::mutex mutex;
        unsigned locked = 0, unlocked = 0;
    } turns;
    VesperHostDevice lent = host.lent();
    lent.user = &turns;
    lent.lock_queue = [](void* user) { static_cast<Turns*>(user)->mutex.lock(), ++static_cast<Turns*>(user)->locked; };
    lent.unlock_queue = [](void* user) {
        ++static_cast<Turns*>(user)->unlocked, static_cast<Turns*>(user)->mutex.unlock();
    };
    VesperDevice* shared = nullptr;
    ASSERT_EQ(vesper_device_borrow(&lent, &shared, &error), VESPER_OK) << error.message;
    VesperToneMapper* turn = nullptr;
    ASSERT_EQ(vesper_tone_mapper_create(shared, &turn, &error), VESPER_OK);
    extent = {12, 12};
    std::thread elsewhere([&] {
        for (int i = 0; i < 50; ++i) {
            const std::lock_guard lock(turns.mutex);
            host->submit([](VkCommandBuffer) {}, ++time);
        }
    });
    std::vector<uint8_t> codes;
    for (unsigned frame = 0; frame < 20; ++frame) codes = map_array(turn, frame);
    elsewhere.join();
    EXPECT_GE(turns.locked, 20u);
    EXPECT_EQ(turns.locked, turns.unlocked);
    for (unsigned frame = 0; frame < 19; ++frame) map_array(mapper, frame);
    EXPECT_EQ(codes, map_array(mapper, 19));
    vesper_tone_mapper_destroy(turn);
    vesper_device_close(shared);
}

TEST_F(OwnDevice, RefusesWhatCannotBe) {
    make_images({8, 8}, VK_FORMAT_R8G8B8A8_UNORM);
    const VesperImage from = described(picture, VK_FORMAT_R32G32B32A32_SFLOAT, extent, kRead, kRead);
    const VesperImage to = described(shown, format, extent, VK_IMAGE_LAYOUT_UNDEFINED, kCopied);
    const auto refuses = [&](const std::string& words, const auto& change) {
        VesperImage f = from, t = to;
        VesperImagePicture given = VESPER_INIT(VesperImagePicture);
        given.image = &f, given.scale = 1, given.vertical_fov = 0.7f;
        VesperHandover handover = VESPER_INIT(VesperHandover);
        change(f, t, given, handover);
        error = {};
        EXPECT_EQ(vesper_tone_map_image(mapper, &settings, &given, 0, &t, &handover, &error), VESPER_BAD_ARGUMENT)
            << words;
        EXPECT_NE(std::string(error.message).find(words), std::string::npos) << error.message;
    };
    refuses("without its size", [](auto& f, auto&, auto&, auto&) { f.size = 4; });
    refuses("without its size", [](auto&, auto& t, auto&, auto&) { t.size = 0; });
    refuses("without its size", [](auto&, auto&, auto& g, auto&) { g.size = 0; });
    refuses("without its size", [](auto&, auto&, auto&, auto& h) { h.size = 0; });
    refuses("without its size", [](auto&, auto&, auto& g, auto&) { g.image = nullptr; });
    refuses("no image", [](auto& f, auto&, auto&, auto&) { f.image = VK_NULL_HANDLE; });
    refuses("no image", [](auto&, auto& t, auto&, auto&) { t.image = VK_NULL_HANDLE; });
    refuses("rgba32f", [](auto& f, auto&, auto&, auto&) { f.format = VK_FORMAT_R8G8B8A8_UNORM; });
    refuses("RGBA or BGRA", [](auto&, auto& t, auto&, auto&) { t.format = VK_FORMAT_R16G16B16A16_SFLOAT; });
    refuses("layout after", [](auto& f, auto&, auto&, auto&) { f.layout_after = VK_IMAGE_LAYOUT_UNDEFINED; });
    refuses("layout after", [](auto&, auto& t, auto&, auto&) { t.layout_after = VK_IMAGE_LAYOUT_PREINITIALIZED; });
    refuses("no such layout", [](auto& f, auto&, auto&, auto&) { f.layout_before = VkImageLayout(12345); });
    refuses("no such layout",
            [](auto&, auto& t, auto&, auto&) { t.layout_before = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL; });
    refuses("no such layout", [](auto&, auto& t, auto&, auto&) { t.layout_after = VkImageLayout(9); });
    refuses("layout before", [](auto& f, auto&, auto&, auto&) { f.layout_before = VK_IMAGE_LAYOUT_UNDEFINED; });
    refuses("must have the size", [](auto&, auto& t, auto&, auto&) { t.width = 9; });
    refuses("1 to 16384", [](auto& f, auto&, auto&, auto&) { f.height = 0; });
    refuses("another image", [](auto& f, auto& t, auto&, auto&) { t.image = f.image; });
    refuses("scale", [](auto&, auto&, auto& g, auto&) { g.scale = 0; });
    refuses("rad", [](auto&, auto&, auto& g, auto&) { g.vertical_fov = -1; });
    refuses("semaphores", [](auto&, auto&, auto&, auto& h) { h.wait_count = 1; });
    refuses("semaphores", [](auto&, auto&, auto&, auto& h) { h.signal_count = 1; });
    EXPECT_EQ(vesper_tone_map_image(nullptr, nullptr, nullptr, 0, nullptr, nullptr, nullptr), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_render_image(nullptr, nullptr, nullptr, 0, nullptr, nullptr, nullptr), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_tone_mapper_finish(nullptr, nullptr, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_tone_mapper_finish(mapper, nullptr, &error), VESPER_OK);
}

/// What is said of a device that was made otherwise than Vesper asked.
std::string complaint(const std::function<void(HostFeatures&, VkDeviceCreateInfo&)>& made,
                      const std::function<void(VesperHostDevice&)>& told = {}) {
    const HostDevice host(made);
    VesperHostDevice lent = host.lent();
    if (told) told(lent);
    VesperDevice* device = nullptr;
    VesperError error;
    EXPECT_NE(vesper_device_borrow(&lent, &device, &error), VESPER_OK);
    EXPECT_EQ(device, nullptr);
    return error.message;
}

void expect_words(const std::string& message, std::initializer_list<const char*> words,
                  std::initializer_list<const char*> not_these = {}) {
    for (const char* word : words) EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
    for (const char* word : not_these) EXPECT_EQ(message.find(word), std::string::npos) << word << " in: " << message;
}

TEST(BorrowedDevice, EverythingMissingIsNamed) {
    expect_words(complaint([](HostFeatures& f, auto&) {
                     f.f13.synchronization2 = f.f12.scalarBlockLayout = VK_FALSE;
                     f.f12.timelineSemaphore = VK_TRUE;
                 }),
                 {"synchronization2", "scalarBlockLayout"}, {"maintenance4", "independentBlend"});
    expect_words(complaint({}, [](VesperHostDevice& lent) { lent.api_version = VK_API_VERSION_1_1; }),
                 {"Vulkan 1.3", "1.1"}, {"synchronization2"});
    expect_words(complaint({}, [](VesperHostDevice& lent) { lent.queue_family = 7; }), {"family 7"});
    expect_words(complaint({}, [](VesperHostDevice& lent) { lent.size = 8; }), {"size"});
    expect_words(complaint({}, [](VesperHostDevice& lent) { lent.queue = VK_NULL_HANDLE; }), {"queue"});
    expect_words(complaint({}, [](VesperHostDevice& lent) { lent.created_with = nullptr; }), {"made with"});
    expect_words(complaint({}, [](VesperHostDevice& lent) { lent.lock_queue = [](void*) {}; }), {"unlocked"});
    VesperError error;
    EXPECT_EQ(vesper_device_borrow(nullptr, nullptr, &error), VESPER_BAD_ARGUMENT);
}

// Features of a version may stand in the structures of the extensions they come from, and core ones in
// pEnabledFeatures.
TEST(BorrowedDevice, FeaturesMayBeAskedForInEitherWay) {
    VkPhysicalDeviceSynchronization2Features sync{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES, nullptr,
                                                  VK_TRUE};
    VkPhysicalDeviceDynamicRenderingFeatures rendering{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES,
                                                       &sync, VK_TRUE};
    VkPhysicalDeviceMaintenance4Features maintenance{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES,
                                                     &rendering, VK_TRUE};
    VkPhysicalDeviceScalarBlockLayoutFeatures layout{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES,
                                                     &maintenance, VK_TRUE};
    VkPhysicalDeviceTimelineSemaphoreFeatures timeline{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES,
                                                       &layout, VK_TRUE};
    VkPhysicalDeviceFeatures core{};
    core.independentBlend = core.shaderClipDistance = core.fragmentStoresAndAtomics = VK_TRUE;
    const HostDevice host(
        [&](HostFeatures&, VkDeviceCreateInfo& info) { info.pNext = &timeline, info.pEnabledFeatures = &core; });
    const VesperHostDevice lent = host.lent();
    VesperDevice* device = nullptr;
    VesperError error;
    ASSERT_EQ(vesper_device_borrow(&lent, &device, &error), VESPER_OK) << error.message;
    vesper_device_close(device);
    core.independentBlend = VK_FALSE, sync.synchronization2 = VK_FALSE;
    EXPECT_EQ(vesper_device_borrow(&lent, &device, &error), VESPER_FAILED);
    expect_words(error.message, {"independentBlend", "synchronization2"}, {"maintenance4"});
}

TEST(BorrowedDevice, FeaturesWithoutAPlaceAreNamed) {
    const HostDevice host;
    VkPhysicalDeviceVulkan12Features f12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 chain{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &f12, {}};
    VesperError error;
    EXPECT_EQ(vesper_device_features(host.physical(), &chain, &error), VESPER_FAILED);
    expect_words(error.message, {"dynamicRendering", "synchronization2", "maintenance4"}, {"scalarBlockLayout"});
    EXPECT_FALSE(f12.scalarBlockLayout) << "nothing is set";
    EXPECT_EQ(vesper_device_features(host.physical(), nullptr, &error), VESPER_BAD_ARGUMENT);
    EXPECT_EQ(vesper_device_features(VK_NULL_HANDLE, &chain, &error), VESPER_BAD_ARGUMENT);
}

}  // namespace
}  // namespace vesper::test
