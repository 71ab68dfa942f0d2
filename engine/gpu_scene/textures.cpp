#include "gpu_scene/textures.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include <glm/gtc/packing.hpp>

#include "base/budget.h"
#include "base/parallel.h"
#include "gpu/commands.h"
#include "scene/reflectance.h"
#include "scene/scene.h"

namespace vesper::gpu_scene {
namespace {

constexpr uint64_t kStaging = 64 << 20;  // bytes between host and device
constexpr size_t kTogether = 1 << 16;    // texels that a thread does at a time

size_t rows_together(uint32_t width) { return std::max<size_t>(kTogether / width, 1); }

// The weights with which `size` texels make up texel `to` of `count`: the area it covers of each.
struct Tap {
    uint32_t first;
    std::vector<float> weights;
};

Tap taps(uint32_t to, uint32_t count, uint32_t size) {
    const double low = double(to) * size / count, high = double(to + 1) * size / count;
    Tap tap{uint32_t(low), {}};
    for (uint32_t i = tap.first; i < size && i < high; ++i)
        tap.weights.push_back(float((std::min(high, i + 1.0) - std::max(low, double(i))) * count / size));
    return tap;
}

VkSamplerAddressMode address_mode(scene::Wrap wrap) {
    switch (wrap) {
        case scene::Wrap::Mirror:
            return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
        case scene::Wrap::Clamp:
            return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
        default:
            return VK_SAMPLER_ADDRESS_MODE_REPEAT;
    }
}

// For in_parallel(), whose threads have no budget: this one's.
bool in_time(size_t) {
    check_time();
    return true;
}

std::vector<Level> with_smaller(Level base) {
    std::vector<Level> levels{std::move(base)};
    while (levels.back().width > 1 || levels.back().height > 1) levels.push_back(half_size(levels.back()));
    return levels;
}

Rows rows_of(const Level& level) {
    return {level.width, level.height, [&level](uint32_t y, float* to) {
                std::copy_n(level.rgba.data() + size_t(y) * level.width * 4, size_t(level.width) * 4, to);
            }};
}

OpacityLevel opacities_of(const Level& level) {
    spend(level.rgba.size() / 4);
    OpacityLevel opacities{level.width, level.height, {}};
    opacities.opacities.reserve(level.rgba.size() / 4);
    for (size_t i = 3; i < level.rgba.size(); i += 4)
        opacities.opacities.push_back(uint8_t(std::lround(std::clamp(level.rgba[i], 0.0f, 1.0f) * 255)));
    return opacities;
}

/// Codes of an image through a table.
Rows decoded_rows(const Image& image, std::vector<float> table, bool linear_alpha) {
    std::vector<float> alphas = linear_alpha ? decode_table(Decode::Data, {}) : table;
    return {image.width, image.height,
            [&image, table = std::move(table), alphas = std::move(alphas)](uint32_t y, float* to) {
                const uint8_t* from = image.rgba.data() + size_t(y) * image.width * 4;
                for (size_t i = 0; i < size_t(image.width) * 4; i += 4) {
                    for (size_t c = i; c < i + 3; ++c) to[c] = table[from[c]];
                    to[i + 3] = alphas[from[i + 3]];
                }
            }};
}

/// A luminance picture divided by `unit`.
Rows picture_rows(const photometry::LuminancePicture& picture, float unit) {
    return {picture.width, picture.height, [&picture, unit](uint32_t y, float* to) {
                const float* from = picture.rgb.data() + size_t(y) * picture.width * 3;
                for (size_t i = 0; i < picture.width; ++i, from += 3, to += 4)
                    to[0] = from[0] / unit, to[1] = from[1] / unit, to[2] = from[2] / unit, to[3] = 1;
            }};
}

Level half_of(const Rows& rows) {
    Level half{std::max(1u, rows.width / 2), std::max(1u, rows.height / 2), {}};
    half.rgba.assign(size_t(half.width) * half.height * 4, 0.0f);
    std::vector<Tap> columns;
    for (uint32_t x = 0; x < half.width; ++x) columns.push_back(taps(x, half.width, rows.width));
    const auto make_row = [&](uint32_t y, std::vector<float>& from) {
        const Tap tap = taps(y, half.height, rows.height);
        for (size_t j = 0; j < tap.weights.size(); ++j) {
            rows.row(tap.first + uint32_t(j), from.data());
            for (uint32_t x = 0; x < half.width; ++x) {
                float* to = &half.rgba[(size_t(y) * half.width + x) * 4];
                for (size_t i = 0; i < columns[x].weights.size(); ++i) {
                    const float weight = tap.weights[j] * columns[x].weights[i];
                    for (size_t c = 0; c < 4; ++c) to[c] += weight * from[(columns[x].first + i) * 4 + c];
                }
            }
        }
    };
    in_parallel(
        half.height, rows_together(rows.width),
        [&](size_t begin, size_t end) {
            std::vector<float> from(size_t(rows.width) * 4);
            for (size_t y = begin; y < end; ++y) make_row(uint32_t(y), from);
        },
        in_time);
    return half;
}

/// A level of all its rows.
Level whole(const Rows& rows) {
    Level level{rows.width, rows.height, std::vector<float>(size_t(rows.width) * rows.height * 4)};
    for (uint32_t y = 0; y < rows.height; ++y) rows.row(y, level.rgba.data() + size_t(y) * rows.width * 4);
    return level;
}

uint64_t float_bytes(const Rows& rows) { return uint64_t{rows.width} * rows.height * 4 * sizeof(float); }

/// The part of a level that `cutoff` leaves of its opacities times `scale`: of its area, between texels as filters see
/// it, where that is no more than 256 x 256 texels; of its texels otherwise.
double covered(const Level& level, float cutoff, float scale = 1) {
    const auto opacity = [&](uint32_t x, uint32_t y) {
        return std::min(level.rgba[(size_t(y) * level.width + x) * 4 + 3] * scale, 1.0f);
    };
    const uint32_t steps = size_t(level.width) * level.height <= 65536 ? 4 : 1;
    size_t count = 0;
    for (uint32_t y = 0; y < level.height; ++y)
        for (uint32_t x = 0; x < level.width; ++x) {
            const uint32_t right = std::min(x + 1, level.width - 1), below = std::min(y + 1, level.height - 1);
            const float corners[4]{opacity(x, y), opacity(right, y), opacity(x, below), opacity(right, below)};
            const auto left = std::count_if(corners, corners + 4, [&](float corner) { return corner >= cutoff; });
            if (left == 0 || left == 4) {  // and so is everything between them
                count += left > 0 ? steps * steps : 0;
                continue;
            }
            for (uint32_t j = 0; j < steps; ++j)
                for (uint32_t i = 0; i < steps; ++i) {
                    const float u = float(i) / float(steps), v = float(j) / float(steps);
                    count += std::lerp(std::lerp(corners[0], corners[1], u), std::lerp(corners[2], corners[3], u), v) >=
                             cutoff;
                }
        }
    return double(count) / (double(level.width) * level.height * steps * steps);
}

/// Scales opacities so that `cutoff` leaves `part`, as nearly as can be.
void cover(Level& level, float cutoff, double part) {
    if (part == 0 || part == 1) return;
    double low = -4, high = 4;  // log2 of the scale
    for (int step = 0; step < 12; ++step) {
        const double middle = (low + high) / 2;
        (covered(level, cutoff, float(std::exp2(middle))) < part ? low : high) = middle;
    }
    const auto scale = float(std::exp2(high));
    for (size_t i = 3; i < level.rgba.size(); i += 4) level.rgba[i] = std::min(level.rgba[i] * scale, 1.0f);
}

bool filters_floats(const gpu::Device& device) {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(device.physical(), VK_FORMAT_R32G32B32A32_SFLOAT, &properties);
    return properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
}

size_t bytes_of_texel(VkFormat format) {
    return format == VK_FORMAT_R32G32B32A32_SFLOAT ? 16 : format == VK_FORMAT_R16G16B16A16_SFLOAT ? 8 : 4;
}

// glm::packHalf1x16, some times as fast where the half is a normal number.
uint16_t half_bits(float value) {
    constexpr uint32_t kLeast = 0x38800000u, kBeyond = 0x477fe000u;  // 2^-14, and the largest half
    const auto bits = std::bit_cast<uint32_t>(value), size = bits & 0x7fffffffu;
    if (size - kLeast >= kBeyond - kLeast) return glm::packHalf1x16(value);
    return uint16_t((bits >> 16 & 0x8000u) | ((size + 0x1000u - (112u << 23)) >> 13));
}

// Texels of four floats.
void pack(VkFormat format, const std::vector<float>& texels, size_t count, std::byte* to) {
    if (format == VK_FORMAT_R32G32B32A32_SFLOAT)
        std::memcpy(to, texels.data(), count * sizeof(glm::vec4));
    else if (format == VK_FORMAT_R16G16B16A16_SFLOAT)
        for (size_t i = 0; i < 4 * count; ++i) {
            const uint16_t half = half_bits(texels[i]);
            std::memcpy(to + i * sizeof half, &half, sizeof half);
        }
    else
        for (size_t i = 0; i < count; ++i) {
            const float* texel = &texels[4 * i];
            const uint32_t packed = glm::packUnorm4x8({texel[0], texel[1], texel[2], texel[3]});
            std::memcpy(to + i * sizeof packed, &packed, sizeof packed);
        }
}

}  // namespace

std::vector<float> decode_table(Decode decode, const scene::Transfer& transfer) {
    std::array<double, 256> linear;
    if (decode == Decode::Data)
        for (size_t code = 0; code < 256; ++code) linear[code] = double(code) / 255;
    else
        linear = scene::linear_codes(decode == Decode::Colour ? transfer
                                                              : scene::Transfer{.kind = scene::Transfer::Kind::Srgb});
    std::vector<float> table;
    for (const double value : linear) table.push_back(float(value));
    return table;
}

Level half_size(const Level& level) { return half_of(rows_of(level)); }

std::vector<Level> masked_levels(Level base, float cutoff) {
    constexpr uint32_t kLeastSide = 8;
    const double part = covered(base, cutoff);
    for (size_t i = 0; i < base.rgba.size(); i += 4)
        for (size_t c = 0; c < 3; ++c) base.rgba[i + c] *= base.rgba[i + 3];
    std::vector<Level> levels = with_smaller(std::move(base));
    // From the smallest up: where a texel has no opacity, the colour is that of the smaller level there.
    for (size_t l = levels.size(); l-- > 0;) {
        Level& level = levels[l];
        for (uint32_t y = 0; y < level.height; ++y)
            for (uint32_t x = 0; x < level.width; ++x) {
                float* texel = &level.rgba[(size_t(y) * level.width + x) * 4];
                if (texel[3] > 0) {
                    for (int c = 0; c < 3; ++c) texel[c] /= texel[3];
                } else if (l + 1 < levels.size()) {
                    const Level& smaller = levels[l + 1];
                    const float* there = &smaller.rgba[(size_t(std::min(y / 2, smaller.height - 1)) * smaller.width +
                                                        std::min(x / 2, smaller.width - 1)) *
                                                       4];
                    std::copy(there, there + 3, texel);
                }
            }
    }
    while (levels.size() > 1 && std::min(levels.back().width, levels.back().height) < kLeastSide) levels.pop_back();
    for (size_t l = 1; l < levels.size(); ++l) cover(levels[l], cutoff, part);
    constexpr double kWithin = 0.1;  // where opacities are all alike nothing is left to cut
    while (levels.size() > 1 && std::abs(covered(levels.back(), cutoff) - part) > kWithin) levels.pop_back();
    return levels;
}

std::vector<Level> relief_levels(const Image& image, float scale) {
    Level base{image.width, image.height, std::vector<float>(size_t(image.width) * image.height * 4)};
    for (size_t i = 0; i < base.rgba.size(); i += 4) {
        const glm::vec3 code = glm::vec3(image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]) - 127.5f;
        glm::vec3 n = glm::sign(code) * (glm::abs(code) - 0.5f) / 127.0f;
        n = glm::normalize(glm::vec3(scale * n.x, scale * n.y, std::max(n.z, 1e-3f)));
        for (int c = 0; c < 3; ++c) base.rgba[i + size_t(c)] = n[c];
    }
    std::vector<Level> levels = with_smaller(std::move(base));
    for (Level& level : levels)
        for (size_t i = 0; i < level.rgba.size(); i += 4) {
            const float length = glm::length(glm::vec3(level.rgba[i], level.rgba[i + 1], level.rgba[i + 2]));
            level.rgba[i + 3] = std::sqrt(std::max(1 - length, 0.0f));
        }
    return levels;
}

TextureStore::TextureStore(const gpu::Device& device, gpu::Arena& arena, PictureFormat pictures)
    : device_(&device), arena_(&arena), picture_format_(filters_floats(device) ? pictures : PictureFormat::Half) {}

VkDescriptorImageInfo TextureStore::get(const scene::Scene& scene, const scene::TextureUse& use, Decode decode,
                                        float cutoff) {
    const auto key = std::tuple(use.image, use.image == scene::kNone ? Decode::Data : decode,
                                use.image == scene::kNone ? 0.0f : cutoff);
    auto found = textures_.find(key);
    if (found == textures_.end()) {
        const Image white{"white", 1, 1, {255, 255, 255, 255}};
        const Image& image = use.image == scene::kNone ? white : scene.images[use.image];
        const bool data = std::get<Decode>(key) == Decode::Data;
        const Rows base = decoded_rows(image, decode_table(std::get<Decode>(key), scene.transfer), !data);
        const VkFormat format = data ? VK_FORMAT_R8G8B8A8_UNORM : VK_FORMAT_R16G16B16A16_SFLOAT;
        const float mask = std::get<float>(key);
        found = textures_
                    .emplace(key, mask > 0 ? upload_masked(base, mask, format, opacities_[{use.image, mask}])
                                           : upload(base, format))
                    .first;
    }
    return {sampler(use), found->second.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

VkDescriptorImageInfo TextureStore::get_relief(const scene::Scene& scene, const scene::TextureUse& use, float scale) {
    const auto key = std::pair(use.image, use.image == scene::kNone ? 0.0f : scale);
    auto found = reliefs_.find(key);
    if (found == reliefs_.end()) {
        const Image flat{"flat", 1, 1, {128, 128, 255, 255}};
        const Image& image = use.image == scene::kNone ? flat : scene.images[use.image];
        const TemporaryMemory of_levels(uint64_t{image.width} * image.height * 4 * sizeof(float) * 4 / 3);
        const std::vector<Level> levels = relief_levels(image, scale);
        std::vector<Rows> rows;
        for (const Level& level : levels) rows.push_back(rows_of(level));
        found = reliefs_.emplace(key, upload(rows, VK_FORMAT_R16G16B16A16_SFLOAT)).first;
    }
    return {sampler(use, true), found->second.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

VkDescriptorImageInfo TextureStore::get_picture(const scene::Scene& scene, const scene::TextureUse& use, float& unit) {
    auto found = pictures_.find(use.image);
    if (found == pictures_.end()) {
        const photometry::LuminancePicture& picture = scene.luminance_pictures[use.image];
        const bool whole = picture_format_ == PictureFormat::Float;
        const float largest = whole ? 0 : *std::max_element(picture.rgb.begin(), picture.rgb.end());
        const float divided = largest > 0 ? std::max(largest / 60000, 1e-30f) : 1;
        const VkFormat format = whole ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R16G16B16A16_SFLOAT;
        found = pictures_.emplace(use.image, std::pair(upload(picture_rows(picture, divided), format), divided)).first;
    }
    unit = found->second.second;
    return {sampler(use), found->second.first.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

TextureStore::Texture TextureStore::upload(const Rows& base, VkFormat format) {
    const TemporaryMemory of_levels(base.width > 1 || base.height > 1 ? float_bytes(base) / 3 : 0);
    std::vector<Level> smaller;
    if (base.width > 1 || base.height > 1) smaller = with_smaller(half_of(base));
    std::vector<Rows> levels{base};
    for (const Level& level : smaller) levels.push_back(rows_of(level));
    return upload(levels, format);
}

TextureStore::Texture TextureStore::upload_masked(const Rows& base, float cutoff, VkFormat format,
                                                  std::vector<OpacityLevel>& opacities) {
    const TemporaryMemory of_levels(float_bytes(base) * 4 / 3);
    const std::vector<Level> masked = masked_levels(whole(base), cutoff);
    std::vector<Rows> levels;
    for (const Level& level : masked) levels.push_back(rows_of(level)), opacities.push_back(opacities_of(level));
    return upload(levels, format);
}

TextureStore::Texture TextureStore::upload(const std::vector<Rows>& levels, VkFormat format) {
    const size_t texel_bytes = bytes_of_texel(format);
    uint64_t bytes = 0;
    for (const Rows& level : levels) bytes += uint64_t(level.width) * level.height * texel_bytes;
    spend(bytes);
    Texture texture;
    texture.image =
        gpu::make_image(*device_, gpu::image_info(format, {levels[0].width, levels[0].height}, uint32_t(levels.size()),
                                                  VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT));
    arena_->bind(texture.image.get());

    // By way of a buffer of some rows, again and again.
    const uint64_t longest = uint64_t(levels[0].width) * texel_bytes;
    const gpu::HostBuffer staging(*device_, std::max(longest, std::min(bytes, kStaging)),
                                  VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::HostBuffer::Direction::ToDevice);
    gpu::UploadPart part{.first = true, .last = false};
    std::vector<VkBufferImageCopy> copies;
    uint64_t used = 0;
    const auto flush = [&] {
        staging.flush();
        device_->run_once([&](VkCommandBuffer commands) {
            gpu::record_upload(commands, staging.buffer(), texture.image.get(), uint32_t(levels.size()), copies, part);
        });
        copies.clear(), used = 0, part.first = false;
    };
    for (uint32_t l = 0; l < levels.size(); ++l) {
        const Rows& level = levels[l];
        const uint64_t row_bytes = uint64_t(level.width) * texel_bytes;
        for (uint32_t y = 0, rows = 0; y < level.height; y += rows) {
            if (used + row_bytes > staging.bytes()) flush();
            rows = uint32_t(std::min<uint64_t>(level.height - y, (staging.bytes() - used) / row_bytes));
            copies.push_back({.bufferOffset = used,
                              .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, l, 0, 1},
                              .imageOffset = {0, int32_t(y), 0},
                              .imageExtent = {level.width, rows, 1}});
            in_parallel(
                rows, rows_together(level.width),
                [&](size_t begin, size_t end) {
                    std::vector<float> row(size_t(level.width) * 4);
                    for (size_t i = begin; i < end; ++i) {
                        level.row(y + uint32_t(i), row.data());
                        pack(format, row, level.width, staging.data() + used + i * row_bytes);
                    }
                },
                in_time);
            used += rows * row_bytes;
        }
    }
    part.last = true;
    flush();
    texture.view = gpu::make_view(*device_, texture.image.get(), format);
    return texture;
}

VkSampler TextureStore::sampler(const scene::TextureUse& use, bool blended) {
    gpu::OwnedSampler& sampler = samplers_[{use.wrap_u, use.wrap_v, use.nearest, blended}];
    if (!sampler) {
        const VkSamplerMipmapMode mips =
            device_->is_cpu() && !blended ? VK_SAMPLER_MIPMAP_MODE_NEAREST : VK_SAMPLER_MIPMAP_MODE_LINEAR;
        const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                       .magFilter = use.nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR,
                                       .minFilter = VK_FILTER_LINEAR,
                                       .mipmapMode = mips,
                                       .addressModeU = address_mode(use.wrap_u),
                                       .addressModeV = address_mode(use.wrap_v),
                                       .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                       .anisotropyEnable = device_->has_anisotropy() && !use.nearest,
                                       .maxAnisotropy = device_->anisotropy(),
                                       .maxLod = VK_LOD_CLAMP_NONE};
        VkSampler raw = VK_NULL_HANDLE;
        gpu::check(vkCreateSampler(device_->handle(), &info, nullptr, &raw), "making a sampler");
        sampler = {device_->handle(), raw};
    }
    return sampler.get();
}

}  // namespace vesper::gpu_scene
