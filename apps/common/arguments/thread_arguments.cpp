#include "arguments/thread_arguments.h"

#include <sched.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <thread>

#include "base/parallel.h"
#include "ranks/ranks.h"

namespace vesper::apps {
namespace {

constexpr const char* kDriver = "LP_NUM_THREADS";  // of Mesa's llvmpipe, when its device is opened

// Those that this process may use.
unsigned processors() {
    cpu_set_t set;
    const int count = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;  // fails with over 1024
    return count > 0 ? unsigned(count) : std::max(std::thread::hardware_concurrency(), 1u);
}

}  // namespace

void add_thread_option(Command command, unsigned& threads) {
    command
        .add_option("--threads", threads,
                    "Threads of a device that is the processor, and of work on the host\nDefault: one for each "
                    "processor; of several ranks their part")
        .check(range(1u, kMostThreads));
}

WantedThreads wanted_threads(unsigned asked, const char* host, const char* driver, unsigned processors,
                             unsigned ranks) {
    if (asked > 0) return {asked, asked};
    const unsigned by_host = threads_in(host), by_driver = threads_in(driver);
    const unsigned part = std::max(processors / std::max(ranks, 1u), 1u);
    WantedThreads wanted;
    if (by_host == 0) wanted.host = by_driver > 0 ? by_driver : part;
    if (!driver && (by_host > 0 || ranks > 0)) wanted.driver = by_host > 0 ? by_host : part;
    return wanted;
}

void use_threads(unsigned asked) {
    const auto [host, driver] = wanted_threads(asked, std::getenv(kThreadsVariable), std::getenv(kDriver), processors(),
                                               Ranks::on_this_machine());
    if (host > 0) setenv(kThreadsVariable, std::to_string(host).c_str(), 1);
    if (driver > 0) setenv(kDriver, std::to_string(driver).c_str(), 1);
}

}  // namespace vesper::apps
