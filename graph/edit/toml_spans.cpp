// SPDX-License-Identifier: Apache-2.0
#include "graph/edit/toml_spans.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>

namespace tactus::edit {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_newline(char c) { return c == '\n' || c == '\r'; }
bool is_bare(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-'; }

void append_utf8(std::string& out, std::uint32_t code) {
    const auto put = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
    if (code < 0x80) return put(code);
    if (code < 0x800) return put(0xC0 | code >> 6), put(0x80 | (code & 0x3F));
    if (code < 0x10000) put(0xE0 | code >> 12);
    else put(0xF0 | code >> 18), put(0x80 | (code >> 12 & 0x3F));
    put(0x80 | (code >> 6 & 0x3F)), put(0x80 | (code & 0x3F));
}

class Scanner {
public:
    Scanner(std::string_view text, std::size_t at) : text_(text), at_(at) {}

    TomlSpans document() {
        if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
        for (skip_space(); at_ < text_.size(); skip_space()) {
            const std::size_t before = at_;
            if (text_[at_] == '[') header();
            else entry(table_, -1);
            // Lines that are no TOML are skipped.
            if (at_ == before) at_ = std::min(text_.find('\n', at_), text_.size());
        }
        return std::move(found_);
    }

    std::vector<TomlElement> elements(std::size_t end) {
        std::vector<TomlElement> all;
        ++at_;  // the bracket
        for (skip_space(); at_ < end && text_[at_] != ']'; skip_space()) {
            if (text_[at_] == ',') {
                if (!all.empty()) all.back().comma = {at_, at_ + 1};
                ++at_;
                continue;
            }
            const std::size_t begin = at_;
            all.push_back({value(), {}});
            if (at_ == begin) ++at_;
        }
        return all;
    }

private:
    bool is(char c) const { return at_ < text_.size() && text_[at_] == c; }

    void skip_blanks() {
        while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    }
    /// Blanks, line ends and comments.
    void skip_space() {
        while (at_ < text_.size()) {
            if (text_[at_] == '#') at_ = std::min(text_.find('\n', at_), text_.size());
            else if (is_blank(text_[at_]) || is_newline(text_[at_])) ++at_;
            else return;
        }
    }

    TextSpan string() {
        const std::size_t begin = at_;
        const char quote = text_[at_];
        const std::string_view fence = quote == '"' ? "\"\"\"" : "'''";
        const bool spans_lines = text_.substr(at_).starts_with(fence);
        at_ += spans_lines ? 3 : 1;
        while (at_ < text_.size()) {
            if (quote == '"' && text_[at_] == '\\') at_ += 2;
            else if (spans_lines && text_.substr(at_).starts_with(fence)) {
                at_ += 3;
                // Up to two quotation marks may stand directly before the closing three.
                for (int more = 0; more < 2 && is(quote); ++more) ++at_;
                break;
            } else if (!spans_lines && (text_[at_] == quote || text_[at_] == '\n')) {
                ++at_;
                break;
            } else ++at_;
        }
        at_ = std::min(at_, text_.size());
        return {begin, at_};
    }

    std::vector<TextSpan> key() {
        std::vector<TextSpan> parts;
        for (;;) {
            skip_blanks();
            const std::size_t begin = at_;
            if (is('"') || is('\'')) string();
            else
                while (at_ < text_.size() && is_bare(text_[at_])) ++at_;
            if (at_ == begin) return parts;
            parts.push_back({begin, at_});
            const std::size_t end = at_;
            skip_blanks();
            if (!is('.')) {
                at_ = end;
                return parts;
            }
            ++at_;
        }
    }

    std::vector<std::string> joined(std::vector<std::string> path, const std::vector<TextSpan>& parts) const {
        for (const TextSpan& part : parts) path.push_back(toml_unquoted(part.of(text_)));
        return path;
    }

    void header() {
        const std::size_t begin = at_++;
        if (is('[')) ++at_;
        std::vector<TextSpan> parts = key();
        skip_blanks();
        while (is(']')) ++at_;
        table_ = joined({}, parts);
        found_.headers.push_back({table_, std::move(parts), {begin, at_}});
    }

    void entry(const std::vector<std::string>& above, int parent) {
        const std::size_t begin = at_;
        std::vector<TextSpan> parts = key();
        skip_blanks();
        if (parts.empty() || !is('=')) return;
        ++at_;
        skip_blanks();
        TomlEntry made;
        made.path = joined(above, parts);
        made.keys = std::move(parts);
        made.header = static_cast<int>(found_.headers.size()) - 1;
        made.parent = parent;
        const auto index = found_.entries.size();
        const std::vector<std::string> path = made.path;
        found_.entries.push_back(std::move(made));
        const TextSpan span = is('{') ? inline_table(path, static_cast<int>(index)) : value();
        found_.entries[index].value = span;
        found_.entries[index].span = {begin, span.end};
    }

    TextSpan inline_table(const std::vector<std::string>& path, int index) {
        const std::size_t begin = at_++;
        for (skip_space(); at_ < text_.size() && text_[at_] != '}'; skip_space()) {
            const std::size_t before = at_;
            if (is(',')) ++at_;
            else if (depth_ < deepest) {
                ++depth_;
                entry(path, index);
                --depth_;
            }
            if (at_ == before) ++at_;
        }
        if (at_ < text_.size()) ++at_;
        return {begin, at_};
    }

    /// A value that is no inline table. Inline tables in arrays are skipped.
    TextSpan value() {
        const std::size_t begin = at_;
        if (at_ >= text_.size()) return {begin, begin};
        if (is('"') || is('\'')) return string();
        if (is('[') || is('{')) {
            // Brackets in strings and comments do not count.
            for (int open = 0; skip_space(), at_ < text_.size();) {
                const char c = text_[at_];
                if (c == '"' || c == '\'') {
                    string();
                    continue;
                }
                ++at_;
                if (c == '[' || c == '{') ++open;
                else if ((c == ']' || c == '}') && --open == 0) break;
            }
            return {begin, at_};
        }
        while (at_ < text_.size() && !is_newline(text_[at_]) && text_[at_] != ',' && text_[at_] != ']' &&
               text_[at_] != '}' && text_[at_] != '#')
            ++at_;
        std::size_t end = at_;
        while (end > begin && is_blank(text_[end - 1])) --end;
        at_ = end;
        return {begin, end};
    }

    static constexpr int deepest = 64;

    std::string_view text_;
    std::size_t at_;
    int depth_ = 0;
    std::vector<std::string> table_;
    TomlSpans found_;
};

/// The character that an escape sequence at `at` (behind the backslash) stands for; moves behind it.
void unescape(std::string_view text, std::size_t& at, std::string& out) {
    const char c = text[at++];
    constexpr std::string_view letters = "btnfre\"\\", meanings = "\b\t\n\f\r\x1b\"\\";
    if (const std::size_t k = letters.find(c); k != std::string_view::npos) {
        out += meanings[k];
    } else if (c == 'u' || c == 'U') {
        const std::size_t digits = c == 'u' ? 4 : 8;
        std::uint32_t code = 0xFFFD;
        const std::string_view hex = text.substr(std::min(at, text.size()), digits);
        std::from_chars(hex.data(), hex.data() + hex.size(), code, 16);
        append_utf8(out, code);
        at += hex.size();
    } else if (is_newline(c) || is_blank(c)) {
        while (at < text.size() && (is_newline(text[at]) || is_blank(text[at]))) ++at;
    }
}

}  // namespace

const TomlEntry* TomlSpans::find(const std::vector<std::string>& path) const {
    const auto found = std::ranges::find(entries, path, &TomlEntry::path);
    return found == entries.end() ? nullptr : &*found;
}

TomlSpans toml_spans(std::string_view text) { return Scanner(text, 0).document(); }

std::vector<TomlElement> toml_elements(std::string_view text, const TextSpan& array) {
    return Scanner(text, array.begin).elements(array.end);
}

std::string toml_unquoted(std::string_view written) {
    if (written.size() < 2 || (written.front() != '"' && written.front() != '\'')) return std::string(written);
    const char quote = written.front();
    const bool spans_lines = written.size() >= 6 && written[1] == quote && written[2] == quote;
    const std::size_t fence = spans_lines ? 3 : 1;
    std::string_view inside = written.substr(fence, written.size() - 2 * fence);
    if (spans_lines && inside.starts_with("\r\n")) inside.remove_prefix(2);
    else if (spans_lines && inside.starts_with('\n')) inside.remove_prefix(1);
    if (quote == '\'') return std::string(inside);
    std::string out;
    for (std::size_t at = 0; at < inside.size();) {
        if (inside[at] == '\\' && at + 1 < inside.size()) unescape(inside, ++at, out);
        else out += inside[at++];
    }
    return out;
}

std::string toml_quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += fmt::format("\\{}", c);
        else if (c == '\n') out += "\\n";
        else if (c == '\t') out += "\\t";
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        else out += c;
    }
    return out + '"';
}

}  // namespace tactus::edit
