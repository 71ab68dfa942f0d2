// Bright displayed light convolved with a normalised Gaussian (Petit, Bremond, Vienne). SPDX-License-Identifier: MIT
// Twice: as the pass does it (a quarter of the resolution, separable), and as it is defined (full resolution, direct).
#pragma once

#include "passes/composite_reference.h"

namespace vesper::reference {

/// Displayed light, rows from the top.
struct LightImage {
    uint32_t width = 0, height = 0;
    std::vector<dvec3> pixels;

    dvec3& at(uint32_t x, uint32_t y) { return pixels[size_t(y) * width + x]; }
    dvec3 at(uint32_t x, uint32_t y) const { return pixels[size_t(y) * width + x]; }
};

/// What glares of displayed light: all of it from where a channel reaches `threshold`, nothing below.
inline dvec3 glaring(dvec3 shown, double threshold) {
    return std::max({shown.x, shown.y, shown.z}) >= threshold ? shown : dvec3(0);
}

constexpr uint32_t kGlareBlock = 4;  // px, of the side of blocks that are blurred as one

/// Means of what glares over such blocks, of those pixels that exist.
inline LightImage bright(const LightImage& shown, double threshold) {
    const uint32_t n = kGlareBlock;
    LightImage out{(shown.width + n - 1) / n, (shown.height + n - 1) / n, {}};
    for (uint32_t y = 0; y < out.height; ++y)
        for (uint32_t x = 0; x < out.width; ++x) {
            dvec3 sum(0);
            double count = 0;
            for (uint32_t j = y * n; j < std::min((y + 1) * n, shown.height); ++j)
                for (uint32_t i = x * n; i < std::min((x + 1) * n, shown.width); ++i)
                    sum += glaring(shown.at(i, j), threshold), count += 1;
            out.pixels.push_back(sum / count);
        }
    return out;
}

/// Standard deviation of the Gaussian in texels of the small image.
inline double small_sigma(double sigma_degrees, double degrees_per_pixel) {
    return sigma_degrees / degrees_per_pixel / kGlareBlock;
}

/// Weights 0 .. radius of a Gaussian cut at 3 sigma; the two-sided sum is 1.
inline std::vector<double> gaussian(double sigma) {
    const int radius = int(std::ceil(3 * sigma));
    std::vector<double> w{1.0};
    double sum = 1;
    for (int i = 1; i <= radius; ++i) w.push_back(std::exp(-i * i / (2 * sigma * sigma))), sum += 2 * w.back();
    for (double& x : w) x /= sum;
    return w;
}

/// One direction of the separable blur; nothing comes from outside the image.
inline LightImage blur(const LightImage& in, const std::vector<double>& w, bool horizontal) {
    LightImage out{in.width, in.height, std::vector<dvec3>(in.pixels.size(), dvec3(0))};
    const int64_t radius = int64_t(w.size()) - 1;
    for (int64_t y = 0; y < in.height; ++y)
        for (int64_t x = 0; x < in.width; ++x)
            for (int64_t k = -radius; k <= radius; ++k) {
                const int64_t i = horizontal ? x + k : x, j = horizontal ? y : y + k;
                if (i < 0 || j < 0 || i >= in.width || j >= in.height) continue;
                out.at(uint32_t(x), uint32_t(y)) += w[size_t(std::abs(k))] * in.at(uint32_t(i), uint32_t(j));
            }
    return out;
}

/// What the pass gives: small, blurred in both directions.
inline LightImage bloom(const LightImage& shown, double threshold, double sigma) {
    const std::vector<double> w = gaussian(sigma);
    return blur(blur(bright(shown, threshold), w, true), w, false);
}

/// The definition: every pixel gathers what glares around it with a two-dimensional Gaussian of `sigma` pixels, cut at
/// `cut` sigma, normalised over the plane.
inline LightImage direct_glare(const LightImage& shown, double threshold, double sigma, double cut = 4) {
    LightImage out{shown.width, shown.height, std::vector<dvec3>(shown.pixels.size(), dvec3(0))};
    const int64_t radius = int64_t(std::ceil(cut * sigma));
    double total = 0;
    for (int64_t j = -radius; j <= radius; ++j)
        for (int64_t i = -radius; i <= radius; ++i) total += std::exp(-double(i * i + j * j) / (2 * sigma * sigma));
    for (int64_t y = 0; y < shown.height; ++y)
        for (int64_t x = 0; x < shown.width; ++x) {
            const dvec3 source = glaring(shown.at(uint32_t(x), uint32_t(y)), threshold);
            if (source == dvec3(0)) continue;
            for (int64_t j = std::max<int64_t>(0, y - radius); j <= std::min<int64_t>(shown.height - 1, y + radius);
                 ++j)
                for (int64_t i = std::max<int64_t>(0, x - radius); i <= std::min<int64_t>(shown.width - 1, x + radius);
                     ++i)
                    out.at(uint32_t(i), uint32_t(j)) +=
                        source * std::exp(-double((i - x) * (i - x) + (j - y) * (j - y)) / (2 * sigma * sigma)) / total;
        }
    return out;
}

}  // namespace vesper::reference
