// SPDX-License-Identifier: Apache-2.0
// Writes the outputs of one group to a take.
#pragma once

#include "engine/io/streams.hpp"
#include "engine/take/take_stream.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tactus::take {

/// One file and its outputs.
struct TakeFile {
    std::string name;  ///< within the take
    std::vector<io::FrameColumn> columns;
};

/// Opens its files at the first frame, whose activation is the start of the files.
class TakeSink : public io::Sink {
public:
    struct Told {
        std::function<void(const TakeFile&, std::int64_t start)> opened;
        std::function<void(const std::string& file, std::int64_t frames)> finished;
        /// First activation without values, asked for before frames from `first` on are written.
        std::function<std::int64_t(std::int64_t first)> end;
        std::function<void(std::int64_t end)> ended;  ///< called when values reached it
        std::function<void()> cut;  ///< called when values are lost
    };
    TakeSink(std::filesystem::path folder, Flicks period, std::size_t frame_bytes, std::vector<TakeFile> files,
             Told told);

    void take(std::int64_t first, const std::byte* frames, std::size_t count) override;
    void finish() override;

private:
    void write(std::int64_t first, const std::byte* frames, std::size_t count);

    const std::filesystem::path folder_;
    const Flicks period_;
    const std::size_t frame_bytes_;
    const std::vector<TakeFile> files_;
    const Told told_;
    std::vector<std::unique_ptr<TakeStreamWriter>> writers_;  // of the open files
    bool is_over_ = false;
    std::int64_t update_ns_ = 0;  // time of the next header update; early, so that the first values survive a crash
};

}  // namespace tactus::take
