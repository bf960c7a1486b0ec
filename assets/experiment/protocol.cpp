// SPDX-License-Identifier: Apache-2.0
#include "assets/experiment/protocol.hpp"

#include "assets/experiment/toml_values.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/units.hpp"
#include "dsp/statistics/orders.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>
#include <set>
#include <sstream>
#include <utility>

namespace tactus::experiment {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t max_conditions = 24, max_tasks = 12, max_measures = 16, max_comparisons = 64;

class ProtocolReader : TomlValues {
public:
    explicit ProtocolReader(const fs::path& path) : TomlValues(path, "an experiment file") {
        protocol_.file = fs::absolute(path).lexically_normal();
    }

    Protocol read() {
        const toml::table& root = this->root();
        know(root, {"format",     "title",       "name",        "about",      "seed",    "subjects",     "order",
                    "order_file", "repetitions", "break_every", "catch_rate", "consent", "registration", "instructions",
                    "condition",  "trial",       "stimulus",    "response",   "method",  "practice",     "limits",
                    "exclusion",  "task",        "comparison",  "alpha"});
        check_format(protocol_format);
        Protocol& p = protocol_;
        p.title = line(need(root, "title", "title = \"Stiffness discrimination\""));
        p.name = label(need(root, "name", "name = \"stiffness\", a name for files"));
        if (const auto* node = root.get("about")) p.about = word(*node);
        if (const auto* node = root.get("seed")) p.seed = static_cast<std::uint64_t>(whole(*node, 0, 2'000'000'000));
        if (const auto* node = root.get("subjects")) p.subjects = whole(*node, 1, 1000);
        if (const auto* node = root.get("repetitions")) p.repetitions = whole(*node, 1, 100);
        if (const auto* node = root.get("break_every")) p.break_every = whole(*node, 0, 100'000);
        if (const auto* node = root.get("consent")) p.needs_consent = flag(*node);
        if (const auto* node = root.get("registration")) p.registration = quantity(*node, "mm", 1e-5, 1.0);
        if (const auto* node = root.get("alpha")) p.alpha = number(*node, 1e-6, 0.5);
        if (const auto* node = root.get("instructions")) read_instructions(as_table(*node));
        if (const auto* node = root.get("condition")) read_conditions(*node);
        if (p.conditions.empty()) p.conditions.push_back({"all", {}, {}, {}, {}, {}});
        if (const auto* node = root.get("limits")) read_limits(as_table(*node));
        if (const auto* node = root.get("exclusion")) read_exclusion(as_table(*node));
        if (const auto* node = root.get("practice")) read_practice(as_table(*node));
        if (const auto* node = root.get("task")) {
            for (const char* other : {"trial", "stimulus", "response", "method", "catch_rate"})
                if (const auto* wrong = root.get(other))
                    fail(*wrong, fmt::format("an experiment has either [[task]] or '{}'", other));
            for (const toml::node* standard : standards_)
                if (standard) fail(*standard, "only a stimulus has a standard");
            read_tasks(*node);
        } else {
            read_trial(as_table(need(root, "trial", "a table [trial] with a patch, or tables [[task]]")));
            read_stimulus(as_table(need(root, "stimulus", "a table [stimulus]")));
            read_response(as_table(need(root, "response", "a table [response]")));
            read_method(as_table(need(root, "method", "a table [method]")));
            if (const auto* node_ = root.get("catch_rate")) {
                p.catch_rate = number(*node_, 0.0, 0.5);
                if (p.is_adjustment() && p.catch_rate > 0.0) fail(*node_, "an adjustment has no catch trials");
            }
        }
        read_order(root);
        if (const auto* node = root.get("comparison")) read_comparisons(*node);
        return std::move(protocol_);
    }

private:
    void read_instructions(const toml::table& table) {
        know(table, {"welcome", "question", "pause", "farewell"});
        const auto set = [&](const char* key, std::string& text) {
            if (const auto* node = table.get(key)) text = word(*node);
        };
        set("welcome", protocol_.welcome);
        set("question", protocol_.question);
        set("pause", protocol_.pause);
        set("farewell", protocol_.farewell);
    }

    void read_conditions(const toml::node& node) {
        for (const toml::node& one : list(node, 1, max_conditions)) {
            const toml::table& table = as_table(one);
            know(table, {"name", "factors", "settings", "standard", "display", "offset"});
            Condition condition;
            const toml::node& name = need(table, "name", "a condition needs a name");
            condition.name = label(name);
            for (const Condition& other : protocol_.conditions)
                if (other.name == condition.name) fail(name, fmt::format("two conditions are called '{}'", other.name));
            if (const auto* factors = table.get("factors"))
                for (const auto& [key, value] : as_table(*factors))
                    condition.factors[std::string(key.str())] = line(value);
            if (const auto* settings_ = table.get("settings")) condition.settings = settings(*settings_);
            if (const auto* display = table.get("display")) condition.display = display_of(*display);
            if (const auto* offset = table.get("offset")) condition.offset = line(*offset);
            standards_.push_back(table.get("standard"));
            protocol_.conditions.push_back(std::move(condition));
        }
        for (const Condition& condition : protocol_.conditions)
            for (const auto& [factor, level] : protocol_.conditions.front().factors)
                if (!condition.factors.contains(factor) ||
                    condition.factors.size() != protocol_.conditions.front().factors.size())
                    fail(node, fmt::format("condition '{}' does not have the same factors as '{}'", condition.name,
                                           protocol_.conditions.front().name));
    }

    /// A file beside this one, or a name in the library.
    std::string display_of(const toml::node& node) const {
        const std::string name = line(node);
        return name.find('/') == std::string::npos && !name.ends_with(".toml") ? name : beside(node).string();
    }

    void read_limits(const toml::table& table) {
        know(table, {"missed", "gap", "limited", "sound"});
        Limits& limits = protocol_.limits;
        if (const auto* node = table.get("sound")) {
            if (const toml::table* outputs = node->as_table())
                for (const auto& [output, level] : *outputs) read_sound_cap(std::string(output.str()), level);
            else read_sound_cap({}, *node);
        }
        if (const auto* node = table.get("missed")) limits.missed = number(*node, 0.0, 1.0);
        if (const auto* node = table.get("gap")) limits.gap = quantity(*node, "ms", 1e-4, 10.0);
        if (const auto* node = table.get("limited")) limits.limited = number(*node, 0.0, 1.0);
    }

    void read_sound_cap(const std::string& output, const toml::node& node) {
        if (node.is_number()) {
            protocol_.limits.sound.push_back({output, number(node, 1e-9, 1e9), false});
            return;
        }
        const std::string text = word(node);
        double level = 0.0;
        int used = 0;
        if (std::sscanf(text.c_str(), "%lf dBFS%n", &level, &used) != 1 || used != static_cast<int>(text.size()) ||
            !(level >= -200.0 && level <= 0.0))
            fail(node,
                 "the loudest sample of an audio output is expected: \"-20 dBFS\", -200 to 0 dB of full scale, or a "
                 "number in the unit of its signal");
        protocol_.limits.sound.push_back({output, std::pow(10.0, level / 20.0), true});
    }

    void read_exclusion(const toml::table& table) {
        know(table, {"min_catch_correct", "max_marked"});
        if (const auto* node = table.get("min_catch_correct")) protocol_.limits.min_catch = number(*node, 0.0, 1.0);
        if (const auto* node = table.get("max_marked")) protocol_.limits.max_marked = number(*node, 0.0, 1.0);
    }

    void read_practice(const toml::table& table) {
        know(table, {"needed", "max_trials"});
        protocol_.practice.needed = whole(need(table, "needed", "needed = 4, correct answers in a row"), 0, 100);
        if (const auto* node = table.get("max_trials")) protocol_.practice.max_trials = whole(*node, 1, 1000);
        if (protocol_.practice.max_trials < protocol_.practice.needed)
            fail(*table.get("needed"), "practice needs more correct answers than it has trials");
    }

    void read_trial(const toml::table& table) {
        know(table, {"patch", "settings", "length"});
        protocol_.patch = beside(need(table, "patch", "patch = \"patches/NAME.toml\""));
        if (const auto* node = table.get("settings")) protocol_.settings = settings(*node);
        protocol_.length = quantity(need(table, "length", "length = \"4 s\""), "s", 0.01, 3600.0);
    }

    void read_stimulus(const toml::table& table) {
        know(table, {"parameters", "unit", "standard", "relative", "scale", "min", "max", "measure", "windows",
                     "tolerance", "step"});
        Stimulus stimulus;
        const toml::node& parameters = need(
            table, "parameters", "parameters = [\"first.stiffness\", \"second.stiffness\"], one for each interval");
        stimulus.parameters = words(parameters, 1, 8);
        for (const std::string& parameter : stimulus.parameters)
            if (parameter.find('.') == std::string::npos || parameter.find('=') != std::string::npos)
                fail(parameters, fmt::format("'{}' is not NODE.PARAM", parameter));
        if (const auto* node = table.get("unit")) {
            stimulus.unit = word(*node);
            try {
                parse_unit(stimulus.unit);
            } catch (const Error& error) {
                fail(*node, error.message());
            }
        }
        if (const auto* node = table.get("relative")) stimulus.is_relative = flag(*node);
        if (const auto* node = table.get("scale")) stimulus.is_log = choice(*node, {"log", "linear"}) == "log";
        constexpr double huge = 1e12;
        if (const auto* node = table.get("standard")) stimulus.standard = quantity(*node, stimulus.unit, -huge, huge);
        else if (stimulus.is_relative)
            need(table, "standard", "a relative stimulus needs the value that levels refer to");
        if (stimulus.is_relative && stimulus.standard == 0.0)
            fail(*table.get("standard"), "levels cannot be relative to a standard of 0");
        const double least = stimulus.is_log ? 1e-12 : -huge;
        const toml::node &min = need(table, "min", "the least level"), &max = need(table, "max", "the greatest level");
        stimulus.min = quantity(min, stimulus.level_unit(), least, huge);
        stimulus.max = quantity(max, stimulus.level_unit(), least, huge);
        if (!(stimulus.min < stimulus.max)) fail(max, "the greatest level must be above the least");
        stimulus.measure = read_measure(as_table(need(table, "measure",
                                                      "how the rendered stimulus is read from the take: "
                                                      "measure = {kind = \"rms\", port = \"hand_out.applied.fz\"}")),
                                        false);
        const toml::node& windows =
            need(table, "windows", "when each interval is: windows = [[\"0 s\", \"2 s\"], [\"2 s\", \"4 s\"]]");
        for (const toml::node& one : list(windows, 1, 8)) {
            const toml::array& pair = list(one, 2, 2);
            const Window window{quantity(*pair.get(0), "s", 0.0, 3600.0), quantity(*pair.get(1), "s", 0.0, 3600.0)};
            if (!(window.begin < window.end && window.end <= protocol_.length + 1e-9))
                fail(one, "an interval must end after it begins, and before the trial ends");
            stimulus.windows.push_back(window);
        }
        if (stimulus.windows.size() != stimulus.parameters.size())
            fail(windows, "each interval needs a parameter and a window");
        if (const auto* node = table.get("step"))
            stimulus.step = quantity(*node, stimulus.level_unit(), 0.0, stimulus.max);
        if (stimulus.step > 0.0 &&
            std::ceil(stimulus.min / stimulus.step - 1e-9) > std::floor(stimulus.max / stimulus.step + 1e-9))
            fail(*table.get("step"), "no multiple of the step lies between min and max");
        if (const auto* node = table.get("tolerance")) stimulus.tolerance = number(*node, 1e-4, 1.0);
        for (std::size_t i = 0; i < standards_.size(); ++i) {
            if (!standards_[i]) continue;
            const double standard = quantity(*standards_[i], stimulus.unit, -huge, huge);
            if (stimulus.is_relative && standard == 0.0)
                fail(*standards_[i], "levels cannot be relative to a standard of 0");
            protocol_.conditions[i].standard = standard;
        }
        protocol_.stimulus = std::move(stimulus);
    }

    void read_response(const toml::table& table) {
        know(table, {"kind", "names", "keys", "ports"});
        Response& response = protocol_.response;
        const toml::node& kind = need(table, "kind", "kind = \"choice\", \"yes_no\", \"same_different\" or \"adjust\"");
        const std::string name = choice(kind, {"choice", "yes_no", "same_different", "adjust"});
        response.kind = name == "choice"   ? ResponseKind::choice
                        : name == "yes_no" ? ResponseKind::yes_no
                        : name == "adjust" ? ResponseKind::adjust
                                           : ResponseKind::same_different;
        const std::size_t intervals = protocol_.stimulus->parameters.size();
        response.intervals = static_cast<int>(intervals);
        if (response.kind == ResponseKind::yes_no && intervals != 1) fail(kind, "a yes/no trial has one interval");
        if (response.kind == ResponseKind::choice && intervals < 2) fail(kind, "a choice needs at least two intervals");
        if (response.kind == ResponseKind::same_different && intervals != 2)
            fail(kind, "a same-different trial has two intervals");
        const std::size_t answers = response.kind == ResponseKind::choice   ? intervals
                                    : response.kind == ResponseKind::adjust ? 3
                                                                            : 2;
        const auto read = [&](const char* key, std::vector<std::string>& list) {
            if (const auto* node = table.get(key)) {
                list = words(*node, answers, answers);
                if (std::set<std::string>(list.begin(), list.end()).size() != answers)
                    fail(*node, "two answers are equal");
            }
        };
        read("names", response.names);
        read("keys", response.keys);
        read("ports", response.ports);
        for (const std::string& key : response.keys)
            if (key.size() != 1 || key == "q")
                fail(*table.get("keys"), "a key is one character other than 'q', which ends the session");
        if (response.names.empty()) {
            if (response.kind == ResponseKind::yes_no) response.names = {"no", "yes"};
            else if (response.kind == ResponseKind::same_different) response.names = {"same", "different"};
            else if (response.kind == ResponseKind::adjust) response.names = {"less", "more", "matches"};
            else
                for (std::size_t i = 1; i <= answers; ++i) response.names.push_back(std::to_string(i));
        }
        if (response.keys.empty()) {
            if (response.kind == ResponseKind::yes_no) response.keys = {"n", "y"};
            else if (response.kind == ResponseKind::same_different) response.keys = {"s", "d"};
            else if (response.kind == ResponseKind::adjust) response.keys = {"-", "+", "m"};
            else
                for (std::size_t i = 1; i <= answers; ++i) response.keys.push_back(std::to_string(i));
        }
    }

    void read_method(const toml::table& table) {
        Method& method = protocol_.method;
        const Stimulus& stimulus = *protocol_.stimulus;
        const toml::node& kind =
            need(table, "kind", "kind = \"quest_plus\", \"staircase\", \"constant\" or \"adjustment\"");
        const std::string name = choice(kind, {"quest_plus", "staircase", "constant", "adjustment"});
        method.kind = name == "quest_plus"  ? Method::Kind::quest_plus
                      : name == "staircase" ? Method::Kind::staircase
                      : name == "constant"  ? Method::Kind::constant
                                            : Method::Kind::adjustment;
        // A key of another method would have no effect.
        std::vector<std::string> keys{"kind", "trials"};
        const auto has = [&](const std::vector<std::string>& more) {
            keys.insert(keys.end(), more.begin(), more.end());
        };
        if (method.kind == Method::Kind::adjustment) has({"starts", "step", "presentations"});
        else has({"form", "slopes", "lapse", "target"});
        if (method.kind == Method::Kind::constant) has({"levels"});
        if (method.kind == Method::Kind::staircase) has({"rule", "down", "start", "step_up", "step_down", "reversals"});
        know(table, keys);
        if ((method.kind == Method::Kind::adjustment) != (protocol_.response.kind == ResponseKind::adjust))
            fail(kind, "the method \"adjustment\" and the response \"adjust\" belong together");
        method.trials = whole(need(table, "trials", "trials = 60 of each block; constant: of each level"), 1, 10'000);
        if (method.kind == Method::Kind::adjustment) {
            read_adjustment(table);
            return;
        }
        if (const auto* node = table.get("form")) {
            const std::string form = choice(*node, {"weibull", "logistic", "normal"});
            method.form = form == "weibull"    ? psychophysics::Form::weibull
                          : form == "logistic" ? psychophysics::Form::logistic
                                               : psychophysics::Form::normal;
        }
        if (const auto* node = table.get("lapse")) method.lapse = number(*node, 0.0, 0.2);
        if (const auto* node = table.get("target")) method.target = number(*node, 0.01, 0.99);
        if (!(method.target > protocol_.response.guess() && method.target < 1.0 - method.lapse))
            fail(table.get("target") ? *table.get("target") : kind,
                 fmt::format("the target must lie between chance ({:.3g}) and 1 - lapse", protocol_.response.guess()));
        if (const auto* node = table.get("slopes")) {
            method.slopes.clear();
            for (const toml::node& one : list(*node, 1, 50)) method.slopes.push_back(number(one, 1e-3, 1e6));
            if (std::ranges::adjacent_find(method.slopes, std::greater_equal<>{}) != method.slopes.end())
                fail(*node, "slopes must ascend");
        } else {
            method.slopes =
                psychophysics::usual_slopes(method.form, stimulus.is_log ? 1.0 : stimulus.max - stimulus.min);
        }
        const std::string level_unit = stimulus.level_unit();
        if (method.kind == Method::Kind::constant) {
            const toml::node& levels = need(table, "levels", "the levels to show");
            for (const toml::node& one : list(levels, 2, 50))
                method.levels.push_back(quantity(one, level_unit, stimulus.min, stimulus.max));
            if (std::ranges::adjacent_find(method.levels, std::greater_equal<>{}) != method.levels.end())
                fail(levels, "levels must ascend");
            for (const double level : method.levels)
                if (std::abs(stimulus.presentable(level) - level) > 1e-9 * std::abs(level))
                    fail(levels,
                         fmt::format("{} is no multiple of the step of the stimulus, {}",
                                     format_quantity(level, level_unit), format_quantity(stimulus.step, level_unit)));
        }
        if (method.kind == Method::Kind::staircase) read_rule(table, level_unit);
    }

    void read_adjustment(const toml::table& table) {
        Method& method = protocol_.method;
        const Stimulus& stimulus = *protocol_.stimulus;
        if (method.trials % 2 != 0)
            fail(*table.get("trials"), "half of the trials begin at each end of the range: their number must be even");
        if (const auto* node = table.get("starts")) method.starts = number(*node, 0.0, 0.4);
        const double range = stimulus.axis(stimulus.max) - stimulus.axis(stimulus.min);
        method.step = 0.02 * range;
        // On a log axis a step is a difference of log10, on a linear one a level.
        if (const auto* node = table.get("step"))
            method.step = stimulus.is_log ? number(*node, 1e-4, 0.5 * range)
                                          : quantity(*node, stimulus.level_unit(), 1e-12, 0.5 * range);
        if (const auto* node = table.get("presentations")) method.presentations = whole(*node, 2, 1000);
    }

    void read_rule(const toml::table& table, const std::string& level_unit) {
        const Stimulus& stimulus = *protocol_.stimulus;
        psychophysics::StaircaseRule& rule = protocol_.method.rule;
        if (protocol_.response.kind != ResponseKind::choice)
            fail(*table.get("kind"), "a staircase needs a choice: yes and no alone do not say what is correct");
        if (const auto* node = table.get("rule"))
            rule.kind = choice(*node, {"transformed", "weighted"}) == "weighted"
                            ? psychophysics::StaircaseRule::Kind::weighted
                            : psychophysics::StaircaseRule::Kind::transformed;
        if (const auto* node = table.get("down")) rule.down = whole(*node, 1, 10);
        rule.min = stimulus.axis(stimulus.min);
        rule.max = stimulus.axis(stimulus.max);
        rule.start = rule.max;
        if (const auto* node = table.get("start"))
            rule.start = stimulus.axis(quantity(*node, level_unit, stimulus.min, stimulus.max));
        rule.step_up = rule.step_down = 0.03 * (rule.max - rule.min);
        const auto step = [&](const char* key, double& value) {
            // On a log axis a step is a difference of log10, on a linear one a level.
            if (const auto* node = table.get(key))
                value = stimulus.is_log ? number(*node, 1e-4, 10.0) : quantity(*node, level_unit, 1e-12, 1e12);
        };
        step("step_up", rule.step_up);
        rule.step_down = rule.step_up;
        step("step_down", rule.step_down);
        if (const auto* node = table.get("reversals")) rule.reversals = whole(*node, 4, 1000);
        rule.max_trials = protocol_.method.trials;
    }

    Measure read_measure(const toml::table& table, bool is_named) const {
        know(table, {"name", "kind", "port", "other", "when", "unit", "log", "scale"});
        Measure measure;
        if (is_named) measure.name = label(need(table, "name", "a measure needs a name"));
        using Kind = Measure::Kind;
        static const std::vector<std::pair<std::string, Kind>> kinds{
            {"mean", Kind::mean},   {"rms", Kind::rms}, {"peak", Kind::peak},         {"last", Kind::last},
            {"slope", Kind::slope}, {"lag", Kind::lag}, {"at_press", Kind::at_press}, {"until", Kind::until}};
        std::vector<std::string> names;
        for (const auto& [name, kind] : kinds) names.push_back(name);
        const toml::node& kind = need(table, "kind", "kind = \"mean\"");
        measure.kind =
            kinds[static_cast<std::size_t>(std::ranges::find(names, choice(kind, names)) - names.begin())].second;
        measure.port = port(need(table, "port", "port = \"NODE.PORT\", or \"NODE.PORT.CHANNEL\""));
        const bool needs_other = measure.kind == Kind::slope || measure.kind == Kind::lag;
        if (needs_other) measure.other = port(need(table, "other", "the port to compare with"));
        else if (const auto* node = table.get("other")) fail(*node, "only 'slope' and 'lag' compare with another port");
        if (measure.kind == Kind::at_press) measure.when = port(need(table, "when", "the bool that becomes true"));
        else if (const auto* node = table.get("when")) measure.when = port(*node);
        if (const auto* node = table.get("unit")) {
            measure.unit = word(*node);
            try {
                parse_unit(measure.unit);
            } catch (const Error& error) {
                fail(*node, error.message());
            }
        }
        if (const auto* node = table.get("log")) measure.is_log = flag(*node);
        if (const auto* node = table.get("scale")) measure.scale = number(*node, -1e9, 1e9);
        return measure;
    }

    std::string port(const toml::node& node) const {
        std::string name = word(node);
        const auto dots = std::ranges::count(name, '.');
        if (dots < 1 || dots > 2) fail(node, fmt::format("'{}' is neither NODE.PORT nor NODE.PORT.CHANNEL", name));
        return name;
    }

    void read_tasks(const toml::node& node) {
        for (const toml::node& one : list(node, 1, max_tasks)) {
            const toml::table& table = as_table(one);
            know(table, {"name", "instruction", "patch", "settings", "length", "done", "ideal", "self_paced",
                         "repetitions", "measure"});
            Task task;
            const toml::node& name = need(table, "name", "a task needs a name");
            task.name = label(name);
            for (const Task& other : protocol_.tasks)
                if (other.name == task.name) fail(name, fmt::format("two tasks are called '{}'", task.name));
            if (const auto* text = table.get("instruction")) task.instruction = word(*text);
            task.patch = beside(need(table, "patch", "patch = \"patches/NAME.toml\""));
            if (const auto* list_ = table.get("settings")) task.settings = settings(*list_);
            task.length = quantity(need(table, "length", "length = \"60 s\""), "s", 0.01, 3600.0);
            if (const auto* done = table.get("done")) task.done = port(*done);
            if (const auto* ideal = table.get("ideal")) task.ideal = beside(*ideal);
            if (const auto* paced = table.get("self_paced")) task.is_self_paced = flag(*paced);
            if (const auto* count = table.get("repetitions")) task.repetitions = whole(*count, 1, 1000);
            const toml::node& measures = need(table, "measure", "a task needs a table [[task.measure]]");
            for (const toml::node& measure : list(measures, 1, max_measures)) {
                task.measures.push_back(read_measure(as_table(measure), true));
                for (std::size_t i = 0; i + 1 < task.measures.size(); ++i)
                    if (task.measures[i].name == task.measures.back().name)
                        fail(measure, fmt::format("two measures are called '{}'", task.measures[i].name));
            }
            protocol_.tasks.push_back(std::move(task));
        }
    }

    void read_order(const toml::table& root) {
        const toml::node* node = root.get("order");
        if (!node) return;
        const std::string name = choice(*node, {"latin_square", "williams", "block_random", "co_location", "table"});
        protocol_.order = name == "latin_square"   ? OrderKind::latin_square
                          : name == "williams"     ? OrderKind::williams
                          : name == "block_random" ? OrderKind::block_random
                          : name == "co_location"  ? OrderKind::co_location
                                                   : OrderKind::table;
        if (protocol_.order == OrderKind::table)
            protocol_.order_file =
                beside(need(root, "order_file", "order = \"table\" needs order_file = \"orders.csv\""));
        else if (const auto* file = root.get("order_file")) fail(*file, "only order = \"table\" has a file");
        if (protocol_.order == OrderKind::co_location) {
            if (protocol_.conditions.size() != 4 || protocol_.tasks.size() != 3)
                fail(*node, "the orders of the co-location study need four conditions and three tasks");
            for (const std::size_t display : {0, 1})
                for (const std::size_t mode : {0, 1}) {
                    const auto& a = protocol_.conditions[2 * display + mode].factors;
                    const auto& same_display = protocol_.conditions[2 * display].factors;
                    const auto& same_mode = protocol_.conditions[mode].factors;
                    if (!a.contains("display") || !a.contains("mode") ||
                        a.at("display") != same_display.at("display") || a.at("mode") != same_mode.at("mode"))
                        fail(*node,
                             "the four conditions must be both modes of the first display, then both of the second, "
                             "with factors 'display' and 'mode'");
                }
        }
    }

    void read_comparisons(const toml::node& node) {
        for (const toml::node& one : list(node, 1, max_comparisons)) {
            const toml::table& table = as_table(one);
            know(table, {"task", "measure", "factor", "a", "b", "within", "margin"});
            Comparison comparison;
            const Protocol& p = protocol_;
            if (p.is_psychophysics()) {
                comparison.measure = "threshold";
                for (const char* key : {"task", "measure"})
                    if (const auto* wrong = table.get(key)) fail(*wrong, "psychophysics compares thresholds only");
            } else {
                std::vector<std::string> names, measures;
                for (const Task& task : p.tasks) names.push_back(task.name);
                comparison.task = choice(need(table, "task", "the task"), names);
                for (const Task& task : p.tasks)
                    if (task.name == comparison.task)
                        for (const Measure& measure : task.measures) measures.push_back(measure.name);
                comparison.measure = choice(need(table, "measure", "the measure"), measures);
            }
            std::vector<std::string> factors;
            for (const auto& [factor, level] : p.conditions.front().factors) factors.push_back(factor);
            comparison.factor = choice(need(table, "factor", "the factor, as in [[condition]]"), factors);
            comparison.a = level_of(need(table, "a", "a level of the factor"), comparison.factor);
            const toml::node& b = need(table, "b", "another level");
            comparison.b = level_of(b, comparison.factor);
            if (comparison.a == comparison.b) fail(b, "a level cannot be compared with itself");
            if (const auto* within = table.get("within")) {
                const toml::table& pair = as_table(*within);
                if (pair.size() != 1) fail(*within, "within = {FACTOR = \"LEVEL\"}");
                comparison.within_factor = std::string(pair.begin()->first.str());
                if (std::ranges::find(factors, comparison.within_factor) == factors.end() ||
                    comparison.within_factor == comparison.factor)
                    fail(*within, fmt::format("'{}' is no other factor{}", comparison.within_factor,
                                              did_you_mean(comparison.within_factor, factors)));
                comparison.within = level_of(pair.begin()->second, comparison.within_factor);
            }
            if (const auto* margin = table.get("margin")) comparison.margin = number(*margin, 0.01, 10.0);
            protocol_.comparisons.push_back(std::move(comparison));
        }
    }

    std::string level_of(const toml::node& node, const std::string& factor) const {
        std::vector<std::string> levels;
        for (const Condition& condition : protocol_.conditions) {
            const std::string& level = condition.factors.at(factor);
            if (std::ranges::find(levels, level) == levels.end()) levels.push_back(level);
        }
        return choice(node, levels);
    }

    Protocol protocol_;
    std::vector<const toml::node*> standards_;  // of the conditions; null: none given
};

/// Rows of condition names, separated by commas; '#' begins a comment.
std::vector<std::vector<std::size_t>> read_order_table(const Protocol& protocol) {
    std::istringstream lines(file::read_whole_file(protocol.order_file));
    std::vector<std::string> names;
    for (const Condition& condition : protocol.conditions) names.push_back(condition.name);
    std::vector<std::vector<std::size_t>> rows;
    int number = 0;
    for (std::string text; std::getline(lines, text);) {
        ++number;
        const SourceLocation where{protocol.order_file.string(), number, 1};
        std::erase_if(text, [](char c) { return c == ' ' || c == '\r' || c == '\t'; });
        if (text.empty() || text.front() == '#') continue;
        std::vector<std::size_t> row;
        std::istringstream cells(text);
        for (std::string name; std::getline(cells, name, ',');) {
            const auto at = std::ranges::find(names, name);
            if (at == names.end())
                throw Error(where, fmt::format("there is no condition '{}'{}", name, did_you_mean(name, names)));
            row.push_back(static_cast<std::size_t>(at - names.begin()));
        }
        rows.push_back(std::move(row));
    }
    if (rows.empty()) throw Error(SourceLocation{protocol.order_file.string(), 1, 1}, "the table has no rows");
    return rows;
}

/// Number of different orders of the conditions; 1 for those that have none.
std::size_t condition_rows(const Protocol& protocol) {
    if (protocol.order == OrderKind::latin_square) return protocol.conditions.size();
    if (protocol.order == OrderKind::williams) return statistics::williams(protocol.conditions.size()).size();
    return 1;
}

}  // namespace

double Stimulus::axis(double level) const { return is_log ? std::log10(level) : level; }
double Stimulus::presentable(double level) const {
    if (!(step > 0.0)) return level;
    // Whole steps within the range, so that the same text gives the same bits.
    return std::clamp(std::round(level / step), std::ceil(min / step - 1e-9), std::floor(max / step + 1e-9)) * step;
}
bool Stimulus::is_rendered(double wanted, double got) const {
    const double floor = is_log ? 0.0 : 0.05 * std::max(std::abs(min), std::abs(max));
    return std::abs(got - wanted) <= tolerance * std::max(std::abs(wanted), floor);
}
double Stimulus::level_at(double at) const { return is_log ? std::pow(10.0, at) : at; }

std::vector<fs::path> Protocol::files() const {
    std::vector<fs::path> all{file};
    const auto add = [&](const fs::path& path) {
        if (!path.empty() && std::ranges::find(all, path) == all.end()) all.push_back(path);
    };
    add(patch);
    add(order_file);
    for (const Condition& condition : conditions)
        if (fs::path(condition.display).is_absolute()) add(condition.display);
    for (const Task& task : tasks) {
        add(task.patch);
        add(task.ideal);
    }
    return all;
}

Protocol load_protocol(const fs::path& path) {
    Protocol protocol = ProtocolReader(path).read();
    if (protocol.order == OrderKind::table) read_order_table(protocol);
    return protocol;
}

std::vector<std::size_t> condition_order(const Protocol& protocol, std::size_t row) {
    const std::size_t count = protocol.conditions.size();
    const auto blocks = static_cast<std::size_t>(protocol.repetitions);
    std::vector<std::size_t> order;
    const auto repeat = [&](const std::vector<std::size_t>& one) {
        for (std::size_t block = 0; block < blocks; ++block) order.insert(order.end(), one.begin(), one.end());
    };
    switch (protocol.order) {
        case OrderKind::latin_square: repeat(statistics::latin_square(count)[row % count]); break;
        case OrderKind::williams: {
            const auto rows = statistics::williams(count);
            repeat(rows[row % rows.size()]);
            break;
        }
        case OrderKind::block_random: order = statistics::block_random(count, blocks, mix(protocol.seed) ^ row); break;
        case OrderKind::co_location:
            for (const auto& [display, mode] : statistics::co_location_row(row).periods())
                order.push_back(2 * display + mode);
            repeat(std::exchange(order, {}));
            break;
        case OrderKind::table: {
            const auto rows = read_order_table(protocol);
            if (row >= rows.size())
                throw Error(fmt::format("{}: has {} rows, but this is subject {}; add a row",
                                        protocol.order_file.string(), rows.size(), row + 1));
            order = rows[row];
            break;
        }
    }
    return order;
}

std::vector<std::size_t> task_order(const Protocol& protocol, std::size_t row) {
    const std::size_t count = protocol.tasks.size();
    if (protocol.order == OrderKind::co_location)
        return statistics::all_orders(3)[statistics::co_location_row(row).task_order];
    if (count == 0) return {};
    // Rotated beside the conditions. Where both numbers of rows have a common divisor, each order of conditions would always meet
    // the same orders of tasks: the rotation is shifted each time that all pairs so far have come once.
    const std::size_t together = std::lcm(condition_rows(protocol), count);
    return statistics::latin_square(count)[(row + row / together) % count];
}

std::string balance_warning(const Protocol& protocol, std::size_t subjects) {
    const std::size_t tasks = std::max<std::size_t>(protocol.tasks.size(), 1);
    const std::size_t rows = protocol.order == OrderKind::co_location ? 16 : condition_rows(protocol) * tasks;
    if (subjects % rows == 0) return {};
    return fmt::format(
        "{} subjects do not fill the {} rows of the order equally often: conditions and order are not "
        "balanced; {} would be",
        subjects, rows, (subjects / rows + 1) * rows);
}

}  // namespace tactus::experiment
