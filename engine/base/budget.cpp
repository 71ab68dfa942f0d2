#include "base/budget.h"

#include <ctime>
#include <utility>

#include "base/decimal.h"
#include "base/limits.h"

namespace vesper {
namespace {

constexpr uint64_t kBytes = uint64_t{2} << 30;
constexpr uint64_t kNanoseconds = 60'000'000'000;
constexpr unsigned kClockEvery = 64;  // calls

thread_local Budget* budget = nullptr;

int64_t processor_time() {
    timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

[[noreturn]] void refuse(const std::string& limit) {
    throw OverLimit(budget->task + " takes more than " + limit +
                    " (VESPER_LIMITS=2 in the environment allows twice as much)");
}

}  // namespace

Budget::Budget(std::string of_task) : task(std::move(of_task)) {
    if (budget) return;
    bytes_left = bytes = scaled_limit(kBytes);
    nanoseconds = int64_t(scaled_limit(kNanoseconds));
    end = processor_time() + nanoseconds;
    budget = this;
}

Budget::~Budget() {
    if (budget == this) budget = nullptr;
}

void spend(uint64_t bytes) {
    if (!budget) return;
    if (bytes > budget->bytes_left) refuse(decimal(double(budget->bytes) / (1 << 30), 3) + " GiB of memory");
    budget->bytes_left -= bytes;
}

TemporaryMemory::~TemporaryMemory() {
    if (budget) budget->bytes_left += bytes_;
}

void check_time() {
    if (!budget || ++budget->calls % kClockEvery != 0 || processor_time() < budget->end) return;
    refuse(decimal(double(budget->nanoseconds) * 1e-9, 3) + " s of processor time");
}

}  // namespace vesper
