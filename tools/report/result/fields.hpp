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
//
// Each field is kept without its type (FieldList), so that what lists, prints and describes fields is compiled once and not for
// each struct.
#pragma once

#include "assets/file/json.hpp"
#include "tools/report/result/result.hpp"

#include <concepts>
#include <functional>
#include <string_view>
#include <type_traits>

namespace tactus::report {

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

/// Fields of a struct whose type is not known here: each function takes its address.
class FieldList {
public:
    using Value = decltype(ResultEntry::value);
    template <class R>
    using Reads = std::function<R(const void*)>;
    /// Calls the second argument with the address of each part of the struct.
    using Visit = std::function<void(const void*, const std::function<void(const void*)>&)>;
    /// What JSON Schema states of a value.
    enum class Shape {
        none,  ///< not in JSON
        number,
        integer,
        text,
        flag,
        band,  ///< a list of numbers, or null
        texts,
        groups,  ///< lists of texts
        integers,
        series,  ///< a list of numbers
        points,  ///< a list of lists of numbers
        members,  ///< an object of numbers
        list,  ///< of objects with the inner fields
        object,  ///< with the inner fields, or null
    };
    struct Field {
        std::string key, name;
        Shape shape;
        Reads<Value> read;
        const FieldList* inner = nullptr;
        Reads<Severity> severity{};
        Reads<Where> where{};
        Reads<bool> is_known{};
        bool is_omitted = false;
        std::string remark{};
    };

    explicit FieldList(std::string about) : about_(std::move(about)) {}

    void add(std::string_view key, std::string_view name, Shape shape, Reads<Value> read);
    /// A table.
    void add_rows(std::string_view key, std::string_view name, const FieldList& inner, Visit rows);
    /// Sections; `is_list`: any number of them, otherwise one at most.
    void add_children(std::string_view key, std::string_view name, const FieldList& inner, bool is_list, Visit parts);
    void add_results(std::string_view key, std::string_view name, const FieldList& inner,
                     Reads<std::vector<Result>> read);
    /// All fields of `inner` and its title, if there is none yet.
    void add_part(const FieldList& inner, const Visit& part);

    Result of(const void* value) const;
    file::Json schema() const;
    std::vector<std::pair<std::string, std::string>> columns() const;

private:
    template <class T>
    friend class Fields;

    std::string about_;
    std::vector<Field> fields_;
    Reads<std::string> title_{}, page_title_{};
    Reads<std::optional<Vec3>> mark_{};
    Reads<bool> is_other_{};
    const FieldList* other_ = nullptr;
};

template <class T>
class Fields {
public:
    /// `about`: what the struct is, in the schema.
    explicit Fields(std::string about) : list_(std::move(about)) {}

    /// `read`: returns a Number, a double or an optional double.
    template <class Read>
    Fields& number(std::string_view key, std::string_view name, NumberFormat format, Read read) {
        return add(key, name, Shape::number, [read, format](const void* of) -> Value {
            return ResultEntry::Quantity{in_unit(Number(std::invoke(read, as(of))), format), format};
        });
    }
    template <class Read>
    Fields& integer(std::string_view key, std::string_view name, Read read) {
        return add(key, name, Shape::integer, [read](const void* of) -> Value {
            const auto value = std::invoke(read, as(of));
            if constexpr (std::integral<std::remove_cvref_t<decltype(value)>>)
                return ResultEntry::Integer{static_cast<long long>(value)};
            else return value ? ResultEntry::Integer{static_cast<long long>(*value)} : ResultEntry::Integer{};
        });
    }
    /// Two numbers, such as a band.
    template <class Read>
    Fields& range(std::string_view key, std::string_view name, NumberFormat format, Read read) {
        return add(key, name, Shape::band, [read, format](const void* of) -> Value {
            return ResultEntry::Numbers{numbers_of(std::invoke(read, as(of)), format.per_si), format, " to "};
        });
    }
    /// Numbers of one unit on one line, such as a place.
    template <class Read>
    Fields& vector(std::string_view key, std::string_view name, NumberFormat format, Read read) {
        return add(key, name, Shape::band, [read, format](const void* of) -> Value {
            return ResultEntry::Numbers{numbers_of(std::invoke(read, as(of)), format.per_si), format};
        });
    }
    /// `read`: a text, or an optional one.
    template <class Read>
    Fields& text(std::string_view key, std::string_view name, Read read) {
        return add(key, name, Shape::text,
                   [read](const void* of) -> Value { return ResultEntry::Text{std::invoke(read, as(of))}; });
    }
    template <class Read>
    Fields& flag(std::string_view key, std::string_view name, Read read) {
        return add(key, name, Shape::flag,
                   [read](const void* of) -> Value { return ResultEntry::Flag{std::invoke(read, as(of))}; });
    }
    template <class Read>
    Fields& texts(std::string_view key, std::string_view name, Read read) {
        return add(key, name, Shape::texts,
                   [read](const void* of) -> Value { return ResultEntry::Texts{std::invoke(read, as(of))}; });
    }
    /// Texts that are printed each on its own line.
    template <class Read>
    Fields& notes(std::string_view key, std::string_view name, Read read) {
        return add(key, name, Shape::texts,
                   [read](const void* of) -> Value { return ResultEntry::Texts{std::invoke(read, as(of)), true}; });
    }
    /// Lists of names, of which each is printed on a line.
    template <class Read>
    Fields& groups(std::string_view key, std::string_view name, Read read) {
        return add(key, name, Shape::groups,
                   [read](const void* of) -> Value { return ResultEntry::Groups{std::invoke(read, as(of))}; });
    }
    /// Integers on one line, such as the size of a grid. `read`: a range of them.
    template <class Read>
    Fields& integers(std::string_view key, std::string_view name, Read read) {
        return add(key, name, Shape::integers, [read](const void* of) -> Value {
            ResultEntry::Integers made;
            for (const auto value : std::invoke(read, as(of))) made.values.push_back(static_cast<long long>(value));
            return made;
        });
    }
    /// A text of pages that explains the section, before its values.
    template <class Read>
    Fields& remark(Read read) {
        return add("", "remark", Shape::none,
                   [read](const void* of) -> Value { return ResultEntry::Remark{std::invoke(read, as(of))}; });
    }
    /// Texts that are printed before all other values.
    template <class Read>
    Fields& warnings(std::string_view key, Read read, std::string_view name = "warning") {
        texts(key, name, read);
        list_.fields_.back().severity = [](const void*) { return Severity::warning; };
        return *this;
    }
    /// `read`: a ResultEntry::Series over values that live as long as the struct.
    template <class Read>
    Fields& series(std::string_view key, Read read) {
        return add(key, "", Shape::series, [read](const void* of) -> Value {
            return static_cast<ResultEntry::Series>(std::invoke(read, as(of)));
        });
    }
    /// A series of points or of the rows of a matrix, each a list.
    template <class Read>
    Fields& points(std::string_view key, Read read) {
        return add(key, "", Shape::points, [read](const void* of) -> Value {
            return static_cast<ResultEntry::Series>(std::invoke(read, as(of)));
        });
    }
    /// `draw`: a display::Figure of the struct and, if it has several, of a style; called when a format shows it, if `has` is true. The struct must live until then.
    template <class Has, class Draw>
    Fields& figure(std::string_view name, Has has, Draw draw) {
        return add("", name, Shape::none, [has, draw](const void* of) -> Value {
            if (!has(as(of))) return ResultEntry::Picture{};
            return ResultEntry::Picture{[draw, of](const FigureStyle& style) {
                if constexpr (std::is_invocable_v<Draw, const T&, const FigureStyle&>) return draw(as(of), style);
                else return draw(as(of));
            }};
        });
    }
    /// Pictures on pages. `make`: a vector of render::LabelledPicture of the struct, which must live until then.
    template <class Make>
    Fields& pictures(Make make) {
        return add("", "pictures", Shape::none, [make](const void* of) -> Value {
            return ResultEntry::Pictures{[make, of] { return std::invoke(make, as(of)); }};
        });
    }
    /// A table: `read` returns a range of U, of which each is a row.
    template <class U, class Read>
    Fields& rows(std::string_view key, std::string_view name, const Fields<U>& of_row, Read read) {
        list_.add_rows(key, name, of_row.list_, each_of<U>(read));
        return *this;
    }
    /// A table whose columns depend on the value, printed only. `read`: a ResultEntry::Rows.
    template <class Read>
    Fields& table(std::string_view name, Read read) {
        return add("", name, Shape::none, [read](const void* of) -> Value {
            return static_cast<ResultEntry::Rows>(std::invoke(read, as(of)));
        });
    }
    /// Sections whose content depends on the value, printed only. `read`: a ResultEntry::Children.
    template <class Read>
    Fields& sections(std::string_view name, Read read) {
        return add("", name, Shape::none, [read](const void* of) -> Value {
            return static_cast<ResultEntry::Children>(std::invoke(read, as(of)));
        });
    }
    /// An object whose members depend on the value: `read` returns pairs of a key and an optional double.
    template <class Read>
    Fields& numbers(std::string_view key, Read read) {
        return add(key, "", Shape::members, [read](const void* of) -> Value {
            Result members;
            for (const auto& [name, value] : std::invoke(read, as(of)))
                members.entries.push_back(
                    {name, "", false, Severity::none, ResultEntry::Quantity{Number(value), NumberFormat{}}});
            return ResultEntry::Children{{std::move(members)}, false};
        });
    }
    /// A section: `read` returns a U, a const U& or a pointer or optional to one.
    template <class U, class Read>
    Fields& child(std::string_view key, std::string_view name, const Fields<U>& of_child, Read read) {
        list_.add_children(key, name, of_child.list_, false,
                           [read](const void* of, const std::function<void(const void*)>& use) {
                               decltype(auto) value = std::invoke(read, as(of));
                               if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, U>) {
                                   use(&value);
                               } else if (value) {
                                   const U& one = *value;
                                   use(&one);
                               }
                           });
        return *this;
    }
    /// A section for each U of the range that `read` returns.
    template <class U, class Read>
    Fields& children(std::string_view key, std::string_view name, const Fields<U>& of_child, Read read) {
        list_.add_children(key, name, of_child.list_, true, each_of<U>(read));
        return *this;
    }

    /// The same of results that were made before, by `of_child`.
    template <class U, class Read>
    Fields& results(std::string_view key, std::string_view name, const Fields<U>& of_child, Read read) {
        list_.add_results(key, name, of_child.list_, [read](const void* of) { return std::invoke(read, as(of)); });
        return *this;
    }

    /// Of the last field: where its value is missing, JSON leaves it out; but where `is_known` returns true the value is
    /// known to be none, and JSON has null or an empty list.
    Fields& omitted(std::function<bool(const T&)> is_known = {}) {
        list_.fields_.back().is_omitted = true;
        list_.fields_.back().is_known = erased(std::move(is_known));
        return *this;
    }
    /// The fields of a part of the struct, among those of the struct, and its title if the struct has none. `read` returns
    /// a reference to the part, or a part whose views live as long as the struct.
    template <class U, class Read>
    Fields& part(const Fields<U>& of_part, Read read) {
        list_.add_part(of_part.list_, [read](const void* of, const std::function<void(const void*)>& use) {
            const U& one = std::invoke(read, as(of));
            use(&one);
        });
        return *this;
    }
    /// Explains the last field, a table, on pages.
    Fields& explained(std::string remark) {
        list_.fields_.back().remark = std::move(remark);
        return *this;
    }
    /// Severity of the last field.
    Fields& judged(std::function<Severity(const T&)> severity) {
        list_.fields_.back().severity = erased(std::move(severity));
        return *this;
    }
    /// Where the last field is printed; JSON and CSV contain it regardless.
    Fields& printed(std::function<Where(const T&)> where) {
        list_.fields_.back().where = erased(std::move(where));
        return *this;
    }
    /// The last field is printed on pages only.
    Fields& on_pages() {
        list_.fields_.back().where = [](const void*) { return Where::pages; };
        return *this;
    }
    /// Describes the values for which `is_other` returns true, such as files that could not be read.
    Fields& otherwise(std::function<bool(const T&)> is_other, const Fields<T>& other) {
        list_.is_other_ = erased(std::move(is_other));
        list_.other_ = &other.list_;
        return *this;
    }
    /// The title of the section.
    Fields& titled(std::function<std::string(const T&)> title) {
        list_.title_ = erased(std::move(title));
        return *this;
    }
    /// The title of a page, where the terminal prints none.
    Fields& page_titled(std::function<std::string(const T&)> title) {
        list_.page_title_ = erased(std::move(title));
        return *this;
    }
    /// As a row of a page: the colour of a square before it.
    Fields& marked(std::function<std::optional<Vec3>(const T&)> mark) {
        list_.mark_ = erased(std::move(mark));
        return *this;
    }
    /// Views of the value live as long as it does.
    Result of(const T& value) const { return list_.of(&value); }
    file::Json schema() const { return list_.schema(); }
    /// Keys and names of the printed fields, as columns of a table.
    std::vector<std::pair<std::string, std::string>> columns() const { return list_.columns(); }

private:
    template <class U>
    friend class Fields;
    using Value = FieldList::Value;
    using Shape = FieldList::Shape;

    static const T& as(const void* of) { return *static_cast<const T*>(of); }

    template <class R>
    static FieldList::Reads<R> erased(std::function<R(const T&)> read) {
        if (!read) return {};
        return [read = std::move(read)](const void* of) { return read(as(of)); };
    }

    template <class U, class Read>
    static FieldList::Visit each_of(Read read) {
        return [read](const void* of, const std::function<void(const void*)>& use) {
            for (const U& one : std::invoke(read, as(of))) use(&one);
        };
    }

    template <class Read>
    Fields& add(std::string_view key, std::string_view name, Shape shape, Read read) {
        list_.add(key, name, shape, std::move(read));
        return *this;
    }

    FieldList list_;
};

}  // namespace tactus::report
