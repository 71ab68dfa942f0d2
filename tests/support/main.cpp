// The entry of the test programs. A process runs many tests, so it says which of them ended it, and how many it leaves
// out. SPDX-License-Identifier: MIT
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <gtest/gtest.h>

// Of sanitizers, where the program has any: called before they end the process.
extern "C" __attribute__((weak)) void __sanitizer_set_death_callback(void (*callback)());

namespace {

constexpr unsigned kMostSeconds = 600;  // of a test

char running[512];  // the test that runs; empty between tests
pid_t process;      // whose tests they are: children that tests make end as they like
int passed, failed, skipped, left_out;

/// The line that scripts/test adds up.
int print_counts(char* text, size_t size) {
    return std::snprintf(text, size, "%d passed, %d failed, %d skipped\n", passed, failed, skipped);
}

/// Counts the test that runs, and those after it, as failed. snprintf of numbers and strings takes no locks or memory.
void say_where(const char* event) {
    if (getpid() != process || !running[0]) return;
    failed += 1 + left_out;
    char text[1024];
    int length = std::snprintf(text, sizeof text, "\n[  FAILED  ] %s %s; %d tests after it did not run\n", running,
                               event, left_out);
    length += print_counts(text + length, sizeof text - size_t(length));
    running[0] = '\0';
    (void)!write(STDOUT_FILENO, text, size_t(length));
}

extern "C" void end_by_signal(int number) {
    say_where(number == SIGALRM ? "took too long" : strsignal(number));
    std::signal(number, SIG_DFL);
    std::raise(number);
}

void exit_early() {
    if (getpid() != process || !running[0]) return;
    say_where("ended the process");
    _exit(1);
}

void watch() {
    process = getpid();
    std::signal(SIGALRM, end_by_signal);
    std::atexit(exit_early);
    if (__sanitizer_set_death_callback) {
        __sanitizer_set_death_callback([] { say_where("was ended by a sanitizer"); });
        return;
    }
    static char own[1 << 16];  // a stack for the signal of a full one
    const stack_t stack{.ss_sp = own, .ss_flags = 0, .ss_size = sizeof own};
    sigaltstack(&stack, nullptr);
    struct sigaction action {};
    action.sa_handler = end_by_signal, action.sa_flags = SA_ONSTACK;
    for (const int number : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) sigaction(number, &action, nullptr);
}

class Watch : public testing::EmptyTestEventListener {
    void OnTestIterationStart(const testing::UnitTest& all, int) override { left_out = all.test_to_run_count(); }
    void OnTestStart(const testing::TestInfo& test) override {
        --left_out;
        std::snprintf(running, sizeof running, "%s.%s", test.test_suite_name(), test.name());
        alarm(kMostSeconds);
    }
    void OnTestEnd(const testing::TestInfo& test) override {
        alarm(0);
        running[0] = '\0';
        const testing::TestResult& result = *test.result();
        ++(result.Failed() ? failed : result.Skipped() ? skipped : passed);
    }
    void OnTestProgramEnd(const testing::UnitTest& all) override {
        failed += all.ad_hoc_test_result().Failed();  // what failed between tests
        char text[128];
        print_counts(text, sizeof text);
        std::fputs(text, stdout);
    }
};

}  // namespace

int main(int count, char** arguments) {
    testing::InitGoogleTest(&count, arguments);
    testing::UnitTest::GetInstance()->listeners().Append(new Watch);
    watch();
    return RUN_ALL_TESTS();
}
