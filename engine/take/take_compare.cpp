// SPDX-License-Identifier: Apache-2.0
#include "engine/take/take_compare.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace tactus::take {

namespace {

bool same_bits(const double* a, const double* b, std::size_t count) {
    return std::equal(a, a + count, b, [](double x, double y) {
        return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
    });
}

/// The part of a frame that one file of the take holds.
struct ComparedFile {
    struct Output {
        TakeStreamInfo info;
        io::FrameColumn column;
        bool differs = false;
    };
    std::vector<Output> outputs;
    std::unique_ptr<TakeStreamReader> reader;
    bool is_over = false;

    const TakeStreamInfo& first() const { return outputs.front().info; }
};

class CompareSink : public io::Sink {
public:
    CompareSink(TakeComparison& comparison, const Take& take, std::vector<ComparedFile> files, std::size_t frame_bytes)
        : comparison_(comparison), folder_(take.folder), files_(std::move(files)), frame_bytes_(frame_bytes) {}

    void take(std::int64_t first, const std::byte* frames, std::size_t count) override {
        std::uint64_t compared = 0;
        for (ComparedFile& file : files_)
            for (std::size_t i = 0; i < count; ++i)
                compared += compare(file, first + static_cast<std::int64_t>(i), frames + i * frame_bytes_);
        comparison_.count(compared);
    }
    void finish() override {}

private:
    /// Returns how many values it compared: 0 where the file has no frame.
    std::uint64_t compare(ComparedFile& file, std::int64_t tick, const std::byte* frame) {
        if (file.is_over || tick < file.first().start) return 0;
        if (!file.reader) file.reader = std::make_unique<TakeStreamReader>(folder_ / file.first().file, file.first());
        if (!file.reader->frame(tick)) {
            file.is_over = true;
            file.reader.reset();
            return 0;
        }
        std::uint64_t compared = 0;
        for (ComparedFile::Output& output : file.outputs) {
            // What follows a difference differs too.
            if (output.differs) continue;
            const double* expected = file.reader->frame(tick, output.info);
            const auto wide = static_cast<std::size_t>(output.info.channels);
            got_.resize(wide);
            to_frame(*output.column.type, frame + output.column.offset, got_.data());
            ++compared;
            output.differs = !same_bits(expected, got_.data(), wide);
            if (output.differs)
                comparison_.differs({output.info.port,
                                     tick,
                                     seconds(tick * output.info.period),
                                     channels_of(*output.column.type),
                                     {expected, expected + wide},
                                     got_});
        }
        return compared;
    }

    TakeComparison& comparison_;
    std::filesystem::path folder_;
    std::vector<ComparedFile> files_;
    std::size_t frame_bytes_;
    std::vector<double> got_;
};

}  // namespace

std::unique_ptr<io::Sink> TakeComparison::tap(const io::FrameLayout& layout, const run::GroupRuntime& group) {
    std::map<std::string, ComparedFile> files;
    std::unordered_map<std::string_view, const io::FrameColumn*> columns;
    for (const io::FrameColumn& column : layout.columns) columns.emplace(column.port, &column);
    for (const TakeStreamInfo& stream : take_.streams) {
        const auto column = columns.find(stream.port);
        if (stream.group_number != group.index || column == columns.end() || stream.type != column->second->type->name)
            continue;
        const auto wide = channels_of(*column->second->type).size();
        if (static_cast<std::size_t>(stream.channels) != wide)
            throw Error(fmt::format("{}: {} channels of {}, but a {} has {}", stream.file, stream.channels, stream.port,
                                    stream.type, wide));
        files[stream.file].outputs.push_back({stream, *column->second, false});
    }
    if (files.empty()) return nullptr;
    std::vector<ComparedFile> list;
    for (auto& [name, file] : files) list.push_back(std::move(file));
    return std::make_unique<CompareSink>(*this, take_, std::move(list), layout.bytes);
}

void TakeComparison::count(std::uint64_t values) {
    const std::lock_guard lock(lock_);
    compared_ += values;
}

void TakeComparison::differs(TakeDifference difference) {
    const std::lock_guard lock(lock_);
    if (!first_ || std::tie(difference.time, difference.port) < std::tie(first_->time, first_->port))
        first_ = std::move(difference);
}

}  // namespace tactus::take
