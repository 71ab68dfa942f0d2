// The processes that mpirun or srun has started together. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "ranks/packet.h"

namespace vesper::apps {

/// What ended the start of all ranks: a text where this rank is the one to print it, else an empty one.
class AgreedError : public Error {
public:
    using Error::Error;
};

/// The processes of one run, which are alike but for their number; or this process alone. Messages of one stream from
/// one rank to another arrive whole and in order. While it lives a thread tells the others every 0.25 s that this
/// process does: one that is silent for kSilence ends the run with a line that names it, and exit code 2. Functions
/// throw Error; one thread may call them.
class Ranks {
public:
    static constexpr double kSilence = 4;  ///< s
    enum class Stream : uint8_t { Beats, Start, Events, Nodes, Light, Statistics, Ready, Records, Eyes, Pictures };

    /// Those that were started together with this process. The first call starts to talk to them.
    static Ranks& all();
    /// Whether there are others, before any talk: as the environment says.
    static bool several();
    /// Number of this process, as the environment says; 0 without others.
    static int own_number();
    /// How many of them are on this machine, as the environment says; 0 where it does not.
    static unsigned on_this_machine();
    /// Of a list as Slurm writes them, "2(x3),1" for 2 on each of three machines and 1 on another: how many machine
    /// `node` has, from 0; 0 where that is not said.
    static unsigned tasks_of_node(const std::string& list, unsigned node);
    /// At the end of a run, waits until all have come so far. Does nothing where all() was never called.
    static void finish();
    /// This process cannot go on, and so none can. During the start every rank comes to know; returns what this one is
    /// to print of it, or nothing. Later this ends the run at once.
    static std::string fail(const std::string& text);

    int rank() const;
    int size() const;
    bool is_first() const { return rank() == 0; }
    /// "rank 2 (right, on node7)", for messages.
    std::string name(int rank) const;
    /// What a rank does, for name(); to be said alike on all.
    void set_role(int rank, const std::string& role);

    void send(int to, Stream stream, Bytes bytes);
    /// Waits for it, and calls `meanwhile` now and then.
    Bytes receive(int from, Stream stream, const std::function<void()>& meanwhile = {});
    std::optional<Bytes> poll(int from, Stream stream);
    /// From now on no wait for another rank is longer, s, or throws Error with its name; 0, as at first: any is
    /// possible.
    void set_patience(double seconds) { patience_ = seconds; }
    /// Of the first rank, on all.
    Bytes broadcast(Stream stream, Bytes bytes);
    /// Of all ranks, in their order, on the first; elsewhere nothing.
    std::vector<Bytes> gather(Stream stream, Bytes bytes);
    /// The same on all.
    std::vector<Bytes> exchange(Stream stream, Bytes bytes);
    /// The end of the start: every rank has read its files. What ranks say of one thing, such as digests, must be the
    /// same; otherwise, or where one has failed, every rank throws AgreedError.
    void agree(const std::map<std::string, std::string>& says);
    /// agree() on the program, on its arguments and on the files that this thread has read (io::contents_read), as far
    /// as others read those of the same names.
    void agree_on_start();
    /// Of this process, before agree_on_start(): name of the program, for messages, and arguments that all must have.
    static void set_program(const std::string& name, const std::string& arguments);
    /// After agree(): ranks of one machine do it one after the other, so that each finds what those before it have left
    /// in a cache; machines at once.
    void in_turns(const std::function<void()>& task);

    ~Ranks();

private:
    Ranks();
    std::vector<std::string> start(const std::string& failure, const std::map<std::string, std::string>& says);

    struct Shared;  // with the thread
    std::unique_ptr<Shared> shared_;
    void wait_for(int other, double waited) const;

    std::vector<Bytes> said_;  // at the start
    double patience_ = 0;
};

}  // namespace vesper::apps
