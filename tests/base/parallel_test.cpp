// Loops on all processors: what is done, and how they end. SPDX-License-Identifier: MIT
#include "base/parallel.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace vesper::test::parallel_test {
namespace {

TEST(Parallel, EveryThingIsDoneOnceInPartsOfItsSize) {
    for (const size_t count : {size_t(1), size_t(7), size_t(64), size_t(1000)})
        for (const size_t part : {size_t(1), size_t(3), size_t(64), size_t(5000)}) {
            std::vector<std::atomic<int>> times(count);
            std::atomic<size_t> parts{0}, odd{0};
            EXPECT_TRUE(in_parallel(count, part, [&](size_t begin, size_t end) {
                ++parts;
                if (begin % part != 0 || end != std::min(begin + part, count)) ++odd;
                for (size_t i = begin; i < end; ++i) ++times[i];
            }));
            for (size_t i = 0; i < count; ++i) EXPECT_EQ(times[i], 1) << i << " of " << count << " by " << part;
            EXPECT_EQ(parts, (count + part - 1) / part);
            EXPECT_EQ(odd, 0u);
        }
}

TEST(Parallel, NothingIsDoneOfNothing) {
    const auto never = [](size_t, size_t) { ADD_FAILURE() << "was called"; };
    EXPECT_TRUE(in_parallel(0, 8, never));
    EXPECT_TRUE(in_parallel(0, 8, never, [](size_t) { return true; }));
}

// Several threads at a time, if there are processors: two parts wait for each other.
TEST(Parallel, UsesOtherThreads) {
    if (parallel_threads() < 2) GTEST_SKIP() << "one processor";
    std::atomic<int> here{0};
    std::set<std::thread::id> threads;
    std::mutex one;
    in_parallel(2, 1, [&](size_t, size_t) {
        ++here;
        while (here < 2) std::this_thread::yield();
        const std::lock_guard lock(one);
        threads.insert(std::this_thread::get_id());
    });
    EXPECT_EQ(threads.size(), 2u);
}

// 1024 stacks of some MiB do not fit into the address space that is left: the threads that there are do the work.
TEST(Parallel, ThreadsThatCannotBeCreatedAreDoneWithout) {
    const auto work = [] {
        uint64_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        const rlim_t bytes = pages * uint64_t(::sysconf(_SC_PAGESIZE)) + (64u << 20);
        const rlimit limit{bytes, bytes};
        ::setenv(kThreadsVariable, "1024", 1);
        std::atomic<size_t> done{0};
        if (::setrlimit(RLIMIT_AS, &limit) != 0) std::_Exit(2);
        const bool whole = in_parallel(5000, 1, [&](size_t begin, size_t end) { done += end - begin; });
        std::_Exit(whole && done == 5000 ? 0 : 1);
    };
    EXPECT_EXIT(work(), testing::ExitedWithCode(0), "");
}

TEST(Parallel, NumbersOfThreadsAreWholeAndAtMost1024) {
    for (const auto& [text, threads] : {std::pair("1", 1u), {"3", 3u}, {"1024", 1024u}})
        EXPECT_EQ(threads_in(text), threads) << text;
    for (const char* text : {"", "0", "1025", "-1", "+2", " 2", "2 ", "2x", "1.5", "many", "4294967297"})
        EXPECT_EQ(threads_in(text), 0u) << text;
    EXPECT_EQ(threads_in(nullptr), 0u);
    EXPECT_GE(parallel_threads(), 1u);
}

// Other threads wait after their first part until something is told, or all is done: else they may do it all before
// this one begins.
TEST(Parallel, ProgressIsToldHereWhatIsDone) {
    const std::thread::id here = std::this_thread::get_id();
    std::atomic<size_t> done{0}, last{0};
    EXPECT_TRUE(in_parallel(
        500, 7,
        [&](size_t begin, size_t end) {
            done += end - begin;
            while (std::this_thread::get_id() != here && last == 0 && done < 500) std::this_thread::yield();
        },
        [&](size_t told) {
            EXPECT_EQ(std::this_thread::get_id(), here);
            EXPECT_GE(told, last);
            EXPECT_LE(told, done);
            last = told;
            return true;
        }));
    EXPECT_EQ(done, 500u);
    EXPECT_GT(last, 0u);
}

// What has begun is done; of a million parts the few of each thread until it is told.
TEST(Parallel, ProgressEndsTheWork) {
    std::atomic<size_t> begun{0}, ended{0};
    int calls = 0;
    EXPECT_FALSE(in_parallel(
        1'000'000, 1,
        [&](size_t, size_t) {
            ++begun;
            std::this_thread::sleep_for(std::chrono::microseconds(50));
            ++ended;
        },
        [&](size_t) { return ++calls < 3; }));
    EXPECT_EQ(calls, 3);
    EXPECT_EQ(begun, ended);
    EXPECT_LT(begun, 1'000'000u);
}

// The first failure reaches the caller, whichever thread it comes from, after all threads have ended.
TEST(Parallel, AFailureOfWorkReachesTheCaller) {
    for (const size_t bad : {size_t(0), size_t(500), size_t(999)}) {
        std::atomic<int> running{0};
        const auto work = [&](size_t begin, size_t) {
            ++running;
            const bool fails = begin == bad;
            --running;
            if (fails) throw std::runtime_error("of part " + std::to_string(begin));
        };
        try {
            in_parallel(1000, 1, work);
            ADD_FAILURE() << "nothing came of " << bad;
        } catch (const std::runtime_error& failure) {
            EXPECT_EQ(failure.what(), "of part " + std::to_string(bad));
        }
        EXPECT_EQ(running, 0);
    }
    EXPECT_THROW(in_parallel(1000, 1, [](size_t, size_t) { throw 1; }), int) << "every part fails";
}

TEST(Parallel, AFailureOfProgressReachesTheCaller) {
    std::atomic<int> running{0};
    const auto work = [&](size_t, size_t) {
        ++running;
        std::this_thread::sleep_for(std::chrono::microseconds(50));
        --running;
    };
    EXPECT_THROW(in_parallel(1'000'000, 1, work, [](size_t) -> bool { throw std::logic_error("told"); }),
                 std::logic_error);
    EXPECT_EQ(running, 0) << "threads have ended";
}

}  // namespace
}  // namespace vesper::test::parallel_test
