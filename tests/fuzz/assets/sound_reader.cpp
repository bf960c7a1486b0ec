// SPDX-License-Identifier: Apache-2.0
// SoundReader: any bytes are finite samples, as many as promised, or one Error.
#include "assets/sound/sound_reader.hpp"

#include "dsp/core/error.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const int file = memfd_create("sound", 0);
    static const std::string path = "/proc/self/fd/" + std::to_string(file);
    if (ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) return 0;
    try {
        tactus::sound::SoundReader reader(path);
        if (reader.channels() > 1024) return 0;
        std::vector<double> samples(256 * reader.channels());
        for (int i = 0; i < 1000; ++i) {
            const std::size_t count = reader.read(samples.data(), 256);
            if (count > 256) std::abort();
            for (std::size_t j = 0; j < count * reader.channels(); ++j)
                if (!std::isfinite(samples[j])) std::abort();
            if (count == 0) break;
        }
    } catch (const tactus::Error& error) {
        if (std::string(error.what()).empty()) std::abort();
    }
    return 0;
}
