// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/dicom_elements.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace tactus::volume {

namespace {

constexpr std::uint32_t undefined = 0xffffffffu;
constexpr int deepest = 32;

class Walk {
public:
    Walk(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

    std::string doubt() {
        try {
            whole_file();
        } catch (const Error& error) {
            if (lacks_samples_) throw;
            return error.what();
        }
        return {};
    }

private:
    void whole_file() {
        // Files without a preamble begin with their first element.
        if (bytes_.size() >= 132 && bytes_.substr(128, 4) == "DICM") at_ = 132;
        while (at_ < bytes_.size() && peek16() == 2) {
            const Element e = element();
            if (e.length == undefined || e.length > bytes_.size() - at_) fail("cut short");
            if (e.number == 0x10) syntax_ = bytes_.substr(at_, e.length);
            at_ += e.length;
        }
        while (!syntax_.empty() && (syntax_.back() == '\0' || syntax_.back() == ' ')) syntax_.remove_suffix(1);
        if (syntax_ == "1.2.840.10008.1.2.1.99") return;  // deflated: only the library can walk it
        implicit_ = syntax_.empty() ? !has_representation() : syntax_ == "1.2.840.10008.1.2";
        big_ = syntax_ == "1.2.840.10008.1.2.2";
        if (at_ >= bytes_.size()) fail("cut short: it has only a header");
        elements(bytes_.size(), 0, false);
    }

    struct Element {
        unsigned group = 0, number = 0;
        std::string_view kind;
        std::uint32_t length = 0;
    };

    [[noreturn]] void fail(std::string_view why) const {
        throw Error(fmt::format("{}: damaged DICOM file: {} (byte {})", file_, why, at_));
    }

    std::uint32_t number(std::size_t size) {
        if (bytes_.size() - at_ < size) fail("cut short");
        std::uint32_t value = 0;
        for (std::size_t n = 0; n < size; ++n)
            value |= std::uint32_t{static_cast<unsigned char>(bytes_[at_ + n])} << (8 * (big_ ? size - 1 - n : n));
        at_ += size;
        return value;
    }

    std::uint32_t peek16() {
        const std::size_t start = at_;
        const std::uint32_t value = number(2);
        at_ = start;
        return value;
    }

    /// Without a stated transfer syntax: two capital letters follow the tag of an explicit element.
    bool has_representation() const {
        const auto is_capital = [&](std::size_t at) {
            return at < bytes_.size() && bytes_[at] >= 'A' && bytes_[at] <= 'Z';
        };
        return is_capital(at_ + 4) && is_capital(at_ + 5);
    }

    Element element() {
        Element e;
        e.group = number(2);
        e.number = number(2);
        if (implicit_ || e.group == 0xfffe) {
            e.length = number(4);
            return e;
        }
        if (bytes_.size() - at_ < 2) fail("cut short");
        e.kind = bytes_.substr(at_, 2);
        constexpr std::string_view kinds =
            "AE AS AT CS DA DS DT FD FL IS LO LT OB OD OF OL OV OW PN SH SL SQ SS ST SV TM UC UI UL UN UR US UT UV ";
        const std::size_t place = kinds.find(std::string(e.kind) + ' ');
        if (place == std::string_view::npos || place % 3 != 0) fail("an element with an unknown value representation");
        at_ += 2;
        constexpr std::string_view wide = "OB OD OF OL OV OW SQ SV UC UN UR UT UV ";
        if (wide.find(std::string(e.kind) + ' ') != std::string_view::npos) {
            number(2);
            e.length = number(4);
        } else {
            e.length = number(2);
        }
        return e;
    }

    // Walks the elements up to `end`, or to the delimiter of an item of undefined length.
    void elements(std::size_t end, int depth, bool to_mark) {
        if (depth > deepest) fail("sequences are nested too deeply");
        while (at_ < end) {
            // Some programs fill files with zeros behind the last element.
            if (depth == 0 && bytes_.find_first_not_of('\0', at_) == std::string_view::npos) return;
            const Element e = element();
            if (e.group == 0xfffe) {
                if (to_mark && e.number == 0xe00d && e.length == 0) return;
                fail("an item outside a sequence");
            }
            // The element's header may reach beyond its container.
            if (at_ > end) fail("cut short: an element reaches beyond its sequence");
            const bool is_pixels = e.group == 0x7fe0 && e.number == 0x10;
            if (e.length == undefined || e.kind == "SQ") {
                if (e.length != undefined && e.length > end - at_) fail("a sequence reaches beyond the file");
                // Correction 246: the items of an unknown sequence of undefined length are implicit.
                const bool is_implicit = implicit_;
                if (e.kind == "UN") implicit_ = true;
                items(e.length == undefined ? end : at_ + e.length, depth, e.length == undefined, is_pixels);
                implicit_ = is_implicit;
                continue;
            }
            if (e.length > end - at_) {
                if (is_pixels && depth == 0) lacks_samples_ = true;
                fail(is_pixels ? "cut short: samples are missing" : "cut short");
            }
            at_ += e.length;
        }
        if (to_mark) fail("cut short: an item has no end");
    }

    void items(std::size_t end, int depth, bool to_mark, bool are_fragments) {
        while (at_ < end) {
            const Element e = element();
            if (at_ > end) fail("cut short: an item reaches beyond its sequence");
            if (e.group != 0xfffe) fail("something else than an item in a sequence");
            if (e.number == 0xe0dd && to_mark) return;
            if (e.number != 0xe000) fail("something else than an item in a sequence");
            if (e.length != undefined && e.length > end - at_) fail("cut short: an item reaches beyond its sequence");
            if (are_fragments) {
                if (e.length == undefined) fail("a fragment without a length");
                at_ += e.length;
            } else {
                elements(e.length == undefined ? end : at_ + e.length, depth + 1, e.length == undefined);
            }
        }
        if (to_mark) fail("cut short: a sequence has no end");
    }

    std::string_view bytes_, syntax_;
    const std::string& file_;
    std::size_t at_ = 0;
    bool implicit_ = false, big_ = false, lacks_samples_ = false;
};

}  // namespace

std::string doubt_about_dicom(std::string_view bytes, const std::string& file) { return Walk(bytes, file).doubt(); }

}  // namespace tactus::volume
