// Exposures to radiance. P. Debevec and J. Malik, "Recovering High Dynamic Range Radiance Maps from Photographs",
// SIGGRAPH 97, eq. 6. SPDX-License-Identifier: MIT
#include "photometry/merge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "base/luminance.h"

namespace vesper::photometry {
namespace {

void check(std::span<const Exposure> exposures) {
    if (exposures.empty() || exposures.size() > kMaxExposures)
        throw Error(std::to_string(exposures.size()) + " pictures: 1 to " + std::to_string(kMaxExposures) +
                    " can be merged");
    const Image& first = exposures.front().image;
    for (const Exposure& exposure : exposures) {
        const Image& image = exposure.image;
        if (image.width != first.width || image.height != first.height)
            throw Error("pictures of " + std::to_string(first.width) + " x " + std::to_string(first.height) + " and " +
                        std::to_string(image.width) + " x " + std::to_string(image.height) + " px cannot be merged");
        if (image.rgba.empty() || image.rgba.size() != size_t{4} * image.width * image.height)
            throw Error("a picture without pixels");
        if (!(exposure.exposure > 0) || !std::isfinite(exposure.exposure)) throw Error("an exposure is not positive");
    }
}

/// One channel of one pixel, as it is put together.
struct Estimate {
    double sum = 0,
           weight = 0;  // of good codes: noise and what JPEG does to saturated places look like codes near the ends
    double closest = 0, closest_weight = -1, closest_exposure = 0;
    bool dark = false, bright = false;

    void add(int code, double precision, double ln_value, double exposure) {
        const double w = code_weight(code);
        if (code >= kLowestGoodCode && code <= kHighestGoodCode) {
            sum += precision * ln_value;
            weight += precision;
        }
        dark |= code < kLowestGoodCode;
        bright |= code > kHighestGoodCode;
        const bool closer = code < 128 ? exposure > closest_exposure : exposure < closest_exposure;
        if (w > closest_weight || (w == closest_weight && closer)) {
            closest = ln_value;
            closest_weight = w;
            closest_exposure = exposure;
        }
    }
    bool seen() const { return closest_weight >= 0; }
    bool good() const { return weight > 0; }
    double value() const { return seen() ? std::exp(good() ? sum / weight : closest) : 0; }
};

}  // namespace

MergedImage merge_exposures(std::span<const Exposure> exposures, const Response& response) {
    check(exposures);
    std::vector<double> ln_exposures;
    for (const Exposure& exposure : exposures) ln_exposures.push_back(std::log(exposure.exposure));
    std::array<std::array<double, 256>, 3> precisions;
    for (size_t c = 0; c < 3; ++c) precisions[c] = code_precisions(response.ln_exposure[c]);
    const int64_t width = exposures.front().image.width, height = exposures.front().image.height;
    MergedImage made;
    made.image.width = static_cast<uint32_t>(width);
    made.image.height = static_cast<uint32_t>(height);
    made.held.reserve(static_cast<size_t>(width * height));
    made.image.rgb.reserve(static_cast<size_t>(width * height * 3));
    made.darkest = std::numeric_limits<double>::infinity();
    for (int64_t y = 0; y < height; ++y)
        for (int64_t x = 0; x < width; ++x) {
            std::array<Estimate, 3> channels;
            for (size_t i = 0; i < exposures.size(); ++i) {
                const Exposure& e = exposures[i];
                const int64_t at_x = x + e.shift.x, at_y = y + e.shift.y;
                if (at_x < 0 || at_y < 0 || at_x >= width || at_y >= height) continue;
                const uint8_t* codes = e.image.rgba.data() + (at_y * width + at_x) * 4;
                for (size_t c = 0; c < 3; ++c)
                    channels[c].add(codes[c], precisions[c][codes[c]],
                                    response.ln_exposure[c][codes[c]] - ln_exposures[i], e.exposure);
            }
            bool dark = false, bright = false, good = true;
            double colour[3];
            for (size_t c = 0; c < 3; ++c) {
                const Estimate& channel = channels[c];
                good &= channel.good();
                dark |= !channel.good() && channel.dark;
                bright |= !channel.good() && channel.bright;
                colour[c] = channel.value();
                made.image.rgb.push_back(static_cast<float>(colour[c]));
            }
            made.held.push_back(good);
            if (good) {
                const double y_of_pixel = luminance({colour[0], colour[1], colour[2]});
                made.darkest = std::min(made.darkest, y_of_pixel);
                made.brightest = std::max(made.brightest, y_of_pixel);
            } else {
                ++(dark == bright ? made.between : dark ? made.too_dark : made.too_bright);
            }
        }
    made.darkest = std::min(made.darkest, made.brightest);
    return made;
}

std::vector<double> relative_exposures(std::span<const std::pair<std::string, io::CameraExposure>> pictures) {
    const auto count = [&](std::optional<double> io::CameraExposure::*what) {
        return static_cast<size_t>(std::count_if(
            pictures.begin(), pictures.end(), [&](const auto& picture) { return (picture.second.*what).has_value(); }));
    };
    const bool f_numbers = count(&io::CameraExposure::f_number) > 0, speeds = count(&io::CameraExposure::iso) > 0;
    std::vector<double> made;
    for (const auto& [name, camera] : pictures) {
        if (!camera.seconds) throw Error(name + ": has no Exif exposure time");
        if (f_numbers && !camera.f_number) throw Error(name + ": has no Exif f-number, but others have");
        if (speeds && !camera.iso) throw Error(name + ": has no Exif ISO speed, but others have");
        const double n = camera.f_number.value_or(1);
        made.push_back(*camera.seconds * camera.iso.value_or(1) / (n * n));
    }
    return made;
}

void scale(MergedImage& merged, double factor) {
    if (!(factor > 0) || !std::isfinite(factor)) throw Error("a scale must be a positive number");
    for (float& value : merged.image.rgb) value = static_cast<float>(static_cast<double>(value) * factor);
    merged.darkest *= factor;
    merged.brightest *= factor;
    merged.image.white_luminance = 1;
}

double scale_to_luminance(MergedImage& merged, const Region& region, double cd_m2) {
    const io::HdrImage& image = merged.image;
    if (region.x < 0 || region.y < 0 || region.width < 1 || region.height < 1 || region.x >= image.width ||
        region.y >= image.height || region.width > image.width - region.x || region.height > image.height - region.y)
        throw Error("the region does not lie inside the picture of " + std::to_string(image.width) + " x " +
                    std::to_string(image.height) + " px");
    double sum = 0;
    int64_t held = 0;
    for (int64_t y = region.y; y < region.y + region.height; ++y)
        for (int64_t x = region.x; x < region.x + region.width; ++x) {
            const auto pixel = static_cast<size_t>(y * image.width + x);
            held += merged.held[pixel];
            const float* rgb = &image.rgb[3 * pixel];
            sum += luminance({rgb[0], rgb[1], rgb[2]});
        }
    const int64_t pixels = region.width * region.height;
    if (held < pixels)
        throw Error(std::to_string(pixels - held) + " of the " + std::to_string(pixels) +
                    " pixels of the region are not well exposed in any picture");
    const double factor = cd_m2 * static_cast<double>(pixels) / sum;
    scale(merged, factor);
    return factor;
}

}  // namespace vesper::photometry
