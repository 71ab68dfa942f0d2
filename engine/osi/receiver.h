// Messages of a simulator that sends them by UDP. SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "osi/datagrams.h"
#include "osi/message.h"

namespace vesper::osi {

constexpr uint16_t kUsualPort = 48198;  ///< that of esmini

/// Where datagrams are expected.
struct Address {
    std::string host = "127.0.0.1";  ///< numbers of IPv4; 0.0.0.0: all of this machine
    uint16_t port = kUsualPort;      ///< 0: any that is free
};
/// "PORT" or "ADDRESS:PORT". Throws Error.
Address parse_address(const std::string& text);

/// Listens on a thread of its own and keeps what came until it is taken, at most 64 MiB of it. A sender is an address
/// of which a message was read. The first one is listened to, and another once no message of that one has come for 5 s.
/// Packets of eight addresses are put together at a time. A sender whose time begins again goes on where it was: its
/// later times are moved. Throws Error.
class Receiver {
public:
    explicit Receiver(const Address&);
    ~Receiver();
    Receiver(const Receiver&) = delete;
    Receiver& operator=(const Receiver&) = delete;

    struct Arrival {
        Message message;
        std::chrono::steady_clock::time_point time;
    };
    /// The oldest that was not taken; waits for it no longer than that.
    std::optional<Arrival> take(std::chrono::milliseconds longest = {});

    uint16_t port() const;
    StreamCounts counts() const;       ///< without late and repeated, which a Timeline tells
    std::string last_problem() const;  ///< why the latest of the malformed messages cannot be read; empty: none is

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vesper::osi
