// SPDX-License-Identifier: Apache-2.0
// The options of a verb. A thin layer over CLI11, which takes seconds to compile and is included in three files only.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace tactus::command {

/// One option of a verb, as it is declared. Copies stand for the same option.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}

    Option& required();
    Option& shows_default();                              ///< the help text states the value that it has now
    Option& range(int least, int most);                   ///< inclusive
    Option& range(double least, double most);             ///< inclusive
    Option& positive();                                   ///< a number above 0
    /// The number may have a unit: "2 min" for unit("s"). Without one it is in `unit`, which is that of the value, too.
    Option& unit(const std::string& unit);
    Option& one_of(const std::vector<std::string>& all);  ///< of these texts
    Option& one_each();  ///< of several values each has the option's name before it
    Option& separated_by(char delimiter);  ///< several values in one text
    Option& count(int values);  ///< exactly so many values
    Option& count(int least, int most);  ///< of values
    Option& needs(const Option& other);
    Option& excludes(const Option& other);
    Option& about(const std::string& text);
    Option& hidden();  ///< works, but no help text shows it: an old spelling

private:
    CLI::Option* option_;
};

/// What a verb still understands although no help text shows it.
struct OldSpellings {
    std::vector<std::pair<std::string, std::string>> renamed;  ///< option before, option now
    std::function<void(std::vector<std::string>&)> rewrite;  ///< of all words behind the verb; may be null
};

/// What a verb takes. What it reads into must live until the verb has run.
class VerbOptions {
public:
    VerbOptions(CLI::App& app, OldSpellings& old) : app_(app), old_(old) {}

    /// `name`: "--out", "-o,--out", or without dashes a positional argument. For texts, paths, numbers, std::optional of
    /// numbers, and std::vector of texts, paths and numbers.
    template <class T>
    Option add(const std::string& name, T& value, const std::string& about);
    /// Calls `take` with the value, for double and std::string. It may throw Error.
    template <class T>
    Option call(const std::string& name, std::function<void(const T&)> take, const std::string& about);
    /// True when it is given; a name with '!' before it: false when it is given.
    Option flag(const std::string& name, bool& value, const std::string& about);
    /// LOW:HIGH, frequencies in Hz or with a unit, as in "200:600" or "200 Hz:1 kHz". The help text states the band that
    /// it has now.
    Option band(const std::string& name, double& low, double& high, const std::string& about);
    /// `before` is another spelling of the option `now`, which no help text shows.
    void old(const std::string& before, const std::string& now) { old_.renamed.emplace_back(before, now); }
    /// Changes what was typed behind the verb, where a word alone does not tell which spelling was meant.
    void old(std::function<void(std::vector<std::string>&)> rewrite) { old_.rewrite = std::move(rewrite); }
    /// One that is there already. Throws when it is not.
    Option find(const std::string& name);
    /// Called when all options of the verb are read. It may throw Error.
    void check(std::function<void()> function);

private:
    CLI::App& app_;
    OldSpellings& old_;
};

/// "200:600" or "200 Hz:1 kHz" → Hz, low and high. Throws Error that names the option.
std::pair<double, double> parse_band(const std::string& text, const std::string& option);

/// What runs once the command line is read; returns the exit code.
using Action = std::function<int()>;

struct Verb;
using Verbs = std::vector<Verb>;

/// Something that the command does, or a group of such. Each lives in a file of its name.
struct Verb {
    const char* name;
    const char* about;
    /// Adds the options and returns what runs with them. Null for a group and for another program.
    Action (*add)(VerbOptions& options);
    /// Of a group. Null otherwise.
    const Verbs& (*verbs)() = nullptr;
    /// Runs another program with all arguments behind the verb. Null otherwise.
    int (*forward)(const std::vector<std::string>& arguments) = nullptr;
    const char* job = "";  ///< heading in the help text; "": that of all
    const char* old_name = nullptr;  ///< understood as well, and not shown
    bool is_hidden = false;  ///< no help text shows it
};

/// A program that is a list of verbs.
struct Program {
    const char* name;
    const char* about;
    const Verbs& verbs;
};

/// "tactus 0.1.0, Release, GCC 12.2.0": version, build type and compiler.
std::string version_text(const char* program);

/// Reads the command line and runs the verb. Says on standard error what is wrong and returns the exit code.
int command_line(const Program& program, int argc, char** argv);

}  // namespace tactus::command
