#include "progress.h"

#include <unistd.h>

#include <cstdio>

#include "base/one_line.h"
#include "ranks/ranks.h"

namespace vesper::apps {

Progress::Progress(std::string what, unsigned total)
    : what_(std::move(what)), total_(total), visible_(total > 1 && isatty(STDERR_FILENO) && Ranks::own_number() == 0) {}

Progress::~Progress() {
    if (visible_) std::fputc('\n', stderr);
}

void Progress::step() {
    ++done_;
    if (!visible_) return;
    constexpr unsigned kBar = 30;
    const unsigned filled = kBar * done_ / total_;
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    std::fprintf(stderr, "\r%s [%s%s] %u/%u, %.0f s left ", one_line(what_).c_str(), std::string(filled, '#').c_str(),
                 std::string(kBar - filled, '.').c_str(), done_, total_, elapsed / done_ * (total_ - done_));
    std::fflush(stderr);
}

}  // namespace vesper::apps
