// What a library of messages between processes offers the programs: the functions of vesper-mpi.so, which is loaded
// where mpirun or srun has started several. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace vesper::apps {

/// Functions return 0, or what MPI says is wrong. One thread at a time may call them.
struct MessagePassing {
    int rank = 0, size = 1;
    const char* host = "";  ///< name of this machine
    /// Takes a copy of the bytes and does not wait.
    int (*send)(int to, int stream, const std::byte* bytes, size_t count) = nullptr;
    /// The earliest message of a rank and stream, where all of it has come; else null. It does not wait, and the bytes
    /// are there until the next call.
    int (*receive)(int from, int stream, const std::byte** bytes, size_t* count) = nullptr;
    /// Moves on what is being sent, and says how many messages are.
    int (*move_on)(size_t* sending) = nullptr;
    const char* (*text_of)(int error) = nullptr;
    void (*end_all)(int code) = nullptr;  ///< ends every process
    void (*finish)() = nullptr;           ///< after all processes have called it
};

/// Of that library: starts it. Null: it cannot be used.
using StartMessagePassing = const MessagePassing* (*)();
inline constexpr const char* kStartMessagePassing = "vesper_message_passing_1";

}  // namespace vesper::apps
