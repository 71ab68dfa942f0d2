#include "gpu/kernel_cache.h"

#include <algorithm>
#include <functional>

#include "base/parallel.h"

namespace vesper::gpu {
namespace {

/// The same, but that no loop is unrolled. SwiftShader, which needs storage variants, compiles unrolled loops for
/// minutes.
std::vector<uint32_t> rolled(std::span<const uint32_t> spirv) {
    constexpr uint32_t kHeader = 5, kLoopMerge = 246, kUnroll = 1, kDontUnroll = 2;
    std::vector<uint32_t> code(spirv.begin(), spirv.end());
    for (size_t at = kHeader; at < code.size(); at += code[at] >> 16)
        if ((code[at] & 0xffff) == kLoopMerge && (code[at + 3] & kUnroll) != 0) code[at + 3] ^= kUnroll | kDontUnroll;
    return code;
}

}  // namespace

const Kernel& KernelCache::get(const Shader& shader, std::initializer_list<uint32_t> constants) const {
    const std::span<const uint32_t> of_texels = shader.spirv, of_storage = shader.storage;
    const bool storage = !of_storage.empty() && !device_.has_long_texel_buffers();
    const std::span<const uint32_t> spirv = storage ? of_storage : of_texels;
    Key key{spirv.data(), constants};
    const auto found = kernels_.find(key);
    if (found != kernels_.end()) return found->second;
    const std::vector<uint32_t> code = storage && device_.is_cpu() ? rolled(spirv) : std::vector<uint32_t>();
    Kernel kernel(device_, shader.name, code.empty() ? spirv : code, constants);
    kernel.texels_in_storage = storage;
    const Kernel& kept = kernels_.emplace(std::move(key), std::move(kernel)).first->second;
    new_.push_back(&kept);
    return kept;
}

void KernelCache::compile() {
    std::erase_if(new_, [](const Kernel* kernel) { return kernel->is_compiled(); });
    if (new_.empty()) return;
    // The longest first, so that none is left to a single thread at the end.
    std::ranges::stable_sort(new_, std::greater(), &Kernel::code_words);
    const PipelineTimer timer(device_, new_.size());
    in_parallel(new_.size(), 1, [this](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) new_[i]->compile();
    });
    new_.clear();
}

}  // namespace vesper::gpu
