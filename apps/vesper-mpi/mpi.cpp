// Messages between processes by MPI, behind message_passing.h. SPDX-License-Identifier: MIT
#include <mpi.h>

#include <climits>
#include <cstdlib>
#include <iterator>
#include <list>
#include <map>
#include <utility>
#include <vector>

#include "ranks/message_passing.h"

namespace {

struct Sending {
    std::vector<std::byte> bytes;
    MPI_Request request = MPI_REQUEST_NULL;
};

std::list<Sending> sending;
char host[MPI_MAX_PROCESSOR_NAME + 1];
char text[MPI_MAX_ERROR_STRING + 1];

int send(int to, int stream, const std::byte* bytes, size_t count) {
    if (count > size_t{INT_MAX}) return MPI_ERR_COUNT;
    Sending& one = sending.emplace_back(Sending{std::vector<std::byte>(bytes, bytes + count)});
    return MPI_Isend(one.bytes.data(), int(count), MPI_BYTE, to, stream, MPI_COMM_WORLD, &one.request);
}

int move_on(size_t* left) {
    for (auto one = sending.begin(); one != sending.end();) {
        int done = 0;
        if (const int error = MPI_Test(&one->request, &done, MPI_STATUS_IGNORE); error != MPI_SUCCESS) return error;
        one = done ? sending.erase(one) : std::next(one);
    }
    *left = sending.size();
    return MPI_SUCCESS;
}

// A message that comes in: nothing waits for the rest of it, so that a machine that stops meanwhile is noticed.
struct Receiving {
    std::vector<std::byte> bytes;
    MPI_Request request = MPI_REQUEST_NULL;
};
std::map<std::pair<int, int>, Receiving> receiving;  // by rank and stream
std::vector<std::byte> received(1);

int receive(int from, int stream, const std::byte** bytes, size_t* count) {
    *bytes = nullptr;
    auto here = receiving.find({from, stream});
    if (here == receiving.end()) {
        int there = 0, size = 0;
        MPI_Message message = MPI_MESSAGE_NULL;
        MPI_Status status;
        if (const int error = MPI_Improbe(from, stream, MPI_COMM_WORLD, &there, &message, &status);
            error != MPI_SUCCESS || !there)
            return error;
        if (const int error = MPI_Get_count(&status, MPI_BYTE, &size); error != MPI_SUCCESS) return error;
        here = receiving.try_emplace({from, stream}).first;
        here->second.bytes.resize(size_t(size));
        if (const int error = MPI_Imrecv(here->second.bytes.data(), size, MPI_BYTE, &message, &here->second.request);
            error != MPI_SUCCESS)
            return error;
    }
    int done = 0;
    const int error = MPI_Test(&here->second.request, &done, MPI_STATUS_IGNORE);
    if (error != MPI_SUCCESS || !done) return error;
    received = std::move(here->second.bytes);
    receiving.erase(here);
    *count = received.size();
    if (received.empty()) received.resize(1);  // a message without bytes is one
    *bytes = received.data();
    return MPI_SUCCESS;
}

const char* text_of(int error) {
    int length = 0;
    text[0] = '\0';
    MPI_Error_string(error, text, &length);
    return text;
}

void end_all(int code) { MPI_Abort(MPI_COMM_WORLD, code); }
void finish() { MPI_Finalize(); }

vesper::apps::MessagePassing passing;

}  // namespace

extern "C" const vesper::apps::MessagePassing* vesper_message_passing_1() {
    // Copies between processes by the kernel are forbidden in many containers, where messages would be lost.
    setenv("OMPI_MCA_btl_vader_single_copy_mechanism", "none", 0);
    int threads = 0, length = 0;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &threads) != MPI_SUCCESS) return nullptr;
    if (threads < MPI_THREAD_SERIALIZED) return nullptr;
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    MPI_Comm_rank(MPI_COMM_WORLD, &passing.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &passing.size);
    MPI_Get_processor_name(host, &length);
    passing.host = host;
    passing.send = send, passing.receive = receive, passing.move_on = move_on;
    passing.text_of = text_of, passing.end_all = end_all, passing.finish = finish;
    return &passing;
}
