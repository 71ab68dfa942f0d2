#include "plots/share_map.h"

#include <algorithm>
#include <cmath>

namespace vesper::apps {
namespace {

constexpr uint32_t kLongest = 1280, kLeast = 320;  // px, of the picture on the canvas
constexpr double kTitle = 40, kEdge = 16, kBar = 24;

glm::uvec2 shown_size(uint32_t width, uint32_t height) {
    const double longest = std::max(width, height);
    const double zoom = longest > kLongest ? kLongest / longest : std::max(1.0, std::floor(kLeast / longest));
    return {std::max(1u, uint32_t(width * zoom)), std::max(1u, uint32_t(height * zoom))};
}

Tint tint_of(double share) {
    share = std::clamp(share, 0.0, 1.0);
    return {map_colour(share), share};
}

}  // namespace

ShareMap::ShareMap(const std::string& title, const ValuePicture& luminance, const ValuePicture& shares,
                   const std::string& unit)
    : corner_(kEdge, kTitle),
      zoom_(glm::dvec2(shown_size(shares.width, shares.height)) / glm::dvec2(shares.width, shares.height)),
      canvas_(uint32_t(zoom_.x * shares.width + 2 * kEdge + 16 + kBarWidth),
              uint32_t(std::max(zoom_.y * shares.height, 160.0) + kTitle + kEdge)) {
    const glm::uvec2 size = shown_size(shares.width, shares.height);
    canvas_.text({kEdge, kTitle / 2}, title, 14);
    const ValuePicture shown = resized(shares, size.x, size.y);
    canvas_.pixels(
        int(corner_.x), int(corner_.y), size.x, size.y,
        tinted(resized(luminance, size.x, size.y), [&](size_t i) { return tint_of(double(shown.values[i])); }));
    const glm::dvec2 bar = corner_ + glm::dvec2(size.x + 16, 26);
    const double height = std::clamp(double(size.y) - 40, 100.0, 400.0);
    canvas_.text(bar - glm::dvec2(0, 18), unit, 13);
    for (double y = 0; y < height; ++y) {
        const double share = 1 - y / height;
        canvas_.fill(bar + glm::dvec2(0, y), {kBar, 1.5}, glm::mix(CanvasColour(0.3), map_colour(share), share));
    }
    canvas_.rectangle(bar, {kBar, height}, CanvasColour(0));
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const double y = bar.y + height * (1 - share);
        canvas_.line({bar.x + kBar, y}, {bar.x + kBar + 5, y}, CanvasColour(0));
        canvas_.text({bar.x + kBar + 9, y}, tick_label(100 * share) + " %", 12);
    }
}

}  // namespace vesper::apps
