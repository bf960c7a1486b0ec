// SPDX-License-Identifier: Apache-2.0
// What the readers of this folder share; includes libsndfile.
#pragma once

#include <sndfile.h>

#include <filesystem>
#include <memory>

namespace tactus::sound {

struct CloseSound {
    void operator()(SNDFILE* file) const { sf_close(file); }
};
using SoundHandle = std::unique_ptr<SNDFILE, CloseSound>;

/// Cuts a file that is being written behind that frame: a full disk may have taken a part of the next one.
inline void keep_whole_frames(SNDFILE* file, sf_count_t frames) {
    sf_command(file, SFC_FILE_TRUNCATE, &frames, sizeof frames);
}

/// Opens for reading and fills `info`. Throws Error when the file is missing, no sound, empty, or cut short.
SoundHandle open_sound(const std::filesystem::path& path, SF_INFO& info);

}  // namespace tactus::sound
