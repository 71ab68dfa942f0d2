// Formats of the images that passes agree on. SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vulkan_core.h>

namespace vesper::render {

constexpr VkFormat kReflectanceFormat = VK_FORMAT_R16G16B16A16_SFLOAT;  ///< base colour, metallic
constexpr VkFormat kSurfaceFormat = VK_FORMAT_R32G32B32A32_SFLOAT;      ///< normal (2), depth (m), roughness
constexpr VkFormat kEmissionFormat = VK_FORMAT_R32G32B32A32_SFLOAT;     ///< cd/m^2 RGB
constexpr VkFormat kTriangleFormat = VK_FORMAT_R32G32_UINT;             ///< see GBuffer::triangle
constexpr VkFormat kSlopeFormat = VK_FORMAT_R32_UINT;                   ///< see GBuffer::slope
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr VkFormat kSceneFormat = VK_FORMAT_R32G32B32A32_SFLOAT;         ///< 1e-4 to 1e8 cd/m^2 in one frame
constexpr VkFormat kBloomFormat = VK_FORMAT_R16G16B16A16_SFLOAT;         ///< displayed light, relative
constexpr VkFormat kDisplayFormat = VK_FORMAT_R32_UINT;                  ///< codes, see add_composite
constexpr VkFormat kShownLightFormat = VK_FORMAT_R32G32B32A32_SFLOAT;    ///< displayed light, see add_shown_light
constexpr VkFormat kDisplayLightFormat = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< cd/m^2 RGB

}  // namespace vesper::render
