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

namespace tactus::file {
class Json;
}

namespace tactus::command {

/// A declared option of a verb. Copies refer to the same option.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}

    Option& required();
    Option& shows_default();                              ///< the help text states the current value as default
    Option& range(int least, int most);                   ///< inclusive
    Option& range(double least, double most);             ///< inclusive
    Option& positive();                                   ///< a number above 0
    /// Accepts a unit: "2 min" for unit("s"). A plain number, and the stored value, are in `unit`.
    Option& unit(const std::string& unit);
    Option& one_of(const std::vector<std::string>& all);  ///< allowed values
    Option& one_each();  ///< every value needs its own option name
    Option& separated_by(char delimiter);  ///< several values in one argument
    Option& count(int values);  ///< exact number of values
    Option& count(int least, int most);  ///< of values
    Option& needs(const Option& other);
    Option& excludes(const Option& other);
    Option& about(const std::string& text);
    Option& value_name(const std::string& name);  ///< in the help text, such as LOW:HIGH
    Option& hidden();  ///< accepted, but not shown in help texts: an old spelling

private:
    CLI::Option* option_;
};

/// What an option names: a file or a folder that the verb writes. Outputs are declared apart from inputs, so that
/// check_written() can protect every input and refuse a name whose ending promises a format that the verb does not
/// write, for all verbs and before any work.
struct OutputFormat {
    std::vector<std::string> endings;  ///< of the file, with their point, as ".seg.nrrd"
    bool is_free = false;  ///< also a folder, or a text of no common format: any ending that no output has

    static OutputFormat folder() { return {{}, true}; }
    static OutputFormat file_or_folder(std::vector<std::string> endings) { return {std::move(endings), true}; }
    static OutputFormat text() { return {{}, true}; }
};

/// An output that a verb declared.
struct DeclaredOutput {
    const CLI::Option* option;
    OutputFormat what;
};

/// Old spellings that a verb accepts; no help text shows them.
struct OldSpellings {
    std::vector<std::pair<std::string, std::string>> renamed;  ///< old option, current option
    std::function<void(std::vector<std::string>&)> rewrite;  ///< applied to all words after the verb; may be null
};

/// Declares the options of a verb. Referenced variables must live until the verb has run.
class VerbOptions {
public:
    VerbOptions(CLI::App& app, OldSpellings& old, std::vector<DeclaredOutput>& outputs)
        : app_(app), old_(old), outputs_(outputs) {}

    /// `name`: "--out", "-o,--out", or without dashes for a positional argument. T: texts, paths, numbers,
    /// std::optional of numbers, and std::vector of texts, paths and numbers.
    template <class T>
    Option add(const std::string& name, T& value, const std::string& about);
    /// The same for a file or a folder that the verb writes. Every such option is declared with it.
    template <class T>
    Option output(const std::string& name, T& value, OutputFormat what, const std::string& about);
    /// Calls `take` with the value. T: double or std::string. `take` may throw Error.
    template <class T>
    Option call(const std::string& name, std::function<void(const T&)> take, const std::string& about);
    /// Sets `value` to true when given; with '!' before the name, to false.
    Option flag(const std::string& name, bool& value, const std::string& about);
    /// LOW:HIGH, frequencies in Hz or with a unit, as in "200:600" or "200 Hz:1 kHz". The help text states the current
    /// band as default.
    Option band(const std::string& name, double& low, double& high, const std::string& about);
    /// Accepts `before` as an old spelling of the option `now`; no help text shows it.
    void old(const std::string& before, const std::string& now) { old_.renamed.emplace_back(before, now); }
    /// Rewrites the words after the verb, for old spellings that depend on context.
    void old(std::function<void(std::vector<std::string>&)> rewrite) { old_.rewrite = std::move(rewrite); }
    /// A declared option. Throws when it does not exist.
    Option find(const std::string& name);
    /// Called when all options of the verb are read. It may throw Error.
    void check(std::function<void()> function);

private:
    CLI::App& app_;
    OldSpellings& old_;
    std::vector<DeclaredOutput>& outputs_;
};

/// "200:600" or "200 Hz:1 kHz" → Hz, low and high. Throws Error that names the option.
std::pair<double, double> parse_band(const std::string& text, const std::string& option);

/// The action of a verb; returns the exit code.
using Action = std::function<int()>;

struct Verb;
using Verbs = std::vector<Verb>;

/// A verb, or a group of verbs. Each is defined in a file of its name.
struct Verb {
    const char* name;
    const char* about;
    /// Declares the options and returns the action. Null for a group and for another program.
    Action (*add)(VerbOptions& options);
    /// The verbs of a group. Null otherwise.
    const Verbs& (*verbs)() = nullptr;
    /// Runs another program with all arguments after the verb. Null otherwise.
    int (*forward)(const std::vector<std::string>& arguments) = nullptr;
    const char* job = "";  ///< heading in the help text; "": none
    const char* old_name = nullptr;  ///< accepted as well, but not shown
    bool is_hidden = false;  ///< no help text shows it
    file::Json (*schema)() = nullptr;  ///< JSON Schema of its --json output; null: it has none
};

/// A program: a list of verbs.
struct Program {
    const char* name;
    const char* about;
    const Verbs& verbs;
    const char* first_steps = nullptr;  ///< printed when there are no arguments; null: an error then
};

/// "tactus 0.1.0, Release, GCC 12.2.0": version, build type and compiler.
std::string version_text(const char* program);

/// Parses the command line and runs the verb. Prints errors on standard error and returns the exit code.
int command_line(const Program& program, int argc, char** argv);

}  // namespace tactus::command
