// SPDX-License-Identifier: Apache-2.0
#include "tests/tools/window/eyes.hpp"

#include "devices/display/png.hpp"

#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace tactus::test {

namespace fs = std::filesystem;

std::map<std::string, Spot> Eyes::spots() const {
    std::map<std::string, Spot> all;
    std::ifstream file(folder / "spots.txt");
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line.substr(line.find('\t') + 1));
        Spot spot{};
        words >> spot.left >> spot.top >> spot.right >> spot.bottom;
        all[line.substr(0, line.find('\t'))] = spot;
    }
    return all;
}

Spot Eyes::spot(const std::string& name) const {
    Spot found{};
    const bool is_there = sees([&] {
        const auto all = spots();
        const auto at = all.find(name);
        if (at != all.end()) found = at->second;
        return at != all.end();
    });
    if (!is_there) FAIL("no control '" << name << "'");
    return found;
}

fs::file_time_type Eyes::written() const {
    std::error_code none;
    return fs::last_write_time(folder / "spots.txt", none);
}

void Eyes::wait_for_next() const {
    const auto before = written();
    // Some scripts write once.
    for (int n = 0; n < 40 && written() == before; ++n) Person::wait(0.025);
}

void Eyes::look_again() const {
    for (int i = 0; i < 2; ++i) wait_for_next();
}

Spot Eyes::resting_spot(const std::string& name) const {
    Spot at = spot(name);
    for (int i = 0; i < 20; ++i) {
        wait_for_next();
        const Spot now = spot(name);
        if (now == at) break;
        at = now;
    }
    return at;
}

std::vector<double> Eyes::last_row(const std::string& table) const {
    constexpr std::streamoff enough = 800;
    std::ifstream file(folder / (table + ".part"), std::ios::ate);
    if (!file) file.open(folder / table, std::ios::ate);
    if (!file) return {};
    const auto size = static_cast<std::streamoff>(file.tellg());
    file.seekg(std::max<std::streamoff>(0, size - enough));
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    const std::size_t end = text.rfind('\n'), begin = end == std::string::npos ? end : text.rfind('\n', end - 1);
    if (begin == std::string::npos) return {};
    std::string line = text.substr(begin + 1, end - begin - 1);
    std::ranges::replace(line, ',', ' ');
    std::istringstream words(line);
    std::vector<double> row;
    for (double value = 0.0; words >> value;) row.push_back(value);
    return row;
}

void press(Person& person, const Eyes& eyes, const std::string& control) {
    const Spot at = eyes.resting_spot(control);
    person.click(0.5 * (at.left + at.right), 0.5 * (at.top + at.bottom));
    Person::wait(0.3);
}

std::string watching_script(const std::string& begin, double seconds) {
    std::string script = begin;
    for (int i = 0; i < static_cast<int>(10.0 * seconds); ++i) script += "wait 0.1\nspots spots.txt\n";
    return script + "close\n";
}

void settle(const Person& person) {
    Picture before = person.look();
    for (int i = 0; i < 30; ++i) {
        Person::wait(0.5);
        Picture now = person.look();
        if (now.rgb == before.rgb) return;
        before = std::move(now);
    }
}

void keep(const Person& person, const std::string& name) {
    const char* folder = std::getenv("TACTUS_KEEP_PICTURES");
    if (!folder) return;
    const Picture seen = person.look();
    display::Image image;
    image.width = seen.width;
    image.height = seen.height;
    image.rgb = seen.rgb;
    display::write_png(image, (fs::path(folder) / (name + ".png")).string());
}

void interrupt(const fs::path& folder, int signal) {
    std::error_code none;
    for (const auto& process : fs::directory_iterator("/proc", none)) {
        std::ifstream name(process.path() / "comm");
        std::string comm;
        if (!(name >> comm) || (comm != "tactus" && comm != "tactus-full") ||
            fs::read_symlink(process.path() / "cwd", none) != folder)
            continue;
        ::kill(std::stoi(process.path().filename()), signal);
    }
}

}  // namespace tactus::test
