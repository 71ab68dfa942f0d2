#include "photometry/reflection_table_rtb.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "base/lower.h"
#include "photometry/table.h"

namespace vesper::photometry {
namespace {

constexpr size_t kMostOnAnAxis = 512;

bool is_heading(std::string_view line) { return lower(trimmed(line)) == "rtable.v1"; }

// The numbers of a file, one after another.
class Numbers {
public:
    explicit Numbers(LineReader& lines) : lines_(lines) {}

    double next(const std::string& what, double most) {
        while (rest_.empty()) {
            const auto line = lines_.next();
            if (!line) lines_.fail("is the end: " + what + " is missing");
            rest_ = trimmed(*line);
        }
        const size_t end = std::min(rest_.find_first_of(" \t;"), rest_.size());
        const std::string_view field = rest_.substr(0, end);
        rest_ = trimmed(rest_.substr(std::min(rest_.find_first_not_of(" \t;", end), rest_.size())));
        const auto value = number_of(field);
        if (!value || !(*value >= 0 && *value <= most))
            lines_.fail(quoted(field) + " is not " + what + ", a number from 0 to " + std::to_string(uint64_t(most)));
        return *value;
    }
    std::vector<double> axis(const std::string& of, double most) {
        const double number = next("the number of " + of, double(kMostOnAnAxis));
        const auto count = size_t(number);
        if (double(count) != number || count < 2) lines_.fail("has no number of " + of + " of at least 2");
        std::vector<double> values;
        for (size_t i = 1; i <= count; ++i) values.push_back(next(of + " " + std::to_string(i), most));
        return values;
    }
    void expect_end() {
        while (rest_.empty()) {
            const auto line = lines_.next();
            if (!line) return;
            rest_ = trimmed(*line);
        }
        lines_.fail(quoted(rest_) + " is more than the table has");
    }

private:
    LineReader& lines_;
    std::string_view rest_;
};

}  // namespace

bool is_rtb(std::span<const uint8_t> text) {
    LineReader lines(text, {});
    const auto first = lines.next();
    return first && is_heading(*first);
}

ReflectionTable parse_rtb(std::span<const uint8_t> text, const std::string& name) {
    LineReader lines(text, name);
    if (const auto heading = lines.next(); !heading || !is_heading(*heading)) lines.fail("is not RTable.v1");
    ReflectionTable table{.name = name};
    lines.next();  // the name that DIALux shows
    Numbers numbers(lines);
    table.tan_gamma = numbers.axis("tan gamma", 1e6);
    table.beta = numbers.axis("beta", 180);
    table.stated_q0 = numbers.next("Q0", 1);
    table.r.resize(table.tan_gamma.size() * table.beta.size());
    for (size_t b = 0; b < table.beta.size(); ++b)
        for (size_t t = 0; t < table.tan_gamma.size(); ++t)
            table.r[t * table.beta.size() + b] = numbers.next("r", 1e9) * 1e-4;
    numbers.expect_end();
    return table;
}

}  // namespace vesper::photometry
