// SPDX-License-Identifier: Apache-2.0
#include "assets/file/zip_file.hpp"

#include "assets/file/room.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <zip.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

namespace tactus::file {

namespace {

constexpr std::uint64_t max_entries = 100'000;
constexpr std::uint64_t longest_list = max_entries * 512;  // bytes of the central directory
constexpr std::uint64_t max_bytes = std::uint64_t{64} << 30;  // all files together, unpacked
constexpr double deflate_limit = 1032.0;                       // most that deflate packs

std::uint64_t little_endian(std::string_view bytes, std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t n = 0; n < size && at + n < bytes.size(); ++n)
        value |= std::uint64_t{static_cast<unsigned char>(bytes[at + n])} << (8 * n);
    return value;
}

// libzip reads the whole list of files, so its length is checked first: in each record that could be the end of the
// zip (a comment may hold more than one).
void check_list(const std::filesystem::path& path, std::uint64_t size) {
    constexpr std::uint64_t farthest = 65535 + 22 + 20;
    std::ifstream file(path, std::ios::binary);
    const std::uint64_t start = size - std::min(size, farthest);
    std::string tail(static_cast<std::size_t>(size - start), '\0');
    file.seekg(static_cast<std::streamoff>(start));
    file.read(tail.data(), static_cast<std::streamsize>(tail.size()));
    const auto refuse = [&](std::uint64_t length) {
        if (length > longest_list)
            throw Error(fmt::format("{}: its list of files has {} bytes; a zip may hold at most {} files",
                                    path.string(), length, max_entries));
    };
    constexpr std::string_view end_mark("PK\5\6", 4), wide_mark("PK\6\7", 4);
    for (std::size_t at = tail.find(end_mark); at != std::string::npos; at = tail.find(end_mark, at + 1)) {
        const std::uint64_t length = little_endian(tail, at + 12, 4);
        if (length != 0xffffffffu) refuse(length);
    }
    for (std::size_t at = tail.find(wide_mark); at != std::string::npos; at = tail.find(wide_mark, at + 1)) {
        const std::uint64_t record = little_endian(tail, at + 8, 8);
        std::array<char, 56> bytes{};
        if (record > size) continue;
        file.clear();
        file.seekg(static_cast<std::streamoff>(record));
        if (file.read(bytes.data(), bytes.size())) refuse(little_endian({bytes.data(), bytes.size()}, 40, 8));
    }
}

std::string clean(std::string_view name) {
    std::string text;
    for (const char c : name.substr(0, 200)) text += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    return text;
}

}  // namespace

bool is_zip_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::array<char, 4> mark{};
    file.read(mark.data(), mark.size());
    const std::string_view found(mark.data(), mark.size());
    return found == std::string_view("PK\3\4", 4) || found == std::string_view("PK\5\6", 4);
}

void ZipFile::Close::operator()(void* archive) const { zip_discard(static_cast<zip_t*>(archive)); }

ZipFile::ZipFile(const std::filesystem::path& path) : path_(path.string()) {
    const std::uint64_t packed = require_file(path);
    check_list(path, packed);
    int code = 0;
    archive_.reset(zip_open(path.c_str(), ZIP_RDONLY, &code));
    if (!archive_) {
        zip_error_t error;
        zip_error_init_with_code(&error, code);
        const std::string why = zip_error_strerror(&error);
        zip_error_fini(&error);
        throw Error(fmt::format("{}: cannot be read as a zip: {}; copy or pack it again", path_, why));
    }
    zip_t* const archive = static_cast<zip_t*>(archive_.get());
    const zip_int64_t count = zip_get_num_entries(archive, 0);
    if (count > static_cast<zip_int64_t>(max_entries))
        throw Error(fmt::format("{}: has {} files; a zip may hold at most {}", path_, count, max_entries));
    std::uint64_t all_packed = 0, all = 0;
    for (zip_uint64_t n = 0; n < static_cast<zip_uint64_t>(count); ++n) {
        zip_stat_t stat;
        const auto refuse = [&](const std::string& why) {
            throw Error(fmt::format("{}: file {} in it ({}) {}", path_, n + 1, stat.name ? clean(stat.name) : "", why));
        };
        zip_stat_init(&stat);
        constexpr zip_uint64_t needed = ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD;
        if (zip_stat_index(archive, n, 0, &stat) != 0 || (stat.valid & needed) != needed) refuse("is damaged");
        if (stat.size == 0) continue;
        if ((stat.valid & ZIP_STAT_ENCRYPTION_METHOD) != 0 && stat.encryption_method != ZIP_EM_NONE)
            refuse("needs a password; unpack it first");
        if (stat.comp_method != ZIP_CM_STORE && stat.comp_method != ZIP_CM_DEFLATE)
            refuse("is not packed by deflate; unpack it first");
        // Damaged, or made to fill a memory: packed bytes that several files share, or sizes that nothing unpacks to.
        if (double(stat.size) > deflate_limit * double(stat.comp_size) + 1024.0 || stat.comp_size > packed ||
            stat.size > max_bytes)
            refuse(fmt::format("claims {} bytes from {}, which is not possible", stat.size, stat.comp_size));
        all_packed += stat.comp_size;
        all += stat.size;
        if (all_packed > packed) refuse("shares its bytes with others");
        if (all > max_bytes)
            throw Error(
                fmt::format("{}: holds more than {} GiB; give a zip of one examination", path_, max_bytes >> 30));
        entries_.push_back({path_ + "/" + clean(stat.name ? stat.name : ""), stat.size, n});
    }
}

std::string ZipFile::read(const Entry& entry, std::uint64_t most) const {
    const std::uint64_t wanted = std::min(entry.size, most);
    require_room(2.0 * double(wanted), entry.name, "it");
    const std::lock_guard lock(one_at_a_time_);
    const auto damaged = [&] {
        return Error(fmt::format("{}: damaged in the zip; copy or pack it again", entry.name));
    };
    const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(
        zip_fopen_index(static_cast<zip_t*>(archive_.get()), entry.index, 0), zip_fclose);
    if (!file) throw damaged();
    std::string bytes;
    // Memory grows with what is there, not with what the list claims.
    constexpr std::uint64_t step = std::uint64_t{1} << 20;
    while (bytes.size() < wanted) {
        const std::size_t before = bytes.size();
        bytes.resize(before + static_cast<std::size_t>(std::min(step, wanted - before)));
        const zip_int64_t got = zip_fread(file.get(), bytes.data() + before, bytes.size() - before);
        if (got <= 0) throw damaged();
        bytes.resize(before + static_cast<std::size_t>(got));
    }
    // The checksum is compared when the end is read.
    char beyond = 0;
    if (wanted == entry.size && zip_fread(file.get(), &beyond, 1) != 0) throw damaged();
    return bytes;
}

}  // namespace tactus::file
