#include "eye/scatter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shared/eye_scatter.h"
#include "vision/glare_pattern.h"

namespace vesper::eye {
namespace {

using glm::dvec2, glm::dvec3;

static_assert(vision::kScatterMargin == int(shared::kScatterUpMargin) &&
              vision::kScatterReach == int(shared::kScatterDownMargin));

// Taps of all levels, each in texels of its own.
std::vector<glm::vec4> padded_taps(const vision::ScatterFit& fit) {
    const auto taps = size_t(fit.taps());
    std::vector<glm::vec4> texels;
    for (size_t first = 0; first < fit.kernels.size(); first += taps)
        for (size_t i = 0; i < taps; i += 4) {
            texels.emplace_back(0);
            for (size_t c = 0; c < 4 && i + c < taps; ++c) texels.back()[int(c)] = fit.kernels[first + i + c];
        }
    return texels;
}

// For each column the rows, in texels of four.
std::vector<glm::vec4> transposed(const std::vector<float>& matrix, size_t rows) {
    const size_t columns = matrix.size() / rows, texels = (rows + 3) / 4;
    std::vector<glm::vec4> turned(columns * texels, glm::vec4(0));
    for (size_t r = 0; r < rows; ++r)
        for (size_t c = 0; c < columns; ++c) turned[c * texels + r / 4][int(r % 4)] = matrix[r * columns + c];
    return turned;
}

}  // namespace

vision::EyeScatter eye_scatter(const ScatterSettings& settings) {
    if (settings.model == ScatterSettings::Model::Spencer)
        return vision::EyeScatter(
            [state = settings.state](double theta) { return vision::spencer_veil(theta, state); });
    if (settings.model == ScatterSettings::Model::Ward) return vision::EyeScatter(vision::ward_veil);
    return vision::EyeScatter([eye = settings.eye](double theta) { return vision::cie_total_glare(theta, eye); });
}

glm::ivec2 scatter_down_strip(const gpu::Device& device) {
    return device.is_cpu() ? glm::ivec2(8, 32) : glm::ivec2(1, 2);
}

GpuScatter::GpuScatter(const gpu::Device& device, const ScatterSettings& settings, const vision::ImageAngles& image)
    : settings_(settings), image_(image), psf_(eye_scatter(settings)), arena_(device) {
    const vision::ScatterFit fit = vision::fit_scatter(psf_, image, scatter_down_strip(device));
    levels_ = fit.levels;
    reach_ = fit.reach;
    nodes_ = fit.nodes;
    edge_x_ = fit.edge.x, edge_y_ = fit.edge.y;
    const auto upload = [&](const auto& values, gpu::OwnedBuffer& buffer) {
        const auto bytes = std::as_bytes(std::span(values));
        buffer = gpu::upload_buffer(device, arena_, bytes, gpu::kTexelUsage);
        return bytes.size();
    };
    taps_bytes_ = upload(padded_taps(fit), taps_);
    top_bytes_ = upload(transposed(fit.top, size_t(fit.top_rows().x * fit.top_rows().y)), top_);
    edge_bytes_ = upload(fit.edge.kept, edge_);
}

std::vector<glm::vec4> GpuScatter::lamps_of(int level, const std::vector<OffscreenLamp>& lamps) const {
    std::vector<glm::vec4> texels;
    for (const OffscreenLamp& lamp : lamps) {
        const std::optional<vision::ScatterEntry> entry = vision::scatter_entry(image_, lamp.direction);
        if (!entry || entry->level != level) continue;
        // Luminance of a pixel there, times the part of a texel that the pixel is.
        const dvec2 pixel = image_.pixel();
        const double solid_angle = pixel.x * pixel.y * vision::steradians_per_area(entry->tangents);
        texels.emplace_back(entry->pixels / std::exp2(level), 0, 0);
        texels.emplace_back(lamp.illuminance / (solid_angle * std::exp2(2 * level)), 0);
    }
    return texels;
}

std::vector<glm::vec4> GpuScatter::far_veil(const std::vector<OffscreenLamp>& lamps) const {
    std::vector<OffscreenLamp> far;
    for (const OffscreenLamp& lamp : lamps)
        if (lamp.direction.z < 0 && !vision::scatter_entry(image_, lamp.direction))
            far.push_back({glm::normalize(lamp.direction), lamp.illuminance});
    const glm::ivec2 rows = vision::scatter_size(image_, levels_) + 2 * vision::kScatterReach;
    std::vector<glm::vec4> veil(size_t(rows.x * rows.y), glm::vec4(0));
    for (int y = 0; y < rows.y && !far.empty(); ++y)
        for (int x = 0; x < rows.x; ++x) {
            const dvec3 to = glm::normalize(
                dvec3(image_.at(std::exp2(levels_) * (dvec2(x, y) - double(vision::kScatterReach) + 0.5)), -1));
            dvec3 sum(0);
            for (const OffscreenLamp& lamp : far) {
                const double theta =
                    std::acos(std::clamp(glm::dot(to, lamp.direction), -1.0, 1.0)) * 180 / std::numbers::pi;
                sum += psf_(theta) * lamp.illuminance;
            }
            veil[size_t(y * rows.x + x)] = glm::vec4(sum, 0);
        }
    return veil;
}

const GpuScatter& ScatterCache::at(const ScatterSettings& settings, const vision::ImageAngles& image) {
    const auto known = std::find_if(fits_.begin(), fits_.end(), [&](const GpuScatter& fit) {
        return fit.settings() == settings && fit.image() == image;
    });
    if (known != fits_.end()) {
        fits_.splice(fits_.begin(), fits_, known);
    } else {
        while (fits_.size() >= most_) fits_.pop_back();  // before the next one takes its memory
        fits_.emplace_front(*device_, settings, image);
    }
    return fits_.front();
}

bool ScatterCache::has(const ScatterSettings& settings, const vision::ImageAngles& image) const {
    return std::any_of(fits_.begin(), fits_.end(),
                       [&](const GpuScatter& fit) { return fit.settings() == settings && fit.image() == image; });
}

}  // namespace vesper::eye
