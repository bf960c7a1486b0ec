// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/saw_model_file.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <sstream>

namespace tactus::sound {

namespace {

using vibration::SawCondition;
using vibration::SawModel;
using vibration::SawModelSize;

constexpr std::int64_t version = 1;
constexpr double greatest_level = 1e6;  // in the model's unit
const std::array<std::string, 4> model_keys{"version", "unit", "phases", "condition"};
const std::array<std::string, 8> condition_keys{"rate",   "state",    "load",  "density",
                                                "orders", "residual", "lines", "swell"};

std::string quoted(const std::string& text) {
    std::ostringstream out;
    out << toml::value<std::string>(text);
    return out.str();
}

std::string list_of(std::span<const double> values) {
    std::string out = "[";
    for (std::size_t i = 0; i < values.size(); ++i) out += fmt::format("{}{:.17g}", i == 0 ? "" : ", ", values[i]);
    return out + "]";
}

/// Orders up to the highest that is heard.
std::span<const double> heard(const std::array<double, SawModelSize::max_orders>& orders) {
    std::size_t count = orders.size();
    while (count > 1 && orders[count - 1] == 0.0) --count;
    return {orders.data(), count};
}

class ModelReader {
public:
    explicit ModelReader(const std::string& file) : file_(file) {}

    SawModelTable read(const toml::table& table) const {
        know(table, model_keys, "a saw's model");
        SawModelTable out;
        const toml::node& number = need(table, "version");
        if (const auto* value = number.as_integer(); !value || value->get() != version)
            fail(number,
                 fmt::format("this program reads models of version {}; make a new one with 'tactus model'", version));
        const toml::node& unit = need(table, "unit");
        const std::string word = text(unit);
        if (word != "m/s^2" && word != "normalised") fail(unit, "'unit' must be \"m/s^2\" or \"normalised\"");
        out.calibrated = word == "m/s^2";
        numbers(need(table, "phases"), out.model.phases, 1, -2.0 * std::numbers::pi, 2.0 * std::numbers::pi);
        const toml::node& list = need(table, "condition");
        const toml::array* conditions = list.as_array();
        if (!conditions || conditions->empty() || conditions->size() > SawModel::max_conditions)
            fail(list, fmt::format("a model has 1 to {} conditions, each beginning with [[model.condition]]",
                                   SawModel::max_conditions));
        for (const toml::node& node : *conditions) out.model.conditions.push_back(condition(node));
        return out;
    }

private:
    [[noreturn]] void fail(const toml::node& node, const std::string& message) const {
        throw Error(file::toml_place(file_, node.source()), message);
    }

    template <std::size_t N>
    void know(const toml::table& table, const std::array<std::string, N>& keys, std::string_view what) const {
        for (const auto& [key, value] : table)
            if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
                throw Error(file::toml_place(file_, key.source()),
                            fmt::format("unknown key '{}' in {}{}", key.str(), what, did_you_mean(key.str(), keys)));
    }

    const toml::node& need(const toml::table& table, std::string_view key) const {
        const toml::node* node = table.get(key);
        if (!node) throw Error(file::toml_place(file_, table.source()), fmt::format("'{}' is missing", key));
        return *node;
    }

    std::string text(const toml::node& node) const {
        if (!node.is_string()) fail(node, "a text in quotes is expected");
        return node.as_string()->get();
    }

    double quantity(const toml::node& node, std::string_view unit, double low, double high) const {
        double value = 0.0;
        try {
            value = parse_as(text(node), unit);
        } catch (const Error& error) {
            if (error.where().line > 0) throw;
            fail(node, error.message());
        }
        if (!(value >= low && value <= high)) fail(node, fmt::format("must be {:g} to {:g} {}", low, high, unit));
        return value;
    }

    /// Fills the first of `values`, as many as the list has; at least `fewest`.
    void numbers(const toml::node& node, std::span<double> values, std::size_t fewest, double low, double high) const {
        const toml::array* list = node.as_array();
        if (!list || list->size() < fewest || list->size() > values.size())
            fail(node, fewest == values.size()
                           ? fmt::format("a list of {} numbers is expected", fewest)
                           : fmt::format("a list of {} to {} numbers is expected", fewest, values.size()));
        for (std::size_t i = 0; i < list->size(); ++i) values[i] = number(*list->get(i), low, high);
    }

    double number(const toml::node& node, double low, double high) const {
        const auto value = node.value<double>();
        if (!value || !(*value >= low && *value <= high))
            fail(node, fmt::format("a number from {:.4g} to {:.4g} is expected", low, high));
        return *value;
    }

    SawCondition condition(const toml::node& node) const {
        if (!node.is_table()) fail(node, "a condition begins with [[model.condition]], in two brackets");
        const toml::table& table = *node.as_table();
        know(table, condition_keys, "a condition");
        SawCondition out;
        out.rate = quantity(need(table, "rate"), "Hz", 5.0, 1000.0);
        const toml::node& state = need(table, "state");
        const std::string word = text(state);
        if (word != "cutting" && word != "free_air") fail(state, "'state' must be \"cutting\" or \"free_air\"");
        out.cutting = word == "cutting";
        if (out.cutting) out.load = quantity(need(table, "load"), "N", 0.0, 1000.0);
        if (const toml::node* density = table.get("density")) out.density = quantity(*density, "kg/m^3", 1.0, 1e4);
        numbers(need(table, "orders"), out.sound.orders, 1, 0.0, greatest_level);
        out.sound.residual = number(need(table, "residual"), 0.0, greatest_level);
        const toml::node& lines = need(table, "lines");
        numbers(lines, out.sound.lines, out.sound.lines.size(), 1e-6, std::numbers::pi - 1e-6);
        for (std::size_t i = 1; i < out.sound.lines.size(); ++i)
            if (!(out.sound.lines[i] > out.sound.lines[i - 1])) fail(lines, "line frequencies must rise");
        std::array<double, 2 * SawModelSize::swells> swell{};
        numbers(need(table, "swell"), swell, swell.size(), -2.0, 2.0);
        for (std::size_t m = 0; m < SawModelSize::swells; ++m) {
            out.sound.swell_cos[m] = swell[2 * m];
            out.sound.swell_sin[m] = swell[2 * m + 1];
        }
        return out;
    }

    const std::string& file_;
};

}  // namespace

void save_saw_model(const SawModel& model, const SawModelTexts& texts, const std::filesystem::path& path) {
    std::string out = fmt::format(
        "# A model of a saw's vibration, for the 'saw' node.\ntitle = {}\nnote = {}\nlicence = {}\nsynthesised = {}\n\n"
        "[model]\nversion = {}\nunit = \"{}\"\nphases = {}\n",
        quoted(texts.title), quoted(texts.note), quoted(texts.licence), texts.synthesised, version,
        texts.calibrated ? "m/s^2" : "normalised", list_of(model.phases));
    for (const SawCondition& condition : model.conditions) {
        const vibration::SawSound& sound = condition.sound;
        out += fmt::format("\n[[model.condition]]\nrate = \"{:.17g} Hz\"\nstate = \"{}\"\n", condition.rate,
                           condition.cutting ? "cutting" : "free_air");
        if (condition.cutting) out += fmt::format("load = \"{:.17g} N\"\n", condition.load);
        if (condition.density > 0.0) out += fmt::format("density = \"{:.17g} kg/m^3\"\n", condition.density);
        std::array<double, 2 * SawModelSize::swells> swell{};
        for (std::size_t m = 0; m < SawModelSize::swells; ++m) {
            swell[2 * m] = sound.swell_cos[m];
            swell[2 * m + 1] = sound.swell_sin[m];
        }
        out += fmt::format("orders = {}\nresidual = {:.17g}\nlines = {}\nswell = {}\n", list_of(heard(sound.orders)),
                           sound.residual, list_of(sound.lines), list_of(swell));
    }
    file::write_whole_file(path, out);
}

SawModelTable read_saw_model(const toml::table& table, const std::string& file) {
    return ModelReader(file).read(table);
}

}  // namespace tactus::sound
