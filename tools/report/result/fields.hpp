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
// `read` is a function of the struct, or a pointer to a member or member function: &Judged::value.
//
// A field has a key in JSON (empty: not in JSON), a name in print (empty: not printed) and a function that reads it. The
// list exists without a value, so that the schema needs no example.
#pragma once

#include "assets/file/json.hpp"
#include "tools/report/result/result.hpp"

#include <algorithm>
#include <concepts>
#include <functional>
#include <memory>
#include <type_traits>

namespace tactus::report {

/// JSON Schema (draft 2020-12) of one kind of value.
file::Json schema_of_number();
file::Json schema_of_texts();
file::Json schema_of_list(file::Json items);
/// The number of a field that is read in SI, in the unit of its format.
Number in_unit(Number read, const NumberFormat& format);
/// A list of numbers: of a band, a vector, a range of numbers or optional numbers, or an optional one of these.
template <class List>
std::optional<std::vector<std::optional<double>>> numbers_of(const List& list, double scale) {
    if constexpr (requires { list.has_value(); }) {
        if (!list) return std::nullopt;
        return numbers_of(*list, scale);
    } else if constexpr (requires { list.first; }) {
        return std::vector<std::optional<double>>{scale * list.first, scale * list.second};
    } else if constexpr (std::is_same_v<List, Vec3>) {
        return std::vector<std::optional<double>>{scale * list.x, scale * list.y, scale * list.z};
    } else {
        std::vector<std::optional<double>> all;
        for (const std::optional<double> value : list) all.push_back(value ? std::optional(scale * *value) : value);
        return all;
    }
}

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
        return add(std::move(key), std::move(name), schema_of_number, [read, format](const T& of) {
            return ResultEntry::Quantity{in_unit(Number(std::invoke(read, of)), format), format};
        });
    }
    template <class Read>
    Fields& integer(std::string key, std::string name, Read read) {
        return add(
            std::move(key), std::move(name), [] { return schema_or_null({{"type", "integer"}}); },
            [read](const T& of) {
                const auto value = std::invoke(read, of);
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
            [read, format](const T& of) {
                return ResultEntry::Numbers{numbers_of(std::invoke(read, of), format.per_si), format, " to "};
            });
    }
    /// Numbers of one unit on one line, such as a place.
    template <class Read>
    Fields& vector(std::string key, std::string name, NumberFormat format, Read read) {
        return add(
            std::move(key), std::move(name), [] { return schema_or_null(schema_of_list(schema_of_number())); },
            [read, format](const T& of) {
                return ResultEntry::Numbers{numbers_of(std::invoke(read, of), format.per_si), format};
            });
    }
    /// `read`: a text, or an optional one.
    template <class Read>
    Fields& text(std::string key, std::string name, Read read) {
        return add(
            std::move(key), std::move(name), [] { return schema_or_null({{"type", "string"}}); },
            [read](const T& of) { return ResultEntry::Text{std::invoke(read, of)}; });
    }
    template <class Read>
    Fields& flag(std::string key, std::string name, Read read) {
        return add(
            std::move(key), std::move(name), [] { return schema_or_null({{"type", "boolean"}}); },
            [read](const T& of) { return ResultEntry::Flag{std::invoke(read, of)}; });
    }
    template <class Read>
    Fields& texts(std::string key, std::string name, Read read) {
        return add(std::move(key), std::move(name), schema_of_texts,
                   [read](const T& of) { return ResultEntry::Texts{std::invoke(read, of)}; });
    }
    /// Texts that are printed each on its own line.
    template <class Read>
    Fields& notes(std::string key, std::string name, Read read) {
        return add(std::move(key), std::move(name), schema_of_texts,
                   [read](const T& of) { return ResultEntry::Texts{std::invoke(read, of), true}; });
    }
    /// Lists of names, of which each is printed on a line.
    template <class Read>
    Fields& groups(std::string key, std::string name, Read read) {
        return add(
            std::move(key), std::move(name), [] { return schema_of_list(schema_of_texts()); },
            [read](const T& of) { return ResultEntry::Groups{std::invoke(read, of)}; });
    }
    /// Integers on one line, such as the size of a grid. `read`: a range of them.
    template <class Read>
    Fields& integers(std::string key, std::string name, Read read) {
        return add(
            std::move(key), std::move(name), [] { return schema_of_list({{"type", "integer"}}); },
            [read](const T& of) {
                ResultEntry::Integers made;
                for (const auto value : std::invoke(read, of)) made.values.push_back(static_cast<long long>(value));
                return made;
            });
    }
    /// A text of pages that explains the section, before its values.
    template <class Read>
    Fields& remark(Read read) {
        return add(
            "", "remark", [] { return file::Json(); },
            [read](const T& of) { return ResultEntry::Remark{std::invoke(read, of)}; });
    }
    /// Texts that are printed before all other values.
    template <class Read>
    Fields& warnings(std::string key, Read read, std::string name = "warning") {
        texts(std::move(key), std::move(name), read);
        fields_.back().severity = [](const T&) { return Severity::warning; };
        return *this;
    }
    /// `read`: a ResultEntry::Series over values that live as long as the struct.
    template <class Read>
    Fields& series(std::string key, Read read) {
        return add(
            std::move(key), "", [] { return schema_of_list(schema_of_number()); },
            [read](const T& of) -> ResultEntry::Series { return std::invoke(read, of); });
    }
    /// A series of points or of the rows of a matrix, each a list.
    template <class Read>
    Fields& points(std::string key, Read read) {
        return add(
            std::move(key), "", [] { return schema_of_list(schema_of_list(schema_of_number())); },
            [read](const T& of) -> ResultEntry::Series { return std::invoke(read, of); });
    }
    /// `draw`: a display::Figure of the struct and, if it has several, of a style; called when a format shows it, if `has` is true. The struct must live until then.
    template <class Has, class Draw>
    Fields& figure(std::string name, Has has, Draw draw) {
        return add(
            "", std::move(name), [] { return file::Json(); },
            [has, draw](const T& of) {
                return has(of) ? ResultEntry::Picture{[draw, &of](const FigureStyle& style) {
                    if constexpr (std::is_invocable_v<Draw, const T&, const FigureStyle&>) return draw(of, style);
                    else return draw(of);
                }}
                               : ResultEntry::Picture{};
            });
    }
    /// Pictures on pages. `make`: a vector of render::LabelledPicture of the struct, which must live until then.
    template <class Make>
    Fields& pictures(Make make) {
        return add(
            "", "pictures", [] { return file::Json(); },
            [make](const T& of) { return ResultEntry::Pictures{[make, &of] { return std::invoke(make, of); }}; });
    }
    /// A table: `read` returns a range of U, of which each is a row.
    template <class U, class Read>
    Fields& rows(std::string key, std::string name, const Fields<U>& of_row, Read read) {
        return add(
            std::move(key), std::move(name), [&of_row] { return schema_of_list(of_row.schema()); },
            [read, &of_row](const T& of) {
                ResultEntry::Rows made{{}, of_row.columns()};
                for (const U& row : std::invoke(read, of)) made.rows.push_back(of_row.of(row));
                return made;
            });
    }
    /// A table whose columns depend on the value, printed only. `read`: a ResultEntry::Rows.
    template <class Read>
    Fields& table(std::string name, Read read) {
        return add(
            "", std::move(name), [] { return file::Json(); },
            [read](const T& of) -> ResultEntry::Rows { return std::invoke(read, of); });
    }
    /// Sections whose content depends on the value, printed only. `read`: a ResultEntry::Children.
    template <class Read>
    Fields& sections(std::string name, Read read) {
        return add(
            "", std::move(name), [] { return file::Json(); },
            [read](const T& of) -> ResultEntry::Children { return std::invoke(read, of); });
    }
    /// An object whose members depend on the value: `read` returns pairs of a key and an optional double.
    template <class Read>
    Fields& numbers(std::string key, Read read) {
        return add(
            std::move(key), "",
            [] { return file::Json{{"type", "object"}, {"additionalProperties", schema_of_number()}}; },
            [read](const T& of) {
                Result members;
                for (const auto& [name, value] : std::invoke(read, of))
                    members.entries.push_back(
                        {name, "", false, Severity::none, ResultEntry::Quantity{Number(value), NumberFormat{}}});
                return ResultEntry::Children{{std::move(members)}, false};
            });
    }
    /// A section: `read` returns a U, a const U& or a pointer or optional to one.
    template <class U, class Read>
    Fields& child(std::string key, std::string name, const Fields<U>& of_child, Read read) {
        return add(
            std::move(key), std::move(name), [&of_child] { return schema_or_null(of_child.schema()); },
            [read, &of_child](const T& of) {
                ResultEntry::Children made{{}, false};
                decltype(auto) value = std::invoke(read, of);
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
                for (const U& one : std::invoke(read, of)) made.results.push_back(of_child.of(one));
                return made;
            });
    }

    /// The same of results that were made before, by `of_child`.
    template <class U, class Read>
    Fields& results(std::string key, std::string name, const Fields<U>& of_child, Read read) {
        return add(
            std::move(key), std::move(name), [&of_child] { return schema_of_list(of_child.schema()); },
            [read](const T& of) { return ResultEntry::Children{std::invoke(read, of), true}; });
    }

    /// Of the last field: where its value is missing, JSON leaves it out; but where `is_known` returns true the value is
    /// known to be none, and JSON has null or an empty list.
    Fields& omitted(std::function<bool(const T&)> is_known = {}) {
        fields_.back().is_omitted = true;
        fields_.back().is_known = std::move(is_known);
        return *this;
    }
    /// The fields of a part of the struct, among those of the struct, and its title if the struct has none. `read` returns
    /// a reference to the part, or a part whose views live as long as the struct.
    template <class U, class Read>
    Fields& part(const Fields<U>& of_part, Read read) {
        for (const auto& field : of_part.fields_) {
            Field made{field.key, field.name, field.schema,
                       [read, inner = field.read](const T& of) { return inner(std::invoke(read, of)); }};
            if (field.severity)
                made.severity = [read, inner = field.severity](const T& of) { return inner(std::invoke(read, of)); };
            if (field.where)
                made.where = [read, inner = field.where](const T& of) { return inner(std::invoke(read, of)); };
            if (field.is_known)
                made.is_known = [read, inner = field.is_known](const T& of) { return inner(std::invoke(read, of)); };
            made.is_omitted = field.is_omitted;
            made.remark = field.remark;
            fields_.push_back(std::move(made));
        }
        if (!title_ && of_part.title_)
            title_ = [read, inner = of_part.title_](const T& of) { return inner(std::invoke(read, of)); };
        return *this;
    }
    /// Explains the last field, a table, on pages.
    Fields& explained(std::string remark) {
        fields_.back().remark = std::move(remark);
        return *this;
    }
    /// Severity of the last field.
    Fields& judged(std::function<Severity(const T&)> severity) {
        fields_.back().severity = std::move(severity);
        return *this;
    }
    /// Where the last field is printed; JSON and CSV contain it regardless.
    Fields& printed(std::function<Where(const T&)> where) {
        fields_.back().where = std::move(where);
        return *this;
    }
    /// The last field is printed on pages only.
    Fields& on_pages() {
        return printed([](const T&) { return Where::pages; });
    }
    /// Describes the values for which `is_other` returns true, such as files that could not be read.
    Fields& otherwise(std::function<bool(const T&)> is_other, const Fields<T>& other) {
        is_other_ = std::move(is_other);
        other_ = &other;
        return *this;
    }
    /// The title of the section.
    Fields& titled(std::function<std::string(const T&)> title) {
        title_ = std::move(title);
        return *this;
    }
    /// The title of a page, where the terminal prints none.
    Fields& page_titled(std::function<std::string(const T&)> title) {
        page_title_ = std::move(title);
        return *this;
    }
    /// As a row of a page: the colour of a square before it.
    Fields& marked(std::function<std::optional<Vec3>(const T&)> mark) {
        mark_ = std::move(mark);
        return *this;
    }
    /// Views of the value live as long as it does.
    Result of(const T& value) const {
        if (other_ && is_other_(value)) return other_->of(value);
        Result result{title_ ? title_(value) : std::string(),
                      {},
                      page_title_ ? page_title_(value) : std::string(),
                      mark_ ? mark_(value) : std::nullopt};
        for (const Field& field : fields_)
            result.entries.push_back({field.key, field.name,
                                      field.is_omitted && !(field.is_known && field.is_known(value)),
                                      field.severity ? field.severity(value) : Severity::none, field.read(value),
                                      field.where ? field.where(value) : Where::everywhere, field.remark});
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
        const file::Json own{{"type", "object"},
                             {"description", about_},
                             {"properties", properties},
                             {"required", required},
                             {"additionalProperties", false}};
        return other_ ? file::Json{{"anyOf", file::Json::array({own, other_->schema()})}} : own;
    }
    /// Keys and names of the printed fields, as columns of a table.
    std::vector<std::pair<std::string, std::string>> columns() const {
        std::vector<std::pair<std::string, std::string>> all;
        for (const Field& field : fields_)
            if (!field.name.empty()) all.emplace_back(field.key, field.name);
        if (other_)
            for (auto& column : other_->columns())
                if (std::ranges::find(all, column) == all.end()) all.push_back(std::move(column));
        return all;
    }

private:
    template <class U>
    friend class Fields;

    struct Field {
        std::string key, name;
        std::function<file::Json()> schema;
        std::function<decltype(ResultEntry::value)(const T&)> read;
        std::function<Severity(const T&)> severity{};
        std::function<Where(const T&)> where{};
        std::function<bool(const T&)> is_known{};
        bool is_omitted = false;
        std::string remark{};
    };

    template <class Read>
    Fields& add(std::string key, std::string name, std::function<file::Json()> schema, Read read) {
        fields_.push_back({std::move(key), std::move(name), std::move(schema),
                           [read](const T& of) { return decltype(ResultEntry::value)(read(of)); }});
        return *this;
    }

    std::string about_;
    std::vector<Field> fields_;
    std::function<std::string(const T&)> title_{}, page_title_{};
    std::function<bool(const T&)> is_other_{};
    std::function<std::optional<Vec3>(const T&)> mark_{};
    const Fields<T>* other_ = nullptr;
};

}  // namespace tactus::report
