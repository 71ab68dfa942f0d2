// SPIR-V that is embedded in the program. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

namespace vesper::gpu {

/// Refers to an array of cmake/embed_shader.cmake: the number of words, then the words.
class EmbeddedCode {
public:
    constexpr EmbeddedCode() = default;
    constexpr EmbeddedCode(const uint32_t* counted) : counted_(counted) {}

    /// Empty if there is no code.
    operator std::span<const uint32_t>() const {
        if (!counted_) return {};
        return {counted_ + 1, *counted_};
    }

private:
    const uint32_t* counted_ = nullptr;
};

}  // namespace vesper::gpu
