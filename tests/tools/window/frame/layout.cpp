// SPDX-License-Identifier: Apache-2.0
// Which panels stand where.
#include "tools/window/frame/layout.hpp"
#include "tests/support/catch.hpp"

#include <set>

using namespace tactus::window;

namespace {

PanelRoom everywhere(Panel) { return PanelRoom::full; }

void check_shares(const std::vector<LayoutColumn>& columns) {
    double across = 0.0;
    for (const LayoutColumn& column : columns) {
        across += column.share;
        double down = 0.0;
        for (const PanelPlace& place : column.panels) down += place.share;
        CHECK(down == Approx(1.0));
    }
    CHECK(across == Approx(1.0));
}

}  // namespace

TEST_CASE("each layout fills the window at each width, and no panel stands twice") {
    for (const char* name : {"patch", "plan", "train"})
        for (const double width : {400.0, 800.0, 1600.0, 2560.0}) {
            const auto layout = layout_of_name(name);
            REQUIRE(layout);
            CHECK(name_of(*layout) == name);
            const auto columns = columns_of(*layout, width, everywhere);
            check_shares(columns);
            std::set<Panel> seen;
            for (const LayoutColumn& column : columns)
                for (const PanelPlace& place : column.panels) CHECK(seen.insert(place.panel).second);
            CHECK(seen.contains(Panel::scene));
        }
    CHECK_FALSE(layout_of_name("desk"));
    CHECK(columns_of(Layout::patch, 1600.0, everywhere).size() == 2);
    CHECK(columns_of(Layout::patch, 2560.0, everywhere).size() == 3);
    CHECK(columns_of(Layout::plan, 2560.0, everywhere).size() == 3);
}

TEST_CASE("a panel without room leaves it to the others, and a window never is empty") {
    const auto without = [](Panel gone) {
        return [gone](Panel panel) { return panel == gone ? PanelRoom::none : PanelRoom::full; };
    };
    const auto columns = columns_of(Layout::patch, 1600.0, without(Panel::scene));
    check_shares(columns);
    CHECK_FALSE(shows(columns, Panel::scene));
    CHECK(columns[1].panels.size() == 1);
    const auto alone = columns_of(Layout::train, 1600.0, without(Panel::task));
    REQUIRE(alone.size() == 1);
    check_shares(alone);
    const auto patch_only = [](Panel panel) { return panel == Panel::patch ? PanelRoom::full : PanelRoom::none; };
    CHECK(shows(columns_of(Layout::train, 1600.0, patch_only), Panel::patch));
    CHECK(columns_of(Layout::train, 1600.0, [](Panel) { return PanelRoom::none; }).empty());
}

TEST_CASE("a border that is moved takes from its neighbour only, and leaves it a part") {
    auto columns = columns_of(Layout::patch, 2560.0, everywhere);
    const double first = columns[0].share, second = columns[1].share, third = columns[2].share;
    move_border(columns, 0, 0.05);
    CHECK(columns[0].share == Approx(first + 0.05));
    CHECK(columns[1].share == Approx(second - 0.05));
    move_border(columns, 0, 7.0);
    CHECK(columns[1].share > 0.1);
    CHECK(columns[2].share == third);
    move_border(columns, 2, 0.5);
    check_shares(columns);
}
