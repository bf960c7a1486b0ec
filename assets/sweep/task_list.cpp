// SPDX-License-Identifier: Apache-2.0
#include "assets/sweep/task_list.hpp"

#include "assets/sweep/template_word.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "dsp/core/random.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>

namespace tactus::sweep {

namespace fs = std::filesystem;

namespace {

std::uint64_t template_hash(const Sweep& sweep, const std::function<std::uint64_t(const fs::path&)>& content_of) {
    Hash hash;
    hash.add_word(static_cast<std::uint64_t>(sweep_format));
    hash.add_word(sweep.seeds.is_independent ? 1 : 0);
    for (const auto& [name, path] : sweep.inputs) {
        hash.add_text(name);
        hash.add_word(content_of(path));
    }
    for (const Step& step : sweep.steps) {
        hash.add_word(step.is_own ? 1 : 2);
        for (const std::string& word : step.words) hash.add_text(word);
        hash.add_text(step.from);
        for (const KeptValue& value : step.values) {
            hash.add_text(value.name);
            hash.add_text(value.pointer);
        }
        for (const std::string& file : step.files) hash.add_text(file);
        for (const int code : step.accepted) hash.add_word(static_cast<std::uint64_t>(code));
    }
    return hash.value();
}

std::uint64_t level_hash(const Axis& axis, std::size_t index,
                         const std::function<std::uint64_t(const fs::path&)>& content_of) {
    Hash hash;
    hash.add_text(axis.name);
    // A row of a table is its content; its number in the file is not.
    if (axis.columns.empty()) hash.add_text(axis.levels[index].text);
    for (std::size_t c = 0; c < axis.columns.size(); ++c) {
        hash.add_text(axis.columns[c]);
        hash.add_text(axis.rows[index][c]);
    }
    if (!axis.files.empty()) hash.add_word(content_of(axis.files[index]));
    return hash.value();
}

/// Sizes of the digits of an index, the first the slowest: grid axes, the design, seeds.
struct Digits {
    std::vector<std::size_t> of_axis;  // index into `sizes`
    std::vector<std::size_t> sizes;

    explicit Digits(const Sweep& sweep) {
        for (const Axis& axis : sweep.axes) {
            of_axis.push_back(axis.kind == Axis::Kind::grid ? sizes.size() : 0);
            if (axis.kind == Axis::Kind::grid) sizes.push_back(axis.levels.size());
        }
        for (std::size_t a = 0; a < of_axis.size(); ++a)
            if (sweep.axes[a].kind == Axis::Kind::design) of_axis[a] = sizes.size();
        sizes.push_back(std::max<std::size_t>(sweep.samples, 1));
        sizes.push_back(sweep.seeds.count);
    }
};

}  // namespace

TaskList::TaskList(const Sweep& sweep, const std::function<std::uint64_t(const fs::path&)>& content_of)
    : sweep_(&sweep) {
    const std::size_t count = sweep.point_count();
    if (count > max_points) throw Error(fmt::format("the sweep has more than {} points", max_points));
    const std::uint64_t base = template_hash(sweep, content_of);
    const Digits digits(sweep);
    std::vector<std::vector<std::uint64_t>> levels;
    for (const Axis& axis : sweep.axes) {
        levels.emplace_back();
        for (std::size_t l = 0; l < axis.levels.size(); ++l) levels.back().push_back(level_hash(axis, l, content_of));
    }
    ids_.resize(count);
    std::vector<std::size_t> digit(digits.sizes.size(), 0);
    Hash all;
    for (std::size_t i = 0; i < count; ++i) {
        Hash hash{base};
        for (std::size_t a = 0; a < levels.size(); ++a) hash.add_word(levels[a][digit[digits.of_axis[a]]]);
        const std::uint64_t seed = sweep.seeds.first + digit.back();
        hash.add_word(seed);
        ids_[i] = hash.value();
        all.add_word(ids_[i]);
        for (std::size_t d = digit.size(); d-- > 0;) {
            if (++digit[d] < digits.sizes[d]) break;
            digit[d] = 0;
        }
    }
    hash_ = all.value();
    slots_.assign(std::bit_ceil(std::max<std::size_t>(2 * count, 2)), 0);
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = 0; i < count; ++i) {
        std::size_t slot = ids_[i] & mask;
        for (; slots_[slot] != 0; slot = (slot + 1) & mask)
            if (ids_[slots_[slot] - 1] == ids_[i])
                throw Error(fmt::format("{}: points {} and {} have the same inputs; remove a repeated level or row",
                                        sweep.file.string(), slots_[slot], i + 1));
        slots_[slot] = static_cast<std::uint32_t>(i + 1);
    }
}

std::optional<std::size_t> TaskList::find(std::uint64_t id) const {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t slot = id & mask; slots_[slot] != 0; slot = (slot + 1) & mask)
        if (ids_[slots_[slot] - 1] == id) return slots_[slot] - 1;
    return {};
}

Point TaskList::point(std::size_t index) const {
    const Digits digits(*sweep_);
    std::vector<std::size_t> digit(digits.sizes.size(), 0);
    std::size_t rest = index;
    for (std::size_t d = digit.size(); d-- > 0; rest /= digits.sizes[d]) digit[d] = rest % digits.sizes[d];
    Point point;
    for (const std::size_t d : digits.of_axis) point.levels.push_back(static_cast<std::uint32_t>(digit[d]));
    point.replicate = digit.back();
    // 53 bits: exact as a number in JSON and TOML.
    point.seed = sweep_->seeds.is_independent ? mix(ids_[index]) >> 11 : sweep_->seeds.first + point.replicate;
    return point;
}

std::string text_of_id(std::uint64_t id) { return fmt::format("{:016x}", id); }

std::optional<std::uint64_t> id_of_text(std::string_view text) {
    std::uint64_t id = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), id, 16);
    if (text.size() != 16 || failure != std::errc{} || end != text.data() + text.size()) return {};
    return id;
}

std::vector<std::string> words_of(const Sweep& sweep, const Step& step, const Point& point, std::uint64_t id,
                                  const fs::path& out, const fs::path& program) {
    const auto value = [&](const std::string& name) -> std::string {
        if (name == "seed") return std::to_string(point.seed);
        if (name == "out") return out.string();
        if (name == "point") return text_of_id(id);
        if (name == "tactus") return program.string();
        if (name.starts_with("inputs.")) return sweep.inputs.at(name.substr(7)).string();
        const std::size_t dot = name.find('.');
        const std::string part = dot == std::string::npos ? "" : name.substr(dot + 1);
        for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
            const Axis& axis = sweep.axes[a];
            if (axis.name != name.substr(0, dot)) continue;
            const std::size_t l = point.levels[a];
            if (part.empty()) return axis.files.empty() ? axis.levels[l].text : axis.files[l].string();
            if (part == "stem" && !axis.files.empty()) return axis.files[l].stem().string();
            if (part == "number" && axis.columns.empty()) return fmt::format("{}", axis.levels[l].number);
            return axis.rows[l][static_cast<std::size_t>(std::ranges::find(axis.columns, part) - axis.columns.begin())];
        }
        throw Error(fmt::format("'{{{}}}' is no name of the sweep", name));
    };
    std::vector<std::string> words;
    for (const std::string& word : step.words) words.push_back(fill_word(word, value));
    return words;
}

}  // namespace tactus::sweep
