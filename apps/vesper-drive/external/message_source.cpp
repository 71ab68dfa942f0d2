#include "external/message_source.h"

#include <algorithm>
#include <charconv>

#include "base/error.h"
#include "base/one_line.h"
#include "osi/run_messages.h"
#include "osi/trace.h"

namespace vesper::drive {

std::string host_of(const std::string& text) {
    if (text.empty() || text == "none") return text;
    uint64_t id = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
    if (error != std::errc() || end != text.data() + text.size())
        throw Error(one_line(text) + ": the number of an object or none is expected");
    return std::to_string(id);
}

HeightReading height_reading_of(const std::string& name) {
    const auto known = std::find(kHeightReadings.begin(), kHeightReadings.end(), name);
    if (known == kHeightReadings.end()) throw Error(one_line(name) + ": auto, middle or ground is expected");
    return HeightReading(known - kHeightReadings.begin());
}

osi::Trace read_messages(const MessageSource& source) {
    if (source.file.empty()) return {};
    const std::filesystem::path named =
        source.file.extension() == ".part" ? source.file.parent_path() / source.file.stem() : source.file;
    if (named.extension() == ".csv") {
        const roads::EsminiRun run = roads::read_esmini_run(source.file);
        return {.messages = osi::messages_of(run), .stationary = {}, .notes = {}};
    }
    if (named.extension() != ".osi" && named.extension() != ".mcap")  // the reader says how that is converted
        throw Error(one_line(source.file.string()) + ": a trace (.osi) or a table of esmini (.csv) is expected");
    // A sender that never sent leaves an empty one.
    std::error_code failed;
    if (source.live && std::filesystem::file_size(source.file, failed) == 0 && !failed) return {};
    osi::Trace trace = osi::read_trace(source.file);
    if (std::any_of(trace.messages.begin(), trace.messages.end(), [](const osi::Message& m) {
            return m.environment && (m.environment->fog || m.environment->precipitation);
        }))
        trace.notes.push_back(one_line(source.file.string()) + ": states " + kWeather);
    return trace;
}

}  // namespace vesper::drive
