#include "arguments/command_line.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>
#include <optional>
#include <set>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <CLI/CLI.hpp>

#include "arguments/arguments.h"
#include "arguments/help.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/file_gate.h"
#include "io/named_file.h"
#include "io/temporary.h"
#include "own_data.h"
#include "print.h"
#include "ranks/ranks.h"

namespace vesper::apps {
namespace {

// A CPU device builds tens of MiB of its own lists in every frame. glibc would give them back to the system after each,
// and have every page cleared again in the next: a twentieth of the frame.
void keep_freed_memory() {
#ifdef __GLIBC__
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    mallopt(M_TOP_PAD, 64 << 20);
    mallopt(M_MMAP_THRESHOLD, 32 << 20);  // setting the first fixes this at 128 KiB
#endif
}

extern "C" void end_of_signal(int number) {
    io::remove_temporaries();
    std::raise(number);  // whose action is the system's again
}

// A signal that ends the program leaves no temporary file. A file that grows beyond a limit is an error of writing.
void handle_signals() {
    std::signal(SIGXFSZ, SIG_IGN);
    for (const int number : {SIGHUP, SIGINT, SIGQUIT, SIGILL, SIGABRT, SIGBUS, SIGFPE, SIGSEGV, SIGPIPE, SIGALRM,
                             SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU}) {
        struct sigaction action {};
        if (::sigaction(number, nullptr, &action) != 0 || action.sa_handler != SIG_DFL) continue;  // somebody else's
        action.sa_handler = end_of_signal;
        action.sa_flags = int(SA_RESETHAND);
        ::sigaction(number, &action, nullptr);
    }
}

constexpr const char* kSwitch = "SWITCH";  // as pages of help name the type

/// Names of all switches of a command and of the commands below it.
void find_switches(const CLI::App& app, std::set<std::string>& names) {
    for (const CLI::Option* option : app.get_options({}))
        if (option->get_type_name().starts_with(kSwitch))
            for (const std::string& name : option->get_lnames()) names.insert("--" + name);
    for (const CLI::App* below : app.get_subcommands({})) find_switches(*below, names);
}

/// Parses words, in which a switch without a value is on.
void parse_words(CLI::App& app, std::vector<std::string> words) {
    std::set<std::string> switches;
    find_switches(app, switches);
    for (size_t i = 0; i < words.size(); ++i)
        if (switches.contains(words[i]) && (i + 1 == words.size() || (words[i + 1] != "on" && words[i + 1] != "off")))
            words[i] += "=on";
    std::ranges::reverse(words);
    app.parse(std::move(words));
}

/// Returns true if everything printed was written; prints the reason to standard error otherwise.
bool output_ended(const std::string& program) {
    if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return true;
    print_error(program, std::string("standard output: ") + std::strerror(errno));
    return false;
}

}  // namespace

Check::Check(const std::function<std::string(const std::string&)>& complaint, const std::string& words)
    : validator_(std::make_shared<CLI::Validator>([complaint](const std::string& given) { return complaint(given); },
                                                  words)) {}

Check::Check(const CLI::Validator& validator) : validator_(std::make_shared<CLI::Validator>(validator)) {}

Check between(double low, double high) {
    const std::string words = format("%g to %g", low, high);
    return {[=](const std::string& given) {
                char* end = nullptr;
                const double value = std::strtod(given.c_str(), &end);
                return *end == 0 && value >= low && value <= high ? std::string()
                                                                  : given + " is not a number from " + words;
            },
            words};
}

Check range(double low, double high) { return Check(CLI::Range(low, high)); }
Check range(int low, int high) { return Check(CLI::Range(low, high)); }
Check range(unsigned low, unsigned high) { return Check(CLI::Range(low, high)); }
Check not_negative() { return Check(CLI::NonNegativeNumber); }
Check one_of(const std::vector<std::string>& words) { return Check(CLI::IsMember(words)); }
Check one_of(std::initializer_list<const char*> words) {
    return one_of(std::vector<std::string>(words.begin(), words.end()));
}
Check one_of(std::initializer_list<int> numbers) { return Check(CLI::IsMember(std::vector<int>(numbers))); }

Option& Option::check(const Check& check) { return option_->check(check.validator()), *this; }
Option& Option::required() { return option_->required(), *this; }
Option& Option::shows_default() { return option_->capture_default_str(), *this; }
Option& Option::shows_default(const std::string& text) { return option_->default_str(text), *this; }
Option& Option::takes(const std::string& word) { return option_->type_name(word), *this; }
Option& Option::separated_by(char separator) { return option_->delimiter(separator), *this; }
Option& Option::values(int least, int most) { return option_->expected(least, most), *this; }
Option& Option::excludes(const Option& other) { return option_->excludes(other.option_), *this; }

Option& Option::repeats() {
    option_->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    return *this;
}

Option& Option::takes_list(std::vector<std::string>& list) {
    option_->delimiter(',')->take_last()->each([&list](const std::string& value) { list.push_back(value); });
    return *this;
}

size_t Option::count() const { return option_->count(); }
const std::vector<std::string>& Option::results() const { return option_->results(); }
std::string Option::name() const { return option_->get_name(); }
std::string Option::group() const { return option_->get_group(); }
bool Option::is_positional() const { return option_->get_positional(); }

std::string Option::as_given() const {
    const std::string name = option_->get_name();
    if (option_->get_items_expected_max() == 0)
        return name + (results().back() == "true" ? "" : "=" + results().back());
    std::string text;
    for (const std::string& value : results()) {
        const bool first = &value == &results().front(), separate = option_->get_delimiter() == 0;
        if (first || separate)
            text += (first ? "" : " ") + name + " ";
        else
            text += option_->get_delimiter();
        text += in_shell(value);
    }
    return text;
}

template <class T>
Option Command::add_option(const std::string& names, T& value, const std::string& help) {
    return Option(app_->add_option(names, value, help));
}
template Option Command::add_option(const std::string&, std::string&, const std::string&);
template Option Command::add_option(const std::string&, double&, const std::string&);
template Option Command::add_option(const std::string&, float&, const std::string&);
template Option Command::add_option(const std::string&, int&, const std::string&);
template Option Command::add_option(const std::string&, unsigned&, const std::string&);
template Option Command::add_option(const std::string&, uint64_t&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<double>&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<float>&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<double>&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<float>&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<unsigned>&, const std::string&);

Option Command::add_option(const std::string& names, const std::string& help) {
    return Option(app_->add_option(names, help));
}
Option Command::add_flag(const std::string& names, bool& value, const std::string& help) {
    return Option(app_->add_flag(names, value, help));
}
Option Command::add_switch(const std::string& names, const std::string& help) {
    return Option(app_->add_option(names, help)->type_name(kSwitch));
}
void Command::add_allow_outside() {
    const auto folders = std::make_shared<std::vector<std::unique_ptr<const io::AllowedFolder>>>();
    const CLI::callback_t allow = [folders](const CLI::results_t& given) {
        for (const std::string& value : given) {
            // CLI11 says "{}" for no value.
            const std::string folder = value.empty() || value == "{}" || value == "all" ? "/" : value;
            if (!std::filesystem::is_directory(folder))
                throw Error("--allow-outside " + one_line(folder) +
                            ": there is no such folder (all opens every folder)");
            folders->push_back(std::make_unique<const io::AllowedFolder>(folder));
        }
        return true;
    };
    app_->add_option("--allow-outside", allow,
                     "Read files that the scene names outside of its folder: those in FOLDER; all, or no value, opens "
                     "every folder (./all is a folder of that name); may be repeated")
        ->type_name("FOLDER")
        ->expected(0, 1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}
Command Command::add_command(const std::string& name, const std::string& help) {
    return Command(app_->add_subcommand(name, help));
}
void Command::requires_command() { app_->require_subcommand(1); }
void Command::footer(const std::string& text) { app_->footer(text); }
void Command::callback(const std::function<void()>& run) {
    app_->callback([run, name = app_->get_name()] {
        if (Ranks::several()) throw Error(name + " does not run on several ranks (mpirun, srun)");
        run();
    });
}
void Command::callback_of_ranks(const std::function<void()>& run) { app_->callback(run); }
void Command::keep(std::shared_ptr<void> kept) {
    app_->parse_complete_callback([kept] {});
}
void Command::help_group(const std::string& heading) { app_->option_defaults()->group(heading); }
void Command::help_group() { help_group(kFirstPage); }

size_t Command::count(const std::string& option) const { return app_ ? app_->count(option) : 0; }
Option Command::option(const std::string& name) const { return Option(app_->get_option(name)); }
std::vector<Option> Command::options() const {
    std::vector<Option> options;
    for (CLI::Option* option : app_->get_options({})) options.emplace_back(option);
    return options;
}
Command Command::command(const std::string& name) const { return Command(app_->get_subcommand(name)); }
std::string Command::name() const { return app_->get_name(); }
std::string Command::listed_name(const Option& option) {
    return option.option_->get_name(option.is_positional(), !option.is_positional());
}
std::string Command::help(bool all) const {
    return app_->help("", all ? CLI::AppFormatMode::All : CLI::AppFormatMode::Normal);
}

Program::Program(const std::string& description, const std::string& name)
    : owned_(std::make_unique<CLI::App>(description, name)) {
    app_ = owned_.get();
    if (name.empty()) {
        app_->set_help_flag();
        return;
    }
    app_->formatter(help_pages());
    app_->set_help_flag("-h,--help", "Print this page");
    app_->set_help_all_flag("--help-all", "Print all options, with the ranges of numbers");
}

Program::~Program() = default;

void Program::version(const std::string& text) { app_->set_version_flag("--version", text); }

namespace {

// What all ranks must be given alike: all but their devices and threads.
std::string common_arguments(int argc, char** argv) {
    std::string words;
    for (int i = 1; i < argc; ++i)
        if (const std::string_view word(argv[i]); word == "--device" || word == "--threads")
            ++i;
        else if (!word.starts_with("--device=") && !word.starts_with("--threads="))
            words += std::string(argv[i]) + '\n';
    return words;
}

}  // namespace

int Program::run(int argc, char** argv) {
    keep_freed_memory();
    handle_signals();
    io::FileGate gate;
    gate.keeps_contents = Ranks::several();
    std::optional<io::AllowedFolder> own;  // scenes of our own share lamps
    try {
        own.emplace(own_data());
    } catch (const Error&) {
        // There are none.
    }
    const std::string name = app_->get_name();
    Ranks::set_program(name, common_arguments(argc, argv));
    std::string failure;
    try {
        parse_words(*app_, {argv + std::min(argc, 1), argv + argc});
        Ranks::finish();
        return output_ended(name) ? 0 : kBadInput;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {  // --help, --version
            if (Ranks::own_number() == 0) app_->exit(error);
            return output_ended(name) ? 0 : kBadInput;
        }
        std::string message = error.what();
        // What is missing may be missing only because this was meant for it.
        const std::vector<std::string> unknown = app_->remaining(true);
        if (error.get_name() == "RequiredError" && !unknown.empty()) message = "there is no " + unknown.front();
        std::replace(message.begin(), message.end(), '\n', ' ');
        failure = one_line(message, 1000) + " (--help shows what is possible)";
    } catch (const Verdict& verdict) {
        Ranks::finish();
        return output_ended(name) ? verdict.exit_code : kBadInput;
    } catch (const AgreedError& error) {
        if (*error.what() != '\0') print_error(name, error.what());
        Ranks::finish();
        return kBadInput;
    } catch (const Error& error) {
        failure = error.what();
    } catch (const std::bad_alloc&) {
        failure = "out of memory";
    }
    try {
        failure = Ranks::fail(failure);
        if (!failure.empty()) print_error(name, failure);
        Ranks::finish();
    } catch (const std::exception& error) {
        print_error(name, error.what());
    }
    return kBadInput;
}

void Program::parse(const std::vector<std::string>& words) {
    try {
        parse_words(*app_, words);
    } catch (const CLI::ParseError& error) {
        throw Error(one_line(error.what()));
    }
}

std::string options_of(const Command& command, const std::vector<std::string>& but) {
    std::string text;
    for (const Option& option : command.options()) {
        if (option.is_positional() || option.count() == 0 || std::count(but.begin(), but.end(), option.name()))
            continue;
        text += (text.empty() ? "" : " ") + option.as_given();
    }
    return one_line(text, 4000);
}

}  // namespace vesper::apps
