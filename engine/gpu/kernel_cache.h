// Compute pipelines by shader and specialization constants. SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <map>
#include <utility>
#include <vector>

#include "gpu/embedded_code.h"
#include "gpu/kernel.h"

namespace vesper::gpu {

/// A compute shader that is embedded in the program.
struct Shader {
    const char* name;  ///< of its file, for messages
    EmbeddedCode spirv;
    /// The same where texel buffers are storage buffers (glsl/texels.glsl), which devices with short texel buffers are
    /// given; empty: there are none, or short ones.
    EmbeddedCode storage = {};
};

/// Makes each kernel when it is first asked for, and keeps it. Not thread-safe.
class KernelCache {
public:
    explicit KernelCache(const Device& device) : device_(device) {}

    /// The kernel of a shader whose specialization constant i is constants[i]. Valid as long as the cache. Throws
    /// Error.
    const Kernel& get(const Shader& shader, std::initializer_list<uint32_t> constants = {}) const;
    /// Compiles all that were asked for and are not compiled, in several threads. Throws Error.
    void compile();
    const Device& device() const { return device_; }

private:
    using Key = std::pair<const uint32_t*, std::vector<uint32_t>>;  // code and constants

    const Device& device_;
    mutable std::map<Key, Kernel> kernels_;
    mutable std::vector<const Kernel*> new_;  // asked for since the last compile()
};

}  // namespace vesper::gpu
