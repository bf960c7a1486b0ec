// SPDX-License-Identifier: Apache-2.0
// Undo tree of an arrangement for use in a tick. Each step stores only its changes, so that undo costs as much as the
// step.
#pragma once

#include "dsp/fit/arrangement/arrangement.hpp"
#include "dsp/fit/arrangement/history.hpp"

#include <cstddef>
#include <vector>

namespace tactus::fit {

/// The tree of history.hpp with the changes of each step. Allocates in the constructor only: when a run exceeds the
/// capacity, its oldest steps can no longer be undone, but the step count remains correct.
class StepTree {
public:
    /// Capacity for `most` steps besides the `known` ones, which must be added first.
    StepTree(std::size_t fragments, std::size_t known, std::size_t most);

    /// Adds known step `step`, which leads from one arrangement to the next.
    void put(int step, int before, const Arrangement& from, const Arrangement& to);
    /// Sets the current position among the known steps.
    void stand(HistoryPlace place);

    /// Adds a step at the head. Its number is the previous `count`.
    void add(const Arrangement& from, const Arrangement& to) noexcept;
    /// Undoes or redoes one step in `now`, the arrangement at the head. Returns false at the end of the branch.
    bool undo(Arrangement& now) noexcept;
    bool redo(Arrangement& now) noexcept;

    /// Returns the current position, as numbers of steps.
    HistoryPlace place() const noexcept;
    /// Moves to another position: undoes to the last common step and redoes from there, in time proportional to the
    /// number of steps. `now`: the arrangement at the head. Returns false, without a change, for a step that is no
    /// longer stored.
    bool go(HistoryPlace to, Arrangement& now) noexcept;

    int count() const noexcept { return first_ + static_cast<int>(steps_.size()); }
    /// Number of the last step done, -1: none.
    int head() const noexcept { return place_.head < 0 ? root_ : place_.head + first_; }
    /// Number of steps from the first one to the head.
    int done() const noexcept;

private:
    struct Step {
        int depth = 0;
        std::size_t places = 0, groups = 0, place_count = 0, group_count = 0;
    };
    template <class What>
    struct Change {
        int number;
        What from, to;
    };
    Step changes(const Arrangement& from, const Arrangement& to) noexcept;
    void forget() noexcept;
    /// State before or after the step, of the changed fragments and groups only.
    template <class Side>
    void restore(const Step& step, Arrangement& now, Side side) const noexcept;

    std::vector<int> before_;  // indices within this object, see history.hpp
    std::vector<int> way_;  // scratch memory of `go`
    std::vector<Step> steps_;
    std::vector<Change<Arrangement::Place>> places_;
    std::vector<Change<Arrangement::Group>> groups_;
    std::size_t fragments_, most_;
    HistoryPlace place_;  // index within this object
    int first_ = 0;  // number of the first stored step
    int root_ = -1;  // the step before it
    int forgotten_ = 0;  // number of steps before the first stored one
};

}  // namespace tactus::fit
