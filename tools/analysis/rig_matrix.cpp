// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/rig_matrix.hpp"

#include "assets/file/toml_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <string_view>

namespace tactus::analysis {

namespace {

class Reader : file::TomlFile {
public:
    explicit Reader(const std::filesystem::path& path) : file::TomlFile(path, "a rig") {}

    RigMatrix read() {
        const toml::table& root = this->root();
        RigMatrix m;
        know(root, {"motors", "rates", "amplitudes", "cycles", "objects", "crossover", "assumed"});
        if (const auto* node = root.get("motors")) m.motors = words(*node);
        if (const auto* node = root.get("rates")) m.rates = quantities(*node, "Hz");
        if (const auto* node = root.get("amplitudes")) m.amplitudes = quantities(*node, "mm");
        if (const auto* node = root.get("cycles")) {
            m.cycles = static_cast<int>(node->value_or<std::int64_t>(0));
            if (m.cycles < 2 || m.cycles > 1000) fail(*node, "cycles must be a whole number from 2 to 1000");
        }
        if (const auto* node = root.get("objects")) m.objects = objects(*node);
        if (const auto* node = root.get("crossover")) {
            const toml::table& table = as_table(*node);
            know(table, {"force", "stiffness", "rates"});
            if (const auto* f = table.get("force")) m.crossover_force = quantity(*f, "N");
            if (const auto* k = table.get("stiffness")) m.crossover_stiffness = quantities(*k, "N/mm");
            if (const auto* r = table.get("rates")) m.crossover_rates = quantities(*r, "Hz");
            std::ranges::sort(m.crossover_rates);
        }
        if (const auto* node = root.get("assumed")) m.assumptions = assumptions(as_table(*node));
        return m;
    }

private:
    double quantity(const toml::node& node, std::string_view unit) const {
        const std::string text = word(node);
        double value = 0.0;
        try {
            value = parse_as(text, unit);
        } catch (const Error& error) {
            fail(node, error.message());
        }
        if (!(value >= 0.0)) fail(node, fmt::format("'{}' must not be negative", text));
        return value;
    }
    template <class Item>
    auto list(const toml::node& node, Item&& item) const {
        const toml::array* array = node.as_array();
        if (!array || array->empty() || array->size() > 100) fail(node, "a list of 1 to 100 is expected here");
        std::vector<decltype(item(*array->get(0)))> all;
        for (const toml::node& one : *array) all.push_back(item(one));
        return all;
    }
    std::vector<std::string> words(const toml::node& node) const {
        return list(node, [this](const toml::node& one) { return word(one); });
    }
    std::vector<double> quantities(const toml::node& node, std::string_view unit) const {
        return list(node, [&](const toml::node& one) {
            const double value = quantity(one, unit);
            if (!(value > 0.0)) fail(one, "must be above 0");
            return value;
        });
    }
    std::vector<RigObject> objects(const toml::node& node) const {
        return list(node, [this](const toml::node& one) {
            const toml::table& table = as_table(one);
            know(table, {"name", "kind", "stiffness", "damping"});
            RigObject object;
            if (const auto* k = table.get("stiffness")) object.stiffness = quantity(*k, "N/mm");
            if (const auto* b = table.get("damping")) object.damping = quantity(*b, "N s/mm");
            if (const auto* kind = table.get("kind")) {
                if (word(*kind) == "wall") object.kind = control::ObjectKind::wall;
                else if (word(*kind) != "elastic") fail(*kind, "kind must be \"elastic\" or \"wall\"");
            }
            if (object.kind == control::ObjectKind::elastic && object.stiffness == 0.0 && object.damping == 0.0)
                fail(one, "an object needs a stiffness or a damping, or kind = \"wall\"");
            const auto* name = table.get("name");
            object.name = name ? word(*name)
                          : object.kind == control::ObjectKind::wall
                              ? "wall"
                              : fmt::format("{:g} N/mm + {:g} N s/mm", object.stiffness * 1e-3, object.damping * 1e-3);
            return object;
        });
    }
    std::vector<RigAssumption> assumptions(const toml::table& table) const {
        std::vector<RigAssumption> all;
        for (const auto& [motor, options] : table)
            for (const auto& [option, ends] : as_table(options)) {
                const std::vector<std::string> both = words(ends);
                if (both.size() != 2) fail(ends, "two limits are expected, as in [\"1 ms\", \"4 ms\"]");
                all.push_back({std::string(motor.str()), std::string(option.str()), both[0], both[1]});
            }
        return all;
    }
};

}  // namespace

RigMatrix load_rig_matrix(const std::filesystem::path& path) { return Reader(path).read(); }

}  // namespace tactus::analysis
