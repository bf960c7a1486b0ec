// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <algorithm>

#include <utility>
#include <vector>

namespace tactus {

std::string Error::format(const SourceLocation& where, const std::string& message) {
    if (where.file.empty()) return message;
    if (where.line == 0) return fmt::format("{}: {}", where.file, message);
    return fmt::format("{}:{}:{}: {}", where.file, where.line, where.column, message);
}

namespace {

/// Insertions, deletions, replacements, and two neighbours exchanged (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
            const bool is_exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (is_exchanged) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, above);
        std::swap(above, row);
    }
    return above[b.size()];
}

}  // namespace

std::string did_you_mean(std::string_view word, std::span<const std::string> candidates) {
    const std::string* best = nullptr;
    // More edits than half of the word's length give no useful suggestion.
    std::size_t least = 2 * std::max<std::size_t>(2, word.size() / 2) + 1;
    for (const std::string& candidate : candidates) {
        const bool prefix = word.size() >= 2 && (candidate.starts_with(word) || word.starts_with(candidate));
        // A prefix counts as one and a half edits: less likely than one wrong letter, and more than two.
        std::size_t distance = 2 * edit_distance(word, candidate);
        if (prefix) distance = std::min<std::size_t>(distance, 3);
        if (distance < least) {
            least = distance;
            best = &candidate;
        }
    }
    return best ? fmt::format("; did you mean '{}'?", *best) : "";
}

}  // namespace tactus
