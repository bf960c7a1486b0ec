// SPDX-License-Identifier: Apache-2.0
// Any bytes called .dcm are images with as many samples as they state, or a tactus::Error. The reading of the process
// that reads scans is called directly, for files that our walk understands: on others the library may end its program.
#include "assets/file/room.hpp"
#include "assets/volume/decoder/dicom_decode.hpp"
#include "assets/volume/dicom_elements.hpp"
#include "dsp/core/error.hpp"

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    const tactus::volume::DicomSource source{"v.dcm", &bytes};
    try {
        if (!tactus::volume::doubt_about_dicom(bytes, source.name).empty()) return 0;
        const std::vector<tactus::volume::DicomImage> images = tactus::volume::decode_dicom_images(source);
        if (images.empty() || images.front().is_colour) return 0;
        std::vector<float> values;
        tactus::volume::decode_dicom_samples(source, images, [&](std::size_t count) {
            values.resize(count);
            return values.data();
        });
        const tactus::volume::DicomImage& first = images.front();
        if (values.size() !=
            images.size() * static_cast<std::size_t>(first.rows) * static_cast<std::size_t>(first.columns))
            std::abort();
    } catch (const tactus::Error&) {
        // Refusing is right for most bytes.
    } catch (const tactus::file::NoRoom&) {
    }
    return 0;
}
