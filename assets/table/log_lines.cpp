// SPDX-License-Identifier: Apache-2.0
#include "assets/table/log_lines.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

namespace tactus::table {

namespace {

void append_utf8(std::string& out, std::uint32_t code) {
    const auto add = [&out](std::uint32_t byte) { out += static_cast<char>(byte); };
    if (code < 0x80) {
        add(code);
    } else if (code < 0x800) {
        add(0xc0 | code >> 6);
        add(0x80 | (code & 0x3f));
    } else {
        add(0xe0 | code >> 12);
        add(0x80 | (code >> 6 & 0x3f));
        add(0x80 | (code & 0x3f));
    }
}

bool is_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const std::size_t more = byte < 0x80                   ? 0
                                 : byte >= 0xc2 && byte < 0xe0 ? 1
                                 : byte < 0xf0                 ? 2
                                 : byte < 0xf5                 ? 3
                                                               : 9;
        if (byte >= 0x80 && byte < 0xc2) return false;
        if (i + more >= text.size()) return false;
        for (std::size_t k = 1; k <= more; ++k)
            if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return false;
        // No second form of a shorter code, no surrogates, nothing above U+10FFFF.
        const auto second = more > 0 ? static_cast<unsigned char>(text[i + 1]) : 0;
        if ((byte == 0xe0 && second < 0xa0) || (byte == 0xed && second >= 0xa0) || (byte == 0xf0 && second < 0x90) ||
            (byte == 0xf4 && second >= 0x90))
            return false;
        i += more + 1;
    }
    return true;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; };
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

std::string as_utf8(std::string_view text) {
    if (is_utf8(text)) return std::string(text);
    std::string out;
    for (const char c : text) append_utf8(out, static_cast<unsigned char>(c));
    return out;
}

bool LogLines::next(std::string_view& line) {
    if (rest_.empty()) return false;
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    line = rest_.substr(0, end);
    const bool both = rest_.substr(end).starts_with("\r\n");
    rest_.remove_prefix(std::min(end + (both ? 2 : 1), rest_.size()));
    while (!line.empty() && line.back() == ' ') line.remove_suffix(1);
    ++number_;
    return true;
}

LogBlocks::LogBlocks(Source source) : source_(std::move(source)) {}

bool LogBlocks::fill() {
    if (has_ended_) return false;
    constexpr std::size_t at_once = std::size_t{1} << 20;
    text_.erase(0, at_);
    newline_ -= std::min(newline_, at_);
    at_ = 0;
    const std::size_t before = text_.size(), left = raw_.size();
    if (coding_ == Coding::bytes) {
        text_.resize(before + at_once);
        const std::size_t count = source_(std::span(text_).subspan(before));
        text_.resize(before + count);
        has_ended_ = count < at_once;
        return count > 0;
    }
    raw_.resize(left + at_once);
    raw_.resize(left + source_(std::span(raw_).subspan(left)));
    has_ended_ = raw_.size() < left + at_once;
    std::size_t start = 0;
    if (coding_ == Coding::unknown) {
        coding_ = raw_.starts_with("\xff\xfe")   ? Coding::little
                  : raw_.starts_with("\xfe\xff") ? Coding::big
                                                 : Coding::bytes;
        start = coding_ != Coding::bytes ? 2 : raw_.starts_with("\xef\xbb\xbf") ? 3 : 0;
    }
    if (coding_ == Coding::bytes) {
        text_.append(raw_, start);
        raw_.clear();
        return text_.size() > before;
    }
    std::size_t i = start;
    for (; i + 1 < raw_.size(); i += 2) {
        const auto first = static_cast<unsigned char>(raw_[i]), second = static_cast<unsigned char>(raw_[i + 1]);
        const std::uint32_t code = coding_ == Coding::little ? first | second << 8u : second | first << 8u;
        // Letters beyond the basic plane have no meaning in a log.
        append_utf8(text_, code >= 0xd800 && code < 0xe000 ? 0xfffd : code);
    }
    raw_.erase(0, i);
    return text_.size() > before;
}

std::string_view LogBlocks::head(std::size_t size) {
    while (text_.size() < size && fill()) {
    }
    return std::string_view(text_).substr(0, size);
}

bool LogBlocks::next(std::string_view& line) {
    std::size_t searched = at_;
    for (;;) {
        if (newline_ < searched || (newline_ < text_.size() && text_[newline_] != '\n')) {
            const void* const found = std::memchr(text_.data() + searched, '\n', text_.size() - searched);
            newline_ = found ? static_cast<std::size_t>(static_cast<const char*>(found) - text_.data()) : text_.size();
        }
        const void* const found = std::memchr(text_.data() + searched, '\r', newline_ - searched);
        std::size_t end = found ? static_cast<std::size_t>(static_cast<const char*>(found) - text_.data()) : newline_;
        // The end of the line, whether LF follows CR, and whether another line follows may lie in the next block. To fill
        // after this would move the line that is returned.
        if (end + 2 >= text_.size() && end - at_ <= max_line && !has_ended_) {
            const std::size_t in_line = std::min(end, text_.size()) - at_;
            fill();
            searched = at_ + in_line;
            continue;
        }
        if (end == text_.size() && end == at_) return false;
        line = std::string_view(text_).substr(at_, end - at_);
        const bool both = end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n';
        at_ = std::min(end + (both ? 2 : 1), text_.size());
        while (!line.empty() && line.back() == ' ') line.remove_suffix(1);
        ++number_;
        return true;
    }
}

bool is_comment(std::string_view line, char separator) {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos) return false;
    line.remove_prefix(first);
    return line.front() == '#' || line.front() == '%' || line.starts_with("//") ||
           (line.front() == ';' && separator != ';');
}

void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
    fields.clear();
    if (const std::size_t arrow = line.substr(0, 40).find(" -> "); arrow != std::string_view::npos) {
        fields.push_back(trimmed(line.substr(0, arrow)));
        line.remove_prefix(arrow + 4);
    }
    if (separator == no_separator) {
        fields.push_back(trimmed(line));
        return;
    }
    for (;;) {
        if (separator == ' ') {
            const std::size_t start = line.find_first_not_of(" \t");
            if (start == std::string_view::npos) return;
            line.remove_prefix(start);
        }
        std::size_t end = separator == ' ' ? line.find_first_of(" \t") : line.find(separator);
        if (!line.empty() && line.front() == '"')
            if (const std::size_t quote = line.find('"', 1); quote != std::string_view::npos && quote > end)
                end = line.find(separator, quote);
        end = std::min(end, line.size());
        fields.push_back(trimmed(line.substr(0, end)));
        if (end == line.size()) return;
        line.remove_prefix(end + 1);
    }
}

}  // namespace tactus::table
