// Textures on the device, decoded to linear values before they are filtered. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <tuple>
#include <vector>

#include "base/image.h"
#include "gpu/memory.h"
#include "gpu_scene/masks.h"
#include "scene/material.h"

namespace vesper::scene {
struct Scene;
}

namespace vesper::gpu_scene {

/// How the codes of an image become the values a shader filters.
enum class Decode : uint8_t { Colour, Srgb, Data };  ///< through Scene::transfer; through sRGB; code / 255

/// One mip level: RGBA, row by row.
struct Level {
    uint32_t width = 0, height = 0;
    std::vector<float> rgba;
};

/// Rows of a level, made when they are asked for: a large picture never lies in memory as floats.
struct Rows {
    uint32_t width = 0, height = 0;
    std::function<void(uint32_t y, float* to)> row;
};

/// The linear value of each 8-bit code.
std::vector<float> decode_table(Decode decode, const scene::Transfer& transfer);
/// Half the size, rounded down: every texel is the mean of the area it covers, whole or in part.
Level half_size(const Level& level);
/// Mip levels of a picture whose opacity says where a surface is: at or above `cutoff`. Colours are means of what is
/// opaque; where nothing is, those of what is nearest, as filters reach that far. Opacities are scaled so that each
/// level covers as much as the first (I. Castano, "Computing Alpha Mipmaps", 2010). The last level has 8 texels a side,
/// or more: where its area would be off by a tenth of the whole, as all of it would be there or nothing.
std::vector<Level> masked_levels(Level base, float cutoff);

/// Mip levels of a normal texture, whose slopes are times `scale`: red, green and blue are the mean of the normals,
/// opacity is the square root of how much shorter than 1 it is, which says how they spread: half floats do not hold
/// that difference of the first three. Codes 127 and 128 are 0, so that what is painted flat is flat; 0 and 255 are -1
/// and 1.
std::vector<Level> relief_levels(const Image& image, float scale);

/// How luminance pictures lie on the device. Float: 32 bits, as they are, where the device filters such textures. Half:
/// brought to at most 60,000; a texel is then off by 2^-11 of itself, one below 1e-9 of the brightest by 5e-13 of that.
enum class PictureFormat : uint8_t { Float, Half };

/// Uploads images on demand; one texture per image, decoding and cutoff, one sampler per way of sampling.
class TextureStore {
public:
    /// `pictures`: Half also where Float is possible.
    TextureStore(const gpu::Device& device, gpu::Arena& arena, PictureFormat pictures = PictureFormat::Float);

    /// View and sampler for a use of an image. Without an image: a white texel. `cutoff`: of opacity, where that masks;
    /// 0: it does not.
    VkDescriptorImageInfo get(const scene::Scene& scene, const scene::TextureUse& use, Decode decode, float cutoff = 0);
    /// The same for a normal texture, whose slopes are times `scale`: see relief_levels(). Without an image: a texel
    /// without relief.
    VkDescriptorImageInfo get_relief(const scene::Scene& scene, const scene::TextureUse& use, float scale);
    /// The same for a luminance picture. `unit`: the luminance that a value of 1 in the texture is of the picture's.
    VkDescriptorImageInfo get_picture(const scene::Scene& scene, const scene::TextureUse& use, float& unit);

    /// Forgets the opacities.
    void drop_opacities() { opacities_.clear(); }
    /// All levels of a colour texture that get() was asked for with this cutoff, above 0.
    std::span<const OpacityLevel> opacities(const scene::TextureUse& use, float cutoff) const {
        return opacities_.at({use.image, cutoff});
    }

private:
    struct Texture {
        gpu::OwnedImage image;
        gpu::OwnedImageView view;
    };
    /// With smaller levels; masked_levels() where there is a cutoff.
    Texture upload(const Rows& base, VkFormat format);
    Texture upload_masked(const Rows& base, float cutoff, VkFormat format, std::vector<OpacityLevel>& opacities);
    Texture upload(const std::vector<Rows>& levels, VkFormat format);
    /// `blended`: between mip levels; otherwise a CPU device takes the nearer one, since two cost it as much again.
    VkSampler sampler(const scene::TextureUse& use, bool blended = false);

    const gpu::Device* device_;
    gpu::Arena* arena_;
    PictureFormat picture_format_;
    std::map<uint32_t, std::pair<Texture, float>> pictures_;  // and the unit
    std::map<std::tuple<uint32_t, Decode, float>, Texture> textures_;
    std::map<std::pair<uint32_t, float>, Texture> reliefs_;                      // by the scale, too
    std::map<std::pair<uint32_t, float>, std::vector<OpacityLevel>> opacities_;  // of masked ones
    std::map<std::tuple<scene::Wrap, scene::Wrap, bool, bool>, gpu::OwnedSampler> samplers_;
};

}  // namespace vesper::gpu_scene
