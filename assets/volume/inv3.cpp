// SPDX-License-Identifier: Apache-2.0
// InVesalius projects: a gzipped tar archive with a property list and raw samples. Masks and surfaces are not read.
#include "assets/volume/readers.hpp"
#include "assets/volume/sample_stream.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>

namespace tactus::volume {

namespace {

struct Entry {
    std::string name;  // without folder
    std::uint64_t size = 0;
};

// The next entry of a tar archive; none at the end. The caller then reads or skips entry.size bytes, rounded up to 512.
std::optional<Entry> next_entry(PackedFile& file, const std::string& name) {
    std::array<char, 512> block;
    if (file.read_some(block) != block.size()) return {};
    if (block[0] == '\0') return {};
    int sum = 0;
    for (std::size_t n = 0; n < block.size(); ++n)
        sum += n >= 148 && n < 156 ? ' ' : static_cast<unsigned char>(block[n]);
    const std::string stated(&block[148], 8);
    if (std::strtol(stated.c_str(), nullptr, 8) != sum)
        throw Error(fmt::format("{}: not an InVesalius project: the content is not a tar archive", name));
    Entry entry;
    entry.name = std::string(block.data(), std::find(block.data(), block.data() + 100, '\0'));
    entry.name = entry.name.substr(entry.name.rfind('/') + 1);
    const char* first = std::find_if(&block[124], &block[136], [](char c) { return c != ' '; });
    if (std::from_chars(first, &block[136], entry.size, 8).ec != std::errc{})
        throw Error(fmt::format("{}: not an InVesalius project: a file in it has no size", name));
    return entry;
}

std::uint64_t padded(std::uint64_t size) { return (size + 511) / 512 * 512; }

struct Place {
    std::uint64_t at, size;  // offset and size in the archive, bytes
};

// Seeks forward to the entry `wanted`.
std::optional<Place> find(PackedFile& file, const std::string& wanted, const std::string& name) {
    std::uint64_t at = 0;
    while (const auto entry = next_entry(file, name)) {
        at += 512;
        if (entry->name == wanted) return Place{at, entry->size};
        if (static_cast<double>(entry->size) > file.max_bytes())
            throw Error(fmt::format("{}: cut short: an entry of {} bytes does not fit in the file", name, entry->size));
        file.skip(padded(entry->size));
        at += padded(entry->size);
    }
    return {};
}

// The text of the element after <key>…</key> in a property list; "" when there is none.
std::string_view value_of(std::string_view list, std::string_view key) {
    const std::string marked = fmt::format("<key>{}</key>", key);
    std::size_t at = list.find(marked);
    if (at == std::string_view::npos) return {};
    at = list.find('<', at + marked.size());
    const std::size_t end = at == std::string_view::npos ? at : list.find('>', at);
    if (end == std::string_view::npos) return {};
    const std::string closing = fmt::format("</{}>", list.substr(at + 1, end - at - 1));
    const std::size_t close = list.find(closing, end);
    return close == std::string_view::npos ? std::string_view{} : list.substr(end + 1, close - end - 1);
}

// The numbers of an array, one element each.
std::vector<double> numbers_in(std::string_view text) {
    std::vector<double> numbers;
    for (std::size_t at = text.find('>'); at != std::string_view::npos; at = text.find('>', at + 1)) {
        const std::string word(text.substr(at + 1, std::min<std::size_t>(text.find('<', at + 1) - at - 1, 40)));
        char* end = nullptr;
        const double number = std::strtod(word.c_str(), &end);
        if (end != word.c_str()) numbers.push_back(number);
    }
    return numbers;
}

// The number of keys of a dictionary.
std::size_t entries_of(std::string_view text) {
    std::size_t count = 0;
    for (std::size_t at = text.find("<key>"); at != std::string_view::npos; at = text.find("<key>", at + 1)) ++count;
    return count;
}

SampleType type_of(std::string_view dtype, const std::string& name) {
    constexpr std::array<std::pair<std::string_view, SampleType::Kind>, 8> known{{{"int16", SampleType::int16},
                                                                                  {"uint16", SampleType::uint16},
                                                                                  {"uint8", SampleType::uint8},
                                                                                  {"int8", SampleType::int8},
                                                                                  {"int32", SampleType::int32},
                                                                                  {"uint32", SampleType::uint32},
                                                                                  {"float32", SampleType::float32},
                                                                                  {"float64", SampleType::float64}}};
    for (const auto& [word, kind] : known)
        if (dtype == word) return {kind};
    throw Error(fmt::format("{}: unknown sample type '{}'", name, dtype));
}

std::string property_list(const std::filesystem::path& path) {
    const std::string name = path.string();
    PackedFile file(path);
    if (!file.is_packed()) throw Error(fmt::format("{}: not an InVesalius project: not packed with gzip", name));
    const auto found = find(file, "main.plist", name);
    if (!found || found->size > 1'000'000)
        throw Error(fmt::format("{}: not an InVesalius project: main.plist is missing or too long", name));
    std::string list(found->size, '\0');
    file.read(list);
    return list;
}

class Inv3Slices final : public SliceReader {
public:
    explicit Inv3Slices(const std::filesystem::path& path) {
        const std::string name = path.string(), list = property_list(path);
        const std::string_view matrix = value_of(list, "matrix");
        const std::vector<double> shape = numbers_in(value_of(matrix, "shape")),
                                  spacing = numbers_in(value_of(list, "spacing"));
        if (shape.size() != 3 || spacing.size() != 3)
            throw Error(fmt::format("{}: main.plist lacks the matrix shape or the spacing (three numbers each)", name));
        for (const double n : shape)
            if (!(n >= 1.0 && n <= 1e6))
                throw Error(fmt::format("{}: {:g} samples along an axis are not possible", name, n));
        const SampleType type = type_of(value_of(matrix, "dtype"), name);
        integers_ = type.is_integer();
        about.format = "InVesalius";
        about.source = path.filename().string();
        about.encoding = "gzip";
        // The shape is slices, rows, columns. Rows run from posterior to anterior, slices from inferior to superior.
        for (std::size_t n = 0; n < 3; ++n) about.size[n] = static_cast<int>(shape[2 - n]);
        const std::size_t count = checked_count({about.size[0], about.size[1], about.size[2]}, name);
        about.map.step = Mat3(0.0);
        for (int axis = 0; axis < 3; ++axis)
            about.map.step[axis][axis] = spacing[static_cast<std::size_t>(axis)] * (axis == 1 ? -1e-3 : 1e-3);
        check_map(about.map, name);
        about.notes.push_back("the project has no patient position; the first voxel is the origin");
        const std::size_t masks = entries_of(value_of(list, "masks")),
                          surfaces = entries_of(value_of(list, "surfaces"));
        if (masks + surfaces > 0)
            about.notes.push_back(
                fmt::format("only the scan is read, not its {} masks and {} surfaces; export a mask from InVesalius as "
                            "NIfTI and import it with --label 1",
                            masks, surfaces));

        PackedFile file(path);
        const auto found = find(file, std::string(value_of(matrix, "filename")), name);
        if (!found) throw Error(fmt::format("{}: the file of the matrix is missing", name));
        if (found->size != count * type.bytes() || static_cast<double>(found->size) > file.max_bytes())
            throw Error(fmt::format("{}: cut short: its shape has {} voxels, but there are {} bytes", name, count,
                                    found->size));
        stream_.emplace(std::vector{SampleStream::Piece{path, 0, found->at, count}}, type, false, Packing::gzip);
    }

    void read(int k, std::span<float> values) override {
        stream_->read(static_cast<std::size_t>(k) * values.size(), values);
    }
    bool in_any_order() const override { return false; }
    void settle(const Tally& tally) override { settle_meaning(about, tally, integers_); }

private:
    std::optional<SampleStream> stream_;
    bool integers_ = false;
};

}  // namespace

std::unique_ptr<SliceReader> open_inv3(const std::filesystem::path& path) { return std::make_unique<Inv3Slices>(path); }

}  // namespace tactus::volume
