#include "thread_arguments.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "base/parallel.h"
#include "ranks.h"

namespace vesper::apps {
namespace {

constexpr const char* kDriver = "LP_NUM_THREADS";  // of Mesa's llvmpipe, when its device is opened

}  // namespace

void add_thread_option(Command command, unsigned& threads) {
    command
        .add_option("--threads", threads,
                    "Threads of a device that is the processor, and of work on the host\nDefault: one for each "
                    "processor; of several ranks their part")
        .check(range(1u, kMostThreads));
}

void use_threads(unsigned asked) {
    if (asked == 0 && (!Ranks::several() || std::getenv(kDriver))) return;
    const unsigned part = std::max(parallel_threads() / unsigned(std::max(Ranks::on_this_machine(), 1)), 1u);
    const std::string number = std::to_string(asked > 0 ? asked : part);
    setenv(kDriver, number.c_str(), 1);
    setenv(kThreadsVariable, number.c_str(), 1);
}

}  // namespace vesper::apps
