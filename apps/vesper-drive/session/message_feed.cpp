#include "session/message_feed.h"

#include <algorithm>
#include <utility>

#include "base/one_line.h"

namespace vesper::drive {
namespace {

constexpr double kSilence = 5;  // s
constexpr auto kLook = std::chrono::milliseconds(50);

}  // namespace

MessageFeed::MessageFeed(const osi::Address& address, double delay)
    : receiver_(address), host_(address.host), delay_(delay), clock_(delay) {}

bool MessageFeed::hear(Session& session, std::chrono::milliseconds longest) {
    auto arrival = receiver_.take(longest);
    if (!arrival) return false;
    const auto& sky = arrival->message.environment;
    weather_ |= sky && (sky->fog || sky->precipitation);
    units_.add(arrival->message);
    standing_.add(arrival->message), objects_ |= !arrival->message.objects.empty();
    arrival->message.stationary = {};
    const int64_t nanoseconds = arrival->message.nanoseconds;
    const osi::Timeline::Added added = session.hear(std::move(arrival->message));
    late_ += added == osi::Timeline::Added::Late, repeated_ += added == osi::Timeline::Added::Repeated;
    crowded_out_ += added == osi::Timeline::Added::CrowdedOut;
    if (added != osi::Timeline::Added::Accepted) return true;
    heard_ = Clock::now(), begun_ = true, silent_ = false;
    if (!first_) first_ = nanoseconds;
    clock_.hear(double(nanoseconds - *first_) / 1e9, std::chrono::duration<double>(arrival->time - began_).count());
    return true;
}

void MessageFeed::listen(Session& session) {
    while (hear(session, {})) {
    }
}

std::optional<double> MessageFeed::shown(Clock::time_point now) {
    return clock_.shown(std::chrono::duration<double>(now - began_).count());
}

bool MessageFeed::wait_for(Session& session, double moment, double first) {
    const Clock::time_point begins = Clock::now();
    const auto seconds_since = [](Clock::time_point time) {
        return std::chrono::duration<double>(Clock::now() - time).count();
    };
    while (!begun_ || session.latest_message() < moment + delay_) {
        if (hear(session, silent_ ? std::chrono::milliseconds(0) : kLook)) continue;
        if (!silent_ && seconds_since(begun_ ? std::max(heard_, begins) : begins) < (begun_ ? kSilence : first))
            continue;
        silent_ = true;  // until something new is heard
        return begun_ && session.latest_message() >= moment;
    }
    return true;
}

osi::StreamCounts MessageFeed::counts() const {
    osi::StreamCounts counts = receiver_.counts();
    counts.late = late_, counts.repeated = repeated_, counts.crowded_out += crowded_out_;
    return counts;
}

std::string MessageFeed::report() const {
    const osi::StreamCounts c = counts();
    std::string text = std::to_string(c.messages) + " messages";
    for (const auto& [number, what] :
         {std::pair(c.late, "late"), std::pair(c.repeated, "repeated"), std::pair(c.malformed, "malformed"),
          std::pair(c.incomplete, "incomplete"), std::pair(c.crowded_out, "faster than they were shown"),
          std::pair(c.astray, "with a time far from the others"), std::pair(c.foreign, "datagrams of another sender"),
          std::pair(c.restarts, "restarts of the sender")})
        if (number > 0) text += ", " + std::to_string(number) + " " + what;
    if (const std::string problem = receiver_.last_problem(); !problem.empty())
        text += " (the last malformed one " + one_line(problem) + ")";
    if (!standing_.counts().empty())
        text += "; stationary objects and signs are shown of traces (--osi), and not of a sender: " +
                text_of(standing_.counts());
    if (c.messages > 0 && !objects_) text += "; no message has a moving object with a place";
    for (const std::string& doubt : units_.doubts()) text += "; " + doubt;
    return text + (weather_ ? std::string("; they state ") + kWeather : "");
}

std::string MessageFeed::place() const { return host_ + ":" + std::to_string(receiver_.port()); }

}  // namespace vesper::drive
