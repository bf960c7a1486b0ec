// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/experiment/turned_level.hpp"

#include "dsp/core/time.hpp"
#include "dsp/core/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace tactus::analysis {

TurnedLevel::TurnedLevel(const experiment::Protocol& protocol, const TrialSpec& spec, PortCollector& ports)
    : protocol_(protocol), spec_(spec), ports_(ports) {}

double TurnedLevel::level() const { return turns_.empty() ? spec_.level : turns_.back().level; }

void TurnedLevel::turn(int presses, run::Engine& engine) {
    const experiment::Stimulus& stimulus = *protocol_.stimulus;
    const double start = stimulus.axis(spec_.level), low = stimulus.axis(stimulus.min),
                 high = stimulus.axis(stimulus.max), step = protocol_.method.step;
    // Presses beyond an end of the range are not counted: the first press back has an effect.
    const auto most = static_cast<int>(std::ceil((high - start) / step - 1e-9)),
               least = static_cast<int>(std::floor((low - start) / step + 1e-9));
    presses_ = std::clamp(presses_ + presses, least, most);
    const double wanted =
        stimulus.presentable(std::clamp(stimulus.level_at(start + presses_ * step), stimulus.min, stimulus.max));
    if (wanted == level()) return;
    const std::string& parameter = stimulus.parameters[static_cast<std::size_t>(spec_.interval - 1)];
    const std::size_t dot = parameter.rfind('.');
    const std::string value = fmt::format(
        "{} {}", protocol_.parameter(spec_.condition, wanted) / parse_unit(stimulus.unit).factor, stimulus.unit);
    const Flicks when = engine.set(parameter.substr(0, dot), parameter.substr(dot + 1),
                                   stimulus.unit.empty() ? value.substr(0, value.size() - 1) : value);
    turns_.push_back({seconds(when), wanted});
}

void TurnedLevel::answer(int index, run::Engine& engine) {
    if (matched_at_) return;
    if (index < 2) {
        turn(index == 1 ? 1 : -1, engine);
        return;
    }
    matched_at_ = engine.progress_seconds();
    ports_.over() = true;
}

void TurnedLevel::answer_by_ports(run::Engine& engine) {
    const std::vector<std::string>& ports = protocol_.response.ports;
    for (std::size_t i = 0; i < ports.size(); ++i)
        for (int presses = ports_.take_presses(ports[i]); presses > 0; --presses) answer(static_cast<int>(i), engine);
}

}  // namespace tactus::analysis
