// Trace files of OSI (.osi): messages, each after its length as four bytes, low byte first. SPDX-License-Identifier:
// MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "osi/message.h"

namespace vesper::osi {

constexpr uint64_t kMostTraceBytes = uint64_t{1} << 30;

struct Trace {
    std::vector<Message> messages;             ///< times ascending, at least one
    std::vector<StationaryObject> stationary;  ///< of all messages, each thing once as it was stated first
    std::vector<std::string> notes;            ///< what was left out, one line each
};

/// Reads a trace of GroundTruths or SensorViews, at most 1 GiB. Messages no later than one before them are left out,
/// and so is a last one that is cut off, both with a note. Throws Error naming file, message and reason.
Trace read_trace(const std::filesystem::path& file);
Trace parse_trace(std::span<const uint8_t> bytes, const std::string& name);

/// A message as it stands in a trace.
std::string trace_bytes_of(const Message&);

}  // namespace vesper::osi
