// SPDX-License-Identifier: Apache-2.0
// What the readers of this folder share; includes libsndfile.
#pragma once

#include <sndfile.h>

#include <filesystem>
#include <memory>

namespace tactus {

struct CloseSound {
    void operator()(SNDFILE* file) const { sf_close(file); }
};
using SoundHandle = std::unique_ptr<SNDFILE, CloseSound>;

/// Opens for reading and fills `info`. Throws Error when the file is missing, no sound, empty, or cut short.
SoundHandle open_sound(const std::filesystem::path& path, SF_INFO& info);

}  // namespace tactus
