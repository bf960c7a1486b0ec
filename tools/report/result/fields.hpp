// SPDX-License-Identifier: Apache-2.0
// The list of fields of a plain struct: from it come the tree of its values and the JSON Schema of its output.
//
//     const Fields<Judged>& judged_fields() {
//         static const Fields<Judged> all = Fields<Judged>("score")
//             .text("name", "score", [](const Judged& s) { return s.name; })
//             .number("value", "value", significant(4), [](const Judged& s) { return s.value; });
//         return all;
//     }
//
// A field has a key in JSON (empty: not in JSON), a name in print (empty: not printed) and a function that reads it. The
// list exists without a value, so that the schema needs no example.
#pragma once

#include "assets/file/json.hpp"
#include "tools/report/result/result.hpp"

#include <concepts>
#include <memory>
#include <type_traits>

namespace tactus::report {

/// JSON Schema (draft 2020-12) of one kind of value.
file::Json schema_of_number();
file::Json schema_of_texts();
file::Json schema_of_list(file::Json items);
/// `type`: "integer", "string", "boolean", "object"; null is allowed too.
file::Json schema_or_null(file::Json schema);

template <class T>
class Fields {
public:
    /// `about`: what the struct is, in the schema.
    explicit Fields(std::string about) : about_(std::move(about)) {}

    /// `read`: returns a Number, a double or an optional double.
    template <class Read>
    Fields& number(std::string key, std::string name, NumberFormat format, Read read) {
        return add(std::move(key), std::move(name), schema_of_number,
                   [read, format](const T& of) { return typename ResultEntry::Quantity{Number(read(of)), format}; });
    }
    template <class Read>
    Fields& integer(std::string key, std::string name, Read read) {
        return add(
            std::move(key), std::move(name), [] { return schema_or_null({{"type", "integer"}}); },
            [read](const T& of) {
                const auto value = read(of);
                if constexpr (std::integral<std::remove_cvref_t<decltype(value)>>)
                    return ResultEntry::Integer{static_cast<long long>(value)};
                else return value ? ResultEntry::Integer{static_cast<long long>(*value)} : ResultEntry::Integer{};
            });
    }
    /// Two numbers, such as a band.
    template <class Read>
    Fields& range(std::string key, std::string name, NumberFormat format, Read read) {
        return add(
            std::move(key), std::move(name), [] { return schema_or_null(schema_of_list(schema_of_number())); },
            [read, format](const T& of) { return ResultEntry::Range{read(of), format}; });
    }
    /// `read`: a text, or an optional one.
    template <class Read>
    Fields& text(std::string key, std::string name, Read read) {
        return add(
            std::move(key), std::move(name), [] { return schema_or_null({{"type", "string"}}); },
            [read](const T& of) { return ResultEntry::Text{read(of)}; });
    }
    template <class Read>
    Fields& flag(std::string key, std::string name, Read read) {
        return add(
            std::move(key), std::move(name), [] { return schema_or_null({{"type", "boolean"}}); },
            [read](const T& of) { return ResultEntry::Flag{read(of)}; });
    }
    template <class Read>
    Fields& texts(std::string key, std::string name, Read read) {
        return add(std::move(key), std::move(name), schema_of_texts,
                   [read](const T& of) { return ResultEntry::Texts{read(of)}; });
    }
    /// Texts that are printed before all other values.
    template <class Read>
    Fields& warnings(std::string key, Read read) {
        texts(std::move(key), "warning", read);
        fields_.back().severity = [](const T&) { return Severity::warning; };
        return *this;
    }
    /// `read`: a ResultEntry::Series over values that live as long as the struct.
    template <class Read>
    Fields& series(std::string key, Read read) {
        return add(
            std::move(key), "", [] { return schema_of_list(schema_of_number()); },
            [read](const T& of) -> ResultEntry::Series { return read(of); });
    }
    /// `draw`: a display::Figure; called when a format shows it, if `has` is true. The struct must live until then.
    template <class Has, class Draw>
    Fields& figure(std::string name, Has has, Draw draw) {
        return add(
            "", std::move(name), [] { return file::Json(); },
            [has, draw](const T& of) {
                return has(of) ? ResultEntry::Picture{[draw, &of] { return draw(of); }} : ResultEntry::Picture{};
            });
    }
    /// A table: `read` returns a range of U, of which each is a row.
    template <class U, class Read>
    Fields& rows(std::string key, std::string name, const Fields<U>& of_row, Read read) {
        return add(
            std::move(key), std::move(name), [&of_row] { return schema_of_list(of_row.schema()); },
            [read, &of_row](const T& of) {
                ResultEntry::Rows made{{}, of_row.columns()};
                for (const U& row : read(of)) made.rows.push_back(of_row.of(row));
                return made;
            });
    }
    /// A section: `read` returns a U, a const U& or a pointer or optional to one.
    template <class U, class Read>
    Fields& child(std::string key, std::string name, const Fields<U>& of_child, Read read) {
        return add(
            std::move(key), std::move(name), [&of_child] { return schema_or_null(of_child.schema()); },
            [read, &of_child](const T& of) {
                ResultEntry::Children made{{}, false};
                decltype(auto) value = read(of);
                if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, U>)
                    made.results.push_back(of_child.of(value));
                else if (value) made.results.push_back(of_child.of(*value));
                return made;
            });
    }
    /// A section for each U of the range that `read` returns.
    template <class U, class Read>
    Fields& children(std::string key, std::string name, const Fields<U>& of_child, Read read) {
        return add(
            std::move(key), std::move(name), [&of_child] { return schema_of_list(of_child.schema()); },
            [read, &of_child](const T& of) {
                ResultEntry::Children made{{}, true};
                for (const U& one : read(of)) made.results.push_back(of_child.of(one));
                return made;
            });
    }

    /// Of the last field: where its value is missing, JSON leaves it out.
    Fields& omitted() {
        fields_.back().is_omitted = true;
        return *this;
    }
    /// The title of the section.
    Fields& titled(std::function<std::string(const T&)> title) {
        title_ = std::move(title);
        return *this;
    }
    /// Views of the value live as long as it does.
    Result of(const T& value) const {
        Result result{title_ ? title_(value) : std::string(), {}};
        for (const Field& field : fields_)
            result.entries.push_back({field.key, field.name, field.is_omitted,
                                      field.severity ? field.severity(value) : Severity::none, field.read(value)});
        return result;
    }
    file::Json schema() const {
        file::Json properties = file::Json::object(), required = file::Json::array();
        for (const Field& field : fields_) {
            if (field.key.empty()) continue;
            properties[field.key] = field.schema();
            if (!field.name.empty()) properties[field.key]["description"] = field.name;
            if (!field.is_omitted) required.push_back(field.key);
        }
        return {{"type", "object"},
                {"description", about_},
                {"properties", properties},
                {"required", required},
                {"additionalProperties", false}};
    }
    /// Keys and names of the printed fields, as columns of a table.
    std::vector<std::pair<std::string, std::string>> columns() const {
        std::vector<std::pair<std::string, std::string>> all;
        for (const Field& field : fields_)
            if (!field.name.empty()) all.emplace_back(field.key, field.name);
        return all;
    }

private:
    struct Field {
        std::string key, name;
        std::function<file::Json()> schema;
        std::function<decltype(ResultEntry::value)(const T&)> read;
        std::function<Severity(const T&)> severity{};
        bool is_omitted = false;
    };

    template <class Read>
    Fields& add(std::string key, std::string name, std::function<file::Json()> schema, Read read) {
        fields_.push_back({std::move(key), std::move(name), std::move(schema),
                           [read](const T& of) { return decltype(ResultEntry::value)(read(of)); }});
        return *this;
    }

    std::string about_;
    std::vector<Field> fields_;
    std::function<std::string(const T&)> title_{};
};

}  // namespace tactus::report
