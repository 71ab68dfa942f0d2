// Loops on all processors. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>

namespace vesper {

constexpr const char* kThreadsVariable = "VESPER_THREADS";  ///< of the environment
constexpr unsigned kMostThreads = 1024;

/// A whole number from 1 to kMostThreads; 0: the text, or null, is none.
unsigned threads_in(const char* text);
/// Threads that a loop uses: as VESPER_THREADS says, or one for each processor.
unsigned parallel_threads();

/// Calls work(begin, end) for parts of `count` things, of `part` each but for the last, in any order and in several
/// threads at a time. `progress` is called now and then from this thread with the number of things done; where it
/// returns false no more are begun, and false is returned. Throws what `work` or `progress` throws first.
bool in_parallel(size_t count, size_t part, const std::function<void(size_t begin, size_t end)>& work,
                 const std::function<bool(size_t done)>& progress = {});

}  // namespace vesper
