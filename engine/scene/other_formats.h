// Scene files of other programs, told by their first bytes. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace vesper::scene {

constexpr size_t kOtherStart = 4096;  ///< bytes that other_format looks at

/// The name of the format that a file is in and the way from it to glTF, as one line goes on behind the file's name;
/// "" for one that is not known. `size` of the file in bytes; `ending` of its name in small letters decides only where
/// the bytes leave it open, as those of compressed files do.
std::string other_format(std::span<const uint8_t> start, uint64_t size, std::string_view ending);

}  // namespace vesper::scene
