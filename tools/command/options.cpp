// SPDX-License-Identifier: Apache-2.0
#include "tools/command/options.hpp"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>

namespace tactus::command {

Option& Option::required() {
    option_->required();
    return *this;
}

Option& Option::shows_default() {
    option_->capture_default_str();
    return *this;
}

Option& Option::range(int least, int most) {
    option_->check(CLI::Range(least, most));
    return *this;
}

Option& Option::range(double least, double most) {
    option_->check(CLI::Range(least, most));
    return *this;
}

Option& Option::positive() {
    option_->check(CLI::PositiveNumber);
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

Option& Option::about(const std::string& text) {
    option_->description(text);
    return *this;
}

template <class T>
Option VerbOptions::add(const std::string& name, T& value, const std::string& about) {
    return Option(app_.add_option(name, value, about));
}

template <class T>
Option VerbOptions::call(const std::string& name, std::function<void(const T&)> take, const std::string& about) {
    return Option(app_.add_option_function<T>(name, std::move(take), about));
}

Option VerbOptions::flag(const std::string& name, bool& value, const std::string& about) {
    return Option(app_.add_flag(name, value, about));
}

Option VerbOptions::find(const std::string& name) { return Option(app_.get_option(name)); }

void VerbOptions::check(std::function<void()> function) { app_.callback(std::move(function)); }

template Option VerbOptions::add(const std::string&, std::string&, const std::string&);
template Option VerbOptions::add(const std::string&, std::filesystem::path&, const std::string&);
template Option VerbOptions::add(const std::string&, int&, const std::string&);
template Option VerbOptions::add(const std::string&, double&, const std::string&);
template Option VerbOptions::add(const std::string&, std::uint64_t&, const std::string&);
template Option VerbOptions::add(const std::string&, std::optional<double>&, const std::string&);
template Option VerbOptions::add(const std::string&, std::optional<std::string>&, const std::string&);
template Option VerbOptions::add(const std::string&, std::optional<std::uint64_t>&, const std::string&);
template Option VerbOptions::add(const std::string&, std::vector<std::string>&, const std::string&);
template Option VerbOptions::add(const std::string&, std::vector<std::filesystem::path>&, const std::string&);
template Option VerbOptions::add(const std::string&, std::vector<int>&, const std::string&);
template Option VerbOptions::add(const std::string&, std::vector<double>&, const std::string&);
template Option VerbOptions::call(const std::string&, std::function<void(const double&)>, const std::string&);
template Option VerbOptions::call(const std::string&, std::function<void(const std::string&)>, const std::string&);

}  // namespace tactus::command
