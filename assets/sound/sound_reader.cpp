// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/sound_reader.hpp"

#include "assets/sound/open_sound.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

namespace tactus::sound {

struct SoundReader::File {
    std::filesystem::path path;
    SF_INFO info{};
    SoundHandle handle;
    std::string note;
    std::size_t done = 0;
};

SoundReader::SoundReader(std::filesystem::path path) : file_(std::make_unique<File>()) {
    file_->path = std::move(path);
    file_->handle = open_sound(file_->path, file_->info, &file_->note);
}

SoundReader::~SoundReader() = default;
SoundReader::SoundReader(SoundReader&&) noexcept = default;
SoundReader& SoundReader::operator=(SoundReader&&) noexcept = default;

double SoundReader::rate() const noexcept { return file_->info.samplerate; }
std::size_t SoundReader::channels() const noexcept { return static_cast<std::size_t>(file_->info.channels); }
std::size_t SoundReader::frames() const noexcept { return static_cast<std::size_t>(file_->info.frames); }

const std::string& SoundReader::note() const noexcept { return file_->note; }

std::string SoundReader::comment() const {
    SNDFILE* handle = file_->handle.get();
    std::string out;
    const auto add = [&out](std::string_view text) {
        text = text.substr(0, std::min(text.find('\0'), text.size()));
        if (!text.empty()) out += (out.empty() ? "" : "\n") + std::string(text);
    };
    for (const int place : {SF_STR_COMMENT, SF_STR_TITLE})
        if (const char* text = sf_get_string(handle, place)) add(text);
    SF_BROADCAST_INFO broadcast{};
    if (sf_command(handle, SFC_GET_BROADCAST_INFO, &broadcast, sizeof broadcast) == SF_TRUE)
        add({broadcast.description, sizeof broadcast.description});
    return out;
}

std::size_t SoundReader::read(double* samples, std::size_t frames) {
    const sf_count_t got = sf_readf_double(file_->handle.get(), samples, static_cast<sf_count_t>(frames));
    const auto fail = [this](const std::string& why) { throw Error(fmt::format("{}: {}", file_->path.string(), why)); };
    if (sf_error(file_->handle.get()) != SF_ERR_NO_ERROR)
        fail(fmt::format("the sound is damaged: {}", sf_strerror(file_->handle.get())));
    const auto count = static_cast<std::size_t>(std::max<sf_count_t>(got, 0));
    for (std::size_t i = 0; i < count * channels(); ++i)
        if (!std::isfinite(samples[i]))
            fail(fmt::format("the sound holds a NaN or an infinity at {:.6g} s",
                             static_cast<double>(file_->done + i / channels()) / rate()));
    file_->done += count;
    // libsndfile reports an unknown length as the largest number.
    constexpr std::size_t unknown = std::size_t{1} << 62;
    if (count == 0 && file_->done < this->frames() && this->frames() < unknown)
        fail(fmt::format("the sound is cut short: it has {} of {} samples", file_->done, this->frames()));
    return count;
}

void SoundReader::skip(std::size_t frames) {
    if (frames == 0) return;
    if (sf_seek(file_->handle.get(), static_cast<sf_count_t>(frames), SEEK_SET) == static_cast<sf_count_t>(frames)) {
        file_->done = frames;
        return;
    }
    file_->handle = open_sound(file_->path, file_->info);
    constexpr std::size_t at_once = 65536;
    std::vector<double> passed(std::min(at_once, frames) * channels());
    while (file_->done < frames)
        if (read(passed.data(), std::min(at_once, frames - file_->done)) == 0) return;
}

}  // namespace tactus::sound
