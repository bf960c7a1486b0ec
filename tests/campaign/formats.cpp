// SPDX-License-Identifier: Apache-2.0
#include "tests/campaign/formats.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/sound/sound.hpp"
#include "assets/volume/write_volume.hpp"
#include "tests/campaign/limited_run.hpp"
#include "tests/campaign/other_bone.hpp"
#include "tests/campaign/packed_dicom.hpp"
#include "tests/fuzz/seeds.hpp"
#include "tests/support/bone_files.hpp"
#include "tests/support/places.hpp"
#include "tests/support/written_recordings.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace tactus::campaign {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

bool is_gzip(const std::string& bytes) { return bytes.starts_with("\x1f\x8b"); }

std::string gzip(const std::string& bytes) {
    z_stream stream{};
    if (deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
    std::string packed(deflateBound(&stream, bytes.size()) + 32, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

std::string gunzip(const std::string& bytes) {
    z_stream stream{};
    inflateInit2(&stream, 15 + 16);
    std::string out(std::size_t{1} << 22, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    inflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    inflateEnd(&stream);
    return out;
}

/// Behind an NRRD's header, what is packed; all of other packed files; nothing of the rest.
std::size_t start_of_packing(const std::string& bytes) {
    if (is_gzip(bytes)) return 0;
    const std::size_t end = bytes.starts_with("NRRD") ? bytes.find("\n\n") : std::string::npos;
    return end != std::string::npos && is_gzip(bytes.substr(end + 2, 2)) ? end + 2 : bytes.size();
}

std::string unpacked(const std::string& bytes) {
    const std::size_t start = start_of_packing(bytes);
    return start == bytes.size() ? bytes : bytes.substr(0, start) + gunzip(bytes.substr(start));
}

/// Checksums of a tar archive's members made right.
void mend_tar(std::string& bytes) {
    for (std::size_t at = 0; at + 512 <= bytes.size(); at += 512) {
        if (bytes.compare(at + 257, 5, "ustar") != 0) continue;
        std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at + 148), 8, ' ');
        unsigned sum = 0;
        for (std::size_t n = 0; n < 512; ++n) sum += static_cast<unsigned char>(bytes[at + n]);
        const std::string text = fmt::format("{:06o}", sum);
        bytes.replace(at + 148, 6, text);
        bytes[at + 154] = '\0';
    }
}

/// Half of the sounds have the length of what is left of them.
std::string mend_riff(std::string bytes, std::uint64_t number) {
    if (number % 2 == 0 && bytes.size() > 8 && bytes.starts_with("RIFF")) {
        const auto size = static_cast<std::uint32_t>(bytes.size() - 8);
        std::memcpy(&bytes[4], &size, sizeof size);
    }
    return bytes;
}

constexpr std::size_t matlab_header = 128;

/// The elements of a MATLAB file that follow its header, each with its tag; the last is what no whole element holds.
std::vector<std::string> matlab_elements(const std::string& bytes) {
    std::vector<std::string> elements;
    for (std::size_t at = matlab_header; at < bytes.size();) {
        std::uint32_t size = 0;
        if (bytes.size() - at >= 8) std::memcpy(&size, &bytes[at + 4], sizeof size);
        if (bytes.size() - at < 8 || size > bytes.size() - at - 8) size = static_cast<std::uint32_t>(bytes.size() - at);
        else size += 8;
        elements.push_back(bytes.substr(at, size));
        at += size;
    }
    return elements;
}

bool is_big_matlab(const std::string& bytes) { return bytes.size() < matlab_header || bytes.substr(126, 2) != "IM"; }

std::string unpacked_variables(const std::string& bytes) {
    if (is_big_matlab(bytes)) return bytes;
    std::string out = bytes.substr(0, matlab_header);
    for (const std::string& element : matlab_elements(bytes)) {
        if (!element.starts_with(std::string("\x0f\0\0\0", 4))) {
            out += element;
            continue;
        }
        std::string plain(std::size_t{1} << 16, '\0');
        uLongf size = plain.size();
        uncompress(reinterpret_cast<Bytef*>(plain.data()), &size, reinterpret_cast<const Bytef*>(element.data() + 8),
                   static_cast<uLong>(element.size() - 8));
        out += plain.substr(0, size);
    }
    return out;
}

/// Half of the files have each variable packed.
std::string packed_variables(std::string bytes, std::uint64_t number) {
    if (number % 2 != 0 || is_big_matlab(bytes)) return bytes;
    std::string out = bytes.substr(0, matlab_header);
    for (const std::string& element : matlab_elements(bytes)) out += test::matlab_packed(element);
    return out;
}

void pack_seeds(const fs::path& folder) {
    for (const fs::path& file : files_in(folder))
        file::write_whole_file(fs::path(file.string() + (file.extension() == ".tar" ? ".inv3" : ".gz")),
                               gzip(file::read_whole_file(file)));
}

std::vector<fs::path> with_ending(const fs::path& folder, const std::string& ending) {
    std::vector<fs::path> files = files_in(folder);
    std::erase_if(files, [&](const fs::path& file) { return !file.string().ends_with(ending); });
    return files;
}

/// The command, which must do what it is asked.
void make_by_command(std::vector<std::string> words, const fs::path& folder) {
    words.insert(words.begin(), tried_command());
    const RunEnd end = run_limited(words, folder);
    if (end.code != 0) throw std::runtime_error(fmt::format("'{}' made no seed: {}", words[1], end.fault));
}

fs::path small_take(const fs::path& folder) {
    make_by_command({"render", "saw-vibration", "--seconds", "0.02", "--out", "out", "--record", "take"}, folder);
    return folder / "take";
}

/// A plan beside its fragments.
fs::path small_case(const fs::path& folder) {
    const fs::path made = folder / "case";
    fs::create_directories(made);
    fs::copy_file(folder / "assets_stl/closed.stl", made / "a.stl");
    write_other_bone(made / "b.obj");
    make_by_command({"plan", "new", "case.plan.json", "a.stl", "b.obj"}, made);
    return made;
}

/// A plan with vessels, files of others, and the inputs of a reconstruction.
fs::path small_flap(const fs::path& folder, const fs::path& texts) {
    const fs::path made = folder / "flap";
    fs::create_directories(made);
    fs::copy_file(folder / "assets_stl/closed.stl", made / "a.stl");
    for (const char* const text :
         {"flap_files.seeds/vessel.csv", "flap_files.seeds/marks.mrk.json", "fibula_inputs.seeds/three.json"})
        fs::copy_file(texts / "assets" / text, made / fs::path(text).filename());
    make_by_command({"plan", "new", "case.plan.json", "a.stl"}, made);
    make_by_command({"plan", "vessel", "case.plan.json", "artery", "--file", "vessel.csv"}, made);
    return made;
}

/// A training task beside the label map of what it spares.
fs::path small_task(const fs::path& folder) {
    const fs::path made = folder / "task";
    fs::create_directories(made);
    volume::Grid labels{{8, 8, 8}, {-1e-3, -4e-3, -6e-3}, Vec3(0.4e-3), std::vector<float>(512, 0.0f)};
    for (std::size_t n = 200; n < 260; ++n) labels.values[n] = 1.0f;
    volume::write_volume(labels, volume::WrittenType::int16, made / "nerve.nrrd");
    fs::copy_file(test::source_folder() / "tests/fuzz/assets/toml_files.seeds/task.toml", made / "task.toml");
    return made;
}

/// 0.7 s, as the shortest that is compared is half a second.
std::vector<fs::path> small_sounds(const fs::path& folder) {
    std::vector<float> samples(2 * 700);
    for (std::size_t n = 0; n < samples.size(); ++n)
        samples[n] = 0.5f * std::sin(0.01f * static_cast<float>(n * (n % 7)));
    const fs::path made = folder / "sounds";
    fs::create_directories(made);
    for (const auto& [name, format] :
         {std::pair{"two.wav", sound::SoundFormat::float_wav}, std::pair{"two.flac", sound::SoundFormat::flac}}) {
        sound::SoundWriter writer(made / name, 2, 1000, format);
        writer.write(samples.data(), samples.size() / 2);
        writer.finish();
    }
    return files_in(made);
}

}  // namespace

std::vector<Format> make_formats(const fs::path& folder) {
    write_seeds(folder);
    for (const char* packed : {"assets_nifti", "assets_inv3"}) pack_seeds(folder / packed);
    const fs::path source = test::source_folder(), texts = source / "tests/fuzz";
    const auto seed = [&](const char* name) { return texts / name; };
    const fs::path take = small_take(folder);
    const std::vector<std::string> info{"info", "FILE"};
    const auto unpack = [](const std::string& bytes) { return unpacked(bytes); };
    const auto pack_samples = [](std::string bytes, std::uint64_t) {
        const std::size_t end = bytes.find("\n\n");
        if (end == std::string::npos || bytes.find("encoding: gzip") > end) return bytes;
        return bytes.substr(0, end + 2) + gzip(bytes.substr(end + 2));
    };
    const auto pack = [](std::string bytes, std::uint64_t number) {
        mend_tar(bytes);
        return number % 2 == 0 ? gzip(bytes) : bytes;
    };
    std::vector<Format> all{
        {.name = "vdb",
         .seeds = files_in(folder / "assets_vdb"),
         .verbs = {info, {"export", "FILE", "-o", "out.stl"}},
         .open = [](const std::string& bytes) { return bytes.substr(0, bytes.size() - 24); },
         .close = [](std::string bytes, std::uint64_t) { return test::sealed(std::move(bytes)); }},
        {.name = "nrrd",
         .seeds = files_in(folder / "assets_nrrd"),
         .verbs = {info, {"import", "FILE", "--unit", "mm", "-o", "out.vdb"}},
         .open = unpack,
         .close = pack_samples},
        {.name = "wav",
         .seeds = small_sounds(folder),
         .verbs = {{"spectrum", "FILE"}, {"exposure", "FILE", "--uncalibrated"}, {"compare", "FILE", "FILE"}},
         .close = mend_riff},
        {.name = "nifti",
         .seeds = files_in(folder / "assets_nifti"),
         .verbs = {info, {"import", "FILE", "--unit", "mm", "-o", "out.vdb"}},
         .open = unpack,
         .close = [](std::string bytes, std::uint64_t number) { return number % 2 == 0 ? gzip(bytes) : bytes; }},
        {.name = "dicom",
         .seeds = files_in(folder / "assets_dicom"),
         .verbs = {info, {"import", "FILE", "--unit", "mm", "-o", "out.vdb"}}},
        {.name = "packed",
         .seeds = packed_dicom(folder / "packed_dicom"),
         .verbs = {info, {"import", "FILE", "--unit", "mm", "-o", "out.vdb"}}},
        {.name = "uff",
         .seeds = files_in(folder / "assets_universal_file"),
         .verbs = {{"spectrum", "FILE"}, {"exposure", "FILE", "--column", "1"}}},
        {.name = "mat",
         .seeds = files_in(folder / "assets_matlab_file"),
         .verbs = {{"spectrum", "FILE"}, {"spectrum", "FILE", "--column", "1", "--sample-rate", "1 kHz"}},
         .open = unpacked_variables,
         .close = packed_variables},
        {.name = "inv3",
         .seeds = with_ending(folder / "assets_inv3", ".inv3"),
         .verbs = {info},
         .open = unpack,
         .close = pack},
        {.name = "plan",
         .seeds = {seed("assets/plan.seeds/eventful.json"), seed("assets/plan.seeds/reconstruction.json")},
         .verbs = {{"plan", "show", "FILE"}, {"plan", "show", "FILE", "--json"}}},
        {.name = "flap",
         .seeds = {small_flap(folder, texts)},
         .verbs = {{"plan", "fibula", "FILE/three.json"},
                   {"plan", "vessel", "FILE/case.plan.json", "artery", "--file", "FILE/vessel.csv"},
                   {"plan", "vessel", "FILE/case.plan.json", "vein", "--file", "FILE/marks.mrk.json"},
                   {"plan", "report", "FILE/case.plan.json", "-o", "out.html"}}},
        {.name = "case",
         .seeds = {small_case(folder)},
         .verbs = {{"plan", "gap", "FILE/case.plan.json"}, {"plan", "export", "FILE/case.plan.json", "--out", "out"}}},
        {.name = "take", .seeds = {take}, .verbs = {{"replay", "FILE"}, {"replay", "FILE", "--anyway"}}},
        {.name = "log",
         .seeds = {seed("assets/sample_log.seeds/small.csv"), take / "timing.log"},
         .verbs = {{"spectrum", "FILE"},
                   {"render", "saw-vibration", "--seconds", "0.02", "--out", "out", "--overwrite", "--log", "FILE"}}},
        {.name = "patch",
         .seeds = {seed("graph/patch.seeds/small.toml"), source / "assets/library/patches/touch-sphere.toml",
                   source / "assets/library/patches/saw-vibration.toml"},
         .verbs = {{"check", "FILE"}, {"draw", "FILE"}}},
        {.name = "task",
         .seeds = {small_task(folder)},
         .verbs = {{"render", "saw-task", "--seconds", "0.02", "--out", "out", "--overwrite", "--asset",
                    "task=FILE/task.toml"}}},
        {.name = "table",
         .seeds = {seed("assets/tables.seeds/response.csv"), seed("assets/tables.seeds/trajectory.csv")},
         .verbs = {{"equalise", "FILE", "-o", "out.toml", "--from", "25", "--to", "80"},
                   {"render", "peg-in-hole", "--seconds", "0.02", "--out", "out", "--overwrite", "--asset",
                    "trajectory=FILE", "--set", "hand.device=replay"}}}};
    for (const std::string kind : {"stl", "ply", "obj"})
        all.push_back({.name = kind,
                       .seeds = files_in(folder / ("assets_" + kind)),
                       .verbs = {info, {"import", "FILE", "--unit", "mm", "-o", "out.vdb"}}});
    return all;
}

}  // namespace tactus::campaign
