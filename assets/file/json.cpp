// SPDX-License-Identifier: Apache-2.0
#include "assets/file/json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>

namespace tactus::file {

namespace {

using Library = nlohmann::ordered_json;

/// Deeper text is no file of ours, and values are freed recursively.
constexpr std::size_t max_nested = 100;

/// Characters of a text for the parser, which reports no lines: counts those that it has read. The parser reads no
/// character behind a name or an opening bracket before it reports it.
class Reading {
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    Reading(const char* at, int* lines) : at_(at), lines_(lines) {}
    reference operator*() const { return *at_; }
    Reading& operator++() {
        *lines_ += *at_ == '\n';
        ++at_;
        return *this;
    }
    Reading operator++(int) {
        Reading before = *this;
        ++*this;
        return before;
    }
    friend bool operator==(const Reading& a, const Reading& b) { return a.at_ == b.at_; }

private:
    const char* at_;
    int* lines_;
};

/// Builds a value from the events of the parser.
class Builder : public nlohmann::json_sax<Library> {
public:
    explicit Builder(const int& line) : line_(line) {}
    Json take() { return std::move(root_); }

    bool null() override { return add(Json()); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(std::int64_t value) override { return add(value); }
    bool number_unsigned(std::uint64_t value) override { return add(value); }
    bool number_float(double value, const std::string&) override { return add(value); }
    bool string(std::string& value) override { return add(std::move(value)); }
    bool binary(Library::binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open(Json::object()); }
    bool start_array(std::size_t) override { return open(Json::array()); }
    bool key(std::string& value) override {
        key_ = std::move(value);
        key_line_ = line_;
        return true;
    }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
        constexpr int out_of_range = 406;  // a number; the text is JSON
        if (error.id == out_of_range) throw Error("a number is out of range");
        throw JsonSyntaxError(error.what(), position);
    }

private:
    Json& place(Json value) {
        if (open_.empty()) return root_ = std::move(value);
        Json& parent = *open_.back();
        if (parent.is_object()) {
            if (const Json* earlier = parent.find(key_))
                throw Error(fmt::format("'{}' is given twice, in lines {} and {}; keep one", key_.substr(0, 80),
                                        earlier->line(), key_line_));
            value.set_line(key_line_);
            return parent[key_] = std::move(value);
        }
        parent.push_back(std::move(value));
        return parent.back();
    }
    bool add(Json value) {
        place(std::move(value));
        return true;
    }
    /// A value that is open gets no sibling: its address stays.
    bool open(Json value) {
        if (open_.size() == max_nested)
            throw JsonSyntaxError(fmt::format("values nest more than {} deep", max_nested), 0);
        value.set_line(line_);
        open_.push_back(&place(std::move(value)));
        return true;
    }
    bool close() {
        open_.pop_back();
        return true;
    }

    Json root_;
    std::vector<Json*> open_;
    std::string key_;
    const int& line_;  ///< that the parser is in
    int key_line_ = 0;
};

Library library_value(const Json& json) {
    if (json.is_object()) {
        Library object = Library::object();
        for (const auto& [key, value] : json.items()) object.emplace(key, library_value(value));
        return object;
    }
    if (json.is_array()) {
        Library list = Library::array();
        for (const Json& element : json) list.push_back(library_value(element));
        return list;
    }
    if (json.is_boolean()) return json.get<bool>();
    if (json.is_string()) return json.as_text();
    if (json.is_number_float()) return json.get<double>();
    if (json.is_number_integer()) {
        // Above the greatest signed number only the unsigned one has the value.
        if (json == json.get<std::int64_t>()) return json.get<std::int64_t>();
        return json.get<std::uint64_t>();
    }
    return nullptr;
}

[[noreturn]] void fail(const char* wanted) { throw Error(fmt::format("a JSON value is {}", wanted)); }

}  // namespace

Json::Json() noexcept : value_(nullptr) {}
Json::Json(std::nullptr_t) noexcept : value_(nullptr) {}
Json::Json(bool value) noexcept : value_(value) {}
Json::Json(int value) noexcept : value_(std::int64_t{value}) {}
Json::Json(long value) noexcept : value_(std::int64_t{value}) {}
Json::Json(long long value) noexcept : value_(std::int64_t{value}) {}
Json::Json(unsigned value) noexcept : value_(std::uint64_t{value}) {}
Json::Json(unsigned long value) noexcept : value_(std::uint64_t{value}) {}
Json::Json(unsigned long long value) noexcept : value_(std::uint64_t{value}) {}
Json::Json(double value) noexcept : value_(value) {}
Json::Json(const char* text) : value_(std::string(text)) {}
Json::Json(std::string_view text) : value_(std::string(text)) {}
Json::Json(std::string text) noexcept : value_(std::move(text)) {}

Json::Json(std::initializer_list<Json> elements) : value_(nullptr) {
    const bool is_object = std::ranges::all_of(elements, [](const Json& element) {
        const List* pair = std::get_if<List>(&element.value_);
        return pair && pair->size() == 2 && pair->front().is_string();
    });
    if (!is_object) {
        *this = array(elements);
        return;
    }
    value_.emplace<Object>().reserve(elements.size());
    for (const Json& element : elements) {
        List& pair = std::get<List>(element.value_);
        // Of two members of one name the first stays.
        if (!contains(pair[0].as_text()))
            std::get<Object>(value_).emplace_back(std::move(std::get<std::string>(pair[0].value_)), std::move(pair[1]));
    }
}

Json::Json(const Json&) = default;
Json::Json(Json&&) noexcept = default;
Json& Json::operator=(const Json&) = default;
Json& Json::operator=(Json&&) noexcept = default;
Json::~Json() = default;

Json Json::array() {
    Json json;
    json.value_.emplace<List>();
    return json;
}

Json Json::array(std::initializer_list<Json> elements) {
    Json json;
    List& list = json.value_.emplace<List>();
    list.reserve(elements.size());
    for (const Json& element : elements) list.emplace_back().value_ = std::move(element.value_);
    return json;
}

Json Json::object() {
    Json json;
    json.value_.emplace<Object>();
    return json;
}

Json Json::parse(std::string_view text) {
    int line = 1;
    Builder builder(line);
    Library::sax_parse(Reading(text.data(), &line), Reading(text.data() + text.size(), &line), &builder);
    return builder.take();
}

Json Json::parse_or_null(std::string_view text) {
    try {
        return parse(text);
    } catch (const Error&) {
        return nullptr;
    }
}

std::string Json::dump(int indent) const {
    // A name that a device or a file gives may be no UTF-8: its bytes are replaced, and the text stays JSON.
    return library_value(*this).dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

bool Json::is_null() const { return std::holds_alternative<std::nullptr_t>(value_); }
bool Json::is_boolean() const { return std::holds_alternative<bool>(value_); }
bool Json::is_number() const { return is_number_integer() || is_number_float(); }
bool Json::is_number_integer() const {
    return std::holds_alternative<std::int64_t>(value_) || std::holds_alternative<std::uint64_t>(value_);
}
bool Json::is_number_float() const { return std::holds_alternative<double>(value_); }
bool Json::is_string() const { return std::holds_alternative<std::string>(value_); }
bool Json::is_array() const { return std::holds_alternative<List>(value_); }
bool Json::is_object() const { return std::holds_alternative<Object>(value_); }

const std::string& Json::as_text() const {
    const std::string* text = std::get_if<std::string>(&value_);
    if (!text) fail("not a string");
    return *text;
}

bool Json::as_boolean() const {
    const bool* truth = std::get_if<bool>(&value_);
    if (!truth) fail("neither true nor false");
    return *truth;
}

double Json::as_real() const {
    if (const double* real = std::get_if<double>(&value_)) return *real;
    if (const auto* natural = std::get_if<std::uint64_t>(&value_)) return static_cast<double>(*natural);
    if (const auto* integer = std::get_if<std::int64_t>(&value_)) return static_cast<double>(*integer);
    fail("not a number");
}

std::int64_t Json::as_integer() const {
    if (const double* real = std::get_if<double>(&value_)) return static_cast<std::int64_t>(*real);
    if (const auto* natural = std::get_if<std::uint64_t>(&value_)) return static_cast<std::int64_t>(*natural);
    if (const auto* integer = std::get_if<std::int64_t>(&value_)) return *integer;
    fail("not a number");
}

const Json::List& Json::elements() const {
    const List* list = std::get_if<List>(&value_);
    if (!list) fail("not a list");
    return *list;
}

std::size_t Json::size() const {
    if (const Object* object = std::get_if<Object>(&value_)) return object->size();
    return static_cast<std::size_t>(end() - begin());
}

const Json* Json::begin() const {
    const List* list = std::get_if<List>(&value_);
    return list ? list->data() : nullptr;
}

const Json* Json::end() const {
    const List* list = std::get_if<List>(&value_);
    return list ? list->data() + list->size() : nullptr;
}

Json* Json::begin() { return const_cast<Json*>(std::as_const(*this).begin()); }
Json* Json::end() { return const_cast<Json*>(std::as_const(*this).end()); }

const Json& Json::operator[](std::size_t index) const {
    const List& list = elements();
    if (index >= list.size()) fail("a list that is too short");
    return list[index];
}

Json& Json::operator[](std::size_t index) { return const_cast<Json&>(std::as_const(*this)[index]); }
Json& Json::back() { return (*this)[size() - 1]; }

void Json::push_back(Json element) {
    if (is_null()) value_.emplace<List>();
    List* list = std::get_if<List>(&value_);
    if (!list) fail("not a list");
    list->push_back(std::move(element));
}

const std::vector<Json::Member>& Json::items() const {
    const Object* object = std::get_if<Object>(&value_);
    if (!object) fail("not an object");
    return *object;
}

const Json* Json::find(std::string_view key) const {
    const Object* object = std::get_if<Object>(&value_);
    if (!object) return nullptr;
    const auto found = std::ranges::find(*object, key, &Member::first);
    return found == object->end() ? nullptr : &found->second;
}

const Json& Json::operator[](std::string_view key) const {
    const Json* value = find(key);
    if (!value) throw Error(fmt::format("a JSON object has no '{}'", key));
    return *value;
}

Json& Json::operator[](std::string_view key) {
    if (is_null()) value_.emplace<Object>();
    Object* object = std::get_if<Object>(&value_);
    if (!object) fail("not an object");
    const auto found = std::ranges::find(*object, key, &Member::first);
    return found == object->end() ? object->emplace_back(std::string(key), Json()).second : found->second;
}

void Json::update(const Json& other) {
    for (const auto& [key, value] : other.items()) (*this)[key] = value;
}

bool operator==(const Json& a, const Json& b) {
    if (a.is_number_integer() && b.is_number_integer()) {
        const auto is_negative = [](const Json& json) {
            const auto* integer = std::get_if<std::int64_t>(&json.value_);
            return integer && *integer < 0;
        };
        return a.as_integer() == b.as_integer() && is_negative(a) == is_negative(b);
    }
    if (a.is_number() && b.is_number()) return a.as_real() == b.as_real();
    return a.value_ == b.value_;
}

Json parse_json(std::string_view text, const std::string& file) {
    try {
        return Json::parse(text);
    } catch (const JsonSyntaxError& error) {
        // The parser counts bytes from 1, and reports the byte behind a text that ends too early.
        const std::string_view before = text.substr(0, error.byte > 0 ? std::min(error.byte - 1, text.size()) : 0);
        const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is the start of the text
        // Its text begins with its own name of the error, and the place once more.
        const std::string_view whole = error.message();
        const std::size_t place = whole.find("column "), colon = whole.find(": ", place);
        const std::string_view reason =
            place == std::string_view::npos || colon == std::string_view::npos ? whole : whole.substr(colon + 2);
        throw Error({file, 1 + static_cast<int>(std::ranges::count(before, '\n')),
                     1 + static_cast<int>(before.size() - line_start)},
                    fmt::format("not valid JSON: {}", reason));
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", file, error.message()));
    }
}

void refuse_unknown(const Json& object, const std::string& where, std::span<const std::string> names) {
    if (!object.is_object()) return;
    for (const auto& [name, value] : object.items())
        if (std::ranges::find(names, name) == names.end())
            throw Error(fmt::format("{} has the unknown key '{}'{}{}", where, name,
                                    value.line() > 0 ? fmt::format(" in line {}", value.line()) : "",
                                    did_you_mean(name, names)));
}

}  // namespace tactus::file
