#include "osi/trace.h"

#include <algorithm>
#include <new>
#include <set>
#include <string_view>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/read_file.h"
#include "osi/unit_check.h"

namespace vesper::osi {
namespace {

constexpr size_t kLengthBytes = 4;
constexpr std::string_view kMcap = "\x89MCAP";

// Writes the messages of a file of MCAP in the order of their times, each after its length.
constexpr char kFromMcap[] =
    "python3 -c \"import struct, sys; from mcap.reader import make_reader; [sys.stdout.buffer.write(struct.pack('<I', "
    "len(m.data)) + m.data) for _, _, m in make_reader(open(sys.argv[1], 'rb')).iter_messages()]\" TRACE.mcap > "
    "TRACE.osi";

// Reads messages one after another.
class TraceReader {
public:
    explicit TraceReader(const std::string& name) : name_(one_line(name)) {}

    Trace read(std::span<const uint8_t> bytes) {
        if (std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()).starts_with(kMcap))
            throw Error(name_ + ": is a trace of MCAP: convert it: pip install mcap && " + kFromMcap);
        for (uint64_t at = 0; at < bytes.size(); ++number_) {
            check_time();
            const auto rest = bytes.subspan(at);
            uint64_t length = 0;
            for (size_t i = 0; i < kLengthBytes && i < rest.size(); ++i) length |= uint64_t(rest[i]) << 8 * i;
            if (rest.size() >= kLengthBytes && length > kMostMessageBytes)
                fail(at, "says that it has " + std::to_string(length) + " bytes; a message has at most " +
                             std::to_string(kMostMessageBytes));
            if (rest.size() < kLengthBytes + length) {
                cut_off(at);
                break;
            }
            add(rest.subspan(kLengthBytes, length), at);
            at += kLengthBytes + length;
        }
        if (trace_.messages.empty()) throw Error(name_ + ": has no message");
        if (late_ > 0) note(std::to_string(late_) + " messages are not later than those before them: left out");
        if (!objects_) note("is of GroundTruths in which nothing moves: no message has a moving_object with a place");
        for (const std::string& doubt : units_.doubts()) note(doubt);
        if (const uint64_t lost = stationary_left_out_ + more_stationary_; lost > 0)
            note(std::to_string(lost) + " stationary objects and signs are left out: without a place, or beyond " +
                 std::to_string(kMostObjects));
        return std::move(trace_);
    }

private:
    [[noreturn]] void fail(uint64_t at, const std::string& reason) const {
        throw Error(name_ + ": message " + std::to_string(number_ + 1) + " at byte " + std::to_string(at) + " " +
                    reason);
    }
    void note(const std::string& text) { trace_.notes.push_back(name_ + ": " + text); }
    void cut_off(uint64_t at) {
        if (number_ == 0) fail(at, "is cut off, and is the first");
        note("ends within message " + std::to_string(number_ + 1) + " at byte " + std::to_string(at));
    }
    void add(std::span<const uint8_t> bytes, uint64_t at) {
        try {
            Message message = parse_message(bytes);
            std::vector<Message>& all = trace_.messages;
            if (!all.empty() && message.nanoseconds <= all.back().nanoseconds) {
                ++late_;
                return;
            }
            take_stationary(message);
            objects_ |= !message.objects.empty();
            units_.add(message);
            spend(memory_of(message));
            all.push_back(std::move(message));
        } catch (const Error& error) {
            fail(at, error.what());
        }
    }

    void take_stationary(Message& message) {
        stationary_left_out_ = std::max(stationary_left_out_, message.stationary_left_out);
        for (StationaryObject& object : message.stationary) {
            if (known_.contains(key_of(object))) continue;
            if (known_.size() >= size_t(kMostObjects)) {
                ++more_stationary_;
                continue;
            }
            known_.insert(key_of(object));
            trace_.stationary.push_back(object);
        }
        message.stationary = {};
    }

    std::string name_;
    std::set<StationaryKey> known_;
    uint64_t stationary_left_out_ = 0, more_stationary_ = 0;  // of one message; of those with more than the trace keeps
    bool objects_ = false;
    UnitCheck units_;
    Trace trace_;
    size_t number_ = 0, late_ = 0;
};

}  // namespace

Trace parse_trace(std::span<const uint8_t> bytes, const std::string& name) {
    try {
        return TraceReader(name).read(bytes);
    } catch (const std::bad_alloc&) {
        throw OutOfHostMemory(one_line(name) + ": not enough memory");
    }
}

Trace read_trace(const std::filesystem::path& file) {
    return parse_trace(io::read_file(file, kMostTraceBytes), file.string());
}

std::string trace_bytes_of(const Message& message) {
    const std::string bytes = bytes_of(message);
    std::string made;
    for (size_t i = 0; i < kLengthBytes; ++i) made += char(bytes.size() >> 8 * i & 0xff);
    return made + bytes;
}

}  // namespace vesper::osi
