// SPDX-License-Identifier: Apache-2.0
// Random formulas against Python, which reads the same text.
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "graph/formula/formula.hpp"
#include "graph/formula/single.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/skip.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::formula;

namespace {

class Writer {
public:
    explicit Writer(std::uint64_t seed) : random_{mix(seed)} {}

    double number() { return 4.0 * random_.uniform(draws_++) - 2.0; }

    std::string formula(int depth = 4) {
        if (depth == 0 || pick(8) == 0) return leaf();
        const std::string a = formula(depth - 1);
        switch (pick(12)) {
            case 0: return a + " + " + formula(depth - 1);
            case 1: return a + " - " + formula(depth - 1);
            case 2: return a + "*" + formula(depth - 1);
            case 3: return a + "/" + formula(depth - 1);
            case 4: return "-" + a;
            case 5: return leaf() + "^" + power();
            case 6: return "-" + leaf() + "^" + power() + "^" + power();
            case 7: return "(" + a + ")" + " % " + "(" + formula(depth - 1) + ")";
            case 8: return one_of({"abs", "sqrt", "exp", "log", "sin", "cos", "tan", "sign", "floor"}) + "(" + a + ")";
            case 9: return one_of({"min", "max"}) + "(" + a + ", " + formula(depth - 1) + ", " + leaf() + ")";
            case 10:
                return "if((" + a + one_of({" < ", " >= ", " <= ", " > "}) + formula(depth - 1) + ")" +
                       one_of({" and ", " or "}) + "not (" + leaf() + " > " + leaf() + "), " + leaf() + ", " +
                       formula(depth - 1) + ")";
            default: return "(" + a + ")*clip(" + leaf() + ", -1, 1)";
        }
    }

private:
    std::uint64_t pick(std::uint64_t count) { return random_.bits(draws_++) % count; }
    std::string one_of(const std::vector<std::string>& words) { return words[pick(words.size())]; }
    std::string leaf() {
        const std::string name = one_of({"x", "y", "z", "", "pi"});
        return name.empty() ? fmt::format("{:.3f}", 2.0 * random_.uniform(draws_++)) : name;
    }
    std::string power() { return one_of({"2", "3", "0.5", "1.5", "-1", "-2"}); }

    Random random_;
    std::uint64_t draws_ = 0;
};

struct Asked {
    std::string text;
    double given[3];
};

std::vector<std::string> answers(const std::vector<Asked>& asked) {
    const auto folder = std::filesystem::temp_directory_path() / fmt::format("tactus_formulas_{}", ::getpid());
    std::filesystem::create_directories(folder);
    {
        std::ofstream file(folder / "asked");
        for (const Asked& a : asked)
            file << fmt::format("{:a} {:a} {:a} {}\n", a.given[0], a.given[1], a.given[2], a.text);
    }
    const std::string script = (test::source_folder() / "tests/graph/formula/evaluate.py").string();
    const std::string command =
        fmt::format("python3 '{}' <'{}' >'{}'", script, (folder / "asked").string(), (folder / "said").string());
    std::vector<std::string> lines;
    if (std::system(command.c_str()) == 0) {
        std::ifstream file(folder / "said");
        for (std::string line; std::getline(file, line);) lines.push_back(line);
    }
    std::filesystem::remove_all(folder);
    return lines;
}

/// Nothing where the formula without variables has no finite value, which is refused.
std::optional<double> value_of(const Asked& asked) {
    static const auto names = parse_variables("x, y, z");
    try {
        const Program program = compile_formula(asked.text, names, {}).program;
        Machine machine(program);
        Single single;
        single.prepare(program);
        for (std::size_t i = 0; i < 3; ++i) *machine.variable(i) = asked.given[i];
        single.put(2, asked.given[2]);
        const double value = single.run(asked.given[0], asked.given[1]), of_block = machine.run(1).front();
        if (std::isfinite(value) || std::isfinite(of_block))
            CHECK(std::bit_cast<std::uint64_t>(value) == std::bit_cast<std::uint64_t>(of_block));
        if (!std::isfinite(value)) return std::nullopt;
        return value;
    } catch (const Error& error) {
        if (std::string(error.what()).find("no finite value") != std::string::npos) return std::nullopt;
        throw;
    }
}

void compare_formulas(std::size_t count) {
    std::vector<Asked> asked;
    for (std::size_t i = 0; i < count; ++i) {
        Writer writer(i);
        asked.push_back({writer.formula(), {writer.number(), writer.number(), writer.number()}});
    }
    const std::vector<std::string> said = answers(asked);
    if (said.empty()) return test::skip("python3 is missing");
    REQUIRE(said.size() == count);
    std::size_t compared = 0, different = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (said[i] == "none") continue;
        const double theirs = std::strtod(said[i].c_str(), nullptr);
        const std::optional<double> ours = value_of(asked[i]);
        ++compared;
        // 1e-12: a square is a product here and a power there, which may round another way.
        if (ours && std::abs(*ours - theirs) <= 1e-12 * std::max(1.0, std::abs(theirs))) {
            different += *ours != theirs;
            continue;
        }
        INFO(asked[i].text << " at " << fmt::format("{} {} {}", asked[i].given[0], asked[i].given[1], asked[i].given[2])
                           << ": " << (ours ? fmt::format("{}", *ours) : "none") << ", Python says " << theirs);
        FAIL_CHECK();
        break;
    }
    CHECK(compared > count / 2);
    CHECK(different < compared / 1000);
}

}  // namespace

TEST_CASE("random formulas have the value that Python gives to their text, to the bit", "[slow]") {
    compare_formulas(20'000);
}

TEST_CASE("100,000 random formulas have the value that Python gives to their text, to the bit", "[long]") {
    compare_formulas(100'000);
}
