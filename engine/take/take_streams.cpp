// SPDX-License-Identifier: Apache-2.0
#include "engine/take/take_streams.hpp"

#include "assets/file/json.hpp"
#include "dsp/core/constants.hpp"
#include "engine/run/group_runtime.hpp"
#include "engine/take/take_sink.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>

namespace tactus::take {

using file::Json;

std::string TakeStreams::file_for(const std::string& group) {
    std::string name = group;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-' && c != '_') c = '-';
    if (name.starts_with('.')) name.front() = '-';
    std::string stem = "streams/" + name;
    for (int again = 2; files_.contains(stem); ++again) stem = fmt::format("streams/{}-{}", name, again);
    files_.insert(stem);
    return stem + ".wav";
}

std::unique_ptr<io::Sink> TakeStreams::sink(const std::filesystem::path& folder, const io::FrameLayout& layout,
                                            const run::GroupRuntime& group) {
    std::vector<TakeFile> files;
    int channels = max_channels, all = 0;
    for (const io::FrameColumn& column : layout.columns) {
        const auto wide = static_cast<int>(channels_of(*column.type).size());
        if (channels + wide > max_channels) {
            files.push_back({file_for(group.plan->name), {}});
            channels = 0;
        }
        files.back().columns.push_back(column);
        channels += wide;
        all += wide;
    }
    std::size_t part = 0;
    {
        const std::lock_guard lock(guard_);
        part = parts_.size();
        // What the run begins with counts before its first values; a group that an edit changes, from its first frame on.
        const bool is_first =
            std::ranges::none_of(parts_, [&](const Part& p) { return p.group == group.index || p.has_values; });
        parts_.push_back(
            {group.index, sizeof(double) * all * rate_of(group.plan->period), is_first ? 0.0 : infinity, infinity});
        find_full();
    }
    return std::make_unique<TakeSink>(
        folder, group.plan->period, layout.bytes, std::move(files),
        TakeSink::Told{
            .opened = [this, &group](const TakeFile& file, std::int64_t start) { opened(file, start, group); },
            .finished =
                [this, part, period = group.plan->period](const std::string& file, std::int64_t frames) {
                    const std::lock_guard lock(guard_);
                    frames_[file] = frames;
                    Part& own = parts_[part];
                    own.end = std::min(own.end, own.begin + static_cast<double>(frames) * seconds(period));
                    find_full();
                },
            .end = [this, part,
                    period = group.plan->period](std::int64_t first) { return end_of(part, first, period); },
            .ended = [this, period = group.plan->period](std::int64_t end) { limited(seconds(end * period)); },
            .cut = [this] { is_cut_ = true; }});
}

std::map<std::string, std::int64_t> TakeStreams::frames() const {
    const std::lock_guard lock(guard_);
    return frames_;
}

void TakeStreams::limit(std::uint64_t bytes) {
    const std::lock_guard lock(guard_);
    max_bytes_ = bytes;
    find_full();
}

std::optional<double> TakeStreams::limited_at() const {
    const std::lock_guard lock(guard_);
    return limited_at_;
}

std::int64_t TakeStreams::end_of(std::size_t part, std::int64_t first, Flicks period) {
    const std::lock_guard lock(guard_);
    Part& own = parts_[part];
    const double now = seconds(first * period);
    if (!own.has_values) {
        own.has_values = true;
        // The group changes from one part to the next.
        for (Part& other : parts_)
            if (other.group == own.group && other.begin < now) other.end = std::min(other.end, now);
        own.begin = now;
        find_full();
    }
    const double end = full_at_ / seconds(period);
    return end < 1e18 ? static_cast<std::int64_t>(end) : std::numeric_limits<std::int64_t>::max();
}

void TakeStreams::find_full() {
    full_at_ = infinity;
    if (max_bytes_ == 0) return;
    std::map<double, double> changes;  // of bytes per second, by time
    for (const Part& part : parts_) {
        if (part.begin == infinity) continue;
        changes[part.begin] += part.bytes_per_second;
        changes[part.end] -= part.bytes_per_second;
    }
    const auto most = static_cast<double>(max_bytes_);
    double at = 0.0, bytes = 0.0, rate = 0.0;
    for (const auto& [time, change] : changes) {
        const double then = rate > 0.0 ? bytes + rate * (time - at) : bytes;
        if (then >= most) {
            full_at_ = at + (most - bytes) / rate;
            return;
        }
        at = time;
        bytes = then;
        rate += change;
    }
}

void TakeStreams::limited(double end) {
    {
        const std::lock_guard lock(guard_);
        if (limited_at_ && *limited_at_ <= end) return;
        limited_at_ = end;
    }
    write_line_(Json{{"values_end_s", end}}.dump());
}

void TakeStreams::opened(const TakeFile& file, std::int64_t start, const run::GroupRuntime& group) {
    Json outputs = Json::array();
    for (const io::FrameColumn& column : file.columns)
        outputs.push_back(
            {{"port", column.port}, {"type", column.type->name}, {"channels", channels_of(*column.type)}});
    write_line_(Json{
        {"stream", file.name},
        {"group", group.plan->name},
        {"group_number", group.index},
        {"period_flicks", group.plan->period},
        {"rate_hz", rate_of(group.plan->period)},
        {"start", start},
        {"outputs",
         outputs}}.dump());
}

}  // namespace tactus::take
