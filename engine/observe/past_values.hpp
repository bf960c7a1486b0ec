// SPDX-License-Identifier: Apache-2.0
// History of an output's values in a run, by logical time. An observer can read any instant, in any order.
#pragma once

#include "dsp/core/time.hpp"
#include "engine/observe/observed_port.hpp"
#include "engine/observe/seen_values.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace tactus::observe {

/// Values of one size. Only changes are stored. When they would exceed the memory limit, every second value is dropped.
class PastValues {
public:
    explicit PastValues(std::size_t value_size) : size_(value_size) {}

    /// `when` must be later than all previous times.
    void add(Flicks when, const std::byte* value);
    /// Copies the last value at or before a time into `value` and returns its time. Empty if there is none.
    std::optional<Flicks> at(Flicks until, std::byte* value) const;
    std::size_t bytes() const { return values_.size() + when_.size() * sizeof(Flicks); }

    static constexpr std::size_t max_bytes = std::size_t{1} << 28;

private:
    void thin_out();

    std::size_t size_;
    Flicks spacing_ = 0;  ///< values closer than this to the previous one are dropped
    std::vector<Flicks> when_;
    std::vector<std::byte> values_;
};

/// The versions of a bone's bricks. It owns their samples; a bone set by `show` refers to them.
class PastBone {
public:
    /// Adds the bricks of a publication, and marks the publication as complete at its end.
    void add(Flicks when, ObservedPort::Piece& piece);
    /// Sets `bone` to its state at a time; all resulting changes count as one update. The bone's own bricks are the
    /// initial state.
    void show(Flicks until, SeenBone& bone) const;
    /// True if something was published at or before `until`.
    bool has_begun(Flicks until) const { return !published_.empty() && published_.front().when <= until; }
    std::size_t bytes() const { return bytes_; }

private:
    struct Publication {
        Flicks when;
        std::int64_t version;
    };
    struct Version {
        Flicks when;
        std::unique_ptr<float[]> samples;
    };

    std::vector<Publication> published_;
    std::vector<std::vector<Version>> bricks_;  ///< by brick, in order of time
    std::vector<std::uint32_t> changing_;  ///< those that have more than the initial version
    std::vector<ObservedPort::Piece> unfinished_;
    std::size_t bytes_ = 0;
};

}  // namespace tactus::observe
