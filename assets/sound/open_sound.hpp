// SPDX-License-Identifier: Apache-2.0
// Common to the readers of this folder; includes libsndfile.
#pragma once

#include <sndfile.h>

#include <filesystem>
#include <memory>
#include <string>

namespace tactus::sound {

struct CloseSound {
    std::shared_ptr<void> source;  ///< data source of the library, or null: a file by its name
    void operator()(SNDFILE* file) const { sf_close(file); }
};
using SoundHandle = std::unique_ptr<SNDFILE, CloseSound>;

/// Truncates a file after that frame, because on a full disk a part of the next frame may have been written.
inline void keep_whole_frames(SNDFILE* file, sf_count_t frames) {
    sf_command(file, SFC_FILE_TRUNCATE, &frames, sizeof frames);
}

/// Opens a sound for reading and fills `info`. If the header of a wave is unfinished or wrong, its size is determined
/// from the samples present and `note` (may be null) describes the defect. Throws Error if the file is missing, not a
/// sound, or empty.
SoundHandle open_sound(const std::filesystem::path& path, SF_INFO& info, std::string* note = nullptr);

}  // namespace tactus::sound
