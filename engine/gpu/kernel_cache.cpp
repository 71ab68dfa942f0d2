#include "gpu/kernel_cache.h"

namespace vesper::gpu {

const Kernel& KernelCache::get(const Shader& shader, std::initializer_list<uint32_t> constants) const {
    const bool storage = !shader.storage.empty() && !device_.has_long_texel_buffers();
    const std::span<const uint32_t> spirv = storage ? shader.storage : shader.spirv;
    Key key{spirv.data(), constants};
    const auto found = kernels_.find(key);
    if (found != kernels_.end()) return found->second;
    return kernels_.emplace(std::move(key), Kernel(device_, shader.name, spirv, constants)).first->second;
}

}  // namespace vesper::gpu
