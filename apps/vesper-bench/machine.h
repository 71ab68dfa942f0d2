// What the machine is, and what it can do at most. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "gpu/device.h"

namespace vesper::bench {

/// The host's processor, as it names itself.
std::string processor_name();

constexpr uint64_t kCopiedBytes = 256ull << 20;  ///< larger than any cache

/// Bytes read and written per second while memory is copied, the best of several times: by the device's own command, or
/// by all threads of the host.
double device_copy_bandwidth(const gpu::Device& device, uint64_t bytes = kCopiedBytes);
double host_copy_bandwidth(uint64_t bytes = kCopiedBytes);
/// That of the device. Where it is the processor, that of the host, since the command there uses one thread.
double copy_bandwidth(const gpu::Device& device);

/// Time that all threads of the host (parallel_threads()) take for the same amount of arithmetic, each kArithmetic
/// multiplications and as many additions of floats, ms, the least of several times: how fast the processor is at this
/// hour.
constexpr uint64_t kArithmetic = 1ull << 26;
double arithmetic_ms(uint64_t operations = kArithmetic);

/// Time that all threads of this process have computed, user and system, ms.
double processor_ms();

/// Most memory of this process that was resident at once, bytes, since it was last forgotten (where the system can
/// forget).
uint64_t peak_host_bytes();
void forget_peak_host_bytes();

}  // namespace vesper::bench
