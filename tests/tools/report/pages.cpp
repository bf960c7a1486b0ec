// SPDX-License-Identifier: Apache-2.0
// Blocks of a report on pages: scripts, tables over several pages, the part that two paper sizes share.
#include "tools/report/blocks/pages.hpp"

#include "devices/display/figure_painter.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/pdf_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using display::Figure;
using report::ReportBlock;

namespace {

std::vector<const Figure::Text*> texts_of(const Figure& page) {
    std::vector<const Figure::Text*> all;
    for (const Figure::Item& item : page.items())
        if (const auto* text = std::get_if<Figure::Text>(&item)) all.push_back(text);
    return all;
}

std::size_t count_of(const Figure& page, const std::string& words) {
    return static_cast<std::size_t>(
        std::ranges::count_if(texts_of(page), [&](const Figure::Text* text) { return text->text == words; }));
}

std::vector<ReportBlock> long_table(int rows) {
    report::ReportTable table{{"fragment", "gap, mm"}, {}};
    for (int n = 0; n < rows; ++n) table.rows.push_back({fmt::format("fragment {}", n), fmt::format("{}.5", n)});
    return {report::Heading{"Gaps"}, table};
}

}  // namespace

TEST_CASE("names in Greek, Cyrillic and Japanese are in the text of a PDF report") {
    const test::Folder folder;
    const std::string greek = "Κάτω γνάθος", cyrillic = "Нижняя челюсть", japanese = "下顎骨の再建";
    std::vector<ReportBlock> blocks{report::Paragraph{greek}, report::ReportTable{{"name"}, {{cyrillic}, {japanese}}}};
    const report::Pdf pdf = report::pdf_of("Σχέδιο", blocks);
    const std::optional<std::string> text = test::pdf_text(folder, folder.write("a.pdf", pdf.bytes));
    if (!text) return;
    CHECK_THAT(*text, ContainsSubstring(greek) && ContainsSubstring(cyrillic) && ContainsSubstring("Σχέδιο"));
    // Where no font has the letters, the report says so.
    if (pdf.warning.empty()) CHECK_THAT(*text, ContainsSubstring(japanese));
    else CHECK_THAT(pdf.warning, ContainsSubstring("U+4E0B"));
}

TEST_CASE("a table over several pages has its head on each, and loses no row") {
    constexpr int rows = 200;
    const std::vector<Figure> pages = report::pages_of("long", long_table(rows));
    REQUIRE(pages.size() > 2);
    for (const Figure& page : pages) CHECK(count_of(page, "gap, mm") == 1);
    for (int n = 0; n < rows; ++n) {
        std::size_t found = 0;
        for (const Figure& page : pages) found += count_of(page, fmt::format("fragment {}", n));
        CHECK(found == 1);
    }
}

TEST_CASE("all that a page holds is on A4 and on Letter") {
    // Letter is 612 × 792 points; A4 is printed on it with the middle on the middle, which cuts 25 points of each end.
    std::vector<ReportBlock> blocks = long_table(100);
    blocks.emplace_back(report::Paragraph{std::string(400, 'w')});
    blocks.emplace_back(report::Drawing{Figure(2000.0, 300.0), "a wide one"});
    for (const Figure& page : report::pages_of("where", blocks))
        for (const Figure::Text* text : texts_of(page)) {
            CAPTURE(text->text);
            const double width = display::figure_painter().text_width(text->text, text->size, text->bold);
            const double left = text->anchor == display::TextAnchor::end ? text->at.x - width : text->at.x;
            CHECK(left >= 36.0);
            CHECK(left + width <= 595.0 - 36.0);
            CHECK(text->at.y - text->size >= 25.0 + 18.0);
            CHECK(text->at.y <= 842.0 - 25.0 - 18.0);
        }
}

TEST_CASE("a text without spaces is broken within the width of its cell, and stays whole") {
    const std::string name(120, 'x');
    const std::vector<ReportBlock> blocks{
        report::ReportTable{{"name", "other", "third"}, {{name, name, std::string("骨").append(name)}}}};
    const std::vector<Figure> pages = report::pages_of("t", blocks);
    REQUIRE(pages.size() == 1);
    std::size_t letters = 0;
    for (const Figure::Text* text : texts_of(pages[0]))
        if (text->text.find("xxxx") != std::string::npos)
            letters += static_cast<std::size_t>(std::ranges::count(text->text, 'x'));
    CHECK(letters == 360);
}

TEST_CASE("no text of a labelled picture is below 6 points on a page") {
    render::LabelledPicture picture;
    picture.image = {720, 540, std::vector<std::uint8_t>(3 * 720 * 540, 200)};
    picture.texts.push_back({100.0, 100.0, 's', 13.0, "fragment", Vec3(1.0, 0.0, 0.0)});
    picture.caption = "as planned";
    const std::vector<ReportBlock> blocks{report::PictureGrid{{picture, picture}}};
    std::size_t seen = 0;
    for (const Figure& page : report::pages_of("t", blocks))
        for (const Figure::Text* text : texts_of(page)) {
            CHECK(text->size > 5.999);
            seen += text->text == "fragment";
        }
    CHECK(seen == 2);
}

TEST_CASE("equal blocks give equal bytes of a PDF report") {
    CHECK(report::pdf_of("long", long_table(50)).bytes == report::pdf_of("long", long_table(50)).bytes);
}
