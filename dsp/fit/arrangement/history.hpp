// SPDX-License-Identifier: Apache-2.0
// Undo history as a tree: every step stores its predecessor.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::fit {

/// A branch of the tree: the steps from the root to `head` are done, those from there to `tip` can be redone. Root:
/// -1.
struct HistoryPlace {
    int head = -1, tip = -1;
};

/// Returns the position after a new step at the head, which abandons the previous redo branch.
constexpr HistoryPlace after_step(int step) { return {step, step}; }

// Below, before[n] is the predecessor of step n and smaller than n; -1 for a first step.

/// Undoes one step; unchanged at the root.
inline HistoryPlace undone(std::span<const int> before, HistoryPlace at) {
    if (at.head < 0) return at;
    return {before[static_cast<std::size_t>(at.head)], at.tip};
}

/// Redoes one step towards the tip; unchanged at the tip.
inline HistoryPlace redone(std::span<const int> before, HistoryPlace at) {
    int next = at.tip;
    while (next >= 0 && next != at.head && before[static_cast<std::size_t>(next)] != at.head)
        next = before[static_cast<std::size_t>(next)];
    if (next < 0 || next == at.head) return at;
    return {next, at.tip};
}

/// Returns the steps from the first to `head`, in order.
inline std::vector<int> steps_to(std::span<const int> before, int head) {
    std::vector<int> steps;
    for (int n = head; n >= 0; n = before[static_cast<std::size_t>(n)]) steps.push_back(n);
    return {steps.rbegin(), steps.rend()};
}

/// Returns whether `step` is on the branch from the root to `tip`; always true for -1.
inline bool is_on_way(std::span<const int> before, int step, int tip) {
    while (tip > step) tip = before[static_cast<std::size_t>(tip)];
    return tip == step;
}

}  // namespace tactus::fit
