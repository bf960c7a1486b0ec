// SPDX-License-Identifier: Apache-2.0
// A JSON value. The JSON library is compiled in json.cpp alone, because its header adds two seconds to the compilation
// of a file.
//
//     Json row{{"name", "mandible"}, {"size_mm", {x, y, z}}};
//     row["hash"] = hash;
//     fmt::print("{}\n", row.dump(2));
#pragma once

#include "dsp/core/error.hpp"

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace tactus::file {

/// Text that is not JSON.
struct JsonSyntaxError : Error {
    JsonSyntaxError(std::string message, std::size_t byte_) : Error(std::move(message)), byte(byte_) {}

    std::size_t byte;  ///< counts from 1; one past the end for text that ends too early
};

/// Null, a boolean, a number, a string, a list, or an object, which keeps the order of its members. Reading a value as
/// another kind throws Error.
class Json {
public:
    using Member = std::pair<std::string, Json>;

    Json() noexcept;
    Json(std::nullptr_t) noexcept;
    Json(bool value) noexcept;
    Json(int value) noexcept;
    Json(long value) noexcept;
    Json(long long value) noexcept;
    Json(unsigned value) noexcept;
    Json(unsigned long value) noexcept;
    Json(unsigned long long value) noexcept;
    Json(double value) noexcept;
    Json(const char* text);
    Json(std::string_view text);
    Json(std::string text) noexcept;
    /// Deleted, because a pointer would convert to a boolean.
    Json(const void*) = delete;
    /// Creates an object if each element is a list of a string and a value, otherwise a list.
    Json(std::initializer_list<Json> elements);
    /// Creates a list of the elements of a container; a map becomes an object.
    template <class Range>
        requires requires(const Range& r) { std::begin(r) != std::end(r); } &&
                 (!std::is_same_v<Range, Json> && !std::is_convertible_v<const Range&, std::string_view>)
    Json(const Range& elements) : Json(array()) {
        if constexpr (requires { elements.begin()->second; }) {
            *this = object();
            for (const auto& [key, value] : elements) (*this)[key] = value;
        } else {
            for (const auto& element : elements) push_back(element);
        }
    }

    Json(const Json&);
    Json(Json&&) noexcept;
    Json& operator=(const Json&);
    Json& operator=(Json&&) noexcept;
    ~Json();

    static Json array();
    static Json array(std::initializer_list<Json> elements);
    static Json object();

    /// Throws JsonSyntaxError for text that is not JSON, or nests more than 100 values deep; Error for a number that is
    /// too large.
    static Json parse(std::string_view text);
    /// Returns null for such text.
    static Json parse_or_null(std::string_view text);

    /// On one line, or indented by that many spaces. Numbers that are not finite become null. Throws for text that is
    /// not UTF-8.
    std::string dump(int indent = -1) const;

    bool is_null() const;
    bool is_boolean() const;
    bool is_number() const;
    bool is_number_integer() const;
    bool is_number_float() const;
    bool is_string() const;
    bool is_array() const;
    bool is_object() const;

    /// Converts a number to any arithmetic type, a boolean to bool, a string, or a list to std::vector.
    template <class T>
    T get() const {
        if constexpr (std::is_same_v<T, bool>) {
            return as_boolean();
        } else if constexpr (std::is_same_v<T, std::string>) {
            return as_text();
        } else if constexpr (std::is_floating_point_v<T>) {
            return static_cast<T>(as_real());
        } else if constexpr (std::is_integral_v<T>) {
            return static_cast<T>(as_integer());
        } else {
            T list;
            for (const Json& element : elements()) list.push_back(element.get<typename T::value_type>());
            return list;
        }
    }
    const std::string& as_text() const;

    /// Number of elements of a list or members of an object; 0 for other kinds.
    std::size_t size() const;
    bool empty() const { return size() == 0; }

    /// Elements of a list; empty for other kinds.
    const Json* begin() const;
    const Json* end() const;
    Json* begin();
    Json* end();
    /// Throws Error if this is not a list or has no element `index`.
    const Json& operator[](std::size_t index) const;
    Json& operator[](std::size_t index);
    Json& back();
    /// Null becomes a list.
    void push_back(Json element);

    /// Members of an object. Throws Error for other kinds.
    const std::vector<Member>& items() const;
    bool contains(std::string_view key) const { return find(key) != nullptr; }
    /// Returns null if this is not an object or has no such member.
    const Json* find(std::string_view key) const;
    /// Throws Error if there is no such member.
    const Json& operator[](std::string_view key) const;
    /// Returns `otherwise` if there is no such member.
    template <class T>
    T value(std::string_view key, T otherwise) const {
        const Json* found = find(key);
        return found ? found->get<T>() : otherwise;
    }
    /// Adds the member if there is none. Null becomes an object.
    Json& operator[](std::string_view key);
    /// Sets all members of `other`.
    void update(const Json& other);

    /// Line of a parsed text, from 1, of the name of this member or of the beginning of this list or object in a list.
    /// 0: unknown, as for a value that was not parsed.
    int line() const { return line_; }
    void set_line(int line) { line_ = line; }

    /// Numbers are equal by value, regardless of their type.
    friend bool operator==(const Json& a, const Json& b);

private:
    using List = std::vector<Json>;
    using Object = std::vector<Member>;

    bool as_boolean() const;
    double as_real() const;
    std::int64_t as_integer() const;
    const List& elements() const;

    // Mutable because the elements of an initialiser list are constant, and are moved from.
    mutable std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string, List, Object> value_;
    int line_ = 0;
};

/// As Json::parse, for hand-written files: errors contain the position, "file:line:column: not valid JSON: ...".
Json parse_json(std::string_view text, const std::string& file);

/// Throws Error for the first member of `object` whose name is not in `names`, with its line and a similar name.
/// Otherwise a misspelt name would silently select a default. `where` begins the message: the file, and the position in
/// it. Every reader of hand-written JSON calls this for each of its objects; readers of TOML use TomlFile::know, and
/// readers of tables NumberTable::know.
void refuse_unknown(const Json& object, const std::string& where, std::span<const std::string> names);

}  // namespace tactus::file
