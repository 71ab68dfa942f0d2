#include "faults/faults.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <vulkan/vulkan.h>

using vesper::test::FaultKind;

namespace {

// One program, one fault: state for all threads, but allocations count on one only.
std::atomic<FaultKind> kind{FaultKind::None};
std::atomic<uint64_t> fails_at{0}, counted{0};
std::atomic<int> fault_code{0};
std::atomic<bool> lost{false};
// In the static block: dynamic thread-local storage would allocate.
__attribute__((tls_model("initial-exec"))) thread_local bool counts_memory = false;
__attribute__((tls_model("initial-exec"))) thread_local int64_t live = 0;

/// Whether this call is the one.
bool due(FaultKind of) { return kind == of && ++counted == fails_at; }

template <class F>
F next(const char* name) {
    return reinterpret_cast<F>(::dlsym(RTLD_NEXT, name));
}

__attribute__((constructor)) void arm_from_environment() {
    int of = 0, code = 0;
    unsigned long long at = 0;
    if (const char* text = std::getenv("VESPER_FAULT"); text && std::sscanf(text, "%d %llu %d", &of, &at, &code) == 3)
        vesper::test::vesper_fault_arm(FaultKind(of), at, code);
}

}  // namespace

namespace vesper::test {

void vesper_fault_arm(FaultKind of, uint64_t at, int code) {
    kind = FaultKind::None;
    counts_memory = of == FaultKind::Memory;
    if (of == FaultKind::None) return;  // what was counted can still be asked for
    fails_at = at, counted = 0, fault_code = code, lost = false, live = 0;
    kind = of;
}
uint64_t vesper_fault_count() { return counted; }
int64_t vesper_fault_live() { return live; }

}  // namespace vesper::test

// ---- Vulkan: what the engine calls and can fail. ----

#define FAULTY_AS(needs_device, waits, name, parameters, arguments)                                         \
    extern "C" VKAPI_ATTR VkResult VKAPI_CALL name parameters {                                             \
        static const auto call = next<PFN_##name>(#name);                                                   \
        if (needs_device && lost) return VK_ERROR_DEVICE_LOST;                                              \
        if (!due(FaultKind::Vulkan)) return call arguments;                                                 \
        lost = fault_code == VK_ERROR_DEVICE_LOST;                                                          \
        if (waits && lost) call arguments; /* what a lost device was doing has ended; here it has to end */ \
        return VkResult(fault_code.load());                                                                 \
    }
#define FAULTY(name, parameters, arguments) FAULTY_AS(false, false, name, parameters, arguments)
#define MADE(name, type, made) \
    FAULTY(name, (VkDevice d, const type* i, const VkAllocationCallbacks* a, made* o), (d, i, a, o))

FAULTY(vkCreateInstance, (const VkInstanceCreateInfo* i, const VkAllocationCallbacks* a, VkInstance* o), (i, a, o))
FAULTY(vkEnumeratePhysicalDevices, (VkInstance i, uint32_t* n, VkPhysicalDevice* o), (i, n, o))
FAULTY(vkEnumerateDeviceExtensionProperties, (VkPhysicalDevice d, const char* l, uint32_t* n, VkExtensionProperties* o),
       (d, l, n, o))
FAULTY(vkCreateDevice, (VkPhysicalDevice d, const VkDeviceCreateInfo* i, const VkAllocationCallbacks* a, VkDevice* o),
       (d, i, a, o))
MADE(vkAllocateMemory, VkMemoryAllocateInfo, VkDeviceMemory)
MADE(vkCreateBuffer, VkBufferCreateInfo, VkBuffer)
MADE(vkCreateBufferView, VkBufferViewCreateInfo, VkBufferView)
MADE(vkCreateCommandPool, VkCommandPoolCreateInfo, VkCommandPool)
MADE(vkCreateDescriptorSetLayout, VkDescriptorSetLayoutCreateInfo, VkDescriptorSetLayout)
MADE(vkCreateFence, VkFenceCreateInfo, VkFence)
MADE(vkCreateImage, VkImageCreateInfo, VkImage)
MADE(vkCreateImageView, VkImageViewCreateInfo, VkImageView)
MADE(vkCreatePipelineLayout, VkPipelineLayoutCreateInfo, VkPipelineLayout)
MADE(vkCreateQueryPool, VkQueryPoolCreateInfo, VkQueryPool)
MADE(vkCreateSampler, VkSamplerCreateInfo, VkSampler)
MADE(vkCreateShaderModule, VkShaderModuleCreateInfo, VkShaderModule)
FAULTY(vkCreateComputePipelines,
       (VkDevice d, VkPipelineCache c, uint32_t n, const VkComputePipelineCreateInfo* i, const VkAllocationCallbacks* a,
        VkPipeline* o),
       (d, c, n, i, a, o))
FAULTY(vkCreateGraphicsPipelines,
       (VkDevice d, VkPipelineCache c, uint32_t n, const VkGraphicsPipelineCreateInfo* i,
        const VkAllocationCallbacks* a, VkPipeline* o),
       (d, c, n, i, a, o))
FAULTY(vkAllocateCommandBuffers, (VkDevice d, const VkCommandBufferAllocateInfo* i, VkCommandBuffer* o), (d, i, o))
FAULTY(vkBeginCommandBuffer, (VkCommandBuffer c, const VkCommandBufferBeginInfo* i), (c, i))
FAULTY(vkEndCommandBuffer, (VkCommandBuffer c), (c))
FAULTY(vkResetCommandPool, (VkDevice d, VkCommandPool p, VkCommandPoolResetFlags f), (d, p, f))
FAULTY(vkBindBufferMemory, (VkDevice d, VkBuffer b, VkDeviceMemory m, VkDeviceSize o), (d, b, m, o))
FAULTY(vkBindImageMemory, (VkDevice d, VkImage b, VkDeviceMemory m, VkDeviceSize o), (d, b, m, o))
FAULTY(vkMapMemory, (VkDevice d, VkDeviceMemory m, VkDeviceSize o, VkDeviceSize s, VkMemoryMapFlags f, void** p),
       (d, m, o, s, f, p))
FAULTY(vkFlushMappedMemoryRanges, (VkDevice d, uint32_t n, const VkMappedMemoryRange* r), (d, n, r))
FAULTY(vkInvalidateMappedMemoryRanges, (VkDevice d, uint32_t n, const VkMappedMemoryRange* r), (d, n, r))
FAULTY(vkResetFences, (VkDevice d, uint32_t n, const VkFence* f), (d, n, f))
FAULTY_AS(true, false, vkQueueSubmit2, (VkQueue q, uint32_t n, const VkSubmitInfo2* s, VkFence f), (q, n, s, f))
FAULTY_AS(true, true, vkQueueWaitIdle, (VkQueue q), (q))
FAULTY_AS(true, true, vkDeviceWaitIdle, (VkDevice d), (d))
FAULTY_AS(true, true, vkWaitForFences, (VkDevice d, uint32_t n, const VkFence* f, VkBool32 all, uint64_t t),
          (d, n, f, all, t))
FAULTY_AS(true, true, vkGetQueryPoolResults,
          (VkDevice d, VkQueryPool p, uint32_t first, uint32_t n, size_t s, void* data, VkDeviceSize stride,
           VkQueryResultFlags f),
          (d, p, first, n, s, data, stride, f))

// ---- Memory: glibc's own functions are behind these. ----

extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void __libc_free(void*);

static bool none_left() {
    if (!counts_memory || !due(FaultKind::Memory)) return false;
    errno = ENOMEM;
    return true;
}
static void* lives(void* made) {
    if (counts_memory && made) ++live;
    return made;
}
void* malloc(size_t size) { return none_left() ? nullptr : lives(__libc_malloc(size)); }
void* calloc(size_t count, size_t size) { return none_left() ? nullptr : lives(__libc_calloc(count, size)); }
void* realloc(void* old, size_t size) {
    if (none_left()) return nullptr;
    void* made = __libc_realloc(old, size);
    return old ? made : lives(made);
}
void free(void* memory) {
    if (counts_memory && memory) --live;
    __libc_free(memory);
}
}

// ---- Disk: what a program changes below its working folder. ----

namespace {

bool is_below(const char* path) {
    char folder[4096];
    if (!::getcwd(folder, sizeof folder)) return false;
    return path[0] != '/' || std::strncmp(path, folder, std::strlen(folder)) == 0;
}
bool is_below(int descriptor) {
    char link[64], path[4096];
    std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    const ssize_t length = ::readlink(link, path, sizeof path - 1);
    if (length < 0) return false;
    path[length] = 0;
    return path[0] == '/' && is_below(path);
}
void change() {
    if (due(FaultKind::Kill)) ::kill(::getpid(), SIGKILL);
}

}  // namespace

extern "C" ssize_t write(int descriptor, const void* bytes, size_t count) {
    static const auto call = next<ssize_t (*)(int, const void*, size_t)>("write");
    if (kind == FaultKind::Kill && is_below(descriptor)) {
        change();
        if (count > 1) {  // and in the middle
            const ssize_t half = call(descriptor, bytes, count / 2);
            change();
            return half;
        }
    }
    if (kind == FaultKind::Disk && is_below(descriptor)) {
        const uint64_t room = fails_at > counted ? fails_at - counted : 0;
        if (room == 0) return errno = ENOSPC, -1;
        if (count > room) count = room;
        counted += count;
    }
    return call(descriptor, bytes, count);
}
extern "C" int rename(const char* from, const char* to) noexcept {
    static const auto call = next<int (*)(const char*, const char*)>("rename");
    if (kind == FaultKind::Kill && is_below(to)) {
        change();
        const int result = call(from, to);
        change();
        return result;
    }
    return call(from, to);
}
static int open_any(const char* name, const char* path, int flags, mode_t mode) {
    const auto call = next<int (*)(const char*, int, ...)>(name);
    if (kind == FaultKind::Kill && (flags & (O_CREAT | O_TRUNC)) && is_below(path)) {
        change();
        const int result = call(path, flags, mode);
        change();
        return result;
    }
    return call(path, flags, mode);
}
extern "C" int open(const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? mode_t(va_arg(more, int)) : 0;
    va_end(more);
    return open_any("open", path, flags, mode);
}
extern "C" int open64(const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? mode_t(va_arg(more, int)) : 0;
    va_end(more);
    return open_any("open64", path, flags, mode);
}
