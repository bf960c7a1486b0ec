// SPDX-License-Identifier: Apache-2.0
#include "engine/take/take_streams.hpp"

#include "assets/file/json.hpp"
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
    {
        const std::lock_guard lock(guard_);
        bytes_per_second_ += sizeof(double) * all * rate_of(group.plan->period);
    }
    return std::make_unique<TakeSink>(
        folder, group.plan->period, layout.bytes, std::move(files),
        TakeSink::Told{
            .opened = [this, &group](const TakeFile& file, std::int64_t start) { opened(file, start, group); },
            .finished =
                [this](const std::string& file, std::int64_t frames) {
                    const std::lock_guard lock(guard_);
                    frames_[file] = frames;
                },
            .end = [this, period = group.plan->period] { return end_of(period); },
            .ended = [this] { limited(); },
            .cut = [this] { is_cut_ = true; }});
}

std::map<std::string, std::int64_t> TakeStreams::frames() const {
    const std::lock_guard lock(guard_);
    return frames_;
}

void TakeStreams::limit(std::uint64_t bytes) {
    const std::lock_guard lock(guard_);
    max_bytes_ = bytes;
}

std::optional<double> TakeStreams::limited_at() const {
    const std::lock_guard lock(guard_);
    return limited_at_;
}

std::int64_t TakeStreams::end_of(Flicks period) const {
    const std::lock_guard lock(guard_);
    if (max_bytes_ == 0 || !(bytes_per_second_ > 0.0)) return std::numeric_limits<std::int64_t>::max();
    return static_cast<std::int64_t>(static_cast<double>(max_bytes_) / bytes_per_second_ / seconds(period));
}

void TakeStreams::limited() {
    {
        const std::lock_guard lock(guard_);
        if (limited_at_) return;
        limited_at_ = static_cast<double>(max_bytes_) / bytes_per_second_;
    }
    write_line_(Json{{"values_end_s", *limited_at()}}.dump());
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
