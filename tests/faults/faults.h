// Makes the n-th call of a kind fail, in tests that link vesper-faults before all others and in programs that preload
// it. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace vesper::test {

enum class FaultKind : int {
    None,
    Vulkan,  ///< a call of Vulkan returns `code`; after VK_ERROR_DEVICE_LOST all that wait for the device do
    Memory,  ///< an allocation of the thread that armed it gives nothing
    Disk,    ///< from so many bytes on, written below the working folder, there is no space left (ENOSPC)
    Kill     ///< before something changes below the working folder, the program is killed (SIGKILL)
};

/// Counts calls of a kind from now on and makes number `at` fail, from 1; 0: none. Programs are armed by
/// VESPER_FAULT="KIND AT CODE", as numbers.
extern "C" void vesper_fault_arm(FaultKind kind, uint64_t at, int code);
/// Counted since it was armed.
extern "C" uint64_t vesper_fault_count();
/// Allocations of this thread less what it freed, since it was armed for Memory.
extern "C" int64_t vesper_fault_live();

}  // namespace vesper::test
