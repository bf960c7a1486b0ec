// SPDX-License-Identifier: Apache-2.0
// Carries the commands of a run from the tick to the plan file.
#pragma once

#include "assets/plan/plan_keeper.hpp"
#include "assets/plan/plan_versions.hpp"
#include "graph/node/setup.hpp"
#include "graph/node/value.hpp"

#include <cstring>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>

namespace tactus::nodes {

/// Values of the stream. A take replays the commands from their causes; the keeper writes them as steps.
inline const ValueType plan_record_type{
    .name = "plan command",
    .size = sizeof(plan::PlanRecord),
    .columns = {},
    .hash =
        [](Hash& hash, const void* p) {
            const auto& record = *static_cast<const plan::PlanRecord*>(p);
            hash.add_word(static_cast<std::uint64_t>(record.number));
            plan::add_to(hash, record.command);
        },
    .interpolate = nullptr,
    .to_columns = nullptr,
    .make_default = [](void* out) { new (out) plan::PlanRecord{}; },
    .version = nullptr,
    .load_asset = nullptr,
};

/// Passes the commands of a stream to the plan's keeper, and publishes each version of the plan before it is written: an
/// observer need not wait for the disk.
class StepKeeper : public StreamKeeper {
public:
    StepKeeper(const plan::CasePlan& plan, Flicks period) : plan_(plan), period_(period) {}

    void open(const std::string& path) override {
        plan_keeper_.emplace(std::move(plan_), path);
        publish();
    }
    void take(std::int64_t first, const std::byte* values, std::size_t count) override {
        for (std::size_t n = 0; n < count; ++n) {
            plan::PlanRecord record;
            std::memcpy(static_cast<void*>(&record), values + n * sizeof record, sizeof record);
            plan_keeper_->add(record, seconds((first + static_cast<std::int64_t>(n)) * period_));
        }
        publish();
    }
    void save() override { plan_keeper_->save(); }
    void finish() override {
        plan_keeper_->finish();
        trouble_ = plan_keeper_->trouble();
        plan_keeper_.reset();
    }
    /// Error about steps that could not be saved, reported at the end of the run; usually empty.
    const std::string& trouble() const { return trouble_; }
    /// The plan of the run. Any thread.
    const plan::PlanVersions& versions() const { return versions_; }

private:
    void publish() { versions_.publish(std::make_shared<const plan::CasePlan>(plan_keeper_->plan())); }

    plan::CasePlan plan_;
    Flicks period_;
    std::optional<plan::PlanKeeper> plan_keeper_;
    plan::PlanVersions versions_;
    std::string trouble_;
};

}  // namespace tactus::nodes
