// False colours. SPDX-License-Identifier: MIT
#include "plots/false_colour.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/hdr_image.h"

namespace vesper::apps {
namespace {

/// viridis at equal steps.
constexpr std::array<uint32_t, 17> kMap{0x440154, 0x48186a, 0x472d7b, 0x424086, 0x3b528b, 0x33638d,
                                        0x2c728e, 0x26828e, 0x21918c, 0x1fa088, 0x28ae80, 0x3fbc73,
                                        0x5ec962, 0x84d44b, 0xaddc30, 0xd8e219, 0xfde725};

CanvasColour colour_of(uint32_t hex) { return glm::dvec3(hex >> 16 & 255, hex >> 8 & 255, hex & 255) / 255.0; }

/// 1, 2 or 5 times a power of ten, at most or at least the value.
double rounded(double value, bool up) {
    const double power = std::pow(10, std::floor(std::log10(value)));
    double best = up ? 10 * power : power;
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (!up && factor * power <= value * (1 + 1e-9)) best = factor * power;
        if (up && factor * power >= value * (1 - 1e-9)) return factor * power;
    }
    return best;
}

}  // namespace

CanvasColour map_colour(double position) {
    const double place = std::clamp(position, 0.0, 1.0) * (kMap.size() - 1);
    const size_t below = std::min(static_cast<size_t>(place), kMap.size() - 2);
    return glm::mix(colour_of(kMap[below]), colour_of(kMap[below + 1]), place - static_cast<double>(below));
}

double ColourScale::position(double value) const {
    return value > 0 ? std::clamp(std::log(value / low) / std::log(high / low), 0.0, 1.0) : 0;
}

ColourScale scale_of(std::span<const float> values) {
    std::vector<float> positive;
    for (const float value : values)
        if (value > 0 && std::isfinite(value)) positive.push_back(value);
    if (positive.empty()) return {};
    const auto percentile = [&](double share) {
        const auto at = positive.begin() + static_cast<ptrdiff_t>(share * static_cast<double>(positive.size() - 1));
        std::nth_element(positive.begin(), at, positive.end());
        return std::max(static_cast<double>(*at), 1e-30);
    };
    ColourScale scale{rounded(percentile(0.01), false), rounded(percentile(0.999), true)};
    scale.low = std::max(scale.low, rounded(scale.high * 1e-8, true));
    if (scale.high < 10 * scale.low) scale.low = rounded(scale.high / 10, false);
    return scale;
}

ValuePicture resized(const ValuePicture& from, uint32_t width, uint32_t height) {
    ValuePicture to{width, height, {}};
    to.values.reserve(size_t{width} * height);
    const auto first = [](uint32_t i, uint32_t size, uint32_t wanted) {
        return static_cast<uint32_t>(uint64_t{i} * size / wanted);
    };
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const uint32_t x0 = first(x, from.width, width), y0 = first(y, from.height, height);
            const uint32_t x1 = std::max(x0 + 1, first(x + 1, from.width, width));
            const uint32_t y1 = std::max(y0 + 1, first(y + 1, from.height, height));
            double sum = 0;
            for (uint32_t v = y0; v < y1; ++v)
                for (uint32_t u = x0; u < x1; ++u) sum += static_cast<double>(from.values[size_t{v} * from.width + u]);
            to.values.push_back(static_cast<float>(sum / (double{1} * (x1 - x0) * (y1 - y0))));
        }
    return to;
}

void save_values(const std::string& file, const ValuePicture& picture, const std::string& meaning) {
    io::HdrImage image{
        .width = picture.width, .height = picture.height, .rgb = {}, .header = {{"vesper:unit", meaning}}};
    image.rgb.reserve(3 * picture.values.size());
    for (const float value : picture.values) image.rgb.insert(image.rgb.end(), 3, value);
    io::write_exr(file, image);
}

std::vector<uint8_t> false_colours(const ValuePicture& picture, const ColourScale& scale) {
    std::vector<uint8_t> rgba;
    rgba.reserve(picture.values.size() * 4);
    for (const float value : picture.values) {
        CanvasColour c = map_colour(scale.position(static_cast<double>(value)));
        if (!std::isfinite(value))
            c = {1, 0, 1};
        else if (!(value > 0))
            c = CanvasColour(0);
        for (int i = 0; i < 3; ++i) rgba.push_back(static_cast<uint8_t>(c[i] * 255 + 0.5));
        rgba.push_back(255);
    }
    return rgba;
}

std::vector<uint8_t> tinted(const ValuePicture& picture, const std::function<Tint(size_t)>& tint_of) {
    constexpr double kGrey = 0.6;  // of the brightest pixels
    const ColourScale scale = scale_of(picture.values);
    std::vector<uint8_t> rgba;
    rgba.reserve(picture.values.size() * 4);
    for (size_t i = 0; i < picture.values.size(); ++i) {
        const double value = double(picture.values[i]);
        const CanvasColour grey(std::isfinite(value) ? kGrey * scale.position(value) : 0);
        const Tint tint = tint_of(i);
        const CanvasColour c = glm::mix(grey, tint.colour, tint.strength);
        for (int k = 0; k < 3; ++k) rgba.push_back(static_cast<uint8_t>(c[k] * 255 + 0.5));
        rgba.push_back(255);
    }
    return rgba;
}

void draw_contours(Canvas& canvas, const ValuePicture& picture, std::span<const double> levels, glm::dvec2 corner) {
    const auto value = [&](uint32_t x, uint32_t y) {
        return static_cast<double>(picture.values[size_t{y} * picture.width + x]);
    };
    for (const double level : levels)
        for (uint32_t y = 0; y + 1 < picture.height; ++y)
            for (uint32_t x = 0; x + 1 < picture.width; ++x) {
                // Marching squares over pixel centres; a saddle gives two pieces, in either of its two ways.
                const double v[4] = {value(x, y), value(x + 1, y), value(x + 1, y + 1), value(x, y + 1)};
                const glm::dvec2 place[4] = {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
                std::array<glm::dvec2, 4> crossing;
                size_t found = 0;
                for (size_t i = 0; i < 4; ++i) {
                    const double a = v[i], b = v[(i + 1) % 4];
                    if ((a < level) != (b < level) && a > 0 && b > 0 && std::isfinite(a) && std::isfinite(b))
                        crossing[found++] = glm::mix(place[i], place[(i + 1) % 4], (level - a) / (b - a));
                }
                for (size_t i = 0; i + 1 < found; i += 2)
                    canvas.line(corner + crossing[i] + 0.5, corner + crossing[i + 1] + 0.5, CanvasColour(1), 1);
            }
}

void draw_colour_bar(Canvas& canvas, glm::dvec2 corner, double height, const ColourScale& scale,
                     const std::string& unit) {
    constexpr double kWide = 24;
    canvas.text(corner + glm::dvec2(0, -14), unit, 13);
    for (double y = 0; y < height; ++y)
        canvas.fill(corner + glm::dvec2(0, y), {kWide, 1.5}, map_colour(1 - y / height));
    canvas.rectangle(corner, {kWide, height}, CanvasColour(0));
    double free = HUGE_VAL;
    for (const double tick : log_ticks(scale.low, scale.high)) {
        const double y = corner.y + height * (1 - scale.position(tick));
        canvas.line({corner.x + kWide, y}, {corner.x + kWide + 5, y}, CanvasColour(0));
        if (free - y < 14) continue;  // labels must not touch
        canvas.text({corner.x + kWide + 9, y}, tick_label(tick), 12);
        free = y;
    }
}

}  // namespace vesper::apps
