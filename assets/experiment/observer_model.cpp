// SPDX-License-Identifier: Apache-2.0
#include "assets/experiment/observer_model.hpp"

#include "assets/experiment/toml_values.hpp"

#include <toml++/toml.h>

#include <utility>

namespace tactus::experiment {

namespace fs = std::filesystem;

namespace {

class ModelReader : TomlValues {
public:
    ModelReader(const fs::path& path, std::string level_unit)
        : TomlValues(path, "a model of subjects"), level_unit_(std::move(level_unit)) {
        model_.file = fs::absolute(path);
    }

    ObserverModel read() {
        const toml::table& root = this->root();
        know(root, {"format", "title", "seed", "observer", "hand"});
        check_format(observer_format);
        if (const auto* node = root.get("title")) model_.title = line(*node);
        if (const auto* node = root.get("seed"))
            model_.seed = static_cast<std::uint64_t>(whole(*node, 0, 2'000'000'000));
        if (const auto* node = root.get("observer")) read_observer(as_table(*node));
        if (const auto* node = root.get("hand")) read_hand(as_table(*node));
        return std::move(model_);
    }

private:
    double level(const toml::node& node) const { return quantity(node, level_unit_, -1e12, 1e12); }

    void read_observer(const toml::table& table) {
        know(table, {"form", "threshold", "thresholds", "slope", "lapse", "false_alarms", "spread", "response_time",
                     "match_spread", "match_lag"});
        model_.has_observer = true;
        SimulatedObserver& o = model_.observer;
        if (const auto* node = table.get("form")) {
            const std::string form = choice(*node, {"weibull", "logistic", "normal"});
            o.form = form == "weibull"    ? psychophysics::Form::weibull
                     : form == "logistic" ? psychophysics::Form::logistic
                                          : psychophysics::Form::normal;
        }
        o.threshold = level(need(table, "threshold", "the level that this observer just feels"));
        if (const auto* node = table.get("thresholds"))
            for (const auto& [condition, value] : as_table(*node))
                o.thresholds[std::string(condition.str())] = level(value);
        if (const auto* node = table.get("slope")) o.slope = number(*node, 1e-6, 1e9);
        if (const auto* node = table.get("lapse")) o.lapse = number(*node, 0.0, 0.5);
        if (const auto* node = table.get("false_alarms")) o.false_alarms = number(*node, 0.0, 0.9);
        if (const auto* node = table.get("spread")) o.spread = number(*node, 0.0, 2.0);
        if (const auto* node = table.get("match_spread")) o.match_spread = number(*node, 0.0, 1e9);
        if (const auto* node = table.get("match_lag")) o.match_lag = number(*node, -1e9, 1e9);
        if (const auto* node = table.get("response_time")) o.response_time = quantity(*node, "s", 0.01, 60.0);
    }

    void read_hand(const toml::table& table) {
        know(table, {"error", "lag", "time", "spread_time", "spread_error", "trial_time", "trial_error", "effect"});
        model_.has_hand = true;
        SimulatedHand& hand = model_.hand;
        if (const auto* node = table.get("error")) hand.error = quantity(*node, "mm", 0.0, 0.1);
        if (const auto* node = table.get("lag")) hand.lag = quantity(*node, "ms", 0.0, 2.0);
        if (const auto* node = table.get("time")) hand.time = number(*node, 0.5, 5.0);
        const auto spread = [&](const char* key, double& value) {
            if (const auto* node = table.get(key)) value = number(*node, 0.0, 1.0);
        };
        spread("spread_time", hand.spread_time);
        spread("spread_error", hand.spread_error);
        spread("trial_time", hand.trial_time);
        spread("trial_error", hand.trial_error);
        if (const auto* node = table.get("effect"))
            for (const toml::node& one : list(*node, 1, 64)) {
                const toml::table& effect = as_table(one);
                know(effect, {"factor", "level", "task", "time", "error"});
                HandEffect read;
                read.factor = line(need(effect, "factor", "the factor of the experiment"));
                read.level = line(need(effect, "level", "the level with the effect"));
                if (const auto* task = effect.get("task")) read.task = line(*task);
                if (const auto* time = effect.get("time")) read.time = number(*time, 0.2, 5.0);
                if (const auto* error = effect.get("error")) read.error = number(*error, 0.0, 20.0);
                hand.effects.push_back(std::move(read));
            }
    }

    std::string level_unit_;
    ObserverModel model_;
};

}  // namespace

ObserverModel load_observer_model(const fs::path& path, const std::string& level_unit) {
    return ModelReader(path, level_unit).read();
}

}  // namespace tactus::experiment
