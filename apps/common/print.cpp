#include "print.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <map>

#include "base/one_line.h"
#include "ranks/ranks.h"

namespace vesper::apps {
namespace {

constexpr size_t kMostBytes = 4000;               // of a text within a line
constexpr size_t kMostLines = 400;                // of a report
constexpr size_t kMostOfAKind = 20, kMost = 100;  // notes

/// The text of one conversion such as "%-24s"; `stars` of the values are widths or precisions.
template <class Value>
std::string converted(const std::string& conversion, const int (&star)[2], size_t stars, Value value) {
    const auto print_to = [&](char* to, size_t size) {
        const char* c = conversion.c_str();
        return stars == 0   ? std::snprintf(to, size, c, value)
               : stars == 1 ? std::snprintf(to, size, c, star[0], value)
                            : std::snprintf(to, size, c, star[0], star[1], value);
    };
    std::string text(size_t(std::max(0, print_to(nullptr, 0))), '\0');
    print_to(text.data(), text.size() + 1);
    return text;
}

std::string formatted(const char* pattern, va_list& values) {
    std::string text;
    for (const char* at = pattern; *at;) {
        const char* percent = std::strchr(at, '%');
        if (!percent) return text + at;
        text.append(at, percent);
        const char* end = percent + 1 + std::strspn(percent + 1, "-+ 0#.*123456789");
        const char* kind = end + std::strspn(end, "hlzt");
        const std::string conversion(percent, kind + 1), size(end, kind);
        at = kind + 1;
        int star[2]{};
        size_t stars = 0;
        for (const char c : conversion)
            if (c == '*' && stars < 2) star[stars++] = va_arg(values, int);
        const auto add = [&](auto value) { text += converted(conversion, star, stars, value); };
        switch (*kind) {
            case '%':
                text += '%';
                break;
            case 's':
                add(one_line(va_arg(values, const char*), kMostBytes).c_str());
                break;
            case 'd':
            case 'i':
            case 'u':
            case 'x':
                if (size == "z" || size == "t" || size == "l")
                    add(va_arg(values, long));
                else if (size == "ll")
                    add(va_arg(values, long long));
                else
                    add(va_arg(values, int));
                break;
            case 'c':
                add(va_arg(values, int));
                break;
            default:
                add(va_arg(values, double));
        }
    }
    return text;
}

/// A note without its numbers and what stands in quotes.
std::string kind_of(const std::string& note) {
    std::string kind;
    bool quoted = false;
    for (const char c : note) {
        if (c == '\'') quoted = !quoted;
        if (!quoted && !std::strchr("0123456789.-", c)) kind += c;
    }
    return kind;
}

void print_line(std::FILE* to, const std::string& before, const std::string& text) {
    std::fprintf(to, "%s%s\n", before.c_str(), one_line(text, kMostBytes).c_str());
}

}  // namespace

std::string format(const char* pattern, ...) {
    va_list values;
    va_start(values, pattern);
    std::string text = formatted(pattern, values);
    va_end(values);
    return text;
}

void print(const char* pattern, ...) {
    va_list values;
    va_start(values, pattern);
    std::fputs(formatted(pattern, values).c_str(), stdout);
    va_end(values);
}

void print_text(const std::string& lines) {
    for (size_t at = 0; at < lines.size();) {
        const size_t end = std::min(lines.find('\n', at), lines.size());
        std::fputs(one_line(lines.substr(at, end - at), lines.size()).c_str(), stdout);
        if (end < lines.size()) std::fputc('\n', stdout);
        at = end + 1;
    }
}

void print_report(const std::string& lines) {
    size_t end = 0, count = 0;
    for (; count < kMostLines && end < lines.size(); ++count)
        end = std::min(lines.find('\n', end), lines.size() - 1) + 1;
    print_text(lines.substr(0, end));
    const auto more = std::count(lines.begin() + std::ptrdiff_t(end), lines.end(), '\n');
    if (more > 0) print("and %zu more lines\n", size_t(more));
}

void print_note(const std::string& text) {
    if (Ranks::own_number() == 0) print_line(stderr, "note: ", text);
}
void print_warning(const std::string& text) {
    if (Ranks::own_number() == 0) print_line(stderr, "warning: ", text);
}

void print_notes(const std::vector<std::string>& notes, const std::string& before) {
    if (Ranks::own_number() != 0) return;
    std::FILE* to = before.empty() ? stdout : stderr;
    std::map<std::string, size_t> kinds;
    size_t printed = 0;
    for (const std::string& note : notes)
        if (++kinds[kind_of(note)] <= kMostOfAKind && printed < kMost) print_line(to, before, note), ++printed;
    if (printed < notes.size())
        print_line(to, before, "and " + std::to_string(notes.size() - printed) + " more like these");
}

void print_error(const std::string& program, const std::string& text) { print_line(stderr, program + ": ", text); }

}  // namespace vesper::apps
