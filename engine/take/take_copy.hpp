// SPDX-License-Identifier: Apache-2.0
// Copy of a take with the values of its replay. A run of hours need not record values that its timing log repeats to the
// bit: they are computed on demand.
#pragma once

#include "engine/take/take_reader.hpp"
#include "engine/take/take_streams.hpp"

#include <memory>
#include <mutex>

namespace tactus::take {

class TakeCopy {
public:
    /// Creates `folder` with all of `from` except its values and its result. Throws Error, also if the folder exists.
    TakeCopy(const Take& from, std::filesystem::path folder);
    /// Removes the folder unless `finish` succeeded.
    ~TakeCopy();
    TakeCopy(const TakeCopy&) = delete;
    TakeCopy& operator=(const TakeCopy&) = delete;

    /// Returns the sink for the values of a group, for EngineOptions::tap.
    std::unique_ptr<io::Sink> sink(const io::FrameLayout& layout, const run::GroupRuntime& group) {
        return streams_.sink(folder_, layout, group);
    }
    /// Call after the replay, if its values are those of the run. Throws Error if values are missing.
    void finish();

private:
    void line(const std::string& json);

    const Take& from_;
    std::filesystem::path folder_;
    std::unique_ptr<file::GrowingFile> events_;
    std::mutex writing_;
    std::int64_t lines_ = 0;
    bool is_finished_ = false;
    TakeStreams streams_;
};

}  // namespace tactus::take
