// Options and commands of the programs: CLI11 behind types that are quick to compile. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI

namespace vesper::apps {

constexpr const char* kFirstPage = "Options";  ///< group of the options that --help lists
constexpr int kBadInput = 2;                   ///< exit code for a file, device or argument that cannot be used

/// Thrown by a command that printed its results and ends with an exit code of its own.
struct Verdict {
    int exit_code = 1;
};

/// A test of one argument, and the words that --help-all shows for it.
class Check {
public:
    /// `complaint` returns the empty string for an argument that is possible, the whole complaint for others.
    Check(const std::function<std::string(const std::string&)>& complaint, const std::string& words);
    explicit Check(const CLI::Validator&);
    const CLI::Validator& validator() const { return *validator_; }

private:
    std::shared_ptr<const CLI::Validator> validator_;
};
/// A number in a range; not-a-number is in none.
Check between(double low, double high);
/// The same, shown with the kind of number: a real one, or a whole one.
Check range(double low, double high);
Check range(int low, int high);
Check range(unsigned low, unsigned high);
Check not_negative();
Check one_of(const std::vector<std::string>& words);
Check one_of(std::initializer_list<const char*> words);
Check one_of(std::initializer_list<int> numbers);
/// The keys of a map.
template <class Map>
Check one_of_keys(const Map& map) {
    std::vector<std::string> words;
    for (const auto& [word, value] : map) words.emplace_back(word);
    return one_of(words);
}

/// An option of a command. A handle: copies are the same option.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}

    Option& check(const Check&);
    Option& required();
    /// --help shows the value that the variable had when this was called, or `text`.
    Option& shows_default();
    Option& shows_default(const std::string& text);
    /// --help shows the word for what it takes.
    Option& takes(const std::string& word);
    /// One argument holds several values.
    Option& separated_by(char separator);
    /// How many values follow.
    Option& values(int number) { return values(number, number); }
    Option& values(int least, int most);
    /// May be given several times, a value each.
    Option& repeats();
    /// Takes a list of values, separated by commas, into `list`; checks apply to each.
    Option& takes_list(std::vector<std::string>& list);
    Option& excludes(const Option&);

    /// Number of times that it was given, values that were given, name with dashes.
    size_t count() const;
    const std::vector<std::string>& results() const;
    std::string name() const;
    std::string group() const;
    bool is_positional() const;
    /// Name and values as a shell would take them again.
    std::string as_given() const;

private:
    friend class Command;
    CLI::Option* option_;
};

/// A program or a command of it. A handle: copies are the same command. Default: none, which was given nothing.
class Command {
public:
    Command() = default;
    explicit Command(CLI::App* app) : app_(app) {}

    /// T: std::string, double, float, int, unsigned, uint64_t, optional float and double, vectors of strings, doubles,
    /// floats and unsigned numbers. `names`: "--long,-s", or "name" of a positional one.
    template <class T>
    Option add_option(const std::string& names, T& value, const std::string& help);
    /// Without a variable: see Option::results().
    Option add_option(const std::string& names, const std::string& help);
    Option add_flag(const std::string& names, bool& value, const std::string& help);
    /// Takes on or off; before any other word, or as the last one, its name alone is on. See Option::results().
    Option add_switch(const std::string& names, const std::string& help);
    /// --allow-outside, for commands that read scenes: opens folders to the files that they name (AllowedFolder).
    void add_allow_outside();
    Command add_command(const std::string& name, const std::string& help);
    void requires_command();
    void footer(const std::string& text);
    /// Runs when the command was given and all its arguments are possible.
    void callback(const std::function<void()>&);
    /// The same where several ranks may run it together (Ranks); others refuse that.
    void callback_of_ranks(const std::function<void()>&);
    /// Keeps `kept` as long as the command.
    void keep(std::shared_ptr<void> kept);
    /// Options that are declared from here on belong to that group of --help-all; without a name, to the first page.
    void help_group(const std::string& heading);
    void help_group();

    size_t count(const std::string& option) const;
    Option option(const std::string& name) const;
    std::vector<Option> options() const;
    Command command(const std::string& name) const;
    std::string name() const;
    /// Name of an option as pages of help list it.
    static std::string listed_name(const Option&);
    /// The first page, or all of them.
    std::string help(bool all = false) const;

protected:
    CLI::App* app_ = nullptr;
};

/// Options without a program: to parse words of other origin. Without a name it has no options of its own, such as
/// --help.
class Program : public Command {
public:
    explicit Program(const std::string& description = "", const std::string& name = "");
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program();

    void version(const std::string& text);
    /// Parses arguments, which runs the callbacks. Complaints are one line on standard error that begins with the
    /// program's name. Returns the exit code: 0, or kBadInput.
    int run(int argc, char** argv);
    /// Parses words. Throws Error.
    void parse(const std::vector<std::string>& words);

private:
    std::unique_ptr<CLI::App> owned_;
};

/// The options given, but for those named, as they would be given again: what a picture was made with.
std::string options_of(const Command& command, const std::vector<std::string>& but);

}  // namespace vesper::apps
