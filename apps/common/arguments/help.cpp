#include "arguments/help.h"

#include <algorithm>
#include <memory>
#include <sstream>

#include <CLI/CLI.hpp>

#include "arguments/command_line.h"

namespace vesper::apps {
namespace {

constexpr size_t kWidth = 100, kLeft = 28;  // columns: of a page, of what stands before descriptions

bool is_first(const std::string& group) { return group == kFirstPage; }

/// Text that begins at column `used`, broken before spaces, and after commas of what is no prose; all further lines
/// begin at column `indent`.
std::string broken(const std::string& text, size_t used, size_t indent, bool prose = true) {
    std::string made;
    for (size_t at = 0; at < text.size();) {
        const size_t space = std::min(text.find(' ', at + 1), text.size()), comma = text.find(',', at);
        const size_t end = prose || comma >= space ? space : comma + 1;
        std::string word = text.substr(at, end - at);
        if (used + word.size() > kWidth && used > indent) {
            word.erase(0, word.find_first_not_of(' '));
            made += "\n" + std::string(indent, ' ');
            used = indent;
        }
        made += word, used += word.size(), at = end;
    }
    return made;
}

/// A name, and beside it, or below where it is long, what it means.
std::string entry(const std::string& name, const std::string& meaning) {
    std::string made = "  " + broken(name, 2, 6, false);
    if (meaning.empty()) return made + "\n";
    made += made.size() + 2 > kLeft ? "\n" + std::string(kLeft, ' ') : std::string(kLeft - made.size(), ' ');
    std::istringstream lines(meaning);
    bool first = true;
    for (std::string line; std::getline(lines, line); first = false) {
        if (!first) made += "\n" + std::string(kLeft, ' ');
        made += broken(line, kLeft, kLeft + (line.starts_with("  ") ? 4 : 0));
    }
    return made + "\n";
}

class Pages : public CLI::Formatter {
public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
        const bool all = mode != CLI::AppFormatMode::Normal;
        std::string text = broken(app->get_description(), 0, 0) + "\n" + make_usage(app, name);
        text += options(app, "Positionals", all, [](const CLI::Option* option) { return option->get_positional(); });
        std::string more;
        for (const std::string& group : app->get_groups()) {
            if (all || is_first(group))
                text += options(app, group, all, [&](const CLI::Option* option) {
                    return option->nonpositional() && option->get_group() == group;
                });
            else
                more += (more.empty() ? "" : ", ") + group;
        }
        if (!more.empty()) text += "\n" + broken("More options with --help-all: " + more + ".", 0, 2) + "\n";
        text += commands(app, name, all);
        const CLI::App* above = app->get_parent();  // whose footer a command without one has
        if (!app->get_footer().empty() && !(above && above->get_footer() == app->get_footer()))
            text += "\n" + app->get_footer();
        return text + (text.ends_with('\n') ? "" : "\n");
    }

private:
    /// Without the range of numbers; a list of words stays.
    std::string short_opts(const CLI::Option* option) const {
        std::string text = make_option_opts(option);
        const std::string type = option->get_type_name();
        const size_t range = type.find(':'), at = text.find(type);
        if (range != type.npos && type.find('{') == type.npos && at != text.npos)
            text.erase(at + range, type.size() - range);
        return text;
    }

    std::string options(const CLI::App* app, const std::string& heading, bool all,
                        const std::function<bool(const CLI::Option*)>& which) const {
        std::string text;
        for (const CLI::Option* option : app->get_options(which)) {
            const std::string name = make_option_name(option, option->get_positional()),
                              meaning = option->get_description();
            text += all ? entry(name + make_option_opts(option), meaning)
                        : entry(name + short_opts(option), meaning.substr(0, meaning.find('\n')));
        }
        return text.empty() ? text : "\n" + heading + ":\n" + text;
    }

    std::string commands(const CLI::App* app, const std::string& name, bool all) const {
        std::string list, pages;
        for (const CLI::App* command : app->get_subcommands({})) {
            list += entry(command->get_name(), command->get_description());
            if (all) pages += "\n\n" + make_help(command, name + " " + command->get_name(), CLI::AppFormatMode::All);
        }
        return list.empty() ? list : "\nSubcommands:\n" + list + pages;
    }
};

}  // namespace

std::shared_ptr<CLI::FormatterBase> help_pages() { return std::make_shared<Pages>(); }

}  // namespace vesper::apps
