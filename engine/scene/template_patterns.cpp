// Patterns for names that differ by a number. SPDX-License-Identifier: MIT
#include "scene/template_patterns.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <string_view>

#include "base/budget.h"
#include "scene/photometry.h"

namespace vesper::scene {
namespace {

constexpr size_t kMostPatterns = 50;           // of a rule
constexpr size_t kMostCompared = 100'000'000;  // names, some seconds
constexpr std::string_view kSideWords[] = {"left", "Left", "LEFT", "right", "Right", "RIGHT"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Each run of digits replaced; wildcards of the name itself are matched by '?'.
std::string replaced(const std::string& name, bool each_digit) {
    std::string made;
    for (size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        if (!is_digit(c))
            made += c == '*' ? '?' : c;
        else if (each_digit)
            made += '?';
        else if (i == 0 || !is_digit(name[i - 1]))
            made += '*';
    }
    return made;
}

std::vector<std::string> distinct(const std::vector<std::string>& texts) {
    const std::set<std::string> sorted(texts.begin(), texts.end());
    return {sorted.begin(), sorted.end()};
}

}  // namespace

std::string without_numbers(const std::string& name) { return replaced(name, false); }

std::string family_of(const std::string& name) {
    size_t end = name.size();
    while (end > 0 && is_digit(name[end - 1])) --end;
    const bool copy = end < name.size() && end > 1 && name[end - 1] == '.';
    const std::string plain = without_numbers(copy ? name.substr(0, end - 1) : name);
    std::string family;
    for (size_t i = 0; i < plain.size();) {
        const auto* const side = std::ranges::find_if(
            kSideWords, [&](std::string_view s) { return std::string_view(plain).substr(i).starts_with(s); });
        const bool is_side = side != std::end(kSideWords);
        family += is_side ? '*' : plain[i];
        i += is_side ? side->size() : 1;
    }
    return family;
}

NameIndex::NameIndex(std::vector<std::string> names, const Scene* scene)
    : names_(std::move(names)), scene_(scene), order_(names_.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    std::ranges::sort(order_, [&](uint32_t a, uint32_t b) { return names_[a] < names_[b]; });
}

void NameIndex::add_range(const std::string& prefix, const std::string& pattern, std::vector<uint32_t>& found) const {
    const bool by_path = scene_ && pattern.find('/') != std::string::npos;
    auto at = std::lower_bound(order_.begin(), order_.end(), prefix,
                               [&](uint32_t i, const std::string& wanted) { return names_[i] < wanted; });
    for (; at != order_.end() && names_[*at].starts_with(prefix); ++at) {
        check_time();
        ++compared_;
        if (by_path ? matches_node(pattern, *scene_, *at) : matches_name(pattern, names_[*at])) found.push_back(*at);
    }
}

std::vector<uint32_t> NameIndex::matched(const std::vector<std::string>& patterns) const {
    std::vector<uint32_t> found;
    for (const std::string& pattern : patterns) {
        add_range(pattern.substr(0, pattern.find_first_of("*?")), pattern, found);
        // A path is matched by the last of its names too.
        const size_t slash = pattern.rfind('/');
        if (!scene_ || slash == std::string::npos) continue;
        const std::string last = pattern.substr(slash + 1);
        add_range(last.substr(0, last.find_first_of("*?")), pattern, found);
    }
    std::ranges::sort(found);
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

std::vector<std::string> patterns_for(const NameIndex& index, const std::vector<uint32_t>& members,
                                      const std::vector<std::string>& texts) {
    const std::vector<std::string> exact = distinct(texts);
    for (const bool each_digit : {false, true}) {
        if (exact.size() == 1 || index.compared() > kMostCompared) break;
        std::vector<std::string> patterns;
        for (const std::string& text : exact) patterns.push_back(replaced(text, each_digit));
        patterns = distinct(patterns);
        if (patterns.size() <= kMostPatterns && index.matched(patterns) == members) return patterns;
    }
    return exact.size() <= kMostPatterns ? exact : std::vector<std::string>{};
}

}  // namespace vesper::scene
