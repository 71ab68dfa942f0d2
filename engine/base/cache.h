// What is kept from run to run to spare work. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "base/digest.h"

namespace vesper {

/// Keeps bytes under digests of all that they depend on, as far as it can: it may forget any. Not thread-safe. Readers
/// check what they get as that of a file from elsewhere. Functions throw nothing but std::bad_alloc.
class Cache {
public:
    virtual ~Cache() = default;

    /// How many bytes are kept, 0 where there are none: before memory is taken for a number that others wrote.
    virtual uint64_t bytes(const Digest::Value& key) = 0;
    /// Fills `bytes` with what is kept. False, and `bytes` hold anything, where nothing is, or not just as many.
    virtual bool read(const Digest::Value& key, std::span<std::byte> bytes) = 0;
    /// False: write() does nothing any more.
    virtual bool writes() const = 0;
    virtual void write(const Digest::Value& key, std::span<const std::byte> bytes) = 0;
    /// To be called after some reads and writes: holds the cache to its size. Returns, once each, why it writes no more
    /// and what it does not trust; else nothing.
    virtual std::string settle() = 0;
};

}  // namespace vesper
