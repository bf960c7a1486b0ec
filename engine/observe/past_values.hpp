// SPDX-License-Identifier: Apache-2.0
// All values of an output in a run, by logical time. An observer can look at any instant, in any order.
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

/// Values of one size. Only changes are stored. When they would take too much memory, every second one is dropped.
class PastValues {
public:
    explicit PastValues(std::size_t value_size) : size_(value_size) {}

    /// Later than all before.
    void add(Flicks when, const std::byte* value);
    /// The last at or before a time: its time, and the value into `value`. None: there was none yet.
    std::optional<Flicks> at(Flicks until, std::byte* value) const;
    std::size_t bytes() const { return values_.size() + when_.size() * sizeof(Flicks); }

    static constexpr std::size_t most_bytes = std::size_t{1} << 28;

private:
    void thin_out();

    std::size_t size_;
    Flicks spacing_ = 0;  ///< values closer to the one before are left out
    std::vector<Flicks> when_;
    std::vector<std::byte> values_;
};

/// The versions of a bone's bricks. They own their samples; a bone that shows them refers to these.
class PastBone {
public:
    /// Adds the bricks of a publication, and at its end marks it as complete.
    void add(Flicks when, ObservedPort::Piece& piece);
    /// Makes `bone` what it was at a time; what changes by that counts as one update. Its own bricks are the first.
    void show(Flicks until, SeenBone& bone) const;
    /// Something was published at or before.
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
    std::vector<std::uint32_t> changing_;  ///< those that have versions
    std::vector<ObservedPort::Piece> unfinished_;
    std::size_t bytes_ = 0;
};

}  // namespace tactus::observe
