// SPDX-License-Identifier: Apache-2.0
#include "graph/formula/single.hpp"

#include "graph/formula/operations.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace tactus::formula {

namespace {

constexpr auto operations = static_cast<std::size_t>(Operation::multiply_multiply) + 1;

/// Where an operand is.
enum class From : std::uint8_t { result, first, second, word };

/// The same for an operand that the operation does not have.
constexpr From from_of(Operation operation, std::size_t operand, std::size_t from) {
    return operand < operands_of(operation) ? static_cast<From>(from) : From::result;
}

}  // namespace

struct Single::Steps {
    using Function = double (*)(const Word*, double, double, double) noexcept;

    template <From from>
    static double take(const Word*& at, double result, double first, double second) noexcept {
        if constexpr (from == From::result) return result;
        else if constexpr (from == From::first) return first;
        else if constexpr (from == From::second) return second;
        else return (at++)->value;
    }
    // Each begins a line of the cache: else the cost depends on where the linker puts them.
    template <Operation operation, From from_a, From from_b, From from_c>
    [[gnu::aligned(64)]] static double run(const Word* at, double result, double first, double second) noexcept {
        ++at;
        const double a = take<from_a>(at, result, first, second);
        const double b = take<from_b>(at, result, first, second);
        const double c = take<from_c>(at, result, first, second);
        return at->run(at, apply_known<operation>(a, b, c), first, second);
    }
    static double store(const Word* at, double result, double first, double second) noexcept {
        *at[1].place = result;
        return at[2].run(at + 2, result, first, second);
    }
    static double end(const Word*, double result, double, double) noexcept { return result; }
    static double end_first(const Word*, double, double first, double) noexcept { return first; }
    static double end_second(const Word*, double, double, double second) noexcept { return second; }
    static double end_word(const Word* at, double, double, double) noexcept { return at[1].value; }

    /// The functions of an operation, by where its operands are, the last one's place first.
    template <Operation operation, std::size_t... i>
    static constexpr std::array<Function, 64> functions_of(std::index_sequence<i...>) {
        return {run<operation, from_of(operation, 0, i % 4), from_of(operation, 1, i / 4 % 4),
                    from_of(operation, 2, i / 16)>...};
    }
    template <std::size_t... i>
    static constexpr std::array<std::array<Function, 64>, operations> all_functions(std::index_sequence<i...>) {
        return {functions_of<static_cast<Operation>(i)>(std::make_index_sequence<64>())...};
    }
    static Function of(Operation operation, From a, From b, From c) {
        static constexpr auto functions = all_functions(std::make_index_sequence<operations>());
        return functions[static_cast<std::size_t>(operation)][static_cast<std::size_t>(a) +
                                                              4 * static_cast<std::size_t>(b) +
                                                              16 * static_cast<std::size_t>(c)];
    }
};

/// Lays out words; what points to words is set when all of them have their places.
struct Single::Writer {
    explicit Writer(const Program& program_) : program(program_) {}

    const Program& program;
    std::vector<Word> words;
    std::vector<std::pair<std::size_t, std::size_t>> stores;  ///< the place's word, and the operand's
    std::vector<std::pair<std::size_t, std::size_t>> uses;    ///< variable, and the operand's word

    std::uint8_t operand(std::size_t instruction, std::size_t i) const {
        const Instruction& at = program.instructions[instruction];
        return i == 0 ? at.a : i == 1 ? at.b : at.c;
    }
    bool is_between(std::uint8_t place) const { return place >= program.variables + program.constants.size(); }
    /// The instruction that made what this one finds in a register between.
    std::size_t maker(std::size_t instruction, std::uint8_t place) const {
        while (instruction-- > 0)
            if (program.instructions[instruction].to == place) return instruction;
        return 0;
    }
    From from(std::size_t instruction, std::uint8_t place) const {
        if (place < program.variables) return place == 0 ? From::first : place == 1 ? From::second : From::word;
        return is_between(place) && maker(instruction, place) + 1 == instruction ? From::result : From::word;
    }
    void word(std::uint8_t place) {
        if (place < program.variables) uses.emplace_back(place, words.size());
        Word word{.value = 0.0};
        if (place >= program.variables && !is_between(place)) word.value = program.constants[place - program.variables];
        words.push_back(word);
    }

    void write() {
        const std::size_t count = program.instructions.size();
        // Of each instruction, the words of stores that wait for its operands' words.
        struct Waiting {
            std::size_t instruction, operand, place;
        };
        std::vector<Waiting> waiting;
        for (std::size_t n = 0; n < count; ++n) {
            const Operation operation = program.instructions[n].operation;
            const std::size_t operands = operands_of(operation);
            From places[3] = {From::result, From::result, From::result};
            for (std::size_t i = 0; i < operands; ++i) places[i] = from(n, operand(n, i));
            words.push_back({.run = Steps::of(operation, places[0], places[1], places[2])});
            for (std::size_t i = 0; i < operands; ++i) {
                if (places[i] != From::word) continue;
                for (const Waiting& w : waiting)
                    if (w.instruction == n && w.operand == i) stores.emplace_back(w.place, words.size());
                word(operand(n, i));
            }
            // Whoever needs the result later than at once has a word for it.
            for (std::size_t later = n + 2; later < count; ++later)
                for (std::size_t i = 0; i < operands_of(program.instructions[later].operation); ++i) {
                    const std::uint8_t place = operand(later, i);
                    if (!is_between(place) || maker(later, place) != n) continue;
                    words.push_back({.run = Steps::store});
                    waiting.push_back({later, i, words.size()});
                    words.push_back({.place = nullptr});
                }
        }
        if (count > 0) return words.push_back({.run = Steps::end});
        // A variable or a constant alone.
        const From only = from(0, program.result);
        words.push_back({.run = only == From::first    ? Steps::end_first
                                : only == From::second ? Steps::end_second
                                                       : Steps::end_word});
        if (only == From::word) word(program.result);
    }
};

void Single::prepare(const Program& program) {
    Writer writer(program);
    writer.write();
    const bool is_near = writer.words.size() <= max_near;
    far_ = is_near ? std::vector<Word>{} : std::move(writer.words);
    if (is_near) std::ranges::copy(writer.words, near_);
    code_ = is_near ? near_ : far_.data();
    for (const auto& [place, operand] : writer.stores) code_[place].place = &code_[operand].value;
    uses_.clear();
    for (const auto& [variable, operand] : writer.uses) uses_.push_back({variable, &code_[operand].value});
}

}  // namespace tactus::formula
