#include "gpu/kernel_cache.h"

namespace vesper::gpu {

const Kernel& KernelCache::get(const Shader& shader, std::initializer_list<uint32_t> constants) const {
    Key key{shader.spirv.data(), constants};
    const auto found = kernels_.find(key);
    if (found != kernels_.end()) return found->second;
    return kernels_.emplace(std::move(key), Kernel(device_, shader.name, shader.spirv, constants)).first->second;
}

}  // namespace vesper::gpu
