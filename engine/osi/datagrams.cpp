#include "osi/datagrams.h"

#include <cstdlib>
#include <limits>
#include <utility>

#include "osi/message.h"

namespace vesper::osi {
namespace {

constexpr size_t kHeading = 8;

uint32_t word_at(std::span<const uint8_t> bytes, size_t at) {
    return uint32_t(bytes[at]) | uint32_t(bytes[at + 1]) << 8 | uint32_t(bytes[at + 2]) << 16 |
           uint32_t(bytes[at + 3]) << 24;
}

}  // namespace

void DatagramReader::drop() {
    if (next_ != 1) ++incomplete_;
    parts_.clear(), next_ = 1, skips_ = false;
}

std::optional<std::vector<uint8_t>> DatagramReader::take(std::span<const uint8_t> datagram) {
    const bool packet = datagram.size() >= kHeading && word_at(datagram, 4) == datagram.size() - kHeading;
    const auto counter = packet ? int32_t(word_at(datagram, 0)) : 0;
    if (counter == 0 || counter == std::numeric_limits<int32_t>::min()) {
        drop();
        return std::vector<uint8_t>(datagram.begin(), datagram.end());
    }
    const int32_t number = std::abs(counter);
    if (number == 1) drop();
    if (number != next_ || parts_.size() + datagram.size() > kMostMessageBytes) {
        if (!skips_) ++incomplete_;
        parts_.clear(), next_ = 1, skips_ = counter > 0;
        return std::nullopt;
    }
    parts_.insert(parts_.end(), datagram.begin() + kHeading, datagram.end());
    if (counter > 0) {
        ++next_;
        return std::nullopt;
    }
    next_ = 1;
    return std::exchange(parts_, {});
}

}  // namespace vesper::osi
