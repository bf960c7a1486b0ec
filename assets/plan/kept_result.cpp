// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/kept_result.hpp"

#include "assets/bone/bone.hpp"
#include "assets/file/cache.hpp"
#include "assets/file/extension.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/volume/nrrd_header.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <utility>

namespace tactus::plan {

namespace {

constexpr std::string_view format_line = "tactus kept result 1\n";

/// Whether all data of a file is in it: a header may name files of samples.
bool is_whole(const std::filesystem::path& path) {
    const std::string extension = file::extension_of(path);
    constexpr std::array<const char*, 5> whole{".vdb", ".stl", ".ply", ".obj", ".nii"};
    if (std::ranges::find(whole, extension) != whole.end()) return true;
    if (extension != ".nrrd") return lower(path.string()).ends_with(".nii.gz");
    try {
        return volume::read_nrrd_header(path).data == std::vector{path};
    } catch (const Error&) {
        return false;
    }
}

std::string checksum(const std::string& key, const std::vector<double>& numbers) {
    Hash hash;
    hash.add_text(key);
    hash.add_bytes(numbers.data(), numbers.size() * sizeof(double));
    return fmt::format("{:016x}", hash.value());
}

}  // namespace

ResultKey::ResultKey(const std::string& what, int version) : text_(fmt::format("{} {}", what, version)) {}

ResultKey& ResultKey::add_file(const std::filesystem::path& path) {
    const std::filesystem::path file = bone::file_of_bone(path);
    if (!std::filesystem::is_regular_file(file) || !is_whole(file)) {
        is_complete_ = false;
        return *this;
    }
    Hash hash;
    file::add_file(hash, file);
    const std::string all = path.string(), own = file.string();
    text_ += fmt::format("\nfile {} {:016x} {}", std::filesystem::file_size(file), hash.value(),
                         file.extension().string() + (all.size() > own.size() ? all.substr(own.size()) : ""));
    return *this;
}

ResultKey& ResultKey::add(const std::string& name, double number) {
    text_ += fmt::format("\n{} {:.17g}", name, number);
    return *this;
}

ResultKey& ResultKey::add_text(const std::string& name, const std::string& value) {
    // A name may have a line break; the hash has none.
    Hash hash;
    hash.add_text(value);
    text_ += fmt::format("\n{} {} {:016x}", name, value.size(), hash.value());
    return *this;
}

std::filesystem::path file_of_result(const ResultKey& key) {
    const std::filesystem::path folder = file::cache_folder();
    if (folder.empty() || key.text().empty()) return {};
    Hash hash;
    hash.add_text(key.text());
    return folder / "results" / fmt::format("{:016x}.txt", hash.value());
}

std::optional<std::vector<double>> kept_result(const ResultKey& key, std::string& note) {
    const std::filesystem::path file = file_of_result(key);
    std::error_code failure;
    if (file.empty() || !std::filesystem::exists(file, failure)) return std::nullopt;
    try {
        const std::string text = file::read_whole_file(file);
        const std::string head = std::string(format_line) + key.text() + "\n\n";
        if (text.starts_with(head)) {
            std::istringstream lines(text.substr(head.size()));
            std::string sum, number;
            std::vector<double> numbers;
            std::getline(lines, sum);
            while (std::getline(lines, number)) numbers.push_back(std::strtod(number.c_str(), nullptr));
            if (sum == checksum(key.text(), numbers)) {
                file::touch_cached(file);
                return numbers;
            }
        }
    } catch (const std::exception&) {
        // Damaged or foreign: report it below and recompute.
    }
    note = fmt::format("{} is damaged or not a kept result; it is ignored and made again", file.string());
    return std::nullopt;
}

void keep_result(const ResultKey& key, const std::vector<double>& numbers) noexcept {
    try {
        const std::filesystem::path file = file_of_result(key);
        // No result has infinite numbers.
        if (file.empty() || !std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); })) return;
        std::string text = std::string(format_line) + key.text() + "\n\n" + checksum(key.text(), numbers) + "\n";
        for (const double number : numbers) text += fmt::format("{:.17g}\n", number);
        file::write_cached(file, text);
    } catch (const std::exception&) {
        // A result that is not kept is computed again.
    }
}

namespace {

/// Beside the numbers: "texts/HASH.txt".
std::filesystem::path file_of_text(const ResultKey& key) {
    const std::filesystem::path file = file_of_result(key);
    return file.empty() ? file : file.parent_path().parent_path() / "texts" / file.filename();
}

std::string head_of_text(const ResultKey& key, const std::string& text) {
    Hash hash;
    hash.add_text(key.text());
    hash.add_text(text);
    return fmt::format("tactus kept text 1\n{}\n\n{:016x}\n", key.text(), hash.value());
}

}  // namespace

std::optional<std::string> kept_text(const ResultKey& key, std::string& note) {
    const std::filesystem::path file = file_of_text(key);
    std::error_code failure;
    if (file.empty() || !std::filesystem::exists(file, failure)) return std::nullopt;
    try {
        const std::string whole = file::read_whole_file(file);
        const std::size_t size = head_of_text(key, "").size();
        std::string text = whole.size() >= size ? whole.substr(size) : "";
        if (whole == head_of_text(key, text) + text) {
            file::touch_cached(file);
            return text;
        }
    } catch (const std::exception&) {
        // Damaged or foreign: report it below and recompute.
    }
    note = fmt::format("{} is damaged or not a kept result; it is ignored and made again", file.string());
    return std::nullopt;
}

void keep_text(const ResultKey& key, const std::string& text) noexcept {
    try {
        const std::filesystem::path file = file_of_text(key);
        if (file.empty()) return;
        file::write_cached(file, head_of_text(key, text) + text);
    } catch (const std::exception&) {
        // A result that is not kept is computed again.
    }
}

std::vector<double> result_of(const ResultKey& key, std::optional<std::size_t> count, std::string& note,
                              const std::function<std::vector<double>()>& make) {
    if (auto kept = kept_result(key, note); kept && (!count || kept->size() == *count)) return *std::move(kept);
    std::vector<double> numbers = make();
    keep_result(key, numbers);
    return numbers;
}

}  // namespace tactus::plan
