// SPDX-License-Identifier: Apache-2.0
// The points of a sweep. A point is named by the hash of all that its result depends on: the template, the contents of
// the inputs, the levels and the seed; neither by its place in the list nor by the program that runs it. So a sweep that
// gets more levels keeps the points that it shares with the former one.
#pragma once

#include "assets/sweep/sweep_file.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tactus::sweep {

/// One point: the level of each axis, and its seed.
struct Point {
    std::vector<std::uint32_t> levels;  ///< indices, in the order of Sweep::axes
    std::size_t replicate = 0;  ///< index of its seed
    std::uint64_t seed = 0;
};

/// At most 24 bytes per point, beside the levels; points are computed from their index on demand. The last axis changes
/// fastest but for the seed, which changes fastest of all.
class TaskList {
public:
    /// `content_of`: hash of an input or a file of an axis, called once for each. Throws Error when two points have the
    /// same inputs.
    TaskList(const Sweep& sweep, const std::function<std::uint64_t(const std::filesystem::path&)>& content_of);

    const Sweep& sweep() const { return *sweep_; }
    std::size_t size() const { return ids_.size(); }
    std::uint64_t id(std::size_t index) const { return ids_[index]; }
    std::optional<std::size_t> find(std::uint64_t id) const;
    Point point(std::size_t index) const;
    /// Of all points and their order.
    std::uint64_t hash() const { return hash_; }

private:
    const Sweep* sweep_;
    std::vector<std::uint64_t> ids_;
    std::vector<std::uint32_t> slots_;  // open addressing: index + 1, 0 is free
    std::uint64_t hash_ = 0;
};

/// 16 hexadecimal digits.
std::string text_of_id(std::uint64_t id);
/// Nothing for other texts.
std::optional<std::uint64_t> id_of_text(std::string_view text);

/// The words of a step at a point. `out`: the point's folder; `program`: this program. Inputs and files are absolute.
std::vector<std::string> words_of(const Sweep& sweep, const Step& step, const Point& point, std::uint64_t id,
                                  const std::filesystem::path& out, const std::filesystem::path& program);

}  // namespace tactus::sweep
