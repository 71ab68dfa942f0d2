#include "api/handles.h"

#include <array>
#include <cstring>
#include <new>

#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "base/one_line.h"
#include "render/eye_state.h"

namespace vesper::api {
namespace {

constexpr uint32_t kMostPixels = 16384;  // in width or height

// One line, cut between characters: names of others' may hold anything.
void say(VesperError* error, const char* message) {
    if (!error) return;
    try {
        const std::string line = one_line(message, sizeof error->message - sizeof "...");
        error->message[line.copy(error->message, line.size())] = 0;
    } catch (const std::bad_alloc&) {
        std::strcpy(error->message, "out of memory");
    }
}

/// Goes before what an eye remembers: what kind of bytes these are, and a sum over them.
constexpr uint32_t kEyeBytes = 0x32455956;  // "VYE2"
struct KeptEye {
    uint32_t kind = kEyeBytes, bytes = sizeof(shared::EyeState), sum = 0;
    shared::EyeState eye;
};

/// FNV-1a (Fowler, Noll and Vo), 32 bits, of the version and the eye: files damaged on the way give pictures, but wrong
/// ones.
uint32_t sum_of(const shared::EyeState& eye) {
    constexpr uint32_t kVersion[]{VESPER_VERSION_MAJOR, VESPER_VERSION_MINOR, VESPER_VERSION_PATCH};
    uint32_t sum = 2166136261u;
    const auto add = [&](const void* bytes, size_t size) {
        for (size_t i = 0; i < size; ++i) sum = (sum ^ static_cast<const uint8_t*>(bytes)[i]) * 16777619u;
    };
    add(kVersion, sizeof kVersion);
    add(&eye, sizeof eye);
    return sum;
}

// What an image of colours can be in, by Vulkan 1.3 and in a host that presents.
constexpr std::array kLayouts{VK_IMAGE_LAYOUT_UNDEFINED,
                              VK_IMAGE_LAYOUT_PREINITIALIZED,
                              VK_IMAGE_LAYOUT_GENERAL,
                              VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                              VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                              VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                              VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL,
                              VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL,
                              VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                              VK_IMAGE_LAYOUT_ATTACHMENT_FEEDBACK_LOOP_OPTIMAL_EXT};

graph::ExternalImage image_of(const VesperImage* given) {
    const VesperImage i = known(given, "an image without its size");
    require(i.image != VK_NULL_HANDLE, "no image");
    for (const VkImageLayout layout : {i.layout_before, i.layout_after})
        require(std::ranges::find(kLayouts, layout) != kLayouts.end(), "colours have no such layout");
    require(i.layout_after != VK_IMAGE_LAYOUT_UNDEFINED && i.layout_after != VK_IMAGE_LAYOUT_PREINITIALIZED,
            "an image has a layout after the call");
    require(i.reserved == 0, "VesperImage::reserved must be 0");
    return {i.image, i.format, extent_of(i.width, i.height), i.layout_before, i.layout_after};
}

// A field that is added changes one of these: then kFirstSize of that structure is what stands here.
static_assert(sizeof(void*) != 8 ||
              (sizeof(VesperDeviceOptions) == 40 && sizeof(VesperToneSettings) == 136 &&
               sizeof(VesperFrameReport) == 32 && sizeof(VesperOutputs) == 40 && sizeof(VesperPicture) == 48 &&
               sizeof(VesperMaterial) == 56 && sizeof(VesperMesh) == 56 && sizeof(VesperLamp) == 80 &&
               sizeof(VesperView) == 96 && sizeof(VesperImage) == 40 && sizeof(VesperHandover) == 32 &&
               sizeof(VesperImagePicture) == 40));

}  // namespace

VesperResult result_of(VesperError* error, void (*call)(const void*), const void* what) noexcept {
    say(error, "");
    try {
        call(what);
        return VESPER_OK;
    } catch (const BadArgument& bad) {
        say(error, bad.what.c_str());
        return VESPER_BAD_ARGUMENT;
    } catch (const std::bad_alloc&) {
        say(error, "out of memory");
        return VESPER_OUT_OF_MEMORY;
    } catch (const OutOfHostMemory& out) {
        say(error, out.what());
        return VESPER_OUT_OF_MEMORY;
    } catch (const gpu::DeviceLost& lost) {
        say(error, lost.what());
        return VESPER_DEVICE_LOST;
    } catch (const gpu::OutOfDeviceMemory& out) {
        say(error, out.what());
        return VESPER_OUT_OF_DEVICE_MEMORY;
    } catch (const std::exception& failure) {
        say(error, failure.what());
        return VESPER_FAILED;
    } catch (...) {
        say(error, "an unknown error");
        return VESPER_FAILED;
    }
}

glm::mat4 place_of(const float* node_to_world) {
    const glm::mat4 place = glm::make_mat4(node_to_world);
    const float size = std::abs(glm::determinant(place));
    require(std::isnormal(size) && glm::row(place, 3) == glm::vec4(0, 0, 0, 1),
            "a place is an affine matrix that can be inverted, column by column");
    return place;
}

VkExtent2D extent_of(uint32_t width, uint32_t height) {
    require(width > 0 && height > 0 && width <= kMostPixels && height <= kMostPixels,
            "an image is 1 to 16384 pixels wide and high");
    return {width, height};
}

std::optional<vision::ImageAngles> angles_of(const float (&edges)[4], VkExtent2D extent) {
    if (std::all_of(edges, edges + 4, [](float edge) { return edge == 0; })) return {};
    require(std::all_of(edges, edges + 4, [](float edge) { return std::abs(edge) <= 100; }) && edges[0] < edges[1] &&
                edges[2] < edges[3],
            "edges are tangents from -100 to 100, of the left less than of the right and of the bottom less than of "
            "the top");
    return vision::ImageAngles{int(extent.width), int(extent.height), {edges[0], edges[2]}, {edges[1], edges[3]}};
}

float seconds_of(float seconds) {
    require(seconds >= 0 && seconds <= 1e6f, "time passes by 0 to 1e6 s");
    return seconds;
}

VesperOutputs outputs_of(const VesperOutputs* given) {
    const VesperOutputs to = known(given, "outputs without their size");
    check_report(to.report);
    return to;
}

render::Outputs wanted(const VesperOutputs& to) {
    return {
        .display = to.codes != nullptr, .scene = to.luminance != nullptr, .display_light = to.display_light != nullptr};
}

void give(const render::ToneMapped& frame, const VesperOutputs& to) {
    give(frame.display, to.codes), give(frame.scene, to.luminance), give(frame.display_light, to.display_light);
    if (to.report) give_known(report_of(frame), to.report);
}

void check_report(const VesperFrameReport* report) {
    require(!report || (report->size >= kFirstSize<VesperFrameReport> && report->size <= 65536),
            "a report without its size");
}

VesperFrameReport report_of(const render::ToneMapped& frame) {
    return {.size = sizeof(VesperFrameReport),
            .adaptation = frame.curve.adaptation,
            .log_average = frame.curve.log_average,
            .not_finite = frame.histogram.non_finite,
            .milliseconds = frame.milliseconds};
}

VesperFrameReport report_of_submitted(const render::ToneMapped& frame) {
    VesperFrameReport report = report_of(frame);
    report.milliseconds = 0;
    for (const graph::Timing& pass : frame.timings) report.milliseconds += pass.milliseconds;
    return report;
}

void give_eye(const shared::EyeState& eye, void* bytes) {
    KeptEye kept;
    kept.eye = eye, kept.sum = sum_of(eye);
    std::memcpy(bytes, &kept, sizeof kept);
}

shared::EyeState eye_of(const void* bytes, size_t size) {
    KeptEye kept;
    require(size == sizeof kept, "the state of the eye has the size of another version");
    std::memcpy(&kept, bytes, sizeof kept);
    require(kept.kind == kEyeBytes && kept.bytes == sizeof kept.eye && kept.sum == sum_of(kept.eye),
            "the state of the eye is damaged, or of another version");
    require(!render::fault_of(kept.eye), "the state of the eye has values out of range");
    return kept.eye;
}

graph::ExternalImage picture_image(const VesperImage* given) {
    const graph::ExternalImage image = image_of(given);
    constexpr VkFormat formats[] = {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT,
                                    VK_FORMAT_B10G11R11_UFLOAT_PACK32, VK_FORMAT_E5B9G9R9_UFLOAT_PACK32};
    require(std::ranges::find(formats, image.format) != std::end(formats),
            "a picture is of rgba32f, rgba16f, b10g11r11 or e5b9g9r9");
    require(image.before != VK_IMAGE_LAYOUT_UNDEFINED, "a picture has a layout before the call");
    return image;
}

graph::ExternalImage shown_image(const VesperImage* given, VkExtent2D extent) {
    const graph::ExternalImage image = image_of(given);
    require(image.extent.width == extent.width && image.extent.height == extent.height,
            "the image to be shown must have the size of the picture");
    require(render::shown_format(image.format).has_value(),
            "pictures are shown in images of RGBA or BGRA, of 8 bits (UNORM or SRGB) or 10 bits");
    return image;
}

graph::SubmitSemaphores semaphores_of(const VesperHandover* given) {
    if (!given) return {};
    const VesperHandover h = known(given, "a handover without its size");
    require((h.wait_count == 0 || h.waits) && (h.signal_count == 0 || h.signals), "a list of semaphores is missing");
    return {{h.waits, h.wait_count}, {h.signals, h.signal_count}};
}

}  // namespace vesper::api

size_t vesper_eye_size() { return sizeof(vesper::api::KeptEye); }
