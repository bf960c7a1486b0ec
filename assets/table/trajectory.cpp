// SPDX-License-Identifier: Apache-2.0
#include "assets/table/trajectory.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>

namespace tactus::table {
namespace {

struct Field {
    std::string_view text;
    int column = 0;  // position of its first character, from 1
};

std::vector<Field> split(std::string_view line) {
    std::vector<Field> fields;
    for (std::size_t begin = 0;;) {
        const std::size_t end = std::min(line.find(',', begin), line.size());
        std::size_t first = begin, last = end;
        while (first < last && (line[first] == ' ' || line[first] == '\t')) ++first;
        while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t')) --last;
        fields.push_back({line.substr(first, last - first), static_cast<int>(first) + 1});
        if (end == line.size()) return fields;
        begin = end + 1;
    }
}

/// A column and its factor to SI.
struct Column {
    std::size_t index = 0;
    double factor = 1.0;
};

struct Unit {
    std::string_view suffix;
    double factor;
};
constexpr std::array<Unit, 2> times{{{"_s", 1.0}, {"_ms", 1e-3}}};
constexpr std::array<Unit, 3> lengths{{{"_mm", 1e-3}, {"_cm", 1e-2}, {"_m", 1.0}}};
constexpr std::array<Unit, 1> forces{{{"_N", 1.0}}};
constexpr std::array<Unit, 1> without_unit{{{"", 1.0}}};

class TrajectoryReader {
public:
    TrajectoryReader(const std::filesystem::path& path, const TrajectorySelection& selection)
        : file_(path.string()), selection_(selection) {
        if (std::filesystem::exists(path)) file::require_file(path);
        stream_.open(path);
        if (!stream_) throw Error(fmt::format("{}: cannot be read", file_));
        std::string line;
        if (!next(line)) fail(1, "the file is empty; a header line with column names is needed");
        header_ = std::move(line);
        if (header_.starts_with("\xef\xbb\xbf")) header_.erase(0, 3);
        for (const Field& field : split(header_)) names_.emplace_back(field.text);
        prefix_ = selection.tool.empty() ? "" : selection.tool + "_";
        time_ = need("", "t", times);
        for (std::size_t i = 0; i < 3; ++i) position_[i] = need(prefix_, position_names[i], lengths);
        for (std::size_t i = 0; i < 4; ++i) rotation_[i] = need(prefix_, rotation_names[i], without_unit);
        for (std::size_t i = 0; i < 3; ++i) force_[i] = find(prefix_, force_names[i], forces);
        trial_ = find("", "trial", without_unit);
        status_ = find(prefix_, "status", without_unit);
        if (selection.trial != 0 && !trial_) fail(1, "there is no column 'trial' to choose a trial by");
    }

    Trajectory read() {
        Trajectory out;
        std::string line;
        while (next(line))
            if (!line.empty()) row(line, out);
        if (out.samples.empty()) {
            if (out.lost > 0) fail(0, "all samples of the tool are lost; choose another tool");
            if (selection_.trial == 0) fail(0, "the file has a header but no samples");
            fail(0, fmt::format("there is no trial {}; there are {}", selection_.trial, fmt::join(trials_, ", ")));
        }
        out.median_step_s = median_step(out.samples);
        return out;
    }

private:
    static constexpr std::array<std::string_view, 3> position_names{"px", "py", "pz"};
    static constexpr std::array<std::string_view, 4> rotation_names{"qw", "qx", "qy", "qz"};
    static constexpr std::array<std::string_view, 3> force_names{"fx", "fy", "fz"};
    static constexpr std::size_t longest_line = 64 * 1024;

    [[noreturn]] void fail(int column, const std::string& message) const {
        throw Error(SourceLocation{file_, column == 0 ? 0 : std::max(line_, 1), column}, message);
    }

    bool next(std::string& line) {
        ++line_;
        if (!std::getline(stream_, line)) return false;
        if (line.size() > longest_line) fail(1, "the line is longer than 64 KiB; this is not a CSV of a trajectory");
        if (!line.empty() && line.back() == '\r') line.pop_back();
        return true;
    }

    std::optional<Column> find(const std::string& prefix, std::string_view base, std::span<const Unit> units) const {
        for (const Unit& unit : units) {
            const auto found =
                std::find(names_.begin(), names_.end(), fmt::format("{}{}{}", prefix, base, unit.suffix));
            if (found != names_.end()) return Column{static_cast<std::size_t>(found - names_.begin()), unit.factor};
        }
        return std::nullopt;
    }

    Column need(const std::string& prefix, std::string_view base, std::span<const Unit> units) const {
        if (const auto column = find(prefix, base, units)) return *column;
        std::vector<std::string> wanted;
        for (const Unit& unit : units) wanted.push_back(fmt::format("{}{}{}", prefix, base, unit.suffix));
        fail(1, fmt::format("there is no column {}{}", fmt::join(wanted, " or "), tools()));
    }

    /// The tools in the file, for the message about a missing column.
    std::string tools() const {
        std::vector<std::string> found;
        for (const std::string& name : names_)
            if (const std::size_t at = name.find("_px_"); at != std::string::npos && at > 0)
                found.push_back(name.substr(0, at));
        return found.empty() ? ""
                             : fmt::format("; the file has the tools {}: name one as the device's option 'tool'",
                                           fmt::join(found, ", "));
    }

    double number(const Field& field, std::string_view name) const {
        double value = 0.0;
        const char* const end = field.text.data() + field.text.size();
        const auto [stop, error] = std::from_chars(field.text.data(), end, value);
        if (error != std::errc{} || stop != end || !std::isfinite(value))
            fail(field.column, fmt::format("'{}' in column {} is not a finite number", field.text, name));
        return value;
    }

    void row(std::string_view line, Trajectory& out) {
        const std::vector<Field> fields = split(line);
        if (fields.size() != names_.size())
            fail(1, fmt::format("the line has {} fields, the header has {}", fields.size(), names_.size()));
        const auto value = [&](const Column& c) { return number(fields[c.index], names_[c.index]) * c.factor; };
        const double time = value(time_);
        if (has_time_ && time <= last_time_)
            fail(fields[time_.index].column,
                 fmt::format("time {} s comes after {} s; times must increase", time, last_time_));
        last_time_ = time;
        has_time_ = true;
        if (trial_) {
            const double trial = value(*trial_);
            if (trials_.empty() || trials_.back() != trial) {
                begins_trial_ = true;
                trials_.push_back(trial);
            }
            if (selection_.trial != 0 && trial != selection_.trial) return;
        }
        if (status_ && fields[status_->index].text != "OK") {
            ++out.lost;
            return;
        }
        simulate::TrajectorySample sample;
        sample.time = time;
        for (int i = 0; i < 3; ++i) sample.pose.position[i] = value(position_[static_cast<std::size_t>(i)]);
        const Quat q(value(rotation_[0]), value(rotation_[1]), value(rotation_[2]), value(rotation_[3]));
        const double length = std::sqrt(glm::dot(q, q));
        if (!(std::abs(length - 1.0) <= 0.01))
            fail(fields[rotation_[1].index].column,
                 fmt::format("the quaternion has length {:.4g}; a rotation must have length 1", length));
        sample.pose.orientation = q / length;
        if (begins_trial_ && !out.samples.empty()) out.breaks.push_back(out.samples.size());
        begins_trial_ = false;
        out.samples.push_back(sample);
        if (force_[0] && force_[1] && force_[2])
            out.forces.push_back({value(*force_[0]), value(*force_[1]), value(*force_[2])});
    }

    static double median_step(const std::vector<simulate::TrajectorySample>& samples) {
        if (samples.size() < 2) return 0.0;
        std::vector<double> steps;
        for (std::size_t i = 1; i < samples.size(); ++i) steps.push_back(samples[i].time - samples[i - 1].time);
        const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
        std::nth_element(steps.begin(), middle, steps.end());
        return *middle;
    }

    std::string file_;
    TrajectorySelection selection_;
    std::ifstream stream_;
    std::string header_, prefix_;
    std::vector<std::string> names_;
    Column time_;
    std::array<Column, 3> position_;
    std::array<Column, 4> rotation_;
    std::array<std::optional<Column>, 3> force_;
    std::optional<Column> trial_, status_;
    std::vector<double> trials_;
    int line_ = 0;
    double last_time_ = 0.0;
    bool has_time_ = false;
    bool begins_trial_ = false;  // of the next sample that is kept: the first of a trial may be lost
};

}  // namespace

simulate::TrajectoryRules Trajectory::rules() const {
    simulate::TrajectoryRules rules;
    rules.max_gap_s = std::max(rules.max_gap_s, 1.5 * median_step_s);
    return rules;
}

Trajectory read_trajectory(const std::filesystem::path& path, const TrajectorySelection& selection) {
    return TrajectoryReader(path, selection).read();
}

}  // namespace tactus::table
