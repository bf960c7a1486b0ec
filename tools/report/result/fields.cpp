// SPDX-License-Identifier: Apache-2.0
#include "tools/report/result/fields.hpp"

#include <algorithm>
#include <utility>

namespace tactus::report {

namespace {

using file::Json;
using Shape = FieldList::Shape;

Json list_of(Json items) { return {{"type", "array"}, {"items", std::move(items)}}; }
Json or_null(Json schema) {
    if (!schema.contains("type")) return {{"anyOf", Json::array({std::move(schema), {{"type", "null"}}})}};
    schema["type"] = Json::array({schema["type"], "null"});
    return schema;
}

/// JSON Schema (draft 2020-12) of one value.
Json schema_of(const FieldList::Field& field) {
    const Json number = or_null({{"type", "number"}}), text = {{"type", "string"}};
    switch (field.shape) {
        case Shape::none: break;
        case Shape::number: return number;
        case Shape::integer: return or_null({{"type", "integer"}});
        case Shape::text: return or_null(text);
        case Shape::flag: return or_null({{"type", "boolean"}});
        case Shape::band: return or_null(list_of(number));
        case Shape::texts: return list_of(text);
        case Shape::groups: return list_of(list_of(text));
        case Shape::integers: return list_of({{"type", "integer"}});
        case Shape::series: return list_of(number);
        case Shape::points: return list_of(list_of(number));
        case Shape::members: return {{"type", "object"}, {"additionalProperties", number}};
        case Shape::list: return list_of(field.inner->schema());
        case Shape::object: return or_null(field.inner->schema());
    }
    return {};
}

/// A function of a part, as a function of the struct that has it.
template <class R>
FieldList::Reads<R> of_part(const FieldList::Visit& part, FieldList::Reads<R> read) {
    if (!read) return {};
    return [part, read = std::move(read)](const void* of) {
        std::optional<R> value;
        part(of, [&](const void* one) { value = read(one); });
        return std::move(*value);
    };
}

}  // namespace

Number in_unit(Number read, const NumberFormat& format) {
    if (read.value) *read.value *= format.per_si;
    if (read.uncertainty) *read.uncertainty *= format.per_si;
    return read;
}

void FieldList::add(std::string_view key, std::string_view name, Shape shape, Reads<Value> read) {
    fields_.push_back({std::string(key), std::string(name), shape, std::move(read)});
}

void FieldList::add_rows(std::string_view key, std::string_view name, const FieldList& inner, Visit rows) {
    add(key, name, Shape::list, [&inner, rows = std::move(rows)](const void* of) -> Value {
        ResultEntry::Rows made{{}, inner.columns()};
        rows(of, [&](const void* row) { made.rows.push_back(inner.of(row)); });
        return made;
    });
    fields_.back().inner = &inner;
}

void FieldList::add_children(std::string_view key, std::string_view name, const FieldList& inner, bool is_list,
                             Visit parts) {
    add(key, name, is_list ? Shape::list : Shape::object,
        [&inner, is_list, parts = std::move(parts)](const void* of) -> Value {
            ResultEntry::Children made{{}, is_list};
            parts(of, [&](const void* part) { made.results.push_back(inner.of(part)); });
            return made;
        });
    fields_.back().inner = &inner;
}

void FieldList::add_results(std::string_view key, std::string_view name, const FieldList& inner,
                            Reads<std::vector<Result>> read) {
    add(key, name, Shape::list, [read = std::move(read)](const void* of) -> Value {
        return ResultEntry::Children{read(of), true};
    });
    fields_.back().inner = &inner;
}

void FieldList::add_part(const FieldList& inner, const Visit& part) {
    for (const Field& field : inner.fields_) {
        Field made = field;
        made.read = of_part(part, field.read);
        made.severity = of_part(part, field.severity);
        made.where = of_part(part, field.where);
        made.is_known = of_part(part, field.is_known);
        fields_.push_back(std::move(made));
    }
    if (!title_) title_ = of_part(part, inner.title_);
}

Result FieldList::of(const void* value) const {
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

Json FieldList::schema() const {
    Json properties = Json::object(), required = Json::array();
    for (const Field& field : fields_) {
        if (field.key.empty()) continue;
        properties[field.key] = schema_of(field);
        if (!field.name.empty()) properties[field.key]["description"] = field.name;
        if (!field.is_omitted) required.push_back(field.key);
    }
    const Json own{{"type", "object"},
                   {"description", about_},
                   {"properties", properties},
                   {"required", required},
                   {"additionalProperties", false}};
    return other_ ? Json{{"anyOf", Json::array({own, other_->schema()})}} : own;
}

std::vector<std::pair<std::string, std::string>> FieldList::columns() const {
    std::vector<std::pair<std::string, std::string>> all;
    for (const Field& field : fields_)
        if (!field.name.empty()) all.emplace_back(field.key, field.name);
    if (other_)
        for (auto& column : other_->columns())
            if (std::ranges::find(all, column) == all.end()) all.push_back(std::move(column));
    return all;
}

}  // namespace tactus::report
