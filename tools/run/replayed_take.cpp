// SPDX-License-Identifier: Apache-2.0
#include "tools/run/replayed_take.hpp"

#include "dsp/core/error.hpp"
#include "tools/run/load_plan.hpp"

#include <optional>
#include <utility>
#include <variant>

namespace tactus::run {

namespace {

compile::Schedule plan_in(const take::Take& take, const std::string& text, compile::AssetCache& assets) {
    patch::Problems problems;
    std::optional<compile::Schedule> plan = plan_of(patch::read_patch(text, take.about.patch_file, problems),
                                                    take.about.overrides, take.about.seed, &assets, problems);
    if (!problems.empty()) throw problems.list.front();
    return std::move(*plan);
}

}  // namespace

ReplayedTake::ReplayedTake(const take::Take& take, run::EngineOptions options, compile::AssetCache& assets) {
    options.replay = &take.log;
    options.devices = &take.devices;
    engine_ = std::make_unique<run::Engine>(plan_in(take, take.text, assets), options);
    for (const auto& event : take.events) {
        if (const auto* edit = std::get_if<take::TakenEdit>(&event))
            engine_->schedule(plan_in(take, edit->text, assets), edit->when);
        if (const auto* change = std::get_if<take::TakenChange>(&event))
            engine_->schedule_change(change->id, change->node, change->param, change->value);
    }
}

}  // namespace tactus::run
