// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/nrrd_header.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/blanks.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/lower.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <fstream>
#include <set>
#include <utility>

namespace tactus::volume {

namespace {

constexpr std::size_t max_field = 700, max_bytes = std::size_t{1} << 24, max_axes = 16;
constexpr int max_lines = 10000;
constexpr std::int64_t max_files = 100'000;

bool may_be_long(std::string_view line) {
    const std::size_t colon = std::min(line.find(':'), line.size());
    return line.starts_with('#') || line.starts_with("content: ") || line.substr(colon).starts_with(":=");
}

/// Removes the first word of `rest` and returns it; empty at the end.
std::string_view take_word(std::string_view& rest) {
    rest = without_blanks(rest);
    const std::string_view word = rest.substr(0, std::min(rest.find_first_of(blanks), rest.size()));
    rest.remove_prefix(word.size());
    return word;
}

template <class T>
std::optional<T> number_of(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    T number{};
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (failure != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    return number;
}

std::optional<SampleType> type_named(std::string_view name) {
    using enum SampleType::Kind;
    static constexpr std::pair<std::string_view, SampleType::Kind> names[] = {{"signed char", int8},
                                                                              {"int8", int8},
                                                                              {"int8_t", int8},
                                                                              {"uchar", uint8},
                                                                              {"unsigned char", uint8},
                                                                              {"uint8", uint8},
                                                                              {"uint8_t", uint8},
                                                                              {"short", int16},
                                                                              {"short int", int16},
                                                                              {"signed short", int16},
                                                                              {"signed short int", int16},
                                                                              {"int16", int16},
                                                                              {"int16_t", int16},
                                                                              {"ushort", uint16},
                                                                              {"unsigned short", uint16},
                                                                              {"unsigned short int", uint16},
                                                                              {"uint16", uint16},
                                                                              {"uint16_t", uint16},
                                                                              {"int", int32},
                                                                              {"signed int", int32},
                                                                              {"int32", int32},
                                                                              {"int32_t", int32},
                                                                              {"uint", uint32},
                                                                              {"unsigned int", uint32},
                                                                              {"uint32", uint32},
                                                                              {"uint32_t", uint32},
                                                                              {"longlong", int64},
                                                                              {"long long", int64},
                                                                              {"long long int", int64},
                                                                              {"signed long long", int64},
                                                                              {"signed long long int", int64},
                                                                              {"int64", int64},
                                                                              {"int64_t", int64},
                                                                              {"ulonglong", uint64},
                                                                              {"unsigned long long", uint64},
                                                                              {"unsigned long long int", uint64},
                                                                              {"uint64", uint64},
                                                                              {"uint64_t", uint64},
                                                                              {"float", float32},
                                                                              {"double", float64}};
    for (const auto& [known, kind] : names)
        if (known == name) return SampleType{kind};
    return std::nullopt;
}

std::optional<NrrdEncoding> encoding_named(std::string_view name) {
    if (name == "raw") return NrrdEncoding::raw;
    if (name == "gz" || name == "gzip") return NrrdEncoding::gzip;
    if (name == "bz2" || name == "bzip2") return NrrdEncoding::bzip2;
    if (name == "txt" || name == "text" || name == "ascii") return NrrdEncoding::text;
    if (name == "hex") return NrrdEncoding::hex;
    return std::nullopt;
}

/// "\n" and "\\" of a key/value pair.
std::string unescaped(std::string_view text) {
    std::string out;
    for (std::size_t n = 0; n < text.size(); ++n) {
        const bool is_escape = text[n] == '\\' && n + 1 < text.size() && (text[n + 1] == 'n' || text[n + 1] == '\\');
        out += !is_escape ? text[n] : text[n + 1] == 'n' ? '\n' : '\\';
        n += is_escape;
    }
    return out;
}

class Parser {
public:
    explicit Parser(const std::filesystem::path& path) : path_(path), file_(path.string()) {
        const std::uintmax_t size = file::require_file(path);
        std::ifstream stream(path, std::ios::binary);
        text_.resize(static_cast<std::size_t>(std::min<std::uintmax_t>(size + 1, max_bytes)));
        stream.read(text_.data(), static_cast<std::streamsize>(text_.size()));
        is_all_ = static_cast<std::size_t>(stream.gcount()) < text_.size();
        text_.resize(static_cast<std::size_t>(stream.gcount()));
    }

    NrrdHeader parse() {
        std::string_view line;
        if (!text_.starts_with("NRRD000"))
            throw Error(fmt::format("{}: not an NRRD file: it does not begin with 'NRRD000'", file_));
        next(line);
        while (next(line) && !line.empty()) {
            if (is_list_) add_data_file(line);
            else field(line);
        }
        const bool is_attached = out_.data.empty();
        if (is_attached && !line.empty()) throw Error(fmt::format("{}: cut short: the header has no end", file_));
        if (is_attached) out_.data.push_back(path_), out_.start = at_;
        check();
        return std::move(out_);
    }

private:
    [[noreturn]] void fail(const std::string& message) const { throw Error({file_, number_, 1}, message); }

    /// The next line without its end, which is LF or CR LF; false at the end of the file.
    bool next(std::string_view& line) {
        if (at_ == text_.size()) {
            if (!is_all_) throw Error(fmt::format("{}: its header is longer than {} MB", file_, max_bytes >> 20));
            return false;
        }
        const std::size_t end = std::min(text_.find('\n', at_), text_.size());
        if (end == text_.size() && !is_all_)
            throw Error(fmt::format("{}: its header is longer than {} MB", file_, max_bytes >> 20));
        line = std::string_view(text_).substr(at_, end - at_);
        if (line.ends_with('\r')) line.remove_suffix(1);
        at_ = std::min(end + 1, text_.size());
        if (++number_ > max_lines) fail(fmt::format("the header has more than {} lines", max_lines));
        if (line.size() > max_field && (number_ == 1 || !may_be_long(line)))
            fail(fmt::format("a header field has {} bytes; the limit is {}", line.size(), max_field));
        return true;
    }

    void field(std::string_view line) {
        if (line.starts_with('#')) return;
        const std::size_t colon = line.find(':');
        if (colon == std::string_view::npos) fail(fmt::format("'{}' is no header field", line.substr(0, 40)));
        if (line.substr(colon).starts_with(":=")) {
            out_.values[unescaped(line.substr(0, colon))] = unescaped(line.substr(colon + 2));
            return;
        }
        std::string name = lower(without_blanks(line.substr(0, colon)));
        const std::string_view rest = without_blanks(line.substr(colon + 1));
        for (const auto& [other, usual] :
             {std::pair{"datafile", "data file"}, {"lineskip", "line skip"}, {"byteskip", "byte skip"}})
            if (name == other) name = usual;
        if (!seen_.insert(name).second) fail(fmt::format("the field '{}' comes twice", name));
        if (name == "type") read_type(rest);
        else if (name == "dimension") dimension_ = whole(rest, 1, max_axes, name);
        else if (name == "sizes") read_sizes(rest);
        else if (name == "space") out_.space = lower(rest);
        else if (name == "space directions") read_directions(rest);
        else if (name == "space origin") read_origin(rest);
        else if (name == "space units") read_units(rest);
        else if (name == "encoding") read_encoding(rest);
        else if (name == "endian") read_endian(rest);
        else if (name == "line skip")
            out_.line_skip = static_cast<std::uint64_t>(whole(rest, 0, std::int64_t{1} << 40, name));
        else if (name == "byte skip") out_.byte_skip = whole(rest, -std::int64_t{1} << 40, std::int64_t{1} << 40, name);
        else if (name == "data file") read_data_file(rest);
        // Others describe how samples are displayed or named.
    }

    std::int64_t whole(std::string_view text, std::int64_t min, std::int64_t max, std::string_view name) const {
        const auto number = number_of<std::int64_t>(text);
        if (!number || *number < min || *number > max)
            fail(fmt::format("'{}' is no {} from {} to {}", text, name, min, max));
        return *number;
    }

    void read_type(std::string_view rest) {
        if (lower(rest) == "block") fail("the samples are blocks, not numbers");
        const std::optional<SampleType> type = type_named(lower(rest));
        if (!type) fail(fmt::format("the type '{}' is unknown", rest));
        out_.type = *type;
    }

    void read_sizes(std::string_view rest) {
        for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest))
            out_.sizes.push_back(whole(word, 1, std::int64_t{1} << 40, "size"));
    }

    /// "(1,0,0)"; NaN is allowed, infinity is not.
    Vec3 take_vector(std::string_view& rest) const {
        rest = without_blanks(rest);
        const std::size_t end = rest.find(')');
        if (!rest.starts_with('(') || end == std::string_view::npos)
            fail(fmt::format("'{}' is no vector, as (1,0,0)", rest.substr(0, 40)));
        const std::string_view all = rest.substr(1, end - 1);
        std::string_view inside = all;
        rest.remove_prefix(end + 1);
        Vec3 vector;
        for (int n = 0; n < 3; ++n) {
            const std::size_t comma = std::min(inside.find(','), inside.size());
            const auto number = number_of<double>(without_blanks(inside.substr(0, comma)));
            if (!number || (comma == inside.size()) != (n == 2))
                fail(fmt::format("'({})' is no vector of three numbers", all.substr(0, 40)));
            vector[n] = *number;
            inside.remove_prefix(std::min(comma + 1, inside.size()));
        }
        return vector;
    }

    void read_directions(std::string_view rest) {
        for (rest = without_blanks(rest); !rest.empty(); rest = without_blanks(rest)) {
            if (out_.directions.size() == max_axes) fail("there are more space directions than axes");
            if (lower(rest.substr(0, 4)) == "none" || lower(rest.substr(0, 3)) == "???") {
                take_word(rest);
                out_.directions.emplace_back();
            } else {
                // A vector of numbers that are none is written for axes that are no directions, too.
                const Vec3 vector = take_vector(rest);
                out_.directions.push_back(is_finite(vector) ? std::optional(vector) : std::nullopt);
            }
        }
    }

    void read_origin(std::string_view rest) {
        const Vec3 origin = take_vector(rest);
        if (!without_blanks(rest).empty()) fail("text follows the space origin");
        // "(nan,nan,nan)" is an unknown origin.
        if (is_finite(origin)) out_.origin = origin;
        else if (!std::isnan(origin.x) || !std::isnan(origin.y) || !std::isnan(origin.z))
            fail("the space origin is not a place");
    }

    void read_units(std::string_view rest) {
        for (rest = without_blanks(rest); !rest.empty(); rest = without_blanks(rest)) {
            const std::size_t end = rest.find('"', 1);
            if (!rest.starts_with('"') || end == std::string_view::npos)
                fail(fmt::format("'{}' is no unit between quotes, as \"mm\"", rest.substr(0, 40)));
            out_.space_units.emplace_back(rest.substr(1, end - 1));
            rest.remove_prefix(end + 1);
        }
    }

    void read_encoding(std::string_view rest) {
        const std::optional<NrrdEncoding> encoding = encoding_named(lower(rest));
        if (!encoding) fail(fmt::format("the encoding '{}' is unknown; save it as raw or gzip", rest));
        out_.encoding = *encoding;
    }

    void read_endian(std::string_view rest) {
        const std::string order = lower(rest);
        if (order != "little" && order != "big") fail(fmt::format("endian is little or big, not '{}'", rest));
        out_.is_swapped = (order == "little") != (std::endian::native == std::endian::little);
    }

    void add_data_file(std::string_view name) {
        if (std::int64_t(out_.data.size()) == max_files) fail(fmt::format("more than {} data files", max_files));
        out_.data.push_back(path_.parent_path() / std::filesystem::path(std::string(name)));
    }

    /// A name, "LIST" with names in the lines that follow, or "name%03d.raw MIN MAX STEP" for numbered files.
    void read_data_file(std::string_view rest) {
        std::string_view words = rest;
        const std::string_view first = take_word(words);
        if (first == "LIST") {
            is_list_ = true;
            return;
        }
        const std::size_t sign = first.find('%');
        if (sign == std::string_view::npos || without_blanks(words).empty()) return add_data_file(rest);
        std::size_t end = sign + 1;
        const bool has_zeros = end < first.size() && first[end] == '0';
        std::size_t width = 0;
        for (; end < first.size() && first[end] >= '0' && first[end] <= '9'; ++end)
            width = 10 * width + static_cast<std::size_t>(first[end] - '0');
        if (end == first.size() || (first[end] != 'd' && first[end] != 'i' && first[end] != 'u') || width > 20)
            fail(fmt::format("'{}' holds no number, as in slice%03d.raw", first));
        std::array<std::int64_t, 3> range{};
        for (std::int64_t& number : range) number = whole(take_word(words), -max_files, max_files, "number of a file");
        const auto [from, to, step] = range;
        if (step == 0 || (to - from) / step < 0 || (to - from) / step >= max_files)
            fail(fmt::format("no files are numbered from {} to {} in steps of {}", from, to, step));
        for (std::int64_t n = from; step > 0 ? n <= to : n >= to; n += step) {
            std::string number = std::to_string(n);
            if (number.size() < width) number.insert(0, width - number.size(), has_zeros ? '0' : ' ');
            add_data_file(fmt::format("{}{}{}", first.substr(0, sign), number, first.substr(end + 1)));
        }
    }

    void check() const {
        for (const char* needed : {"type", "dimension", "sizes", "encoding"})
            if (!seen_.contains(needed)) throw Error(fmt::format("{}: its header has no field '{}'", file_, needed));
        const auto check_number = [&](std::size_t count, const char* what) {
            if (count != static_cast<std::size_t>(dimension_))
                throw Error(fmt::format("{}: its header states {} axes and {} {}", file_, dimension_, count, what));
        };
        check_number(out_.sizes.size(), "sizes");
        if (seen_.contains("space directions")) check_number(out_.directions.size(), "space directions");
        const bool is_binary = out_.encoding != NrrdEncoding::text;
        if (is_binary && out_.type.bytes() > 1 && !seen_.contains("endian"))
            throw Error(
                fmt::format("{}: its header does not state the order of bytes; add 'endian: little' or "
                            "'endian: big'",
                            file_));
        if (!is_binary && out_.byte_skip != 0) throw Error(fmt::format("{}: samples as text have no byte skip", file_));
    }

    std::filesystem::path path_;
    std::string file_, text_;
    bool is_all_ = true, is_list_ = false;
    std::size_t at_ = 0;
    int number_ = 0;
    std::int64_t dimension_ = 0;
    std::set<std::string> seen_;
    NrrdHeader out_;
};

}  // namespace

std::string_view name_of(NrrdEncoding encoding) {
    constexpr std::array<std::string_view, 5> names{"raw", "gzip", "bzip2", "text", "hex"};
    return names[static_cast<std::size_t>(encoding)];
}

double NrrdHeader::count() const {
    double count = 1.0;
    for (const std::int64_t size : sizes) count *= static_cast<double>(size);
    return count;
}

std::string NrrdHeader::value(const std::string& key) const {
    const auto found = values.find(key);
    return found == values.end() ? std::string() : found->second;
}

NrrdHeader read_nrrd_header(const std::filesystem::path& path) { return Parser(path).parse(); }

}  // namespace tactus::volume
