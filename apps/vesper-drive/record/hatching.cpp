#include "record/hatching.h"

#include <cstring>
#include <vector>

#include "record/detection.h"

namespace vesper::drive {
namespace {

constexpr double kBright = 0.75;  // of the largest code

// A grey of that part of the largest code, as codes lie in a word.
uint32_t grey_word(double part, uint32_t bits) {
    const auto code = uint32_t(part * double((1u << bits) - 1));
    return (bits == 8 ? 0xffu << 24 : 3u << 30) | code << 2 * bits | code << bits | code;
}

}  // namespace

void hatch_unseen(render::Frame& frame, const render::RenderSettings& settings, double visible_from) {
    if (frame.obstacle_pixels.empty() || frame.display.empty()) return;
    std::vector<bool> unseen{false};  // 0 is none
    for (const render::SeenObstacle& seen : frame.obstacles)
        unseen.push_back(!is_visible(seen, settings.tone.observer.age, visible_from).value_or(true));
    const uint32_t stripes[]{grey_word(kBright, settings.display.bits), grey_word(0, settings.display.bits)};
    const VkExtent2D shown = frame.shown_extent;
    for (uint32_t y = 0; y < shown.height; ++y)
        for (uint32_t x = 0; x < shown.width; ++x) {
            // The rendered pixel at the middle of the shown one.
            const uint64_t column = (2ull * x + 1) * frame.extent.width / (2ull * shown.width),
                           row = (2ull * y + 1) * frame.extent.height / (2ull * shown.height);
            const uint32_t stripe = (x + y) / kHatchWide % 4;
            if (stripe > 1 || !unseen[frame.obstacle_pixels[row * frame.extent.width + column]]) continue;
            std::memcpy(&frame.display[4 * (size_t{y} * shown.width + x)], &stripes[stripe], 4);
        }
}

}  // namespace vesper::drive
