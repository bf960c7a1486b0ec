// SPDX-License-Identifier: Apache-2.0
#include "tools/command/options.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <tuple>

namespace tactus::command {

namespace {

bool is_bare_number(const std::string& text) {
    // Parses numbers like CLI11, which also accepts "1e3", "+5" and " 5".
    char* end = nullptr;
    std::strtod(text.c_str(), &end);
    while (end && *end == ' ') ++end;
    return !text.empty() && end && *end == '\0';
}

/// Placeholder of the value in help texts.
std::string name_of_unit(const std::string& unit) {
    const Dimension dimension = parse_unit(unit).dimension;
    for (const auto& [like, name] : {std::pair{"s", "TIME"},
                                     {"Hz", "FREQUENCY"},
                                     {"m", "LENGTH"},
                                     {"m^2", "AREA"},
                                     {"deg", "ANGLE"},
                                     {"kg", "MASS"}})
        if (parse_unit(like).dimension == dimension) return name;
    return "QUANTITY";
}

double frequency_of(const std::string& text) {
    return is_bare_number(text) ? std::strtod(text.c_str(), nullptr) : parse_as(text, "Hz");
}

}  // namespace

std::pair<double, double> parse_band(const std::string& text, const std::string& option) {
    const std::size_t colon = text.find(':');
    double low = 0.0, high = 0.0;
    try {
        if (colon != std::string::npos) {
            low = frequency_of(text.substr(0, colon));
            high = frequency_of(text.substr(colon + 1));
        }
    } catch (const Error&) {
        low = 0.0;  // reported below
    }
    if (!(low > 0.0) || !(high > low) || !std::isfinite(high))
        throw Error(fmt::format("{} takes LOW:HIGH in Hz, as in {} 200:600 or \"200 Hz:1 kHz\", not '{}'", option,
                                option, text));
    return {low, high};
}

namespace {

/// Comparisons with "nan" are false, so that no range leaves it out.
CLI::Validator is_number() {
    return CLI::Validator(
        [](std::string& text) {
            double number = 0.0;
            return CLI::detail::lexical_cast(text, number) && std::isnan(number) ? "'" + text + "' is not a number"
                                                                                 : std::string();
        },
        "");
}

}  // namespace

Option& Option::required() {
    option_->required();
    return *this;
}

Option& Option::shows_default() {
    option_->capture_default_str();
    return *this;
}

Option& Option::range(int least, int most) {
    option_->check(CLI::Range(least, most).description(fmt::format("{} to {}", least, most)));
    return *this;
}

Option& Option::range(double least, double most) {
    option_->check(is_number());
    option_->check(CLI::Range(least, most).description(fmt::format("{} to {}", least, most)));
    return *this;
}

Option& Option::positive() {
    option_->check(is_number())->check(CLI::PositiveNumber);
    return *this;
}

Option& Option::unit(const std::string& unit) {
    const auto read = [unit](std::string& text) {
        if (is_bare_number(text)) return std::string();
        try {
            text = fmt::format("{}", parse_as(text, unit) / parse_unit(unit).factor);
        } catch (const Error& error) {
            return error.message();
        }
        return std::string();
    };
    option_->transform(CLI::Validator(read, ""));
    option_->type_name(name_of_unit(unit));
    return *this;
}

Option& Option::hidden() {
    option_->group("");
    return *this;
}

Option& Option::one_of(const std::vector<std::string>& all) {
    option_->check(CLI::IsMember(all));
    return *this;
}

Option& Option::one_each() {
    option_->allow_extra_args(false);
    return *this;
}

Option& Option::separated_by(char delimiter) {
    option_->delimiter(delimiter);
    return *this;
}

Option& Option::count(int values) {
    option_->expected(values);
    return *this;
}

Option& Option::count(int least, int most) {
    option_->expected(least, most);
    return *this;
}

Option& Option::needs(const Option& other) {
    option_->needs(other.option_);
    return *this;
}

Option& Option::excludes(const Option& other) {
    option_->excludes(other.option_);
    return *this;
}

Option& Option::value_name(const std::string& name) {
    option_->type_name(name);
    return *this;
}

Option& Option::about(const std::string& text) {
    option_->description(text);
    return *this;
}

template <class T>
Option VerbOptions::add(const std::string& name, T& value, const std::string& about) {
    return Option(app_.add_option(name, value, about));
}

template <class T>
Option VerbOptions::output(const std::string& name, T& value, OutputFormat what, const std::string& about) {
    CLI::Option* option = app_.add_option(name, value, about);
    outputs_.push_back({option, std::move(what)});
    return Option(option);
}

template <class T>
Option VerbOptions::call(const std::string& name, std::function<void(const T&)> take, const std::string& about) {
    return Option(app_.add_option_function<T>(name, std::move(take), about));
}

Option VerbOptions::flag(const std::string& name, bool& value, const std::string& about) {
    return Option(app_.add_flag(name, value, about));
}

Option VerbOptions::band(const std::string& name, double& low, double& high, const std::string& about) {
    const std::string shown = name.substr(name.rfind(',') + 1);
    CLI::Option* option = app_.add_option_function<std::string>(
        name, [&low, &high, shown](const std::string& text) { std::tie(low, high) = parse_band(text, shown); }, about);
    option->type_name("LOW:HIGH");
    option->default_str(fmt::format("{:g}:{:g}", low, high));
    return Option(option);
}

Option VerbOptions::find(const std::string& name) { return Option(app_.get_option(name)); }

void VerbOptions::check(std::function<void()> function) { app_.callback(std::move(function)); }

template Option VerbOptions::add(const std::string&, std::string&, const std::string&);
template Option VerbOptions::add(const std::string&, std::filesystem::path&, const std::string&);
template Option VerbOptions::add(const std::string&, int&, const std::string&);
template Option VerbOptions::add(const std::string&, double&, const std::string&);
template Option VerbOptions::add(const std::string&, std::uint64_t&, const std::string&);
template Option VerbOptions::add(const std::string&, std::optional<int>&, const std::string&);
template Option VerbOptions::add(const std::string&, std::optional<double>&, const std::string&);
template Option VerbOptions::add(const std::string&, std::optional<std::string>&, const std::string&);
template Option VerbOptions::add(const std::string&, std::optional<std::uint64_t>&, const std::string&);
template Option VerbOptions::add(const std::string&, std::vector<std::string>&, const std::string&);
template Option VerbOptions::add(const std::string&, std::vector<std::filesystem::path>&, const std::string&);
template Option VerbOptions::add(const std::string&, std::vector<int>&, const std::string&);
template Option VerbOptions::add(const std::string&, std::vector<double>&, const std::string&);
template Option VerbOptions::output(const std::string&, std::string&, OutputFormat, const std::string&);
template Option VerbOptions::output(const std::string&, std::filesystem::path&, OutputFormat, const std::string&);
template Option VerbOptions::output(const std::string&, std::vector<std::filesystem::path>&, OutputFormat,
                                    const std::string&);
template Option VerbOptions::call(const std::string&, std::function<void(const double&)>, const std::string&);
template Option VerbOptions::call(const std::string&, std::function<void(const std::string&)>, const std::string&);

}  // namespace tactus::command
