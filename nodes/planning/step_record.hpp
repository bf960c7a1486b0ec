// SPDX-License-Identifier: Apache-2.0
// The steps that are done in a run: kept for undo, and as a stream of rows.
#pragma once

#include "assets/plan/step_row.hpp"
#include "graph/value.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <new>
#include <span>
#include <vector>

namespace tactus::nodes {

/// Rows in a stream.
inline const ValueType step_row_type{
    .name = "plan step",
    .size = sizeof(StepRow),
    .columns = step_row_names,
    .hash = [](Hash& hash, const void* p) { hash.add_bytes(p, sizeof(StepRow)); },
    .interpolate = nullptr,
    .to_columns = [](const void* p, double* out) { std::memcpy(out, p, sizeof(StepRow)); },
    .make_default = [](void* out) { new (out) StepRow{}; },
    .version = nullptr,
    .load_asset = nullptr,
};

/// The tree of a run's steps. Takes its memory when made; what is done beyond that is recorded, but not undone.
class StepLog {
public:
    explicit StepLog(std::size_t fragments) {
        const std::size_t most = most_steps + 16 * fragments;
        rows_.reserve(most);
        seconds_.reserve(most);
        steps_.reserve(most_steps);
        way_.reserve(most);
    }

    std::size_t count() const noexcept { return steps_.size(); }
    int head() const noexcept { return head_; }
    bool overflowed() const noexcept { return overflowed_; }
    std::span<const StepRow> rows() const noexcept { return rows_; }
    std::span<const double> seconds() const noexcept { return seconds_; }

    /// The row that a new step begins with.
    StepRow next(StepKind kind) noexcept {
        StepRow row;
        row.step = static_cast<double>(steps_.size());
        row.after = head_;
        row.kind = static_cast<double>(kind);
        first_ = rows_.size();
        return row;
    }
    void add(const StepRow& row, double second) noexcept {
        if (rows_.size() == rows_.capacity() || steps_.size() == steps_.capacity()) {
            overflowed_ = true;
            return;
        }
        rows_.push_back(row);
        seconds_.push_back(second);
    }
    /// The rows since `next` are a step.
    void done() noexcept {
        if (overflowed_) {
            // Half a step is none.
            rows_.resize(first_);
            seconds_.resize(first_);
            return;
        }
        steps_.push_back({head_, first_, rows_.size()});
        head_ = tip_ = static_cast<int>(steps_.size()) - 1;
    }
    bool undo() noexcept {
        if (head_ < 0) return false;
        head_ = steps_[static_cast<std::size_t>(head_)].before;
        return true;
    }
    bool redo() noexcept {
        int n = tip_;
        while (n >= 0 && n != head_ && steps_[static_cast<std::size_t>(n)].before != head_)
            n = steps_[static_cast<std::size_t>(n)].before;
        if (n < 0 || n == head_) return false;
        head_ = n;
        return true;
    }
    int done_to_head() const noexcept {
        int count = 0;
        for (int n = head_; n >= 0; n = steps_[static_cast<std::size_t>(n)].before) ++count;
        return count;
    }
    /// The rows of all steps up to the head, in their order.
    std::span<const StepRow> rows_to_head() noexcept {
        way_.clear();
        for (int n = head_; n >= 0; n = steps_[static_cast<std::size_t>(n)].before)
            for (std::size_t r = steps_[static_cast<std::size_t>(n)].end;
                 r-- > steps_[static_cast<std::size_t>(n)].first;)
                way_.push_back(rows_[r]);
        std::reverse(way_.begin(), way_.end());
        return way_;
    }

private:
    static constexpr std::size_t most_steps = 4096;
    struct Step {
        int before;
        std::size_t first, end;
    };
    std::vector<StepRow> rows_, way_;
    std::vector<double> seconds_;
    std::vector<Step> steps_;
    std::size_t first_ = 0;
    int head_ = -1, tip_ = -1;
    bool overflowed_ = false;
};

}  // namespace tactus::nodes
