// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/search.hpp"

#include "dsp/core/lower.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <vector>

namespace tactus::window {

namespace {

/// Words of one line mean the same.
constexpr std::array<std::string_view, 30> synonyms{
    "sine oscillator tone lfo wave",
    "gain multiply amplify volume factor scale",
    "add sum plus mix",
    "subtract minus difference",
    "filter lowpass highpass bandpass equaliser",
    "delay echo",
    "noise random",
    "output speaker sound audio dac",
    "input hand device stylus",
    "sphere ball",
    "wall plane box",
    "wrench force torque",
    "penetration depth",
    "contact touch collision",
    "saw cut carve burr drill",
    "fracture fragment piece",
    "snap fit match settle",
    "constant number value slider",
    "record log save write table csv",
    "scope plot show monitor meter",
    "gate switch select choose",
    "compare threshold greater less",
    "toggle latch flip",
    "trigger button event bang",
    "clip limit clamp saturate",
    "range map scale",
    "smooth slew ramp glide",
    "envelope adsr",
    "remove delete erase",
    "open load",
};

std::vector<std::string_view> words_of(std::string_view text) {
    std::vector<std::string_view> words;
    for (std::size_t at = 0; (at = text.find_first_not_of(" \t", at)) != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(" \t", at), text.size());
        words.push_back(text.substr(at, end - at));
        at = end;
    }
    return words;
}

bool begins_word(std::string_view text, std::size_t at) {
    return at == 0 || !std::isalnum(static_cast<unsigned char>(text[at - 1]));
}

double place_of(std::string_view word, std::string_view name, std::string_view about) {
    if (name == word) return 8.0;
    if (name.starts_with(word)) return 5.0;
    if (const std::size_t at = name.find(word); at != std::string_view::npos) return begins_word(name, at) ? 4.0 : 2.0;
    if (const std::size_t at = about.find(word); at != std::string_view::npos)
        return begins_word(about, at) ? 1.0 : 0.4;
    return 0.0;
}

double place_of_meaning(std::string_view word, std::string_view name, std::string_view about) {
    double best = place_of(word, name, about);
    // A beginning of two letters means too much.
    if (best >= 2.0 || word.size() < 3) return best;
    for (const std::string_view line : synonyms) {
        const auto same = words_of(line);
        if (std::ranges::none_of(same, [&](std::string_view known) { return known.starts_with(word); })) continue;
        for (const std::string_view other : same) best = std::max(best, 0.5 * place_of(other, name, about));
    }
    return best;
}

}  // namespace

double suits(std::string_view typed, std::string_view name, std::string_view about, std::string_view details) {
    const std::string wanted = lower(typed), in_name = lower(name), in_about = lower(about),
                      in_details = lower(details);
    double sum = 0.0;
    const auto words = words_of(wanted);
    for (const std::string_view word : words) {
        double place = place_of_meaning(word, in_name, in_about);
        if (const std::size_t at = in_details.find(word); place < 0.9 && at != std::string::npos)
            place = std::max(place, begins_word(in_details, at) ? 0.9 : 0.3);
        if (place == 0.0) return 0.0;
        sum += place;
    }
    return words.empty() ? 1.0 : sum / static_cast<double>(words.size());
}

}  // namespace tactus::window
