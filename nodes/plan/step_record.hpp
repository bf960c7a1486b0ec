// SPDX-License-Identifier: Apache-2.0
// Carries the steps of a run from the tick to the plan file.
#pragma once

#include "assets/plan/plan_keeper.hpp"
#include "graph/node/setup.hpp"
#include "graph/node/value.hpp"

#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <utility>

namespace tactus::nodes {

/// Rows of the stream.
inline const ValueType step_row_type{
    .name = "plan step",
    .size = sizeof(plan::StepRow),
    .columns = plan::step_row_names,
    .hash = [](Hash& hash, const void* p) { hash.add_bytes(p, sizeof(plan::StepRow)); },
    .interpolate = nullptr,
    .to_columns = [](const void* p, double* out) { std::memcpy(out, p, sizeof(plan::StepRow)); },
    .make_default = [](void* out) { new (out) plan::StepRow{}; },
    .version = nullptr,
    .load_asset = nullptr,
};

/// Passes the rows of a stream to the plan's keeper.
class StepKeeper : public StreamKeeper {
public:
    StepKeeper(const plan::CasePlan& plan, Flicks period) : plan_(plan), period_(period) {}

    void open(const std::string& path) override { plan_keeper_.emplace(std::move(plan_), path); }
    void take(std::int64_t first, const std::byte* values, std::size_t count) override {
        for (std::size_t n = 0; n < count; ++n) {
            plan::StepRow row;
            std::memcpy(static_cast<void*>(&row), values + n * sizeof row, sizeof row);
            plan_keeper_->add(row, seconds((first + static_cast<std::int64_t>(n)) * period_));
        }
    }
    void save() override { plan_keeper_->save(); }
    void finish() override {
        plan_keeper_->finish();
        trouble_ = plan_keeper_->trouble();
        plan_keeper_.reset();
    }
    /// Error about steps that could not be saved, reported at the end of the run; usually empty.
    const std::string& trouble() const { return trouble_; }

private:
    plan::CasePlan plan_;
    Flicks period_;
    std::optional<plan::PlanKeeper> plan_keeper_;
    std::string trouble_;
};

}  // namespace tactus::nodes
