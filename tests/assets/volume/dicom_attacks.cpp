// SPDX-License-Identifier: Apache-2.0
// Series of DICOM files that do not belong together, or whose headers contradict each other: each is read right, read with a note, or refused
// with what to do.
#include "assets/file/whole_file.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/assets/volume/dicom_changes.hpp"
#include "tests/assets/volume/written_volume.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/sanitized.hpp"

#include <sys/resource.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <functional>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

// Numbers that differ from sample to sample: one at a wrong place shows.
WrittenVolume uneven_block(const Mat3& step) {
    WrittenVolume v;
    v.size = {9, 8, 10};
    v.step = step;
    v.origin = {-10.5, 20.25, -100.5};
    int n = 0;
    v.fill([&n](const Vec3&) { return -1000.0 + 2.0 * (n++ * 37 % 900); });
    return v;
}

WrittenVolume uneven_block() { return uneven_block({Vec3(1.5, 0.0, 0.0), Vec3(0.0, 1.25, 0.0), Vec3(0.0, 0.0, 2.0)}); }

std::function<std::string(const std::string&)> always(std::string value) {
    return [value = std::move(value)](const std::string&) { return value; };
}

struct Series {
    TemporaryFolder folder;
    WrittenVolume v = uneven_block();

    void put(const std::string& name, const std::string& bytes) const { file::write_whole_file(folder / name, bytes); }
    /// All slices, one of them changed.
    void write(int changed, const std::function<std::string(std::string)>& change) const {
        for (int k = 0; k < v.size[2]; ++k)
            put(fmt::format("{:03}.dcm", k), k == changed ? change(dicom_bytes(v, k)) : dicom_bytes(v, k));
    }
    void write_all(const std::function<std::string(std::string)>& change) const {
        for (int k = 0; k < v.size[2]; ++k) put(fmt::format("{:03}.dcm", k), change(dicom_bytes(v, k)));
    }
    volume::ScanVolume read(const volume::ReadOptions& options = {}) const {
        return volume::read_volume(folder.path, options);
    }
    void check_read(const volume::ScanVolume& scan) const {
        REQUIRE(scan.size == v.size);
        for (std::size_t n = 0; n < v.hu.size(); ++n) REQUIRE(scan.values[n] == Approx(v.hu[n]).margin(0.51));
        const Vec3 last(v.size[0] - 1, v.size[1] - 1, v.size[2] - 1);
        CHECK(glm::length(scan.map(last) * 1e3 - v.position(v.size[0] - 1, v.size[1] - 1, v.size[2] - 1)) < 1e-3);
    }
    void check_refused(const std::string& words) const { CHECK_THROWS_WITH(read(), ContainsSubstring(words)); }
};

std::string notes_of(const volume::ScanVolume& scan) { return fmt::format("{}", fmt::join(scan.notes, "; ")); }

std::string without_samples(const std::string& bytes) {
    return bytes.substr(0, bytes.find(tag_bytes(0x7fe0, 0x10), 132));
}

/// A private element of this many bytes before the samples, so that the file could hold them.
std::string with_private_bytes(const std::string& bytes, std::size_t count) {
    std::string more = tag_bytes(0x29, 0x1010) + std::string("OB\0\0", 4);
    for (int shift = 0; shift < 32; shift += 8) more += static_cast<char>(count >> shift & 0xff);
    const std::string head = without_samples(bytes);
    return head + more + std::string(count, 'x') + bytes.substr(head.size());
}

}  // namespace

TEST_CASE("slices of another orientation, modality, spacing or number of samples in a series are refused by name",
          "[slow]") {
    const Series series;
    series.write(4, [](std::string bytes) { return with_value(bytes, 0x20, 0x37, always("0\\1\\0\\0\\0\\-1")); });
    series.check_refused("000.dcm and 004.dcm have different orientations");
    series.write(4, [](std::string bytes) {
        return with_value(bytes, 0x20, 0x37, always("0.9998\\0.02\\0\\-0.02\\0.9998\\0"));
    });
    series.check_refused("different orientations");
    series.write(4, [](std::string bytes) { return with_value(bytes, 0x8, 0x60, always("MR")); });
    series.check_refused("000.dcm is CT and 004.dcm is MR");
    series.write(4, [](std::string bytes) { return with_value(bytes, 0x28, 0x30, always("1.25\\1.4")); });
    series.check_refused("000.dcm and 004.dcm differ in pixel spacing");
    for (const char* wrong : {"0\\0", "-1.25\\1.5"}) {
        series.write_all([&](std::string bytes) { return with_value(bytes, 0x28, 0x30, always(wrong)); });
        series.check_refused("no pixel spacing");
    }
    series.write_all([](std::string bytes) { return with_value(bytes, 0x20, 0x37, always("1\\0\\0\\1\\0\\0")); });
    series.check_refused("not orthogonal");
    // A whole second orientation, as of a reformatted plane.
    series.write_all([](std::string bytes) { return bytes; });
    for (int k = 0; k < 5; ++k)
        series.put(fmt::format("z{}.dcm", k),
                   with_value(dicom_bytes(series.v, k), 0x20, 0x37, always("1\\0\\0\\0\\0\\-1")));
    series.check_refused("different orientations");
}

TEST_CASE("equal slices at one position count once with a note, different ones are refused") {
    const Series series;
    series.write_all([](std::string bytes) { return bytes; });
    series.put("copy.dcm", dicom_bytes(series.v, 3));
    const volume::ScanVolume read = series.read();
    series.check_read(read);
    CHECK_THAT(notes_of(read), ContainsSubstring("1 duplicate images ignored"));
    WrittenVolume other = series.v;
    other.hu[other.hu.size() / 2] = 77;
    for (int k = 0; k < other.size[2]; ++k) series.put(fmt::format("p{}.dcm", k), dicom_bytes(other, k));
    series.check_refused("at the same position");
}

TEST_CASE("a tilted gantry is read at the places that the headers state, and one beyond 70 degrees is refused") {
    for (const double degrees : {-25.0, 12.0, 60.0, 80.0}) {
        CAPTURE(degrees);
        const double angle = degrees * 3.14159265358979 / 180.0;
        Series series;
        series.v = uneven_block(
            {Vec3(1.5, 0.0, 0.0), 1.25 * Vec3(0.0, std::cos(angle), std::sin(angle)), Vec3(0.0, 0.0, 2.0)});
        series.write_all([](std::string bytes) { return bytes; });
        if (degrees > 70.0) series.check_refused("sheared by more than 70 degrees");
        else series.check_read(series.read());
    }
}

TEST_CASE("a scan that was split over two series is refused with how to join it, and joined when asked", "[slow]") {
    for (const bool is_alternating : {false, true}) {
        const Series series;
        for (int k = 0; k < series.v.size[2]; ++k) {
            SliceStyle style;
            style.series = (is_alternating ? k % 2 == 0 : k < 6) ? "1.2.3.4" : "1.2.3.77";
            series.put(fmt::format("{}.dcm", k), dicom_bytes(series.v, k, style));
        }
        series.check_refused("join them with --series 1.2.3.4,1.2.3.77");
        const volume::ScanVolume read = series.read({"3.4,3.77", {}});
        series.check_read(read);
        CHECK_THAT(notes_of(read), ContainsSubstring("2 series were joined"));
        CHECK_THROWS_WITH(series.read({"3.4,3.4", {}}), ContainsSubstring("named twice"));
        CHECK_THROWS_WITH(series.read({"3.4,9", {}}), ContainsSubstring("--series 9 matches 0 of 2 series"));
    }
    // Two reconstructions of one scan are not parts of it.
    const Series series;
    SliceStyle style;
    style.series = "1.2.3.77";
    series.write_all([](std::string bytes) { return bytes; });
    for (int k = 0; k < series.v.size[2]; ++k) series.put(fmt::format("b{}.dcm", k), dicom_bytes(series.v, k, style));
    series.check_refused("choose one with --series UID");
    CHECK_THAT(notes_of(series.read({"3.4,3.77", {}})), ContainsSubstring("10 duplicate images ignored"));
}

TEST_CASE("images without samples are refused, whatever else their files hold") {
    const Series series;
    const std::size_t each = 9 * 8 * 2;
    series.write(4, without_samples);
    series.check_refused("004.dcm: ");
    series.write(4, [&](const std::string& bytes) { return without_samples(with_private_bytes(bytes, 4 * each)); });
    series.check_refused("004.dcm: the image cannot be decoded");
    series.write(4, [&](const std::string& bytes) {
        return without_samples(with_private_bytes(bytes, 4 * each)) + tag_bytes(0x7fe0, 0x10) +
               std::string("OW\0\0\0\0\0\0", 8);
    });
    series.check_refused("004.dcm: the image cannot be decoded");
    series.write(4, [&](const std::string& bytes) { return with_private_bytes(bytes, 4 * each); });
    series.check_read(series.read());
}

TEST_CASE("a rescale that changes from slice to slice counts for each, one that lacks or contradicts is refused") {
    const Series series;
    for (int k = 0; k < series.v.size[2]; ++k) {
        SliceStyle style;
        style.slope = 1.0 + 0.25 * k, style.intercept = -1024.0 - 10.0 * k;
        series.put(fmt::format("{:03}.dcm", k), dicom_bytes(series.v, k, style));
    }
    const volume::ScanVolume read = series.read();
    REQUIRE(read.size == series.v.size);
    for (std::size_t n = 0; n < series.v.hu.size(); ++n)
        // Stored as whole numbers of the slope.
        REQUIRE(read.values[n] ==
                Approx(series.v.hu[n]).margin(0.5 * (1.0 + 0.25 * static_cast<double>(n / 72)) + 1e-3));
    const auto without_rescale = [](std::string bytes) {
        const std::size_t from = bytes.find(tag_bytes(0x28, 0x1052), 132),
                          to = bytes.find(tag_bytes(0x7fe0, 0x10), 132);
        return bytes.erase(from, to - from);
    };
    series.write(4, without_rescale);
    series.check_refused("000.dcm states a rescale to HU (RescaleSlope, RescaleIntercept) and 004.dcm none");
    series.write(4, [](std::string bytes) { return with_value(bytes, 0x28, 0x1054, always("OD")); });
    series.check_refused("in HU and those of 004.dcm in OD");
    series.write(4, [](std::string bytes) { return with_value(bytes, 0x28, 0x1053, always("0")); });
    series.check_refused("004.dcm states a RescaleSlope of 0");
    series.write_all([](std::string bytes) { return with_value(bytes, 0x28, 0x1053, always("0")); });
    const volume::ScanVolume zero = series.read();
    series.check_read(zero);
    CHECK_THAT(notes_of(zero), ContainsSubstring("RescaleSlope is 0"));
    series.write(4, [](std::string bytes) { return with_value(bytes, 0x28, 0x1052, always("-1024\\-1000")); });
    series.check_refused("004.dcm: the rescale to HU (RescaleSlope, RescaleIntercept) has several numbers");
}

TEST_CASE("an element that states gigabytes costs a small file no memory") {
    const Series series;
    // A fragment of run lengths, after an empty table of offsets.
    const std::string fragments = tag_bytes(0x7fe0, 0x10) + std::string("OB\0\0\xff\xff\xff\xff", 8) +
                                  tag_bytes(0xfffe, 0xe000) + std::string(4, '\0') + tag_bytes(0xfffe, 0xe000) +
                                  std::string("\xfe\xff\xff\xff", 4) + std::string(200, '\0');
    series.write(4, [&](std::string bytes) {
        const std::string plain("1.2.840.10008.1.2.1\0", 20);
        return without_samples(
                   bytes.replace(bytes.find(plain), plain.size(), std::string("1.2.840.10008.1.2.5\0", 20))) +
               fragments;
    });
    CHECK_THROWS(series.read());
    rusage used{};
    REQUIRE(::getrusage(RUSAGE_CHILDREN, &used) == 0);
    // Under sanitizers the process has no limit.
    if (!test::sanitized) CHECK(used.ru_maxrss < 1'500'000);
}
