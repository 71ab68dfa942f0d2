#include "osi/receiver.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/one_line.h"
#include "io/descriptor.h"

namespace vesper::osi {
namespace {

using Clock = std::chrono::steady_clock;

constexpr uint64_t kMostQueued = uint64_t{64} << 20;  // bytes
constexpr size_t kLargestDatagram = 65536;
constexpr int kBuffer = 4 << 20, kWake = 50;        // bytes that the system keeps; ms between looks at the end
constexpr auto kSilence = std::chrono::seconds(5);  // of a sender, after which another is listened to
constexpr size_t kMostSources = 8;                  // of datagrams that are no message yet, whose packets are kept
constexpr double kBack = 1, kAhead = 10;            // s: further from the latest message is another run
constexpr int kAstrayInTurn = 5;                    // messages of that, which goes on after the one before by
constexpr int64_t kStep = 50'000'000;               // ns

sockaddr_in socket_address(const Address& address) {
    sockaddr_in made{};
    made.sin_family = AF_INET, made.sin_port = htons(address.port);
    if (::inet_pton(AF_INET, address.host.c_str(), &made.sin_addr) != 1)
        throw Error("--osi-udp " + one_line(address.host) + ": an address such as 127.0.0.1 is expected");
    return made;
}

bool is_same(const sockaddr_in& a, const sockaddr_in& b) {
    return a.sin_addr.s_addr == b.sin_addr.s_addr && a.sin_port == b.sin_port;
}

// An address that datagrams came from.
struct Source {
    sockaddr_in from{};
    DatagramReader datagrams = {};
    Clock::time_point heard = {};
};

}  // namespace

Address parse_address(const std::string& text) {
    Address address;
    const size_t colon = text.rfind(':');
    if (colon != text.npos) address.host = text.substr(0, colon);
    const std::string port = colon == text.npos ? text : text.substr(colon + 1);
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
    if (error != std::errc() || end != port.data() + port.size())
        throw Error("--osi-udp " + one_line(text) + ": [ADDRESS:]PORT is expected, such as 48198");
    socket_address(address);
    return address;
}

struct Receiver::Impl {
    explicit Impl(const Address& address) : socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
        const std::string place = "--osi-udp " + address.host + ":" + std::to_string(address.port) + ": ";
        if (!socket.is_open()) throw Error(place + std::strerror(errno));
        sockaddr_in own = socket_address(address);
        ::setsockopt(socket.number(), SOL_SOCKET, SO_RCVBUF, &kBuffer, sizeof kBuffer);  // less is no failure
        if (::bind(socket.number(), reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0)
            throw Error(place + std::strerror(errno));
        socklen_t size = sizeof own;
        ::getsockname(socket.number(), reinterpret_cast<sockaddr*>(&own), &size);
        port = ntohs(own.sin_port);
        try {
            listener = std::thread([this] { listen(); });
        } catch (const std::system_error& error) {
            throw Error(place + "no thread can be created to listen: " + error.code().message());
        }
    }
    ~Impl() {
        ends = true;
        listener.join();
    }

    void listen() {
        std::vector<uint8_t> buffer(kLargestDatagram);
        while (!ends) {
            pollfd waits{.fd = socket.number(), .events = POLLIN, .revents = 0};
            if (::poll(&waits, 1, kWake) <= 0) continue;
            sockaddr_in from{};
            socklen_t size = sizeof from;
            const ssize_t bytes =
                ::recvfrom(socket.number(), buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
            if (bytes >= 0) hear({buffer.data(), size_t(bytes)}, from);
        }
    }

    void hear(std::span<const uint8_t> datagram, const sockaddr_in& from) {
        const Clock::time_point now = Clock::now();
        if (sender && !is_same(*sender, from) && now - heard < kSilence) {
            const std::lock_guard lock(mutex);
            ++counts.foreign;
            return;
        }
        Source& source = source_of(from, now);
        const uint64_t before = source.datagrams.incomplete();
        std::string problem;
        try {
            const auto bytes = source.datagrams.take(datagram);
            incomplete += source.datagrams.incomplete() - before;
            if (bytes) {
                Message message = parse_message(*bytes);
                if (!sender || !is_same(*sender, from)) sender = from;
                heard = now;
                hear_message(std::move(message), now);
            }
        } catch (const std::exception& error) {  // also of memory: nothing that comes ends the drive
            problem = error.what();
        }
        const std::lock_guard lock(mutex);
        counts.incomplete = incomplete;
        if (problem.empty()) return;
        ++counts.malformed;
        last_problem = std::move(problem);
    }

    // Where the datagrams of an address are put together. The source that was silent for the longest time gives way.
    Source& source_of(const sockaddr_in& from, Clock::time_point now) {
        auto source =
            std::find_if(sources.begin(), sources.end(), [&](const Source& s) { return is_same(s.from, from); });
        if (source == sources.end() && sources.size() < kMostSources) {
            source = sources.insert(sources.end(), Source{.from = from});
        } else if (source == sources.end()) {
            source = std::min_element(sources.begin(), sources.end(),
                                      [](const Source& a, const Source& b) { return a.heard < b.heard; });
            *source = Source{.from = from};
        }
        source->heard = now;
        return *source;
    }

    void hear_message(Message message, Clock::time_point now) {
        const bool astray = !move_time(message);
        const uint64_t bytes = memory_of(message);
        const std::lock_guard lock(mutex);
        ++counts.messages;
        counts.restarts = restarts;
        if (astray) {
            ++counts.astray;
        } else if (queued + bytes > kMostQueued) {
            ++counts.crowded_out;
        } else {
            queue.push_back({{std::move(message), now}, bytes});
            queued += bytes;
            arrived.notify_one();
        }
    }

    // A sender that begins again, or jumps, has times far from those that it had, and goes on from there once some in
    // turn have. False: it is far from them, so far.
    bool move_time(Message& message) {
        const double far = 1e9, most = double(kMostNanoseconds);
        const auto moved_time = [&] { return double(message.nanoseconds) + double(moved); };
        const auto is_astray = [&] {
            const double by = latest ? moved_time() - double(*latest) : 0;
            return by < -kBack * far || by > kAhead * far || std::abs(moved_time()) > most;
        };
        astray_in_turn = is_astray() ? astray_in_turn + 1 : 0;
        if (astray_in_turn > 0 && astray_in_turn < kAstrayInTurn) return false;
        if (astray_in_turn > 0) {
            if (double(*latest) - double(message.nanoseconds) > 2 * most) return false;
            moved = *latest + kStep - message.nanoseconds, astray_in_turn = 0, ++restarts;
            if (is_astray()) return false;
        }
        message.nanoseconds += moved;
        latest = std::max(latest.value_or(message.nanoseconds), message.nanoseconds);
        return true;
    }

    struct Queued {
        Arrival arrival;
        uint64_t bytes;
    };
    io::Descriptor socket;
    uint16_t port = 0;
    // Of the listener.
    std::optional<sockaddr_in> sender;  // of the latest message
    Clock::time_point heard;            // that message
    std::vector<Source> sources;
    uint64_t incomplete = 0;
    std::optional<int64_t> latest;
    int64_t moved = 0;
    int astray_in_turn = 0;
    uint64_t restarts = 0;
    // Of both.
    std::mutex mutex;
    std::condition_variable arrived;
    std::deque<Queued> queue;
    uint64_t queued = 0;
    StreamCounts counts;
    std::string last_problem;
    std::atomic<bool> ends{false};
    std::thread listener;
};

Receiver::Receiver(const Address& address) : impl_(std::make_unique<Impl>(address)) {}
Receiver::~Receiver() = default;

std::optional<Receiver::Arrival> Receiver::take(std::chrono::milliseconds longest) {
    std::unique_lock lock(impl_->mutex);
    if (!impl_->arrived.wait_for(lock, longest, [&] { return !impl_->queue.empty(); })) return std::nullopt;
    Impl::Queued oldest = std::move(impl_->queue.front());
    impl_->queue.pop_front();
    impl_->queued -= oldest.bytes;
    return std::move(oldest.arrival);
}

uint16_t Receiver::port() const { return impl_->port; }

StreamCounts Receiver::counts() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->counts;
}

std::string Receiver::last_problem() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->last_problem;
}

}  // namespace vesper::osi
