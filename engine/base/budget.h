// What reading and preparing a file may take. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "base/error.h"

namespace vesper {

/// A file asks for more than a limit allows: it may be whole, and a higher limit would read it.
struct OverLimit : Error {
    using Error::Error;
};

/// Limits processor time and memory of this thread during its lifetime: 60 s and 2 GiB, both times the factor
/// VESPER_LIMITS (base/limits.h). Memory is what is announced by spend(): it grows with the file. A
/// budget within another has no effect. Without a budget nothing is refused.
class Budget {
public:
    /// `task` begins messages: "reading street.gltf".
    explicit Budget(std::string task);
    ~Budget();
    Budget(const Budget&) = delete;
    Budget& operator=(const Budget&) = delete;

    std::string task;
    uint64_t bytes_left = 0, bytes = 0;
    int64_t end = 0, nanoseconds = 0;  ///< of the thread's processor time
    unsigned calls = 0;
};

/// Announces memory before it is taken. Throws OverLimit if the budget does not have it.
void spend(uint64_t bytes);

/// Memory that is taken for a while.
class TemporaryMemory {
public:
    explicit TemporaryMemory(uint64_t bytes) : bytes_(bytes) { spend(bytes); }
    ~TemporaryMemory();
    TemporaryMemory(const TemporaryMemory&) = delete;
    TemporaryMemory& operator=(const TemporaryMemory&) = delete;

private:
    uint64_t bytes_;
};

/// For loops whose length a file states. Throws OverLimit if the time of the budget is over; looks at the clock at one
/// call in 64.
void check_time();

}  // namespace vesper
