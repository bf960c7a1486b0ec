// SPDX-License-Identifier: Apache-2.0
#include "graph/patch/patch_wire.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

namespace tactus::patch {

bool is_name(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
    });
}

namespace {

struct Word {
    std::string_view text;
    std::size_t at = 0;
};

std::vector<Word> words_of(std::string_view text) {
    std::vector<Word> words;
    for (std::size_t at = 0; at < text.size();) {
        if (std::isspace(static_cast<unsigned char>(text[at]))) {
            ++at;
            continue;
        }
        // No spaces are needed around the arrow.
        std::size_t end = at;
        if (text.substr(at).starts_with("->")) end = at + 2;
        else
            while (end < text.size() && !std::isspace(static_cast<unsigned char>(text[end])) &&
                   !text.substr(end).starts_with("->"))
                ++end;
        words.push_back({text.substr(at, end - at), at});
        at = end;
    }
    return words;
}

class WireParser {
public:
    WireParser(std::string_view text, const SourceLocation& where, bool as_written)
        : text_(text), where_(where), as_written_(as_written), words_(words_of(text)) {}

    PatchWire parse() {
        wire_.where = where_;
        if (words_.size() < 3 || words_[1].text != "->")
            fail(words_.size() > 1 ? words_[1].at : 0, "a wire reads \"node.port -> node.port\"");
        end_of(words_[0], wire_.from_node, wire_.from_port, true);
        end_of(words_[2], wire_.to_node, wire_.to_port, false);
        if (words_.size() > 3) mode();
        return std::move(wire_);
    }

private:
    [[noreturn]] void fail(std::size_t at, const std::string& message) const {
        SourceLocation where = where_;
        if (as_written_ && where.column > 0) where.column += static_cast<int>(at);
        constexpr std::size_t max_shown = 80;
        const bool is_long = text_.size() > max_shown;
        throw Error(where, fmt::format("{}, not \"{}{}\"", message, text_.substr(0, max_shown), is_long ? "…" : ""));
    }

    void end_of(const Word& word, std::string& node, std::string& port, bool may_be_asset) const {
        const std::size_t dot = word.text.find('.');
        if (dot == std::string_view::npos) {
            if (!may_be_asset) fail(word.at, "a wire ends at a port, as in \"node.port\"");
            node = word.text;
        } else {
            node = word.text.substr(0, dot);
            port = word.text.substr(dot + 1);
            if (!is_name(port)) fail(word.at + dot + 1, "a port's name has letters, digits and '_'");
        }
        if (!is_name(node)) fail(word.at, "a node's name has letters, digits, '_' and '-'");
    }

    void mode() {
        if (words_[3].text != "as" || words_.size() < 5)
            fail(words_[3].at, "after the target comes \"as hold\", \"as linear\", \"as batch\" or \"as delay N\"");
        const std::string_view word = words_[4].text;
        wire_.mode_given = true;
        std::size_t used = 5;
        if (word == "hold") wire_.mode = WireMode::hold;
        else if (word == "linear") wire_.mode = WireMode::linear;
        else if (word == "batch") wire_.mode = WireMode::batch;
        else if (word == "delay") {
            wire_.mode = WireMode::delay;
            const std::string_view number = words_.size() > 5 ? words_[5].text : "";
            const auto [end, failure] = std::from_chars(number.data(), number.data() + number.size(), wire_.delay);
            if (failure != std::errc{} || end != number.data() + number.size() || wire_.delay < 1 ||
                wire_.delay > 1'000'000)
                fail(words_[4].at, "a delay is a whole number of ticks, at least 1, as in \"as delay 1\"");
            used = 6;
        } else fail(words_[4].at, "a wire delivers as hold, linear, batch or delay N");
        if (words_.size() > used) fail(words_[used].at, "nothing may follow here");
    }

    std::string_view text_;
    SourceLocation where_;
    bool as_written_;
    std::vector<Word> words_;
    PatchWire wire_;
};

}  // namespace

PatchWire parse_wire(std::string_view text, const SourceLocation& where, bool as_written) {
    return WireParser(text, where, as_written).parse();
}

}  // namespace tactus::patch
