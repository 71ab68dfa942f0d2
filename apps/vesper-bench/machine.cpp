#include "machine.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <system_error>
#include <thread>
#include <vector>

#include "base/parallel.h"
#include "base/stopwatch.h"
#include "gpu/memory.h"

namespace vesper::bench {
namespace {

constexpr int kTries = 5;

/// The rest of the first line of a file that begins with a key, without blanks and the colon.
std::string value_in(const char* file, const std::string& key) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with(key)) continue;
        const size_t at = line.find_first_not_of(" \t:", key.size());
        return at == line.npos ? std::string() : line.substr(at);
    }
    return {};
}

/// The least time of several that all threads of the host take for work(thread, threads), ms.
template <class Work>
double least_ms(const Work& work) {
    const size_t threads = parallel_threads();
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kTries; ++i) {
        const Stopwatch watch;
        std::vector<std::jthread> working;
        size_t t = 0;
        try {
            for (; t < threads; ++t) working.emplace_back([&work, t, threads] { work(t, threads); });
        } catch (const std::system_error&) {  // the host has no more: the rest is done here
        }
        for (; t < threads; ++t) work(t, threads);
        working.clear();
        best = std::min(best, watch.milliseconds());
    }
    return best;
}

}  // namespace

std::string processor_name() {
    const std::string name = value_in("/proc/cpuinfo", "model name");
    return name.empty() ? "an unknown processor" : name;
}

double host_copy_bandwidth(uint64_t bytes) {
    std::vector<std::byte> from(bytes, std::byte{1}), to(bytes, std::byte{2});
    const double best = least_ms([&](size_t thread, size_t threads) {
        const size_t begin = bytes * thread / threads, end = bytes * (thread + 1) / threads;
        std::memcpy(to.data() + begin, from.data() + begin, end - begin);
    });
    return 2 * double(bytes) / (best * 1e-3);
}

double device_copy_bandwidth(const gpu::Device& device, uint64_t bytes) {
    gpu::Arena arena(device);
    gpu::OwnedBuffer buffers[2];
    for (gpu::OwnedBuffer& buffer : buffers) {
        buffer = gpu::make_buffer(device, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        arena.bind(buffer.get());
    }
    const auto copy = [&](uint32_t times) {
        const Stopwatch watch;
        device.run_once([&](VkCommandBuffer commands) {
            for (uint32_t i = 0; i < times; ++i) {
                const VkBufferCopy whole{0, 0, bytes};
                vkCmdCopyBuffer(commands, buffers[i % 2].get(), buffers[1 - i % 2].get(), 1, &whole);
                const VkMemoryBarrier2 barrier{
                    .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                    .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                    .srcAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT,
                    .dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                    .dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT};
                const VkDependencyInfo dependency{
                    .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &barrier};
                vkCmdPipelineBarrier2(commands, &dependency);
            }
        });
        return watch.milliseconds();
    };
    copy(1);                         // the memory is touched, the clocks are up
    constexpr uint32_t kTimes = 40;  // the way to the device and back is shared by so many
    double best = 0;
    for (int i = 0; i < kTries; ++i) best = std::max(best, 2 * double(bytes) * kTimes / (copy(kTimes) * 1e-3));
    return best;
}

double copy_bandwidth(const gpu::Device& device) {
    return device.is_cpu() ? host_copy_bandwidth() : device_copy_bandwidth(device);
}

double arithmetic_ms(uint64_t operations) {
    constexpr size_t kChains = 32;  // that do not wait for one another
    std::vector<float> results(parallel_threads());
    const double best = least_ms([&](size_t thread, size_t) {
        float values[kChains];
        for (size_t k = 0; k < kChains; ++k) values[k] = float(k);
        for (uint64_t n = 0; n < operations / kChains; ++n)
            for (float& value : values) value = value * 0.999f + 0.001f;  // towards 1
        for (const float value : values) results[thread] += value;
    });
    return std::ranges::all_of(results, [](float result) { return result > 0; }) ? best : 0;  // they are used
}

uint64_t peak_host_bytes() {
    if (const std::string peak = value_in("/proc/self/status", "VmHWM"); !peak.empty())
        return std::strtoull(peak.c_str(), nullptr, 10) << 10;  // kB
    rusage use{};
    getrusage(RUSAGE_SELF, &use);
    return uint64_t(use.ru_maxrss) << 10;
}

double processor_ms() {
    rusage use{};
    getrusage(RUSAGE_SELF, &use);
    const auto ms = [](const timeval& time) { return 1e3 * double(time.tv_sec) + 1e-3 * double(time.tv_usec); };
    return ms(use.ru_utime) + ms(use.ru_stime);
}

void forget_peak_host_bytes() { std::ofstream("/proc/self/clear_refs") << "5"; }

}  // namespace vesper::bench
