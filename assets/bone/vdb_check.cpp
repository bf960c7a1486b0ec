// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/vdb_check.hpp"

#include "assets/file/room.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <set>
#include <string_view>
#include <type_traits>
#include <vector>

namespace tactus::bone {

namespace {

static_assert(std::endian::native == std::endian::little, "OpenVDB writes numbers as they lie in memory");

constexpr std::int64_t vdb_magic = 0x56444220;
constexpr std::uint32_t vdb_format = 224;
constexpr std::string_view float_tree = "Tree_float_5_4_3", loading_hints = "__delayedload", skipped = "__passed_over",
                           half_floats = "is_saved_as_half_float";
static_assert(loading_hints.size() == skipped.size());

enum Packing : std::uint32_t { zip = 1, active_only = 2, blosc = 4 };

constexpr std::uint32_t leaf_side_bits = 3, lower_side_bits = 4, upper_side_bits = 5;
constexpr std::uint32_t upper_extent = 1u << (leaf_side_bits + lower_side_bits + upper_side_bits);

constexpr std::size_t values_in(std::uint32_t side_bits) { return std::size_t{1} << (3 * side_bits); }

/// One bit per child or voxel of a node.
struct Mask {
    const unsigned char* bytes = nullptr;
    std::size_t size = 0;

    std::size_t count() const {
        std::size_t on = 0;
        for (std::size_t n = 0; n < size; ++n) on += static_cast<std::size_t>(std::popcount(bytes[n]));
        return on;
    }
};

class Walk {
public:
    Walk(std::string& bytes, const std::string& file) : bytes_(bytes), file_(file) {}

    void run() {
        if (take<std::int64_t>() != vdb_magic) fail("is not an OpenVDB file");
        if (const auto format = take<std::uint32_t>(); format != vdb_format)
            fail(fmt::format("is of OpenVDB's format {}, not {}", format, vdb_format));
        skip(2 * sizeof(std::uint32_t));  // version of the library
        if (take<std::uint8_t>() != 0) fail("has grid offsets in its header");
        skip(36);  // identifier
        pass_metadata();
        // A grid takes at least three strings and three offsets.
        const std::uint32_t grids = take_count(36, "grids");
        for (std::uint32_t n = 0; n < grids; ++n) pass_grid();
        if (at_ != bytes_.size()) fail(fmt::format("has {} bytes after its last grid", bytes_.size() - at_));
        // Memory that OpenVDB allocates per node: its values, or a pointer per value.
        file::require_room(static_cast<double>(memory_), file_, "its grids");
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw Error(
            fmt::format("{}: damaged: it {} (at byte {}); make it again with 'tactus import'", file_, what, at_));
    }

    std::size_t left() const { return bytes_.size() - at_; }

    const char* pass(std::size_t size) {
        if (size > left()) fail(fmt::format("is {} bytes too short", size - left()));
        const char* from = bytes_.data() + at_;
        at_ += size;
        return from;
    }
    void skip(std::size_t size) { pass(size); }

    template <typename T>
    T take() {
        static_assert(std::is_arithmetic_v<T>);
        T value;
        std::memcpy(&value, pass(sizeof value), sizeof value);
        return value;
    }

    /// Reads a count of items that take at least `least` bytes each.
    std::uint32_t take_count(std::size_t least, std::string_view what) {
        const auto count = take<std::uint32_t>();
        if (count > left() / least) fail(fmt::format("claims {} {}, more than it can hold", count, what));
        return count;
    }

    std::string_view take_text() {
        const std::uint32_t size = take_count(1, "characters");
        return {pass(size), size};
    }

    void pass_metadata() {
        // Sizes of the types that OpenVDB reads without checking the stated length.
        constexpr std::pair<std::string_view, std::uint32_t> fixed[] = {
            {"bool", 1},   {"int32", 4},  {"int64", 8},  {"float", 4},  {"double", 8}, {"vec2i", 8},   {"vec2s", 8},
            {"vec2d", 16}, {"vec3i", 12}, {"vec3s", 12}, {"vec3d", 24}, {"mat4s", 64}, {"mat4d", 128},
        };
        const std::uint32_t count = take_count(12, "entries of metadata");
        for (std::uint32_t n = 0; n < count; ++n) {
            const bool is_half = take_text() == half_floats;
            const std::string_view type = take_text();
            const std::size_t type_at = at_ - type.size();
            const auto* known = std::ranges::find(fixed, type, &std::pair<std::string_view, std::uint32_t>::first);
            const std::uint32_t size = take_count(1, "bytes of one entry");
            if (known != std::end(fixed) ? size != known->second : type != "string" && type != loading_hints)
                fail(fmt::format("has metadata that are not a known type of {} bytes", size));
            if (type == "bool" && left() > 0 && static_cast<unsigned char>(bytes_[at_]) > 1)
                fail("has a truth value other than 0 and 1");
            // This flag overrides the type of the grid: OpenVDB would then read half as many bytes per node.
            if (is_half && (type != "bool" || left() == 0 || bytes_[at_] != 0)) fail("has 16-bit numbers");
            if (type == loading_hints) bytes_.replace(type_at, skipped.size(), skipped);
            skip(size);
        }
    }

    void pass_transform() {
        constexpr std::size_t vector = 3 * sizeof(double), matrix = 16 * sizeof(double);
        constexpr std::pair<std::string_view, std::size_t> maps[] = {
            {"AffineMap", matrix},
            {"UnitaryMap", matrix},
            {"TranslationMap", vector},
            {"ScaleMap", 5 * vector},
            {"UniformScaleMap", 5 * vector},
            {"ScaleTranslateMap", 6 * vector},
            {"UniformScaleTranslateMap", 6 * vector},
        };
        const std::string_view type = take_text();
        const auto* map = std::ranges::find(maps, type, &std::pair<std::string_view, std::size_t>::first);
        if (map == std::end(maps)) fail("has a grid with an unknown kind of transform");
        skip(map->second);
    }

    void pass_grid() {
        const std::string_view name = take_text();
        if (!names_.emplace(name).second) fail("has two grids with the same name");
        if (take_text() != float_tree) fail(fmt::format("has a grid that is not a {}", float_tree));
        if (!take_text().empty()) fail("has a grid that shares the tree of another");
        skip(3 * sizeof(std::int64_t));  // offsets in the file; unused in a stream
        packing_ = take<std::uint32_t>();
        if ((packing_ & ~7u) != 0 || (packing_ & (zip | blosc)) == (zip | blosc))
            fail(fmt::format("has a grid of unknown compression {}", packing_));
        pass_metadata();
        pass_transform();
        pass_tree();
    }

    void pass_tree() {
        if (take<std::int32_t>() != 1) fail("has a tree of several buffers");
        skip(sizeof(float));  // background
        const std::uint32_t tiles = take<std::uint32_t>(), children = take<std::uint32_t>();
        if (tiles > left() / 17) fail(fmt::format("claims {} tiles, more than it can hold", tiles));
        for (std::uint32_t n = 0; n < tiles; ++n) {
            skip(3 * sizeof(std::int32_t) + sizeof(float));
            if (take<std::uint8_t>() != 0) fail("has an active tile");
        }
        std::optional<std::array<std::int32_t, 3>> last;
        leaves_ = 0;
        for (std::uint32_t n = 0; n < children; ++n) {
            std::array<std::int32_t, 3> place;
            for (std::int32_t& number : place) number = take<std::int32_t>();
            for (const std::int32_t number : place)
                if (static_cast<std::uint32_t>(number) % upper_extent != 0) fail("has a node at an invalid position");
            // OpenVDB reads values in the order of their positions, each position once.
            if (last && place <= *last) fail("has nodes that are out of order");
            last = place;
            pass_upper();
        }
        for (std::size_t n = 0; n < leaves_; ++n) pass_values(leaf_side_bits, take_mask(leaf_side_bits).count());
    }

    Mask take_mask(std::uint32_t side_bits) {
        const std::size_t size = values_in(side_bits) / 8;
        return {reinterpret_cast<const unsigned char*>(pass(size)), size};
    }

    /// Checks masks and values of an inner node; returns its number of children.
    std::size_t pass_inner(std::uint32_t side_bits) {
        const std::size_t children = take_mask(side_bits).count();
        if (take_mask(side_bits).count() != 0) fail("has an active tile");
        pass_values(side_bits, 0);
        memory_ += values_in(side_bits) * sizeof(void*);
        return children;
    }

    void pass_upper() {
        for (std::size_t n = pass_inner(upper_side_bits); n > 0; --n)
            for (std::size_t m = pass_inner(lower_side_bits); m > 0; --m) {
                take_mask(leaf_side_bits);
                ++leaves_;
                memory_ += values_in(leaf_side_bits) * sizeof(float);
            }
    }

    /// Checks the values of a node that has `active` active positions.
    void pass_values(std::uint32_t side_bits, std::size_t active) {
        // How inactive values are stored (OpenVDB io/Compression.h): their number, and whether a mask selects between
        // two.
        constexpr std::uint8_t all_values = 6;
        constexpr std::array<std::size_t, all_values + 1> values{0, 0, 1, 0, 1, 2, 0};
        const auto kind = take<std::uint8_t>();
        if (kind > all_values) fail("has a node of an unknown kind");
        skip(values[kind] * sizeof(float));
        if (kind >= 3 && kind < all_values) take_mask(side_bits);
        const bool only_active = (packing_ & active_only) != 0 && kind != all_values;
        pass_chunk(sizeof(float) * (only_active ? active : values_in(side_bits)));
    }

    /// Checks a chunk that unpacks to `size` bytes.
    void pass_chunk(std::size_t size) {
        if ((packing_ & (zip | blosc)) == 0) return skip(size);
        const auto stated = take<std::int64_t>();
        if (stated <= 0) {  // a negative size means not packed
            if (stated != -static_cast<std::int64_t>(size))
                fail(fmt::format("has a plain chunk of {} bytes where a node has {}", stated, size));
            return skip(size);
        }
        if (static_cast<std::uint64_t>(stated) > left())
            fail(fmt::format("has a packed chunk of {} bytes, more than it holds", stated));
        const std::string_view chunk(pass(static_cast<std::size_t>(stated)), static_cast<std::size_t>(stated));
        if ((packing_ & blosc) != 0) check_blosc(chunk, size);
        // zlib stops at the end of the chunk and of the node, and OpenVDB checks the unpacked size.
    }

    /// Blosc reads both sizes from the chunk: they must match the chunk and the node.
    void check_blosc(std::string_view chunk, std::size_t size) const {
        constexpr std::size_t head = 16;
        constexpr std::uint8_t version = 2, lz4 = 1;
        if (chunk.size() < head) fail("has a packed chunk without a header");
        const auto number = [&](std::size_t at) {
            std::uint32_t value;
            std::memcpy(&value, chunk.data() + at, sizeof value);
            return value;
        };
        const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(chunk[at]); };
        if (byte(0) != version || byte(2) >> 5 != lz4) fail("has a chunk with an unknown packing");
        const std::uint32_t unpacked = number(4), block = number(8), packed = number(12);
        if (unpacked != size)
            fail(fmt::format("has a chunk that unpacks to {} bytes where a node has {}", unpacked, size));
        if (packed != chunk.size())
            fail(fmt::format("has a chunk of {} bytes whose header states {}", chunk.size(), packed));
        if (size > 0 && (block == 0 || block > size)) fail("has a chunk with blocks larger than itself");
    }

    std::string& bytes_;
    const std::string& file_;
    std::size_t at_ = 0, leaves_ = 0, memory_ = 0;
    std::uint32_t packing_ = 0;
    std::set<std::string, std::less<>> names_;
};

}  // namespace

void check_vdb(std::string& bytes, const std::string& file) { Walk(bytes, file).run(); }

}  // namespace tactus::bone
