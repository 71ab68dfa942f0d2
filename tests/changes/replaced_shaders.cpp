// Gives the device changed shaders in place of built ones; preloaded by scripts/changes. SPDX-License-Identifier: MIT
// VESPER_REPLACED_SHADERS is a folder with pairs of SPIR-V files N.was and N.now.
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <vulkan/vulkan.h>

namespace {

using Code = std::vector<char>;

Code read(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::pair<Code, Code>> read_all() {
    std::vector<std::pair<Code, Code>> all;
    const std::filesystem::path folder = std::getenv("VESPER_REPLACED_SHADERS");
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".was")
            all.emplace_back(read(entry.path()), read(std::filesystem::path(entry.path()).replace_extension(".now")));
    return all;
}

}  // namespace

extern "C" VKAPI_ATTR VkResult VKAPI_CALL vkCreateShaderModule(VkDevice device, const VkShaderModuleCreateInfo* given,
                                                               const VkAllocationCallbacks* allocator,
                                                               VkShaderModule* module) {
    static const auto next = reinterpret_cast<PFN_vkCreateShaderModule>(::dlsym(RTLD_NEXT, "vkCreateShaderModule"));
    static const std::vector<std::pair<Code, Code>> replaced = read_all();
    VkShaderModuleCreateInfo info = *given;
    const char* bytes = reinterpret_cast<const char*>(given->pCode);
    for (const auto& [was, now] : replaced) {
        if (Code(bytes, bytes + given->codeSize) != was) continue;
        info.pCode = reinterpret_cast<const uint32_t*>(now.data()), info.codeSize = now.size();
        std::ofstream(std::filesystem::path(std::getenv("VESPER_REPLACED_SHADERS")) / "used");
    }
    return next(device, &info, allocator, module);
}
