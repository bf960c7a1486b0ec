// SPDX-License-Identifier: Apache-2.0
// The outputs of a group in a take: every value they published, as a multichannel sound file of doubles that audio
// editors open. A large value is stored as two numbers, the halves of its content hash.
#pragma once

#include "dsp/core/time.hpp"
#include "engine/io/frames.hpp"
#include "graph/node/value.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tactus::take {

/// One output in a file.
struct TakeStreamInfo {
    std::string file;       ///< within the take
    std::string port;       ///< "node.port"
    std::string group, type;
    int group_number = 0;    ///< as in the timing log: an edit can end a group and create another of that name
    Flicks period = 0;
    std::int64_t start = 0;  ///< activation of the file's first frame
    int channel = 0, channels = 1;  ///< its first channel, and the number of its channels
};

/// Largest number of channels of a file.
inline constexpr int max_channels = 1024;

/// Returns the names of a type's channels.
std::vector<std::string> channels_of(const ValueType& type);
/// Converts one value to the numbers of a frame.
void to_frame(const ValueType& type, const void* value, double* frame);

class TakeStreamWriter {
public:
    /// `path` appears immediately and is readable while it grows. `columns` of frames of `frame_bytes` bytes make at
    /// most `max_channels` channels; the first frame is that of activation `start`. Throws Error.
    TakeStreamWriter(const std::filesystem::path& path, Flicks period, std::int64_t start,
                     std::vector<io::FrameColumn> columns, std::size_t frame_bytes);
    ~TakeStreamWriter();
    TakeStreamWriter(const TakeStreamWriter&) = delete;
    TakeStreamWriter& operator=(const TakeStreamWriter&) = delete;

    /// Writes frames of activations first … first + count − 1. The previous frame is repeated where activations never
    /// ran.
    void write(std::int64_t first, const std::byte* frames, std::size_t count);
    /// Updates the length in the file's header.
    void update();
    void finish();
    std::int64_t frames() const;  ///< written so far

private:
    struct File;
    std::unique_ptr<File> file_;
};

/// Reads one output of a file.
class TakeStreamReader {
public:
    /// Throws Error.
    TakeStreamReader(const std::filesystem::path& path, const TakeStreamInfo& info);
    ~TakeStreamReader();
    TakeStreamReader(const TakeStreamReader&) = delete;
    TakeStreamReader& operator=(const TakeStreamReader&) = delete;

    int channels() const;  ///< of the output
    std::int64_t frames() const;  ///< in the file
    /// Positions the reader: the next requested frame must not precede that of `activation`.
    void seek(std::int64_t activation);
    /// Returns the output's part of the frame of an activation, or null if the file does not contain it. Activations
    /// must be requested in ascending order.
    const double* frame(std::int64_t activation);
    /// The same for another output of that file.
    const double* frame(std::int64_t activation, const TakeStreamInfo& other);

private:
    struct File;
    std::unique_ptr<File> file_;
};

}  // namespace tactus::take
