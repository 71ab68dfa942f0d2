// Every reader of files from outside, as a function of bytes: what fuzzers call. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>

namespace vesper::test {

/// Reads the bytes as a file of its kind. A vesper::Error is an answer; anything else that is thrown is a finding.
using FuzzTarget = std::function<void(std::span<const uint8_t>)>;

/// The library's readers, by name.
const std::map<std::string, FuzzTarget>& fuzz_targets();
/// The readers of the programs and the C interface, by name.
const std::map<std::string, FuzzTarget>& program_fuzz_targets();

/// A reader of files, given one of this name that holds the bytes.
FuzzTarget of_file(const std::string& name, const std::function<void(const std::filesystem::path&)>& read);
/// The same, with what a vesper::Error says passed over.
std::map<std::string, FuzzTarget> answering(std::map<std::string, FuzzTarget>);

}  // namespace vesper::test
