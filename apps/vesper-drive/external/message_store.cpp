#include "external/message_store.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "base/error.h"
#include "osi/trace.h"

namespace vesper::drive {
namespace {

[[noreturn]] void give_up() { throw Error(std::string("keeping messages: ") + std::strerror(errno)); }

}  // namespace

void MessageStore::keep(const std::string& bytes) {
    if (!all_) all_.reset(std::tmpfile());
    if (!all_ || std::fwrite(bytes.data(), 1, bytes.size(), all_.get()) != bytes.size()) give_up();
    if (trace_) trace_->append(bytes);
}

bool MessageStore::add(const osi::Message& message) {
    if (!problem_.empty()) return false;
    try {
        const std::string bytes = osi::trace_bytes_of(message);
        bytes_ += bytes.size();
        if (bytes_ > osi::kMostTraceBytes) throw Error("messages are more than a trace may have");
        keep(bytes);
    } catch (const Error& error) {
        problem_ = error.what();
    }
    return problem_.empty();
}

void MessageStore::open(const std::filesystem::path& trace) {
    if (!problem_.empty()) throw Error(problem_);
    trace_ = std::make_unique<io::GrowingFile>(trace);
    if (!all_) return;
    if (std::fseek(all_.get(), 0, SEEK_SET) != 0) give_up();
    std::array<char, 1 << 16> buffer;
    while (const size_t read = std::fread(buffer.data(), 1, buffer.size(), all_.get()))
        trace_->append({buffer.data(), read});
    if (std::ferror(all_.get()) != 0 || std::fseek(all_.get(), 0, SEEK_END) != 0) give_up();
}

void MessageStore::close() {
    if (trace_) std::exchange(trace_, nullptr)->complete();
}

}  // namespace vesper::drive
