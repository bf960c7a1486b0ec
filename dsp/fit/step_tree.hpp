// SPDX-License-Identifier: Apache-2.0
// Steps of an arrangement that a tick may undo: each knows what it changed, so the way back is as short as the step.
#pragma once

#include "dsp/fit/arrangement.hpp"
#include "dsp/fit/history.hpp"

#include <cstddef>
#include <vector>

namespace tactus::fit {

/// The tree of history.hpp with what each step changed. Memory is taken by the constructor: a run that does more steps
/// than there is room for forgets how to undo those before, and counts on.
class StepTree {
public:
    /// Room for `most` steps besides the `known` ones, which are to be put first.
    StepTree(std::size_t fragments, std::size_t known, std::size_t most);

    /// Step `step` of the known ones leads from one arrangement to the next.
    void put(int step, int before, const Arrangement& from, const Arrangement& to);
    /// Where the known steps stand.
    void stand(HistoryPlace place);

    /// A new step at the head. Its number is what `count` was before.
    void add(const Arrangement& from, const Arrangement& to) noexcept;
    /// One step back or on, in `now`, which is where the head is. False at the end of the way.
    bool undo(Arrangement& now) noexcept;
    bool redo(Arrangement& now) noexcept;

    int count() const noexcept { return first_ + static_cast<int>(steps_.size()); }
    /// Number of the step that was done last, -1: none.
    int head() const noexcept { return place_.head < 0 ? root_ : place_.head + first_; }
    /// Steps from the first one to the head.
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
    /// What the step changed, as it was on one side of it.
    template <class Side>
    void restore(const Step& step, Arrangement& now, Side side) const noexcept;

    std::vector<int> before_;  // within this, as history.hpp has it
    std::vector<Step> steps_;
    std::vector<Change<Arrangement::Place>> places_;
    std::vector<Change<Arrangement::Group>> groups_;
    std::size_t fragments_, most_;
    HistoryPlace place_;  // within this
    int first_ = 0;       // number of the first step that is kept
    int root_ = -1;       // of the one that it follows
    int forgotten_ = 0;   // steps on the way to that
};

}  // namespace tactus::fit
