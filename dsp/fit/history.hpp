// SPDX-License-Identifier: Apache-2.0
// Steps that can be undone without end: a tree in which every step knows the one before it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::fit {

/// A way through the tree: the steps from the root to `head` are done, those from there to `tip` can be redone. Root:
/// -1.
struct HistoryPlace {
    int head = -1, tip = -1;
};

/// The place after a step that was made at the head: what could be redone from there is left aside.
constexpr HistoryPlace after_step(int step) { return {step, step}; }

// In what follows before[n] is the step before step n, which is smaller than n, or -1 for a first one.

/// One step back; the same place at the root.
inline HistoryPlace undone(std::span<const int> before, HistoryPlace at) {
    if (at.head < 0) return at;
    return {before[static_cast<std::size_t>(at.head)], at.tip};
}

/// One step on towards the tip; the same place at the tip.
inline HistoryPlace redone(std::span<const int> before, HistoryPlace at) {
    int next = at.tip;
    while (next >= 0 && next != at.head && before[static_cast<std::size_t>(next)] != at.head)
        next = before[static_cast<std::size_t>(next)];
    if (next < 0 || next == at.head) return at;
    return {next, at.tip};
}

/// The steps from the first to `head`, in their order.
inline std::vector<int> steps_to(std::span<const int> before, int head) {
    std::vector<int> steps;
    for (int n = head; n >= 0; n = before[static_cast<std::size_t>(n)]) steps.push_back(n);
    return {steps.rbegin(), steps.rend()};
}

/// Whether `step` lies on the way from the root to `tip`; -1 always does.
inline bool is_on_way(std::span<const int> before, int step, int tip) {
    while (tip > step) tip = before[static_cast<std::size_t>(tip)];
    return tip == step;
}

}  // namespace tactus::fit
