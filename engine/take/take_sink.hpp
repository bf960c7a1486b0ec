// SPDX-License-Identifier: Apache-2.0
// Where the outputs of one group go in a take.
#pragma once

#include "engine/io/streams.hpp"
#include "engine/take/take_stream.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tactus::take {

/// One file, and the outputs in it.
struct TakeFile {
    std::string name;  ///< within the take
    std::vector<io::FrameColumn> columns;
};

/// Opens its files with the first frames, which say at which activation the files begin.
class TakeSink : public io::Sink {
public:
    struct Told {
        std::function<void(const TakeFile&, std::int64_t start)> opened;
        std::function<void(const std::string& file, std::int64_t frames)> finished;
        std::function<void()> cut;  ///< some values are not kept
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
    std::vector<std::unique_ptr<TakeStreamWriter>> writers_;  // of the files that are open
    std::int64_t update_ns_ = 0;  // of the next update; a run that is killed soon has its first values
};

}  // namespace tactus::take
