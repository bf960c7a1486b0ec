// SPDX-License-Identifier: Apache-2.0
// MATLAB 5 files ("MAT-File Format", MathWorks): elements with a type and a size, in the byte order of the header. Read here: matio
// would bring HDF5 with it, and the part that holds samples is small.
#include "assets/file/room.hpp"
#include "assets/table/recording.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/lower.hpp"

#include <zlib.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <unordered_map>
#include <utility>

namespace tactus::table {

namespace {

constexpr std::size_t header_size = 128, min_samples = 4, max_columns = 4096;

// Types of elements and classes of arrays.
enum Type : std::uint32_t {
    int8 = 1,
    uint8,
    int16,
    uint16,
    int32,
    uint32,
    single = 7,
    real = 9,
    int64 = 12,
    uint64,
    matrix,
    packed
};
enum Class : std::uint32_t { structure = 2, first_numeric = 6, last_numeric = 15 };

class MatlabFile {
public:
    MatlabFile(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

    Recording read() {
        if (bytes_.size() < header_size) fail("cut short: it has no header");
        is_swapped_ = (bytes_.substr(126, 2) == "IM") != (std::endian::native == std::endian::little);
        for (std::string_view rest = bytes_.substr(header_size); !rest.empty();) {
            const Element element = take(rest, true);
            if (element.type == packed) {
                const std::string unpacked = unpack(element.data);
                std::string_view inside = unpacked;
                unpacked_ = unpacked.size();
                if (!inside.empty()) variable(take(inside, false));
                unpacked_ = 0;
            } else {
                variable(element);
            }
        }
        add_rate();
        if (recording_.channels.empty())
            fail(fmt::format("none of its {} variables is a vector or matrix of at least {} real numbers", variables_,
                             min_samples));
        recording_.format = fmt::format("MATLAB file, {} of {} variables{}", used_, variables_,
                                        left_out_.empty() ? "" : "; left out: " + left_out_);
        if (recording_.rate_place.empty()) recording_.rate_place = "a variable";
        return std::move(recording_);
    }

private:
    [[noreturn]] void fail(const std::string& message) const { throw Error(fmt::format("{}: {}", file_, message)); }

    struct Element {
        std::uint32_t type = 0;
        std::string_view data;
    };

    template <class T>
    T number_at(std::string_view data, std::size_t at) const {
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), data.data() + at, sizeof(T));
        if (is_swapped_) std::reverse(raw.begin(), raw.end());
        return std::bit_cast<T>(raw);
    }

    /// Removes an element from `rest`: its tag, its data, and the padding to 8 bytes.
    Element take(std::string_view& rest, bool is_top) const {
        if (rest.size() < 8) fail("cut short: an element has no tag");
        const auto first = number_at<std::uint32_t>(rest, 0);
        // A small element has its size in the upper half of the first word, and its data in the second.
        if (const std::uint32_t small = first >> 16; small != 0) {
            if (small > 4) fail("a small element states more than 4 bytes; the file is damaged");
            const Element element{first & 0xffff, rest.substr(4, small)};
            rest.remove_prefix(8);
            return element;
        }
        const std::size_t size = number_at<std::uint32_t>(rest, 4);
        if (size > rest.size() - 8) fail("cut short: an element states more bytes than the file has");
        const Element element{first, rest.substr(8, size)};
        // Packed elements at the top are not padded.
        const std::size_t padded = is_top && first == packed ? size : (size + 7) / 8 * 8;
        rest.remove_prefix(std::min(rest.size(), 8 + padded));
        return element;
    }

    /// Each number is held twice: in its channel and in the chosen columns. `bytes`: of what is unpacked.
    void require_room(std::size_t bytes, std::size_t numbers) const {
        file::require_room(static_cast<double>(bytes_.size()) + static_cast<double>(bytes) +
                               16.0 * (static_cast<double>(held_) + static_cast<double>(numbers)),
                           file_, "its variables");
    }

    std::string unpack(std::string_view data) const {
        constexpr std::size_t at_once = std::size_t{1} << 20;
        z_stream stream{};
        if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
        struct End {
            z_stream* stream;
            ~End() { inflateEnd(stream); }
        } end{&stream};
        std::string out;
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
        stream.avail_in = static_cast<uInt>(data.size());
        for (int code = Z_OK; code != Z_STREAM_END;) {
            require_room(2 * (out.size() + at_once), 0);
            const std::size_t before = out.size();
            out.resize(before + at_once);
            stream.next_out = reinterpret_cast<Bytef*>(out.data() + before);
            stream.avail_out = static_cast<uInt>(at_once);
            code = inflate(&stream, Z_NO_FLUSH);
            out.resize(before + at_once - stream.avail_out);
            if (code != Z_OK && code != Z_STREAM_END)
                fail("its packed data are damaged or cut short; copy the file again");
        }
        return out;
    }

    struct Array {
        std::uint32_t kind = 0;
        bool is_complex = false;
        std::vector<std::size_t> dimensions;
        std::string name;
        std::string_view rest;  // the elements behind the name
        std::size_t count() const {
            double count = 1.0;
            for (const std::size_t n : dimensions) count *= static_cast<double>(n);
            return count < 1e15 ? static_cast<std::size_t>(count) : ~std::size_t{0};
        }
    };

    Array array_of(const Element& element) const {
        std::string_view rest = element.data;
        Array array;
        const Element flags = take(rest, false);
        if (flags.type != uint32 || flags.data.size() < 8) fail("the flags of a variable are damaged");
        const auto word = number_at<std::uint32_t>(flags.data, 0);
        array.kind = word & 0xff;
        array.is_complex = (word & 0x800) != 0;
        const Element dimensions = take(rest, false);
        if (dimensions.type != int32 || dimensions.data.size() < 8 || dimensions.data.size() > 128)
            fail("the dimensions of a variable are damaged");
        for (std::size_t at = 0; at + 4 <= dimensions.data.size(); at += 4) {
            const auto size = number_at<std::int32_t>(dimensions.data, at);
            if (size < 0) fail("the dimensions of a variable are damaged");
            array.dimensions.push_back(static_cast<std::size_t>(size));
        }
        const Element name = take(rest, false);
        if (name.type != int8 && name.type != uint8) fail("the name of a variable is damaged");
        array.name = name.data;
        array.rest = rest;
        return array;
    }

    void variable(const Element& element) {
        if (element.type != matrix) return;  // none that holds a variable
        ++variables_;
        const Array array = array_of(element);
        if (array.kind == structure && array.count() == 1) {
            fields(array);
            return;
        }
        if (!numbers(array, own_name(array.name))) leave_out(array.name);
        else ++used_;
    }

    void leave_out(const std::string& name) {
        if (left_out_.size() > 200) {
            if (!left_out_.ends_with("...")) left_out_ += ", ...";
            return;
        }
        left_out_ += (left_out_.empty() ? "" : ", ") + name;
    }

    /// The numbers in the fields of a structure, which have names of a fixed length.
    void fields(const Array& array) {
        std::string_view rest = array.rest;
        const Element length = take(rest, false), names = take(rest, false);
        if (length.type != int32 || length.data.size() < 4) fail("the fields of a structure are damaged");
        const auto size = number_at<std::int32_t>(length.data, 0);
        if (size < 1 || size > 1024) fail("the fields of a structure are damaged");
        bool is_used = false;
        const auto step = static_cast<std::size_t>(size);
        for (std::size_t at = 0; at + step <= names.data.size() && !rest.empty(); at += step) {
            std::string name(names.data.substr(at, step));
            name.resize(std::strlen(name.c_str()));
            const Element field = take(rest, false);
            if (field.type != matrix || field.data.empty()) continue;
            // The name of the structure is none of a quantity or unit, as 's' may be.
            const Array inner = array_of(field);
            if (numbers(inner, own_name(name))) is_used = true;
            else leave_out(array.name + "." + name);
        }
        used_ += is_used;
    }

    /// "a (2)" where "a" is taken, or is the beginning of other channels: "a_1".
    std::string own_name(const std::string& wanted) {
        std::string name = wanted;
        while (taken_.contains(name)) name = fmt::format("{} ({})", wanted, ++taken_[wanted]);
        return name;
    }

    void note_name(const std::string& name) {
        taken_.try_emplace(name, 1);
        for (std::size_t at = name.find('_'); at != std::string::npos; at = name.find('_', at + 1))
            taken_.try_emplace(name.substr(0, at), 1);
    }

    /// Adds the columns of a numeric array; false when it holds no samples and no rate.
    bool numbers(const Array& array, const std::string& name) {
        if (array.kind < first_numeric || array.kind > last_numeric || array.is_complex || array.dimensions.size() != 2)
            return false;
        const std::size_t count = array.count();
        if (count == 0) return false;
        std::string_view rest = array.rest;
        const Element data = take(rest, false);
        const std::vector<double> values = values_of(data, count);
        if (count == 1) return scalar(name, values.front());
        const std::size_t rows = array.dimensions[0], columns = array.dimensions[1];
        // A row is a vector; in matrices the longer side is time.
        const bool is_across = rows < columns;
        const std::size_t samples = std::max(rows, columns), channels = std::min(rows, columns);
        if (samples < min_samples || channels > max_columns) return false;
        for (std::size_t c = 0; c < channels; ++c) {
            RecordedChannel channel{channels == 1 ? name : fmt::format("{}_{}", name, c + 1), "", {}, 0.0, 0};
            channel.values.reserve(samples);
            for (std::size_t n = 0; n < samples; ++n)
                channel.values.push_back(is_across ? values[n * channels + c] : values[c * samples + n]);
            const auto known = std::ranges::find(lengths_, samples);
            channel.group = static_cast<std::size_t>(known - lengths_.begin());
            if (known == lengths_.end()) lengths_.push_back(samples);
            held_ += samples;
            note_name(channel.name);
            recording_.channels.push_back(std::move(channel));
        }
        return true;
    }

    template <class T>
    void convert(std::string_view data, std::vector<double>& values) const {
        for (std::size_t n = 0; n < values.size(); ++n)
            values[n] = static_cast<double>(number_at<T>(data, n * sizeof(T)));
    }

    /// Numbers may be stored in a smaller type than that of their class.
    std::vector<double> values_of(const Element& data, std::size_t count) const {
        const auto with_size = [&](std::size_t size) {
            if (count > data.data.size() / size) fail("a variable has fewer numbers than its dimensions state");
            require_room(unpacked_, count);
            return std::vector<double>(count);
        };
        std::vector<double> values;
        switch (data.type) {
            case int8: values = with_size(1), convert<std::int8_t>(data.data, values); break;
            case uint8: values = with_size(1), convert<std::uint8_t>(data.data, values); break;
            case int16: values = with_size(2), convert<std::int16_t>(data.data, values); break;
            case uint16: values = with_size(2), convert<std::uint16_t>(data.data, values); break;
            case int32: values = with_size(4), convert<std::int32_t>(data.data, values); break;
            case uint32: values = with_size(4), convert<std::uint32_t>(data.data, values); break;
            case single: values = with_size(4), convert<float>(data.data, values); break;
            case real: values = with_size(8), convert<double>(data.data, values); break;
            case int64: values = with_size(8), convert<std::int64_t>(data.data, values); break;
            case uint64: values = with_size(8), convert<std::uint64_t>(data.data, values); break;
            default: fail(fmt::format("numbers of an unknown type {}", data.type));
        }
        return values;
    }

    /// "fs", "SampleRate", "SampleFrequency" in Hz; "dt", "Ts", "SampleInterval" in s.
    bool scalar(const std::string& name, double value) {
        const std::string word = lower(name);
        constexpr std::array<std::string_view, 9> rates{"fs",
                                                        "samplerate",
                                                        "sample_rate",
                                                        "samplingrate",
                                                        "sampling_rate",
                                                        "samplefrequency",
                                                        "sample_frequency",
                                                        "samplingfrequency",
                                                        "srate"};
        constexpr std::array<std::string_view, 7> intervals{
            "dt", "ts", "sampleinterval", "sample_interval", "tinc", "samplingperiod", "sampleperiod"};
        if (!(value > 0.0) || !std::isfinite(value)) return false;
        if (std::ranges::find(rates, word) != rates.end()) return state_rate(name, value);
        if (std::ranges::find(intervals, word) != intervals.end()) return state_rate(name, 1.0 / value);
        return false;
    }

    bool state_rate(const std::string& name, double rate) {
        // Several rates belong to several groups of channels, but the file does not assign them.
        if (rate_ > 0.0 && std::abs(rate / rate_ - 1.0) > 1e-9) has_several_rates_ = true;
        rate_ = rate;
        recording_.rate_place = fmt::format("variable '{}'", name);
        return true;
    }

    void add_rate() {
        if (has_several_rates_ || lengths_.size() > 1) {
            if (rate_ > 0.0)
                left_out_ +=
                    fmt::format("{}the rate, which may be that of some channels only", left_out_.empty() ? "" : ", ");
            return;
        }
        for (RecordedChannel& channel : recording_.channels) channel.rate = rate_;
    }

    std::string_view bytes_;
    const std::string& file_;
    bool is_swapped_ = false, has_several_rates_ = false;
    int variables_ = 0, used_ = 0;
    double rate_ = 0.0;
    std::string left_out_;
    std::vector<std::size_t> lengths_;
    std::size_t held_ = 0;  // numbers of all channels so far
    std::size_t unpacked_ = 0;  // bytes of the variable that is read
    std::unordered_map<std::string, int> taken_;  // names, with how many of each
    Recording recording_;
};

}  // namespace

bool is_matlab_file(std::string_view start) {
    return start.starts_with("MATLAB 5.0 MAT-file") || start.starts_with("MATLAB 7.3 MAT-file") ||
           start.starts_with("\x89HDF\r\n") ||
           (start.size() >= header_size && (start.substr(124, 4) == std::string_view("\0\1IM", 4) ||
                                            start.substr(124, 4) == std::string_view("\1\0MI", 4)));
}

Recording read_matlab_file(std::string_view bytes, const std::string& file) {
    if (bytes.starts_with("MATLAB 7.3") || bytes.starts_with("\x89HDF"))
        throw Error(
            fmt::format("{}: MATLAB 7.3 files are HDF5, which is not read; save it with save(..., '-v7')", file));
    return MatlabFile(bytes, file).read();
}

}  // namespace tactus::table
