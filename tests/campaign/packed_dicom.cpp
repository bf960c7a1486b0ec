// SPDX-License-Identifier: Apache-2.0
#include "tests/campaign/packed_dicom.hpp"

#include "assets/file/whole_file.hpp"
#include "tests/assets/volume/written_volume.hpp"

#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmImageReader.h>
#include <gdcmImageWriter.h>
#include <gdcmTransferSyntax.h>

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <stdexcept>

namespace tactus::campaign {

void pack_dicom(const std::filesystem::path& from, const std::filesystem::path& to, const std::string& kind) {
    using gdcm::TransferSyntax;
    static const std::map<std::string, TransferSyntax::TSType> kinds{{"rle", TransferSyntax::RLELossless},
                                                                     {"jpeg", TransferSyntax::JPEGLosslessProcess14_1},
                                                                     {"jpeg_ls", TransferSyntax::JPEGLSLossless},
                                                                     {"j2k", TransferSyntax::JPEG2000Lossless},
                                                                     {"j2k_lossy", TransferSyntax::JPEG2000}};
    const auto fail = [&](const char* what) {
        throw std::runtime_error(fmt::format("GDCM cannot {} {} as {}", what, from.string(), kind));
    };
    gdcm::ImageReader reader;
    reader.SetFileName(from.c_str());
    if (!reader.Read()) fail("read");
    gdcm::ImageChangeTransferSyntax change;
    change.SetTransferSyntax(kinds.at(kind));
    change.SetInput(reader.GetImage());
    if (!change.Change()) fail("compress");
    gdcm::ImageWriter writer;
    writer.SetFile(reader.GetFile());
    writer.SetImage(change.GetOutput());
    writer.SetFileName(to.c_str());
    if (!writer.Write()) fail("write");
}

std::vector<std::filesystem::path> packed_dicom(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    // GDCM writes beyond its memory when it compresses images of a few samples.
    WrittenVolume v;
    v.size = {48, 40, 3};
    v.step = Mat3(Vec3(0.5, 0.0, 0.0), Vec3(0.0, 0.6, 0.0), Vec3(0.0, 0.0, 1.5));
    v.origin = {-12.0, -12.0, 10.0};
    v.fill([](const Vec3& p) {
        const bool is_bone = std::hypot(p.x, p.y, p.z - 11.5) < 8.0;
        return is_bone ? 1000.0 + std::floor(40.0 * std::sin(3.0 * p.x * p.y)) : -1000.0;
    });
    file::write_whole_file(folder / "slice.dcm", dicom_bytes(v, 1));
    file::write_whole_file(folder / "frames.dcm", enhanced_dicom_bytes(v));
    std::vector<std::filesystem::path> made;
    for (const char* const source : {"slice", "frames"})
        for (const char* const kind : {"rle", "jpeg", "jpeg_ls", "j2k", "j2k_lossy"}) {
            made.push_back(folder / fmt::format("{}_{}.dcm", source, kind));
            pack_dicom(folder / fmt::format("{}.dcm", source), made.back(), kind);
        }
    return made;
}

}  // namespace tactus::campaign
