// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/file_hash.hpp"

#include "assets/file/extension.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/volume/nrrd_header.hpp"
#include "dsp/core/error.hpp"

namespace tactus::volume {

void add_file_with_samples(Hash& hash, const std::filesystem::path& path) {
    file::add_file(hash, path);
    const std::string extension = file::extension_of(path);
    if (extension != ".nrrd" && extension != ".nhdr") return;
    try {
        for (const std::filesystem::path& samples : read_nrrd_header(path).data)
            if (samples != path) file::add_file(hash, samples);
    } catch (const Error&) {
        // A damaged header, or samples that are missing: reported when the file is read.
    }
}

}  // namespace tactus::volume
