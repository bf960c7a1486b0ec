// SPDX-License-Identifier: Apache-2.0
#include "engine/observe/past_values.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace tactus::observe {

void PastValues::add(Flicks when, const std::byte* value) {
    if (!when_.empty()) {
        if (when < when_.back() + spacing_) return;
        if (std::equal(value, value + size_, values_.end() - static_cast<std::ptrdiff_t>(size_))) return;
    }
    when_.push_back(when);
    values_.insert(values_.end(), value, value + size_);
    if (bytes() > max_bytes) thin_out();
}

/// Half as many from now on, as far as they are close to each other.
void PastValues::thin_out() {
    spacing_ = std::max(2 * spacing_, 2 * (when_.back() - when_.front()) / static_cast<Flicks>(when_.size()));
    std::size_t kept = 1;
    for (std::size_t i = 1; i < when_.size(); ++i) {
        if (when_[i] < when_[kept - 1] + spacing_) continue;
        when_[kept] = when_[i];
        std::memmove(values_.data() + kept * size_, values_.data() + i * size_, size_);
        ++kept;
    }
    when_.resize(kept);
    values_.resize(kept * size_);
}

std::optional<Flicks> PastValues::at(Flicks until, std::byte* value) const {
    const auto past = std::ranges::upper_bound(when_, until) - when_.begin();
    if (past == 0) return std::nullopt;
    const auto i = static_cast<std::size_t>(past - 1);
    std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(i * size_), size_, value);
    return when_[i];
}

void PastBone::add(Flicks when, ObservedPort::Piece& piece) {
    if (piece.brick >= 0) {
        unfinished_.push_back(std::move(piece));
        return;
    }
    for (ObservedPort::Piece& brick : unfinished_) {
        const auto b = static_cast<std::size_t>(brick.brick);
        if (bricks_.size() <= b) bricks_.resize(b + 1);
        if (bricks_[b].empty()) changing_.push_back(static_cast<std::uint32_t>(b));
        bricks_[b].push_back({when, std::move(brick.samples)});
        bytes_ += volume::brick_samples * sizeof(float);
    }
    unfinished_.clear();
    published_.push_back({when, piece.version});
}

void PastBone::show(Flicks until, SeenBone& bone) const {
    bool changes = false;
    for (const std::uint32_t b : changing_) {
        const auto& versions = bricks_[b];
        const auto past = std::ranges::upper_bound(versions, until, {}, &Version::when);
        const float* wanted = past == versions.begin() ? bone.distance[b].get() : std::prev(past)->samples.get();
        if (bone.root.distance[b] == wanted) continue;
        if (!std::exchange(changes, true)) ++bone.update;
        bone.root.distance[b] = wanted;
        bone.changed_at[b] = bone.update;
    }
    const auto past = std::ranges::upper_bound(published_, until, {}, &Publication::when);
    bone.version = past == published_.begin() ? bone.first_version : std::prev(past)->version;
    bone.when = past == published_.begin() ? 0 : std::prev(past)->when;
}

}  // namespace tactus::observe
