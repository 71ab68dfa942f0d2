// A simulator that sends messages to this machine. SPDX-License-Identifier: MIT
#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

namespace vesper::test {

class UdpSender {
public:
    explicit UdpSender(uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
        to_.sin_family = AF_INET, to_.sin_port = htons(port), to_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    }
    ~UdpSender() { ::close(socket_); }
    UdpSender(const UdpSender&) = delete;
    UdpSender& operator=(const UdpSender&) = delete;

    void send(const std::string& bytes) const {
        EXPECT_EQ(::sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_),
                  ssize_t(bytes.size()));
    }
    /// As esmini does; packet `lost` is not sent.
    void send_packets(const std::string& bytes, size_t size, int32_t lost = 0) const {
        int32_t counter = 1;
        for (size_t from = 0; from < bytes.size(); from += size, ++counter) {
            const std::string part = bytes.substr(from, size);
            const int32_t number = from + size >= bytes.size() ? -counter : counter;
            std::string packet;
            for (const uint32_t word : {uint32_t(number), uint32_t(part.size())})
                for (int i = 0; i < 4; ++i) packet += char(word >> 8 * i & 0xff);
            if (counter != lost) send(packet + part);
        }
    }

private:
    int socket_;
    sockaddr_in to_{};
};

}  // namespace vesper::test
