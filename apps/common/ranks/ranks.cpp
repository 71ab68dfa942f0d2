#include "ranks/ranks.h"

#include <dlfcn.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <sstream>
#include <system_error>
#include <thread>

#include "base/digest.h"
#include "base/one_line.h"
#include "io/file_gate.h"
#include "io/read_file.h"
#include "print.h"
#include "ranks/message_passing.h"

namespace vesper::apps {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto kBeat = std::chrono::milliseconds(250);
constexpr int kEndCode = 2;
const MessagePassing kAlone;
Ranks* started = nullptr;
std::string program = "vesper", start_arguments;
std::string start_problem;  // for which there are no ranks

double since(Clock::time_point time) { return std::chrono::duration<double>(Clock::now() - time).count(); }

int number_in(std::initializer_list<const char*> names, int otherwise) {
    for (const char* name : names)
        if (const char* value = std::getenv(name)) return std::atoi(value);
    return otherwise;
}

// Between looks for a message that was waited for so long: at first none, for others are often as fast; later so that
// they have the processor.
void rest(double seconds) {
    if (seconds > 1e-4) std::this_thread::sleep_for(std::chrono::microseconds(seconds < 5e-3 ? 50 : 200));
}

// Beside this program, or where it is installed.
const MessagePassing* load() {
    std::error_code failed;
    const fs::path programs = fs::read_symlink("/proc/self/exe", failed).parent_path();
    std::string problem = "vesper-mpi.so is not there";
    for (const fs::path& file :
         {programs / "vesper-mpi.so", (programs / VESPER_MPI_FROM_PROGRAMS).lexically_normal()}) {
        if (!fs::exists(file, failed)) continue;
        // Parts of Open MPI look for its symbols among those of all.
        void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
        if (!library) {
            problem = dlerror();
            continue;
        }
        const auto start = reinterpret_cast<StartMessagePassing>(dlsym(library, kStartMessagePassing));
        if (const MessagePassing* passing = start ? start() : nullptr) return passing;
        problem = "MPI does not start";
    }
    throw Error("several processes were started together, but they cannot reach each other: " + problem);
}

}  // namespace

struct Ranks::Shared {
    const MessagePassing* passing = &kAlone;
    std::mutex mutex;  // of what `passing` offers, and of the following
    std::vector<std::string> roles, hosts;
    std::vector<Clock::time_point> heard;
    std::atomic<bool> over{false};
    bool agreed = false;
    std::thread beats;

    void check(int error) const {
        if (error != 0) throw Error(std::string("messages to other ranks: ") + passing->text_of(error));
    }
    std::string name(int rank) const {
        const std::string &role = roles[size_t(rank)], &host = hosts[size_t(rank)];
        std::string about = role;
        if (!host.empty()) about += (about.empty() ? "on " : ", on ") + host;
        return "rank " + std::to_string(rank) + (about.empty() ? "" : " (" + about + ")");
    }
    std::optional<Bytes> take(int from, Stream stream) {
        const std::byte* bytes = nullptr;
        size_t count = 0;
        check(passing->receive(from, int(stream), &bytes, &count));
        return bytes ? std::optional(Bytes(bytes, bytes + count)) : std::nullopt;
    }
    // Returns whether anything is still being sent.
    bool move_on() {
        size_t left = 0;
        check(passing->move_on(&left));
        return left > 0;
    }
    [[noreturn]] void end(const std::string& text) {
        print_error(program, text);
        passing->end_all(kEndCode);
        std::_Exit(kEndCode);
    }
    // Of the first rank to all others, and of these to the first.
    void beat() {
        Clock::time_point last = Clock::now();
        bool sends = false;  // large messages go on in the calls of both ends
        while (!over) {
            std::this_thread::sleep_for(std::chrono::microseconds(sends ? 200 : 5000));
            const std::scoped_lock lock(mutex);
            try {
                sends = move_on();
                if (Clock::now() - last < kBeat) continue;
                // Whoever was stopped itself has heard nobody.
                if (since(last) > kSilence / 2) heard.assign(heard.size(), Clock::now());
                last = Clock::now();
                for (int other = 0; other < passing->size; ++other) {
                    if (other == passing->rank || (passing->rank != 0 && other != 0)) continue;
                    check(passing->send(other, int(Stream::Beats), nullptr, 0));
                    while (take(other, Stream::Beats)) heard[size_t(other)] = Clock::now();
                    // The first rank is to name who is silent; where it is silent itself the others do.
                    const double longest = passing->rank == 0 ? kSilence : kSilence + 0.5;
                    if (since(heard[size_t(other)]) > longest && !over)
                        end(name(other) + " has been silent for " + format("%.0f s", kSilence) + ": the run ends");
                }
            } catch (const std::exception& error) {
                end(error.what());
            }
        }
    }
};

Ranks& Ranks::all() {
    if (!start_problem.empty()) throw Error(start_problem);
    try {
        static Ranks ranks;
        started = &ranks;
        return ranks;
    } catch (const Error& error) {
        start_problem = error.what();  // MPI starts once
        throw;
    }
}

void Ranks::finish() {
    if (!started || started->size() == 1) return;
    Shared& shared = *started->shared_;
    started->exchange(Stream::Start, {});
    shared.over = true;
    shared.beats.join();
    while (shared.move_on()) std::this_thread::sleep_for(std::chrono::microseconds(200));
    shared.passing->finish();
}

std::string Ranks::fail(const std::string& text) {
    if (!several()) return text;
    if (!started) try {
            all();
        } catch (const Error& error) {
            const int number = own_number();
            return number == 0 ? error.what() : "rank " + std::to_string(number) + ": " + error.what();
        }
    Shared& shared = *started->shared_;
    if (shared.agreed) shared.end((started->is_first() ? "" : started->name(started->rank()) + ": ") + text);
    const std::vector<std::string> failures = started->start(text, {});
    const auto same = [&](const std::string& other) { return other == text; };
    if (std::ranges::find_if(failures, same) - failures.begin() != started->rank()) return "";  // another one prints it
    return started->is_first() || std::ranges::all_of(failures, same) ? text
                                                                      : started->name(started->rank()) + ": " + text;
}

unsigned Ranks::on_this_machine() {
    if (!several()) return 1;
    const int count = number_in({"OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS"}, 0);
    const char* list = std::getenv("SLURM_STEP_TASKS_PER_NODE");
    return count <= 0 && list ? tasks_of_node(list, unsigned(number_in({"SLURM_NODEID"}, 0)))
                              : unsigned(std::max(count, 0));
}

unsigned Ranks::tasks_of_node(const std::string& list, unsigned node) {
    std::istringstream parts(list);
    for (std::string part; std::getline(parts, part, ',');) {
        unsigned count = 0, machines = 1;
        if (std::sscanf(part.c_str(), "%u(x%u)", &count, &machines) < 1) return 0;
        if (node < machines) return count;
        node -= machines;
    }
    return 0;
}

bool Ranks::several() { return number_in({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"}, 1) > 1; }

int Ranks::own_number() {
    return several() ? number_in({"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK", "SLURM_PROCID"}, 0) : 0;
}

Ranks::Ranks() : shared_(std::make_unique<Shared>()) {
    Shared& s = *shared_;
    if (several()) {
        // MPI would end the process.
        if (number_in({"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"}, -1) < 0)
            throw Error("srun started several processes that do not know each other: give --mpi=pmix");
        s.passing = load();
        if (s.passing->size == 1) throw Error("several processes were started together, but MPI knows of one");
    }
    const auto size = size_t(s.passing->size);
    s.roles.resize(size), s.hosts.resize(size);
    s.heard.assign(size, Clock::now());
    if (size > 1) try {
            s.beats = std::thread([&s] { s.beat(); });
        } catch (const std::system_error& error) {  // without it the others would take this rank for dead
            throw Error("no thread can be created for messages to other ranks: " + error.code().message());
        }
}

Ranks::~Ranks() {
    shared_->over = true;
    if (shared_->beats.joinable()) shared_->beats.join();
}

int Ranks::rank() const { return shared_->passing->rank; }
int Ranks::size() const { return shared_->passing->size; }

std::string Ranks::name(int rank) const {
    const std::scoped_lock lock(shared_->mutex);
    return shared_->name(rank);
}

void Ranks::set_role(int rank, const std::string& role) {
    const std::scoped_lock lock(shared_->mutex);
    shared_->roles.at(size_t(rank)) = role;
}

void Ranks::send(int to, Stream stream, Bytes bytes) {
    const std::scoped_lock lock(shared_->mutex);
    shared_->check(shared_->passing->send(to, int(stream), bytes.data(), bytes.size()));
}

std::optional<Bytes> Ranks::poll(int from, Stream stream) {
    const std::scoped_lock lock(shared_->mutex);
    shared_->move_on();
    return shared_->take(from, stream);
}

Bytes Ranks::receive(int from, Stream stream, const std::function<void()>& meanwhile) {
    const Clock::time_point begin = Clock::now();
    for (;;) {
        if (auto bytes = poll(from, stream)) return std::move(*bytes);
        if (meanwhile) meanwhile();
        wait_for(from, since(begin));
    }
}

void Ranks::wait_for(int other, double waited) const {
    if (patience_ > 0 && waited > patience_)
        throw Error(name(other) + " lives but has not gone on for " + format("%.0f s", waited));
    rest(waited);
}

Bytes Ranks::broadcast(Stream stream, Bytes bytes) {
    if (!is_first()) return receive(0, stream);
    for (int other = 1; other < size(); ++other) send(other, stream, bytes);
    return bytes;
}

std::vector<Bytes> Ranks::gather(Stream stream, Bytes bytes) {
    if (!is_first()) {
        send(0, stream, std::move(bytes));
        return {};
    }
    std::vector<Bytes> all;
    all.push_back(std::move(bytes));
    for (int other = 1; other < size(); ++other) all.push_back(receive(other, stream));
    return all;
}

std::vector<Bytes> Ranks::exchange(Stream stream, Bytes bytes) {
    const std::vector<Bytes> all = gather(stream, std::move(bytes));
    return parted(broadcast(stream, joined(all)));
}

// Says what this rank has come to, and hears it of all: why they failed, if they did.
std::vector<std::string> Ranks::start(const std::string& failure, const std::map<std::string, std::string>& says) {
    PacketWriter own;
    own.list(std::string(shared_->passing->host)), own.list(failure);
    for (const auto& [thing, value] : says) own.list(thing), own.list(value);
    said_ = exchange(Stream::Start, own.take());
    shared_->agreed = true;
    std::vector<std::string> failures;
    for (size_t other = 0; other < said_.size(); ++other) {
        PacketReader packet(said_[other]);
        const std::string host = packet.text();
        failures.push_back(packet.text());
        const std::scoped_lock lock(shared_->mutex);
        shared_->hosts[other] = host;
    }
    return failures;
}

void Ranks::agree(const std::map<std::string, std::string>& says) {
    const std::vector<std::string> failures = start("", says);
    if (std::ranges::any_of(failures, [](const std::string& text) { return !text.empty(); })) throw AgreedError("");
    std::map<std::string, std::string> first;
    for (size_t other = 0; other < said_.size(); ++other) {
        PacketReader packet(said_[other]);
        packet.text(), packet.text();
        while (!packet.at_end()) {
            const std::string thing = packet.text(), value = packet.text();
            if (first.try_emplace(thing, value).first->second == value) continue;
            throw AgreedError(is_first() ? name(int(other)) + " has another " + one_line(thing) + " than " + name(0)
                                         : "");
        }
    }
}

void Ranks::agree_on_start() {
    if (size() == 1) return;
    std::map<std::string, std::string> says;
    for (const auto& [file, digests] : io::contents_read()) {
        Digest all;
        for (const Digest::Value& one : digests) all.add_value(one);
        says[file] = hexadecimal(all.value());
    }
    Digest build;
    build.add_list(io::read_file("/proc/self/exe", uint64_t{1} << 30));
    says["build of Vesper"] = hexadecimal(build.value()), says["command line"] = start_arguments;
    agree(says);
}

void Ranks::set_program(const std::string& name, const std::string& arguments) {
    program = name, start_arguments = arguments;
}

void Ranks::in_turns(const std::function<void()>& task) {
    const std::vector<std::string>& hosts = shared_->hosts;
    std::vector<int> turns;
    for (size_t i = 0; i < hosts.size(); ++i)
        turns.push_back(int(std::count(hosts.begin(), hosts.begin() + ptrdiff_t(i), hosts[i])));
    for (int turn = 0; turn <= *std::ranges::max_element(turns); ++turn) {
        if (turns[size_t(rank())] == turn) task();
        if (size() > 1) exchange(Stream::Start, {});
    }
}

}  // namespace vesper::apps
