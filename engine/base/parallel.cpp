#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

namespace vesper {

unsigned threads_in(const char* text) {
    const std::string_view digits(text ? text : "");
    unsigned threads = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), threads);
    const bool whole = error == std::errc() && end == digits.data() + digits.size();
    return whole && threads <= kMostThreads ? threads : 0;
}

unsigned parallel_threads() {
    const unsigned asked = threads_in(std::getenv(kThreadsVariable));
    return asked > 0 ? asked : std::max(std::thread::hardware_concurrency(), 1u);
}

bool in_parallel(size_t count, size_t part, const std::function<void(size_t, size_t)>& work,
                 const std::function<bool(size_t)>& progress) {
    std::atomic<size_t> next{0}, done{0};
    std::atomic<bool> ends{false};
    std::exception_ptr failure;
    std::mutex one;
    // False once there is nothing more to do.
    const auto step = [&] {
        const size_t begin = ends ? count : next.fetch_add(part);
        if (begin >= count) return false;
        const size_t end = std::min(begin + part, count);
        try {
            work(begin, end);
        } catch (...) {
            const std::lock_guard lock(one);
            if (!failure) failure = std::current_exception();
            ends = true;
        }
        done += end - begin;
        return true;
    };
    {
        std::vector<std::jthread> threads;
        const size_t parts = (count + part - 1) / part, wanted = parallel_threads();
        try {
            try {
                for (size_t i = 1; i < std::min(parts, wanted); ++i)
                    threads.emplace_back([&step] {
                        while (step()) continue;
                    });
            } catch (const std::system_error&) {  // the host has no more: those there are do the work
            }
            while (step())
                if (progress && !progress(done)) ends = true;
        } catch (...) {
            ends = true;  // for the threads, which are waited for
            throw;
        }
    }
    if (failure) std::rethrow_exception(failure);
    return !ends;
}

}  // namespace vesper
