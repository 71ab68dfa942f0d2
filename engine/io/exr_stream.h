// OpenEXR files in memory. Not for others. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include <ImfIO.h>

namespace vesper::io {

/// Bytes as OpenEXR reads them. Throws Error where they end.
class ExrStream : public Imf::IStream {
public:
    ExrStream(const std::string& name, std::span<const uint8_t> bytes) : IStream(name.c_str()), bytes_(bytes) {}
    bool read(char to[], int count) override;
    uint64_t tellg() override { return at_; }
    void seekg(uint64_t position) override { at_ = position; }
    void clear() override {}

private:
    std::span<const uint8_t> bytes_;
    uint64_t at_ = 0;
};

/// Bits of the second word of a file.
constexpr uint32_t kExrVersion = 0xff, kExrTiled = 0x200, kExrDeep = 0x800, kExrParts = 0x1000;

/// The word (little endian) at a place of a file that has it.
uint32_t exr_word(std::span<const uint8_t> bytes, size_t at);

/// Goes through the attributes of all headers of a file before OpenEXR does, which takes the memory that each states.
/// Throws Error unless it is an OpenEXR file with all of them in it, and what every header must have.
void see_exr_attributes(std::span<const uint8_t> bytes,
                        const std::function<void(std::string_view name, std::span<const uint8_t> value)>& see);

}  // namespace vesper::io
