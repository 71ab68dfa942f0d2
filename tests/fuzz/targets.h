// Every reader of files from outside, as a function of bytes: what fuzzers call. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>

namespace vesper::test {

/// Reads the bytes as a file of its kind. A vesper::Error is an answer; anything else that is thrown is a finding.
using FuzzTarget = std::function<void(std::span<const uint8_t>)>;

/// By name.
const std::map<std::string, FuzzTarget>& fuzz_targets();

}  // namespace vesper::test
