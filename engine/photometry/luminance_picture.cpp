// Pictures of light sources: checks, means. SPDX-License-Identifier: MIT
#include "photometry/luminance_picture.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/luminance.h"
#include "io/hdr_image.h"

namespace vesper::photometry {
namespace {

/// The colour nearest to `c` on the way to the grey of its luminance that has no negative component.
glm::dvec3 inside(glm::dvec3 c) {
    const double y = luminance(c), least = std::min({c.r, c.g, c.b});
    if (!(y > 0)) return glm::dvec3(0);
    return glm::max(glm::dvec3(y) + (c - y) * (y / (y - least)), glm::dvec3(0));
}

}  // namespace

LuminancePicture make_luminance_picture(io::HdrImage image, uint64_t* changed) {
    LuminancePicture made{.name = {}, .width = image.width, .height = image.height, .rgb = std::move(image.rgb)};
    for (size_t i = 0; i + 2 < made.rgb.size(); i += 3) {
        float* c = &made.rgb[i];
        for (size_t k = 0; k < 3; ++k)
            if (!(std::abs(c[k]) <= kLargestValue))
                throw Error("pixel (" + std::to_string(i / 3 % image.width) + ", " +
                            std::to_string(i / 3 / image.width) + ") is not finite, or beyond 1e30");
        if (c[0] >= 0 && c[1] >= 0 && c[2] >= 0) continue;
        const glm::dvec3 moved = inside({c[0], c[1], c[2]});
        for (size_t k = 0; k < 3; ++k) c[k] = static_cast<float>(moved[static_cast<int>(k)]);
        if (changed) ++*changed;
    }
    return made;
}

glm::dvec3 mean_colour(const LuminancePicture& p) {
    glm::dvec3 sum(0);
    for (size_t i = 0; i + 2 < p.rgb.size(); i += 3) sum += glm::dvec3(p.rgb[i], p.rgb[i + 1], p.rgb[i + 2]);
    return sum / static_cast<double>(std::max<size_t>(1, p.rgb.size() / 3));
}

double largest_luminance(const LuminancePicture& p) {
    double largest = 0;
    for (size_t i = 0; i + 2 < p.rgb.size(); i += 3)
        largest = std::max(largest, luminance({p.rgb[i], p.rgb[i + 1], p.rgb[i + 2]}));
    return largest;
}

PictureMeans::PictureMeans(const LuminancePicture& p) : width_(p.width), height_(p.height) {
    sums_.reserve((size_t{width_} + 1) * height_);
    for (size_t y = 0; y < height_; ++y) {
        double sum = 0;
        sums_.push_back(0);
        for (size_t x = 0; x < width_; ++x) {
            const float* c = &p.rgb[(y * width_ + x) * 3];
            sums_.push_back(sum += luminance({c[0], c[1], c[2]}));
        }
        mean_ += sum / width_ / height_;
    }
}

double PictureMeans::row_up_to(int64_t y, double x) const {
    const double* row = &sums_[static_cast<size_t>((y % height_ + height_) % height_) * (size_t{width_} + 1)];
    const double turns = std::floor(x / width_), rest = std::clamp(x - turns * width_, 0.0, width_ - 1e-9);
    const auto whole = static_cast<size_t>(rest);
    return turns * row[width_] + row[whole] + (rest - static_cast<double>(whole)) * (row[whole + 1] - row[whole]);
}

double PictureMeans::over(const std::array<glm::dvec2, 3>& uv) const {
    std::array<glm::dvec2, 3> p;
    for (size_t i = 0; i < 3; ++i) p[i] = uv[i] * glm::dvec2(width_, height_);
    const glm::dvec2 low = glm::min(p[0], glm::min(p[1], p[2])), high = glm::max(p[0], glm::max(p[1], p[2]));
    constexpr double kRepetitions = 64, kFarthest = 1e12;  // the latter so that texels can be counted
    const glm::dvec2 extent = (high - low) / glm::dvec2(width_, height_),
                     farthest = glm::max(glm::abs(low), glm::abs(high));
    if (!(std::max(extent.x, extent.y) <= kRepetitions && std::max(farthest.x, farthest.y) < kFarthest)) return mean_;
    double sum = 0, length = 0;
    for (auto y = static_cast<int64_t>(std::floor(low.y)); static_cast<double>(y) < high.y; ++y) {
        const double middle = static_cast<double>(y) + 0.5;
        double from = HUGE_VAL, to = -HUGE_VAL;
        for (size_t i = 0; i < 3; ++i) {
            const glm::dvec2 a = p[i], b = p[(i + 1) % 3];
            if ((a.y <= middle) == (b.y <= middle)) continue;
            const double x = a.x + (b.x - a.x) * (middle - a.y) / (b.y - a.y);
            from = std::min(from, x), to = std::max(to, x);
        }
        if (!(to > from)) continue;
        sum += row_up_to(y, to) - row_up_to(y, from);
        length += to - from;
    }
    if (length > 0) return sum / length;
    const glm::dvec2 texel = glm::floor((p[0] + p[1] + p[2]) / 3.0);
    return row_up_to(static_cast<int64_t>(texel.y), texel.x + 1) - row_up_to(static_cast<int64_t>(texel.y), texel.x);
}

}  // namespace vesper::photometry
