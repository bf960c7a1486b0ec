// SPDX-License-Identifier: Apache-2.0
// The options of a verb. A thin layer over CLI11, which takes seconds to compile and is included in two files only.
#pragma once

#include <functional>
#include <string>
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
    Option& one_of(const std::vector<std::string>& all);  ///< of these texts
    Option& one_each();                                   ///< of several values each has the option's name before it
    Option& separated_by(char delimiter);                 ///< several values in one text
    Option& count(int values);                            ///< exactly so many values
    Option& count(int least, int most);                   ///< of values
    Option& needs(const Option& other);
    Option& excludes(const Option& other);
    Option& about(const std::string& text);

private:
    CLI::Option* option_;
};

/// What a verb takes. What it reads into must live until the verb has run.
class VerbOptions {
public:
    explicit VerbOptions(CLI::App& app) : app_(app) {}

    /// `name`: "--out", "-o,--out", or without dashes a positional argument. For texts, paths, numbers, std::optional of
    /// numbers, and std::vector of texts, paths and numbers.
    template <class T>
    Option add(const std::string& name, T& value, const std::string& about);
    /// Calls `take` with the value, for double and std::string. It may throw Error.
    template <class T>
    Option call(const std::string& name, std::function<void(const T&)> take, const std::string& about);
    /// True when it is given; a name with '!' before it: false when it is given.
    Option flag(const std::string& name, bool& value, const std::string& about);
    /// One that is there already. Throws when it is not.
    Option find(const std::string& name);
    /// Called when all options of the verb are read. It may throw Error.
    void check(std::function<void()> function);

private:
    CLI::App& app_;
};

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
};

/// A program that is a list of verbs.
struct Program {
    const char* name;
    const char* about;
    const Verbs& verbs;
};

/// Reads the command line and runs the verb. Says on standard error what is wrong and returns the exit code.
int command_line(const Program& program, int argc, char** argv);

}  // namespace tactus::command
