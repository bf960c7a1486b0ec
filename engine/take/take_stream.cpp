// SPDX-License-Identifier: Apache-2.0
#include "engine/take/take_stream.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/sound/open_sound.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tactus::take {

namespace {

constexpr std::size_t numbers_at_once = 1 << 16;

std::size_t frames_at_once(std::size_t channels) {
    return std::clamp<std::size_t>(numbers_at_once / channels, 1, 1024);
}

/// The track names that audio editors show, as the iXML chunk has them.
void write_names(SNDFILE* file, const std::vector<std::string>& names) {
    std::string xml = fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?><BWFXML><TRACK_LIST><TRACK_COUNT>{}"
        "</TRACK_COUNT>",
        names.size());
    for (std::size_t i = 0; i < names.size(); ++i)
        xml += fmt::format(
            "<TRACK><CHANNEL_INDEX>{0}</CHANNEL_INDEX><INTERLEAVE_INDEX>{0}</INTERLEAVE_INDEX>"
            "<NAME>{1}</NAME></TRACK>",
            i + 1, names[i]);
    xml += "</TRACK_LIST></BWFXML>";
    // libsndfile holds headers of up to 100 kB in a buffer that it doubles: beyond half of that it writes a chunk without
    // its content, and nobody can read the file. The take lists the channels, too.
    constexpr std::size_t max_bytes = 40'000;
    if (xml.size() > max_bytes) return;
    if (xml.size() % 2 != 0) xml += ' ';
    SF_CHUNK_INFO chunk{};
    std::memcpy(chunk.id, "iXML", 4);
    chunk.id_size = 4;
    chunk.datalen = static_cast<unsigned>(xml.size());
    chunk.data = xml.data();
    sf_set_chunk(file, &chunk);
}

}  // namespace

std::vector<std::string> channels_of(const ValueType& type) {
    if (type.columns.empty()) return {"hash_high", "hash_low"};
    return {type.columns.begin(), type.columns.end()};
}

void to_frame(const ValueType& type, const void* value, double* frame) {
    if (type.to_columns) {
        type.to_columns(value, frame);
        return;
    }
    Hash hash;
    type.hash(hash, value);
    frame[0] = static_cast<double>(hash.value() >> 32);
    frame[1] = static_cast<double>(hash.value() & 0xffffffffu);
}

namespace {

struct Track {
    const ValueType& type;
    std::size_t offset;   // in the frame, bytes
    std::size_t channel;  // the first
};

}  // namespace

struct TakeStreamWriter::File {
    std::filesystem::path path;
    std::vector<Track> tracks;
    std::size_t frame_bytes;
    std::int64_t start, next;
    sound::SoundHandle handle;
    std::size_t channels = 0;
    std::vector<double> frames, last;
    sf_count_t written = 0;  // frames

    void put(const double* from, std::size_t count) {
        const auto wanted = static_cast<sf_count_t>(count);
        const sf_count_t some = sf_writef_double(handle.get(), from, wanted);
        written += std::max<sf_count_t>(some, 0);
        if (some == wanted) return;
        const std::string why = sf_strerror(handle.get());
        sound::keep_whole_frames(handle.get(), written);
        throw Error(fmt::format("{}: cannot write: {}", path.string(), why));
    }
};

TakeStreamWriter::TakeStreamWriter(const std::filesystem::path& path, Flicks period, std::int64_t start,
                                   std::vector<io::FrameColumn> columns, std::size_t frame_bytes)
    : file_(std::make_unique<File>(File{path, {}, frame_bytes, start, start, {}, 0, {}, {}, 0})) {
    std::vector<std::string> names;
    for (const io::FrameColumn& column : columns) {
        file_->tracks.push_back({*column.type, column.offset, names.size()});
        const std::vector<std::string> channels = channels_of(*column.type);
        for (const std::string& channel : channels)
            names.push_back(channels.size() == 1 ? column.port : fmt::format("{} {}", column.port, channel));
    }
    file_->channels = names.size();
    file_->frames.resize(frames_at_once(names.size()) * names.size());
    file_->last.resize(names.size());
    SF_INFO format{};
    format.channels = static_cast<int>(names.size());
    format.samplerate = static_cast<int>(std::max<long>(1, std::lround(rate_of(period))));
    format.format = SF_FORMAT_RF64 | SF_FORMAT_DOUBLE;
    file_->handle.reset(sf_open(path.c_str(), SFM_WRITE, &format));
    if (!file_->handle) throw Error(fmt::format("{}: cannot write: {}", path.string(), sf_strerror(nullptr)));
    // The PEAK chunk carries the time of writing: without it the same values give the same bytes.
    sf_command(file_->handle.get(), SFC_SET_ADD_PEAK_CHUNK, nullptr, SF_FALSE);
    write_names(file_->handle.get(), names);
}

TakeStreamWriter::~TakeStreamWriter() = default;

void TakeStreamWriter::write(std::int64_t first, const std::byte* frames, std::size_t count) {
    File& file = *file_;
    const std::size_t most = frames_at_once(file.channels);
    while (file.next < first) {
        const std::size_t some = std::min(static_cast<std::size_t>(first - file.next), most);
        for (std::size_t i = 0; i < some; ++i)
            std::ranges::copy(file.last, file.frames.begin() + static_cast<std::ptrdiff_t>(i * file.channels));
        file.put(file.frames.data(), some);
        file.next += static_cast<std::int64_t>(some);
    }
    for (std::size_t done = 0; done < count;) {
        const std::size_t some = std::min(count - done, most);
        for (std::size_t i = 0; i < some; ++i) {
            const std::byte* frame = frames + (done + i) * file.frame_bytes;
            double* numbers = file.frames.data() + i * file.channels;
            for (const Track& track : file.tracks) to_frame(track.type, frame + track.offset, numbers + track.channel);
        }
        file.put(file.frames.data(), some);
        done += some;
        std::copy_n(file.frames.data() + (some - 1) * file.channels, file.channels, file.last.data());
    }
    file.next += static_cast<std::int64_t>(count);
}

void TakeStreamWriter::update() { sf_command(file_->handle.get(), SFC_UPDATE_HEADER_NOW, nullptr, 0); }

void TakeStreamWriter::finish() {
    if (!file_->handle) return;
    if (sf_close(file_->handle.release()) != 0)
        throw Error(fmt::format("{}: could not be completed; is the disk full?", file_->path.string()));
}

std::int64_t TakeStreamWriter::frames() const { return file_->next - file_->start; }

struct TakeStreamReader::File {
    std::int64_t start = 0;
    sound::SoundHandle handle;
    std::size_t channels = 0, first_channel = 0;  // of the file; of the output
    int width = 0;                      // channels of the output
    std::int64_t length = 0;            // of the file
    std::int64_t first = 0, count = 0;  // activations in `frames`
    std::vector<double> frames;
};

TakeStreamReader::TakeStreamReader(const std::filesystem::path& path, const TakeStreamInfo& info)
    : file_(std::make_unique<File>()) {
    SF_INFO format{};
    if (std::filesystem::exists(path)) file::require_file(path);
    file_->handle.reset(sf_open(path.c_str(), SFM_READ, &format));
    if (!file_->handle) throw Error(fmt::format("{}: cannot read: {}", path.string(), sf_strerror(nullptr)));
    if (format.channels < info.channel + info.channels || format.channels > max_channels)
        throw Error(fmt::format("{}: {} channels; {} needs those from {} to {}, and a file has at most {}",
                                path.string(), format.channels, info.port, info.channel + 1,
                                info.channel + info.channels, max_channels));
    file_->channels = static_cast<std::size_t>(format.channels);
    file_->first_channel = static_cast<std::size_t>(info.channel);
    file_->width = info.channels;
    file_->length = format.frames;
    file_->start = file_->first = info.start;
    file_->frames.resize(frames_at_once(file_->channels) * file_->channels);
}

TakeStreamReader::~TakeStreamReader() = default;

int TakeStreamReader::channels() const { return file_->width; }

std::int64_t TakeStreamReader::frames() const { return file_->length; }

void TakeStreamReader::seek(std::int64_t activation) {
    File& file = *file_;
    const std::int64_t wanted = std::clamp<std::int64_t>(activation - file.start, 0, file.length);
    if (sf_seek(file.handle.get(), wanted, SEEK_SET) != wanted) return;
    file.first = file.start + wanted;
    file.count = 0;
}

const double* TakeStreamReader::frame(std::int64_t activation) {
    File& file = *file_;
    if (activation < file.first) return nullptr;
    while (activation >= file.first + file.count) {
        file.first += file.count;
        file.count = sf_readf_double(file.handle.get(), file.frames.data(),
                                     static_cast<sf_count_t>(frames_at_once(file.channels)));
        if (file.count <= 0) {
            file.count = 0;
            return nullptr;
        }
    }
    return file.frames.data() + static_cast<std::size_t>(activation - file.first) * file.channels + file.first_channel;
}

const double* TakeStreamReader::frame(std::int64_t activation, const TakeStreamInfo& other) {
    const double* own = frame(activation);
    return own ? own - file_->first_channel + other.channel : nullptr;
}

}  // namespace tactus::take
