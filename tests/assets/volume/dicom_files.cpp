// SPDX-License-Identifier: Apache-2.0
// DICOM files that other programs wrote, in all the ways that samples are packed: those of Debian's python3-pydicom.
#include "assets/volume/dicom_images.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

using namespace tactus;

namespace {

const std::filesystem::path folder = "/usr/lib/python3/dist-packages/pydicom/data/test_files";

bool are_there() {
    if (std::filesystem::exists(folder / "MR_small.dcm")) return true;
    tactus::test::skip("the Debian package python3-pydicom is not installed");
    return false;
}

std::vector<float> samples_of(const std::string& name) {
    volume::DicomReader reader;
    return reader.samples(reader.images(folder / name).at(0)).values;
}

double sum_of(const std::vector<float>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

}  // namespace

TEST_CASE("one picture has the same samples plain, swapped, implicit, in RLE, JPEG 2000 and JPEG-LS") {
    if (!are_there()) return;
    // pydicom: dcmread("MR_small.dcm").pixel_array.sum(), .min(), .max()
    const std::vector<float> plain = samples_of("MR_small.dcm");
    REQUIRE(plain.size() == 64 * 64);
    CHECK(sum_of(plain) == 2125338.0);
    CHECK(*std::min_element(plain.begin(), plain.end()) == 127.0f);
    CHECK(*std::max_element(plain.begin(), plain.end()) == 2145.0f);
    for (const char* name : {"MR_small_bigendian.dcm", "MR_small_implicit.dcm", "MR_small_RLE.dcm",
                             "MR_small_padded.dcm", "MR_small_jp2klossless.dcm", "MR_small_jpeg_ls_lossless.dcm"}) {
        CAPTURE(name);
        CHECK(samples_of(name) == plain);
    }
    // The rescaled values of a CT: pixel_array * 1 - 1024.
    CHECK(sum_of(samples_of("CT_small.dcm")) == 14826310.0 - 1024.0 * 128 * 128);
    // 32 bits and 15 frames, plain and in RLE, in units of 1e-6 Gy; big-endian ones GDCM swaps wrongly.
    const std::vector<float> dose = samples_of("rtdose.dcm");
    CHECK(sum_of(dose) == 1519910000.0);
    CHECK(samples_of("rtdose_rle.dcm") == dose);
    CHECK_THROWS_AS(samples_of("rtdose_expb.dcm"), Error);
}

TEST_CASE("every DICOM file of another program's tests gives as many samples as it says, or one error") {
    if (!are_there()) return;
    std::size_t read = 0, refused = 0;
    volume::DicomReader reader;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file() || entry.path().extension() != ".dcm") continue;
        CAPTURE(entry.path().filename().string());
        try {
            const std::vector<volume::DicomImage> images = reader.images(entry.path());
            if (images.empty() || images.front().is_colour) continue;
            const std::vector<float> values = reader.samples(images.front()).values;
            CHECK(values.size() == images.size() * static_cast<std::size_t>(images.front().rows) *
                                       static_cast<std::size_t>(images.front().columns));
            CHECK(std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }));
            ++read;
        } catch (const Error& error) {
            const std::string text = error.what();
            CHECK(text.find(entry.path().filename().string()) != std::string::npos);
            CHECK(text.find('\n') == std::string::npos);
            ++refused;
        }
        // No scan of a patient's volume is among them: alone each is one slice, or says nothing about places.
        CHECK_THROWS_AS(volume::read_volume(entry.path()), Error);
    }
    CHECK(read >= 15);
    CHECK(refused >= 12);
}
